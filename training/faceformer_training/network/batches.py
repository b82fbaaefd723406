"""Which drawings make a batch, and batches without end."""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from torch.utils.data import DataLoader, IterableDataset, get_worker_info

from .config import RunConfig

# A shard, with `sizes`, the edges of its drawings, and the number of a drawing in it.
Place = tuple[Any, int]


def batches(places: Sequence[Place], budget: int, seed: int) -> Iterator[list[Place]]:
    """Drawings in random batches of similar size, at most ``budget`` padded edges in each.

    The same seed gives the same batches in the same order.
    """
    random = np.random.default_rng(seed)
    order = random.permutation(len(places))
    groups: list[list[Place]] = []
    chunk = 2048
    for first in range(0, len(order), chunk):
        some = [places[k] for k in order[first : first + chunk]]
        some.sort(key=lambda place: place[0].sizes[place[1]])
        group: list[Place] = []
        for place in some:
            if group and (len(group) + 1) * place[0].sizes[place[1]] > budget:
                groups.append(group)
                group = []
            group.append(place)
        groups.append(group)
    for k in random.permutation(len(groups)):
        yield groups[k]


class Source:
    """Batches without end; epoch k reads the shards of list k modulo their number.

    The networks differ in ``open``, what a shard is; ``fits``, whether a drawing can be trained on;
    and ``collate``, what a batch of drawings is.
    """

    def __init__(self, config: RunConfig, rank: int, world: int):
        self.config, self.rank, self.world = config, rank, world
        self.loaded: tuple[int, list] | None = None

    def open(self, path: Path) -> Any:
        raise NotImplementedError

    def fits(self, shard: Any, i: int) -> bool:
        return shard.sizes[i] <= self.config.max_edges

    def collate(self, group: list[Place], *seed: int) -> Any:
        raise NotImplementedError

    def groups(self, places: list[Place], seed: int) -> Iterator[list[Place]]:
        """The drawings of each batch of an epoch."""
        yield from batches(places, self.config.batch_edges, seed)

    def shards(self, epoch: int) -> list:
        which = epoch % len(self.config.train)
        if self.loaded is None or self.loaded[0] != which:
            # The old ones go first: two lists at a time may be too much.
            self.loaded = None
            self.loaded = (which, [self.open(Path(p)) for p in self.config.train[which]])
        return self.loaded[1]

    def places(self, shards: list) -> list[Place]:
        """The drawings that can be trained on."""
        return [(s, i) for s in shards for i in range(len(s)) if self.fits(s, i)]

    def validation(self) -> list:
        """The same batches whenever it is asked."""
        places = self.places([self.open(Path(p)) for p in self.config.validation])
        step = max(1, len(places) // max(1, self.config.validate_drawings))
        groups = batches(places[::step], self.config.batch_edges, 0)
        return [self.collate(group, 0, k) for k, group in enumerate(groups)]

    def batches(self, skip: int, every: int = 1) -> Iterator[tuple[int, Any, int]]:
        """Epoch, batch and its number of drawings: each ``every``-th, after ``skip`` batches."""
        if not self.config.train:
            raise ValueError("no shards to train on: name them in the configuration or by --train")
        epoch = seen = 0
        while True:
            places = self.places(self.shards(epoch))
            if not places:
                raise ValueError("the shards hold no drawing to train on")
            seed = self.config.seed * 1_000_003 + epoch
            for k, group in enumerate(self.groups(places, seed)):
                if k % self.world != self.rank:
                    continue
                seen += 1
                if seen > skip and (seen - skip - 1) % every == 0:
                    yield epoch, self.collate(group, seed, k), len(group)
            epoch += 1


class Dealt(IterableDataset):
    """A source's batches, of which each worker of a ``DataLoader`` makes its share.

    The loader takes from its workers in turn, so that batches come in the order of the source.
    """

    def __init__(self, source: Source, skip: int):
        self.source, self.skip = source, skip

    def __iter__(self) -> Iterator[tuple[int, Any, int]]:
        worker = get_worker_info()
        return self.source.batches(self.skip + worker.id, worker.num_workers)


def made_ahead(source: Source, skip: int) -> Iterator[tuple[int, Any, int]]:
    """A source's batches, made ahead of their use: in a thread, or in ``workers`` processes."""
    workers = source.config.workers
    if workers == 0:
        return prefetched(source.batches(skip))
    return iter(DataLoader(Dealt(source, skip), batch_size=None, num_workers=workers))


def prefetched(items: Iterator, ahead: int = 4) -> Iterator:
    """The same items, made in a thread a few ahead of their use."""
    waiting: queue.Queue = queue.Queue(ahead)
    stop, end = threading.Event(), object()

    def fill() -> None:
        last: object = end
        try:
            for item in items:
                while not stop.is_set():
                    try:
                        waiting.put((item, None), timeout=0.2)
                        break
                    except queue.Full:
                        continue
                if stop.is_set():
                    return
        except BaseException as error:
            last = error
        waiting.put((None, last))

    thread = threading.Thread(target=fill, daemon=True)
    thread.start()
    try:
        while True:
            item, last = waiting.get()
            if last is end:
                return
            if last is not None:
                raise last
            yield item
    finally:
        stop.set()
