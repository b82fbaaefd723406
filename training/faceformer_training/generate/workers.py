"""Worker processes that can be killed: OCCT cannot be interrupted from within a process.

Each worker draws the attempts of one solid at a time and reports every one. An attempt that uses
more processor time than the limit ends its worker (so a busy machine changes no result), and one
that takes ``PATIENCE`` times as long on the clock is killed; a new worker goes on with the next.
"""

import math
import multiprocessing
import signal
import time
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait

try:
    import resource
except ImportError:  # not on Windows: there the clock alone limits an attempt
    resource = None

from .archive import packed
from .finish import Limits
from .solid import MOST_ATTEMPTS, attempts

PATIENCE = 20
# Seconds on the clock that a new worker may take to load OCCT.
START = 300.0

CRASHED = "the kernel crashed"
TIMED_OUT = "over the time limit"
GIVEN_UP = "given up after too many draws"


@dataclass(frozen=True)
class Result:
    """Solid ``k``: a member's bytes and its index record; ``reasons`` are those of failed draws.

    ``data`` is None where all draws failed.
    """

    k: int
    data: bytes | None
    record: dict | None
    reasons: list[str]


@dataclass
class _Worker:
    process: multiprocessing.process.BaseProcess
    pipe: Connection
    ready: bool = False
    k: int | None = None
    attempt: int = 0
    since: float = 0.0
    reasons: list[str] = field(default_factory=list)


def limit_processor(seconds: float) -> None:
    """The process is ended by SIGXCPU after this much more processor time, in whole seconds."""
    if resource is not None:
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        end = math.ceil(time.process_time() + seconds)
        resource.setrlimit(resource.RLIMIT_CPU, (end, hard))


def serve(pipe: Connection, seed: int, limits: Limits, mix: str, seconds: float) -> None:
    """A worker's life: (k, first attempt) in; one message an attempt out; None ends it.

    The first message, None, says that the worker is ready.
    """
    pipe.send(None)
    while (task := pipe.recv()) is not None:
        k, first = task
        limit_processor(seconds)
        for number, result in enumerate(attempts(seed, k, limits, mix, first), first):
            if result.solid is None:
                pipe.send((None, None, result.reason))
                limit_processor(seconds)
                continue
            solid = result.solid
            record = {
                "n": k,
                "recipe": result.recipe,
                "attempt": number,
                "hash": solid.signature,
                "faces": solid.faces,
                "edges": solid.edges,
                "types": solid.types,
                "volume": float(f"{solid.volume:.5g}"),
            }
            pipe.send((packed(solid.shape), record, None))


class Pool:
    """``jobs`` workers that draw solids of one seed and mix, each attempt within ``seconds``."""

    def __init__(self, seed: int, limits: Limits, mix: str, jobs: int, seconds: float) -> None:
        self.drawn_from, self.seconds = (seed, limits, mix), seconds
        self.context = multiprocessing.get_context("spawn")
        self.workers = [self._start() for _ in range(jobs)]

    def _start(self) -> _Worker:
        ours, theirs = self.context.Pipe()
        process = self.context.Process(
            target=serve, args=(theirs, *self.drawn_from, self.seconds), daemon=True
        )
        process.start()
        theirs.close()
        return _Worker(process, ours)

    def run(self, numbers: Iterable[int]) -> Iterator[Result]:
        """The solids of these numbers, in their order."""
        todo = iter(numbers)
        order: deque[int] = deque()
        ready: dict[int, Result] = {}
        for i in range(len(self.workers)):
            self._give(i, todo, order)
        while order:
            busy = {w.pipe: i for i, w in enumerate(self.workers) if w.k is not None}
            heard = wait(list(busy), timeout=0.5)
            for pipe in heard:
                result = self._hear(busy[pipe])
                if result is not None:
                    ready[result.k] = result
                    self._give(busy[pipe], todo, order)
            for i in busy.values():
                result = self._watch(i)
                if result is not None:
                    ready[result.k] = result
                    self._give(i, todo, order)
            while order and order[0] in ready:
                yield ready.pop(order.popleft())

    def _give(self, i: int, todo: Iterator[int], order: deque[int]) -> None:
        worker = self.workers[i]
        worker.k = next(todo, None)
        if worker.k is not None:
            order.append(worker.k)
            worker.reasons = []
            worker.attempt = 0
            self._send(worker)

    def _send(self, worker: _Worker) -> None:
        worker.since = time.monotonic()
        worker.pipe.send((worker.k, worker.attempt))

    def _hear(self, i: int) -> Result | None:
        worker = self.workers[i]
        try:
            message = worker.pipe.recv()
        except (EOFError, ConnectionError):
            worker.process.join()
            over = worker.process.exitcode == -getattr(signal, "SIGXCPU", 0)
            return self._lost(i, TIMED_OUT if over else CRASHED)
        worker.since = time.monotonic()
        if message is None:
            worker.ready = True
            return None
        data, record, reason = message
        if data is not None:
            return Result(worker.k, data, record, worker.reasons)
        return self._failed(worker, reason)

    def _watch(self, i: int) -> Result | None:
        worker = self.workers[i]
        limit = PATIENCE * self.seconds if worker.ready else START
        if worker.k is None or time.monotonic() - worker.since < limit:
            return None
        worker.process.kill()
        return self._lost(i, TIMED_OUT)

    def _lost(self, i: int, reason: str) -> Result | None:
        """Replaces a dead worker; the new one goes on with the next attempt."""
        old = self.workers[i]
        old.process.join()
        old.pipe.close()
        new = self._start()
        new.k, new.attempt, new.reasons = old.k, old.attempt, old.reasons
        self.workers[i] = new
        result = self._failed(new, reason)
        if result is None:
            self._send(new)
        return result

    @staticmethod
    def _failed(worker: _Worker, reason: str) -> Result | None:
        worker.reasons.append(reason)
        worker.attempt += 1
        if worker.attempt < MOST_ATTEMPTS:
            return None
        return Result(worker.k, None, None, [*worker.reasons, GIVEN_UP])

    def close(self) -> None:
        for worker in self.workers:
            worker.process.kill()
            worker.process.join()
            worker.pipe.close()

    def __enter__(self) -> "Pool":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
