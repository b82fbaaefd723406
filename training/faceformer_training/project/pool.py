"""Worker processes that can be ended, with a time limit for each solid.

An alarm in Python cannot interrupt OCCT, so a solid that takes too long, or brings the process
down, costs its process; the solid is counted with that reason and the item goes on after it in a
fresh one.
"""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from typing import Any

from .read import Item, ItemReader
from .work import READING, Plan, SolidResult, solid_name, work_on

SOLIDS_A_WORKER = 1000
"""A worker is replaced after so many solids, since OCCT's readers do not give back all memory."""


def _serve(pipe: Connection, plan: Plan) -> None:
    """A worker's life: items come in, numbers and results go out, None after each item."""
    # OCCT's readers report on standard output.
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    reader = ItemReader()
    try:
        while True:
            item, first = pipe.recv()
            for message in work_on(item, plan, reader, first):
                pipe.send(message)
            pipe.send(None)
    except (EOFError, KeyboardInterrupt, BrokenPipeError):
        return


@dataclass
class _Task:
    number: int
    item: Item
    first: int = 0
    results: list[SolidResult] = field(default_factory=list)


class _Worker:
    def __init__(self, plan: Plan) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=_serve, args=(other, plan), daemon=True)
        self.process.start()
        other.close()
        self.task: _Task | None = None
        self.current = READING
        self.begun = time.monotonic()
        self.solids = 0

    def give(self, task: _Task) -> None:
        self.task, self.current = task, READING
        # A fresh process still has to load its libraries: the clock starts at its first message.
        self.begun = time.monotonic() + (30 if self.solids == 0 else 0)
        self.pipe.send((task.item, task.first))

    def end(self) -> None:
        self.process.kill()
        self.process.join()
        self.pipe.close()


class LocalPool:
    """Runs items over ``size`` processes; ``limit`` is the seconds a solid may take."""

    def __init__(self, plan: Plan, size: int = 1, limit: float = 60.0) -> None:
        self.plan, self.size, self.limit = plan, size, limit
        self._workers: list[_Worker] = []

    def run(self, tasks: Iterable[tuple[int, Item]]) -> Iterator[tuple[int, list[SolidResult]]]:
        """Results of each numbered item, as they come, in no fixed order.

        Tasks are drawn from the iterable only as workers become idle.
        """
        waiting = iter(tasks)
        again: list[_Task] = []
        exhausted = False
        while True:
            for worker in self._idle():
                task = again.pop() if again else None
                if task is None and not exhausted:
                    following = next(waiting, None)
                    exhausted = following is None
                    task = None if following is None else _Task(*following)
                if task is not None:
                    worker.give(task)
            busy = [w for w in self._workers if w.task is not None]
            if not busy:
                if exhausted and not again:
                    return
                continue
            ready = wait([w.pipe for w in busy], timeout=0.5)
            for worker in busy:
                if worker.pipe in ready:
                    finished = self._listen(worker, again)
                    if finished is not None:
                        yield finished.number, finished.results
                elif time.monotonic() - worker.begun > self.limit:
                    finished = self._lose(worker, "time-limit", again)
                    if finished is not None:
                        yield finished.number, finished.results

    def close(self) -> None:
        """End all processes."""
        for worker in self._workers:
            worker.end()
        self._workers.clear()

    def __enter__(self) -> LocalPool:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _idle(self) -> list[_Worker]:
        for worker in [w for w in self._workers if w.task is None and w.solids > SOLIDS_A_WORKER]:
            worker.end()
            self._workers.remove(worker)
        while len(self._workers) < self.size:
            self._workers.append(_Worker(self.plan))
        return [w for w in self._workers if w.task is None]

    def _listen(self, worker: _Worker, again: list[_Task]) -> _Task | None:
        task = worker.task
        assert task is not None
        try:
            message: Any = worker.pipe.recv()
        except (EOFError, OSError):
            return self._lose(worker, "crash", again)
        worker.begun = time.monotonic()
        if message is None:
            worker.task = None
            return task
        if isinstance(message, SolidResult):
            worker.solids += 1
            task.results.append(message)
        else:
            worker.current = message
        return None

    def _lose(self, worker: _Worker, code: str, again: list[_Task]) -> _Task | None:
        """Count the solid that cost a worker; the item if it is over, else None."""
        task = worker.task
        assert task is not None
        number = worker.current
        name = solid_name(task.item, max(number, 0))
        detail = f"after {self.limit:g} s" if code == "time-limit" else ""
        task.results.append(
            SolidResult(number, name, task.item.source, code, detail, seconds=self.limit)
        )
        worker.end()
        self._workers.remove(worker)
        if number == READING:
            return task
        again.append(_Task(task.number, task.item, number + 1, task.results))
        return None
