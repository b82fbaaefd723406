"""Solids come out of every kind of file, each distinct one once."""

import io
import tarfile
import zipfile

import pytest
import zstandard
from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.BRepTools import BRepTools
from OCP.gp import gp_Trsf, gp_Vec
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound

from faceformer_training.project.errors import ProjectionError
from faceformer_training.project.read import Item, ItemReader, list_items


def two_boxes_and_a_cylinder():
    """A compound in which one box is placed twice."""
    compound = TopoDS_Compound()
    builder = BRep_Builder()
    builder.MakeCompound(compound)
    box = BRepPrimAPI_MakeBox(3, 2, 1).Solid()
    shift = gp_Trsf()
    shift.SetTranslation(gp_Vec(10, 0, 0))
    for shape in (box, box.Located(TopLoc_Location(shift))):
        builder.Add(compound, shape)
    builder.Add(compound, BRepPrimAPI_MakeCylinder(1, 4).Shape())
    return compound


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("solids")
    shape = two_boxes_and_a_cylinder()
    BRepTools.Write_s(shape, str(path / "a.brep"))
    BinTools.Write_s(shape, str(path / "b.bin"))
    writer = STEPControl_Writer()
    writer.Transfer(shape, STEPControl_AsIs)
    writer.Write(str(path / "c.step"))
    packed = zstandard.compress((path / "b.bin").read_bytes())
    (path / "d.bin.zst").write_bytes(packed)
    with zipfile.ZipFile(path / "e.FCStd", "w") as document:
        document.writestr("Document.xml", "<Document/>")
        document.write(path / "a.brep", "Part.Shape.brp")
        document.writestr("Empty.brp", "")
    return path


@pytest.mark.parametrize("name", ["a.brep", "b.bin", "c.step", "d.bin.zst", "e.FCStd"])
def test_each_form(folder, name):
    (item,) = list_items([folder / name])
    solids = ItemReader().read(item)
    # STEP writes both placements of the box as one solid, or as two.
    assert len(solids) in ((2, 3) if name == "c.step" else (2,))


def test_an_archive_with_an_index(folder, tmp_path):
    path = tmp_path / "parts.tar"
    with tarfile.open(path, "w") as archive:
        archive.add(folder / "a.brep", "x/a.brep")
        archive.add(folder / "d.bin.zst", "d.bin.zst")
        info = tarfile.TarInfo("readme.txt")
        archive.addfile(info, io.BytesIO())
    index = '{"id": "parts/d", "repo": "o/r", "path": "p.step", "licence": "MIT", "name": "n"}\n'
    (tmp_path / "index_parts.jsonl").write_text(index)
    items = list_items([path])
    assert [i.name for i in items] == ["parts/x/a", "parts/d"]
    assert [i.source for i in items] == ["x/a.brep", "github.com/o/r p.step:n (MIT)"]
    reader = ItemReader()
    assert [len(reader.read(i)) for i in items] == [2, 2]


def test_a_folder_is_searched(folder):
    names = [i.name.split("/")[1] for i in list_items([folder])]
    assert names == ["a", "b", "c", "d", "e"]


@pytest.mark.parametrize("name", ["x.step", "x.brep", "x.bin", "x.bin.zst", "x.FCStd"])
def test_rubbish_is_refused(tmp_path, name):
    (tmp_path / name).write_bytes(b"no solid at all")
    with pytest.raises(ProjectionError) as caught:
        ItemReader().read(Item(str(tmp_path / name), None, "x", "x"))
    assert caught.value.code in ("unreadable", "no-solid")


def test_other_files_are_no_input(tmp_path):
    (tmp_path / "x.stl").write_text("")
    with pytest.raises(ValueError, match="neither"):
        list_items([tmp_path / "x.stl"])
    with pytest.raises(FileNotFoundError):
        list_items([tmp_path / "nothing.tar"])
