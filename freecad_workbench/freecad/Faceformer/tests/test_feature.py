# SPDX-License-Identifier: LGPL-2.1-or-later
import os
import tempfile
from pathlib import Path
from unittest import mock

import FreeCAD
import Part

from .. import api, feature, pipeline
from ..errors import BadInput, Failed
from .test_extract import DocumentTest


class FeatureTest(DocumentTest):
    def solid(self):
        obj = self.document.addObject("Part::FeaturePython", "Solid")
        feature.Solid(obj)
        return obj

    def test_a_new_object_has_the_defaults(self):
        obj = self.solid()
        self.assertEqual(obj.Engine, "rotation")
        self.assertEqual(obj.SchemaVersion, feature.SCHEMA)
        self.assertEqual(feature.options_of(obj), pipeline.SolidOptions())

    def test_options_survive_the_properties(self):
        obj = self.solid()
        options = pipeline.SolidOptions(2.5, True, "drawn", 3, ("Edge1 Edge2",))
        feature.apply(obj, "varley", options)
        self.assertEqual(feature.options_of(obj), options)
        self.assertEqual(obj.Engine, "varley")

    def test_an_object_without_source_is_invalid_and_says_why(self):
        obj = self.solid()
        self.document.recompute()
        self.assertFalse(obj.isValid())
        self.assertIn("Nothing is selected", obj.getStatusString())

    def test_the_solid_follows_the_work_of_the_library(self):
        obj, sketch = self.solid(), self.sketch()
        obj.Source = sketch
        brep = Part.makeBox(1, 2, 3).exportBrepToString()
        built = pipeline.Built(brep, {}, {}, {"notices": ["Two planes became one."]})
        identified = mock.Mock()
        identified.identification.findings = []
        identified.identification.notices = ["A notice."]
        with (
            mock.patch.object(pipeline, "identify", return_value=identified),
            mock.patch.object(pipeline, "solid", return_value=built),
        ):
            self.document.recompute()
        self.assertTrue(obj.isValid(), obj.getStatusString())
        self.assertAlmostEqual(obj.Shape.Volume, 6)
        self.assertEqual(obj.Messages, ["A notice.", "Two planes became one."])

    def test_text_that_is_no_brep_is_an_error(self):
        with self.assertRaisesRegex(Failed, "could not be read"):
            feature.shape_of(pipeline.Built("garbage", {}, {}, {}))

    def test_a_saved_object_comes_back_with_its_proxy_and_missing_properties(self):
        obj = self.solid()
        obj.Scale = 3
        obj.removeProperty("Reading")
        name = obj.Name
        with tempfile.TemporaryDirectory() as folder:
            path = os.fspath(Path(folder) / "solid.FCStd")
            self.document.saveAs(path)
            again = FreeCAD.openDocument(path)
            try:
                restored = again.getObject(name)
                self.assertTrue(feature.is_solid(restored))
                self.assertEqual(restored.Scale, 3)
                self.assertEqual(restored.Reading, 0)
            finally:
                if again.Name != self.document.Name:
                    FreeCAD.closeDocument(again.Name)

    def test_the_console_refuses_options_that_do_not_exist(self):
        sketch = self.sketch()
        with self.assertRaisesRegex(BadInput, "no engine 'magic'.*rotation"):
            api.identify_faces(sketch, "magic")
        with self.assertRaisesRegex(BadInput, "scale"):
            api.to_solid(sketch, scale=0)
        with self.assertRaisesRegex(BadInput, "orientation"):
            api.to_solid(sketch, orientation="sideways")
        self.assertEqual(len(self.document.Objects), 1)
