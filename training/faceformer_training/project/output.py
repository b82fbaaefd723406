"""The files of a run: drawings, the index of solids, the state to resume from, the report.

Beside ``OUT.jsonl.zst`` come ``OUT.large.jsonl.zst`` (drawings beyond the paper's limits),
``OUT.solids.jsonl`` (a row for every solid: what became of it, its keys and split),
``OUT.state.json`` (lengths of these files after the last whole item; it lets a stopped run go
on) and ``OUT.report.json`` (counts by reason).
"""

from __future__ import annotations

import json
import os
import re
import time
from collections import Counter
from pathlib import Path
from typing import Any

from ..drawing import DrawingWriter
from .errors import REASONS
from .signature import split_of
from .work import SolidResult

SECONDS_BETWEEN_SAVES = 20.0


class OtherRunError(ValueError):
    """The output belongs to a run with other solids or settings."""


def beside(path: Path, part: str) -> Path:
    """``OUT.PART`` for an output ``OUT.jsonl[.zst]``."""
    stem = re.sub(r"\.jsonl(\.zst)?$", "", path.name)
    return path.with_name(f"{stem}.{part}")


def large_output(path: Path) -> Path:
    """Where the drawings of large solids go."""
    suffix = ".jsonl.zst" if path.name.endswith(".zst") else ".jsonl"
    return beside(path, f"large{suffix}")


class RunOutput:
    """Takes results in the order of the items and writes them, without duplicates.

    ``identity`` is what must be equal for a run to be resumed. ``done`` is the number of items
    already written. Raises ``OtherRunError``.
    """

    def __init__(self, path: Path, identity: dict[str, Any], *, restart: bool = False) -> None:
        self.path = path
        self._state_path = beside(path, "state.json")
        self._index_path = beside(path, "solids.jsonl")
        self._large_path = large_output(path)
        self._identity = identity
        self._shapes: set[str] = set()
        self._views: set[str] = set()
        self.outcomes: Counter[str] = Counter()
        self.drawn: Counter[str] = Counter()
        self.large: Counter[str] = Counter()
        self.refused: dict[str, Counter[str]] = {}
        self.splits: Counter[str] = Counter()
        self.families: set[str] = set()
        self.seconds = 0.0
        self._cpu = 0.0
        state = None if restart else self._load()
        self.done = 0 if state is None else state["done"]
        lengths: dict[str, int | None] = {} if state is None else state["lengths"]
        self._writer = DrawingWriter(path, resume_at=lengths.get("drawings"))
        self._large = DrawingWriter(self._large_path, resume_at=lengths.get("large"))
        if state is None:
            self._index_path.write_text("", "utf-8")
        else:
            self.seconds = state["seconds"]
            os.truncate(self._index_path, lengths["index"] or 0)
            for line in self._index_path.read_text("utf-8").splitlines():
                self._count(json.loads(line))
        self._index = open(self._index_path, "a", encoding="utf-8")  # noqa: SIM115
        self._begun = self._saved = time.monotonic()

    def _load(self) -> dict[str, Any] | None:
        if not self._state_path.exists():
            return None
        state = json.loads(self._state_path.read_text("utf-8"))
        if state["identity"] != self._identity:
            raise OtherRunError(
                f"{self._state_path} is of a run with other solids or settings; "
                "use another output, or --restart"
            )
        return state

    def add(self, results: list[SolidResult]) -> None:
        """Write what became of one item's solids."""
        for result in results:
            row = result.row()
            if result.outcome == "ok":
                if row["shape"] in self._shapes:
                    row["outcome"] = "duplicate"
                elif row["views"] in self._views:
                    row["outcome"] = "duplicate-views"
                else:
                    row["split"] = split_of(row["family"])
                    for kind, large, line in result.drawings:
                        (self._large if large else self._writer).write(line)
                        row.setdefault("large_drawings", 0)
                        row["large_drawings"] += large
                        self.large[kind] += large
            if row["outcome"] != "ok":
                row["drawings"] = {}
            self._count(row)
            self._index.write(json.dumps(row, separators=(",", ":")) + "\n")
        self.done += 1
        if time.monotonic() - self._saved > SECONDS_BETWEEN_SAVES:
            self.save()

    def _count(self, row: dict[str, Any]) -> None:
        self.outcomes[row["outcome"]] += 1
        self._cpu += row["cpu_seconds"]
        if "shape" in row and row["outcome"] == "ok":
            self._shapes.add(row["shape"])
            self._views.add(row["views"])
            self.families.add(row["family"])
            self.splits[row["split"]] += sum(row["drawings"].values())
        if row["outcome"] in ("duplicate", "duplicate-views"):
            return
        self.drawn.update(row["drawings"])
        for kind, code in row["refused"].items():
            self.refused.setdefault(kind, Counter())[code] += 1

    def save(self) -> None:
        """Make all that was added lasting."""
        lengths = {"drawings": self._writer.flush(), "large": self._large.flush()}
        self._index.flush()
        lengths["index"] = self._index_path.stat().st_size
        now = time.monotonic()
        self.seconds += now - self._begun
        self._begun = self._saved = now
        state = {
            "identity": self._identity,
            "done": self.done,
            "lengths": lengths,
            "seconds": self.seconds,
        }
        fresh = self._state_path.with_suffix(".new")
        fresh.write_text(json.dumps(state), "utf-8")
        os.replace(fresh, self._state_path)

    def report(self) -> dict[str, Any]:
        """Counts of the whole run so far; failures by reason, each with what it means."""
        drawings = sum(self.drawn.values())
        failed = {
            code: {"solids": count, "meaning": REASONS.get(code, "")}
            for code, count in self.outcomes.most_common()
            if code != "ok"
        }
        return {
            "solids": sum(self.outcomes.values()),
            "drawn": self.outcomes["ok"],
            "drawings": drawings,
            "by_view": dict(self.drawn),
            "not_drawn": failed,
            "views_refused": {kind: dict(codes) for kind, codes in self.refused.items()},
            "families": len(self.families),
            "drawings_by_split": dict(self.splits),
            "wall_seconds": round(self.seconds, 1),
            "cpu_seconds": round(self._cpu, 1),
            "drawings_per_second": round(drawings / self.seconds, 2) if self.seconds else None,
            "drawings_per_cpu_second": round(drawings / self._cpu, 2) if self._cpu else None,
        }

    def close(self) -> None:
        """Save, write the report and close the files."""
        self.save()
        report = json.dumps(self.report(), indent=2)
        beside(self.path, "report.json").write_text(report + "\n", "utf-8")
        self._writer.close()
        self._large.close()
        self._index.close()
