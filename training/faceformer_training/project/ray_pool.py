"""The same pool spread over a Ray cluster; the optional extra ``ray``.

Each Ray task looks after one killable worker process of its own, so time limits and crashes are
handled as on one machine. All nodes must see the files under the same paths.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from .pool import LocalPool
from .read import Item
from .work import Plan, SolidResult

_pool: LocalPool | None = None


def _work(number: int, item: Item, plan: Plan, limit: float) -> tuple[int, list[SolidResult]]:
    # One worker a Ray process, kept for the tasks that follow.
    global _pool
    if _pool is None or _pool.plan != plan:
        _pool = LocalPool(plan, 1, limit)
    return next(iter(_pool.run([(number, item)])))


class RayPool:
    """As ``LocalPool``, with ``size`` tasks in flight on the cluster (0: one a CPU of it)."""

    def __init__(self, plan: Plan, size: int, limit: float, address: str | None = None) -> None:
        import ray

        self._ray = ray
        ray.init(address=address, log_to_driver=False, ignore_reinit_error=True)
        self.plan, self.limit = plan, limit
        self.size = size or int(ray.cluster_resources().get("CPU", 1))

    def run(self, tasks: Iterable[tuple[int, Item]]) -> Iterator[tuple[int, list[SolidResult]]]:
        """Results of each numbered item, as they come, in no fixed order."""
        remote = self._ray.remote(max_retries=1)(_work)
        plan = self._ray.put(self.plan)
        flying: set = set()
        waiting = iter(tasks)
        while True:
            while len(flying) < 2 * self.size:
                following = next(waiting, None)
                if following is None:
                    break
                flying.add(remote.remote(*following, plan, self.limit))
            if not flying:
                return
            ready, rest = self._ray.wait(list(flying))
            flying = set(rest)
            for done in ready:
                yield self._ray.get(done)

    def close(self) -> None:
        """Leave the cluster."""
        self._ray.shutdown()

    def __enter__(self) -> RayPool:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
