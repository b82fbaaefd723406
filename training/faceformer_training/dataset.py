"""The whole set of drawings by one command: generate, project, check, split, compare.

``python -m faceformer_training.dataset OUT SOLIDS...``

``SOLIDS`` are archives of real solids, one a source. The directory ``OUT`` then holds
``solids/`` (the generated archives), ``drawings/`` (a run of the projector for each archive),
``splits/`` and ``splits-large/`` (by family of solids), ``statistics.html`` (generated drawings
against real ones) and ``report.json`` (counts, and the seconds of each step). A run that was
stopped goes on where it was.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path

from .project.output import beside, large_output
from .project.read import ARCHIVE

VIEWS = "ortho=2,iso=1,persp=1"


class StepError(RuntimeError):
    """A step ended with an error; it has told the reason itself."""


@dataclass(frozen=True)
class Options:
    """What to make: numbers of generated solids (like real parts; curved only), views a solid."""

    out: Path
    sources: tuple[Path, ...]
    generated: int = 14000
    curved: int = 6000
    views: str = VIEWS
    seed: int = 1
    processes: int = 2


class Steps:
    """Runs commands of this package; what is finished, and how long it took, outlives a stop."""

    def __init__(self, path: Path, settings: dict) -> None:
        self._path = path
        self._settings = settings
        self.seconds: dict[str, float] = {}
        if path.exists():
            state = json.loads(path.read_text("utf-8"))
            if state["settings"] != settings:
                raise StepError(f"{path.parent} holds a set with other settings; use another")
            self.seconds = state["seconds"]

    def run(self, name: str, *commands: Sequence[object], parallel: int = 1) -> None:
        """Each command is a module of this package and its arguments. Raises ``StepError``."""
        if name in self.seconds:
            return
        print(f"== {name}", flush=True)
        begun = time.monotonic()
        with ThreadPoolExecutor(parallel) as pool:
            codes = list(pool.map(_run, commands))
        if any(codes):
            raise StepError(f"{name} failed")
        self.seconds[name] = round(time.monotonic() - begun, 1)
        state = {"settings": self._settings, "seconds": self.seconds}
        self._path.write_text(json.dumps(state, indent=1), "utf-8")


def _run(command: Sequence[object]) -> int:
    module, *arguments = map(str, command)
    return subprocess.call([sys.executable, "-m", f"faceformer_training.{module}", *arguments])


def make(options: Options) -> dict:
    """Make the set; the report. Raises ``StepError``, ``OSError``."""
    solids, drawings = options.out / "solids", options.out / "drawings"
    for directory in (solids, drawings):
        directory.mkdir(parents=True, exist_ok=True)
    # How many processes there are changes no drawing.
    settings = {k: v for k, v in asdict(options).items() if k not in ("out", "processes")}
    steps = Steps(options.out / "steps.json", json.loads(json.dumps(settings, default=str)))
    made = []
    for name, count, seed, mix in (
        ("generated", options.generated, options.seed, "real"),
        ("curved", options.curved, options.seed + 1, "curved"),
    ):
        if count:
            made.append(solids / f"{name}.tar")
            more = ("--seed", seed, "--mix", mix, "--jobs", options.processes)
            steps.run(f"generate {name}", ("generate", count, made[-1], *more))
    runs = []
    for archive in (*made, *options.sources):
        name = ARCHIVE.sub("", archive.name)
        runs.append(drawings / f"{name}.jsonl.zst")
        more = ("--views", options.views, "--processes", options.processes)
        steps.run(f"project {name}", ("project", archive, runs[-1], *more))
    every = [file for run in runs for file in (run, large_output(run))]
    steps.run("check", *(("check", file) for file in every), parallel=options.processes)
    steps.run(
        "split",
        ("split", *runs, "--out", options.out / "splits"),
        ("split", *runs, "--out", options.out / "splits-large", "--large"),
        parallel=options.processes,
    )
    real = runs[len(made) :]
    if options.generated and real:
        page = options.out / "statistics.html"
        steps.run(
            "statistics",
            ("statistics", runs[0], "--against", *real, "-o", page, "--limit", 8000),
        )
    return _report(runs, steps.seconds)


def _report(runs: list[Path], seconds: dict[str, float]) -> dict:
    reports = {
        run.name.partition(".")[0]: json.loads(beside(run, "report.json").read_text("utf-8"))
        for run in runs
    }
    total = sum(seconds.values())
    drawings = sum(report["drawings"] for report in reports.values())
    return {
        "solids": sum(report["drawn"] for report in reports.values()),
        "drawings": drawings,
        "seconds": round(total, 1),
        "drawings_per_second": round(drawings / total, 2) if total else None,
        "steps": seconds,
        "sources": reports,
    }


def main(arguments: list[str] | None = None) -> int:
    """Make the set and write its report; 0 done, 1 a step failed, 2 bad usage."""
    standard = Options(Path(), ())
    parser = argparse.ArgumentParser(
        prog="python -m faceformer_training.dataset", description=__doc__.split("\n\n")[0]
    )
    parser.add_argument("out", type=Path, metavar="OUT", help="directory")
    parser.add_argument("solids", nargs="*", type=Path, metavar="SOLIDS", help="archives, real")
    parser.add_argument("--generated", type=int, default=standard.generated, metavar="N")
    parser.add_argument("--curved", type=int, default=standard.curved, metavar="N")
    parser.add_argument("--views", default=standard.views, help=f"default {standard.views}")
    parser.add_argument("--seed", type=int, default=standard.seed)
    parser.add_argument("--processes", type=int, default=standard.processes)
    given = parser.parse_args(arguments)
    for archive in given.solids:
        if not (archive.is_file() and ARCHIVE.search(archive.name)):
            parser.error(f"{archive} is not an archive of solids")
    try:
        report = make(
            Options(
                given.out,
                tuple(given.solids),
                given.generated,
                given.curved,
                given.views,
                given.seed,
                given.processes,
            )
        )
    except (StepError, OSError) as error:
        print(error, file=sys.stderr)
        return 1
    text = json.dumps(report, indent=2) + "\n"
    (given.out / "report.json").write_text(text, "utf-8")
    print(
        f"{report['drawings']} drawings of {report['solids']} solids, {report['seconds']} s, "
        f"{report['drawings_per_second']} drawings a second"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
