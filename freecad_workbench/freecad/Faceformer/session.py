# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the panel works on: a source, its faces, and the choices of the user. No Qt here."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import FreeCAD

from . import api, extract, feature, pipeline, preferences
from .errors import FaceformerError, Failed
from .i18n import translate
from .model import Drawing, Face, Finding
from .transaction import transaction


@dataclass(frozen=True)
class Outcome:
    """How far the identification came: a drawing without faces still has its findings."""

    drawing: Drawing | None = None
    identified: pipeline.Identified | None = None
    error: BaseException | None = None


@dataclass
class Session:
    """One source on its way to a solid, or a solid whose choices are being changed."""

    links: list[Any]
    target: Any = None
    """The solid that is edited; None if a new one is to be made."""
    engine: str = field(default_factory=preferences.engine)
    scale: float = 1.0
    flip: bool = False
    orientation: str = "upright"
    reading: int = 0
    off: set[str] = field(default_factory=set)
    drawn: extract.Extraction | None = None
    outcome: Outcome = field(default_factory=Outcome)

    @classmethod
    def of_solid(cls, obj: Any) -> Session:
        """A session with the choices that a solid has."""
        options = feature.options_of(obj)
        return cls(
            list(obj.Source),
            obj,
            obj.Engine,
            options.scale,
            options.flip,
            options.orientation,
            options.reading,
            set(options.off),
        )

    def extract(self) -> None:
        """Takes the edges from the source; on FreeCAD's thread, unlike `work`."""
        self.outcome = Outcome()
        self.drawn = extract.extract(self.links)

    def work(self):
        """The identification as a function for a thread."""
        text, engine = self.drawn.to_json(), self.engine
        names = [edge.name for edge in self.drawn.edges]
        reading, off = self.reading, set(self.off)

        def identify(progress: pipeline.Progress) -> Outcome:
            drawing = None
            try:
                _, drawing = pipeline.read(text, names)
                identified = pipeline.identify(text, names, engine, progress)
            except FaceformerError as error:
                return Outcome(drawing, None, error)
            outcome = Outcome(identified.identification.drawing, identified)
            # The panel asks for these next; here they do not keep the window waiting.
            Session([], engine=engine, reading=reading, off=off, outcome=outcome).conflicts(
                progress
            )
            return outcome

        return identify

    def options(self) -> pipeline.SolidOptions:
        """The user's choices for the solid, without faces that are not there any more."""
        off = tuple(sorted(self.off & {face.key for face in self.faces()}))
        return pipeline.SolidOptions(self.scale, self.flip, self.orientation, self.reading, off)

    def conflicts(self, progress: pipeline.Progress | None = None) -> tuple[Finding, ...]:
        """Which faces of the chosen reading contradict each other; none if depth cannot be had."""
        if not self.faces():
            return ()
        try:
            return pipeline.conflicts(self.outcome.identified, self.options(), progress)
        except FaceformerError:
            # Whatever it is, the attempt to convert says it.
            return ()

    def build(self):
        """The solid as a function for a thread; its result goes to the store."""
        identified, options = self.outcome.identified, self.options()
        return lambda progress: pipeline.solid(identified, options, progress)

    def faces(self) -> tuple[Face, ...]:
        """Faces of the chosen reading."""
        if self.outcome.identified is None:
            return ()
        readings = self.outcome.identified.identification.readings
        return readings[min(self.reading, len(readings) - 1)].faces

    def document(self) -> FreeCAD.Document:
        """The document that the source is in."""
        return extract.normalise(self.links)[0][0].Document

    def source_label(self) -> str:
        """Names of the source's objects."""
        return ", ".join(thing.Label for thing, _ in extract.normalise(self.links))

    def convert(self) -> Any:
        """Makes the solid, or gives the edited one the new choices; one undo step."""
        options = self.options()
        if self.target is not None:
            return self._update(options)
        return api.to_solid(
            self.links,
            self.engine,
            options.scale,
            options.flip,
            orientation=options.orientation,
            reading=options.reading,
            off=options.off,
        )

    def _update(self, options: pipeline.SolidOptions) -> Any:
        obj = self.target
        with transaction(obj.Document, translate("Faceformer", "Edit Solid")):
            feature.apply(obj, self.engine, options)
            obj.Source = extract.property_links(self.links)
            obj.Document.recompute([obj])
            if not obj.isValid():
                raise Failed(obj.getStatusString())
        return obj
