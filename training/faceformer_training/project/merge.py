"""Arcs joined again where only a seam or a split had cut a curve: vertices of degree 2.

A vertex of degree 2 stays where two different curves meet (a line and an arc, two arcs of
different circles, a corner): it is a vertex of the solid. It goes where the curve goes on.
"""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from .brep import Brep
from .curves import EdgeCurve
from .errors import require
from .split import EDGE_END, Arc, Split

GOES_ON = np.cos(0.1)
"""Two free curves go on into one another below this angle (0.1 rad) between tangents."""


class Wireframe:
    """The drawn edges and faces in the solid's frame.

    ``vertices`` (N, 3); ``edges`` a list of (tail, head, points (m, 3)); ``loops[part]`` loops of
    signed edge numbers from 1, for the parts of the split in order.
    """

    def __init__(self, brep: Brep, split: Split) -> None:
        self._brep = brep
        self._split = split
        self._ends: dict[int, list[int]] = defaultdict(list)
        for number, arc in enumerate(split.arcs):
            if arc.points is not None:
                self._ends[arc.tail].append(2 * number)
                self._ends[arc.head].append(2 * number + 1)
        self._gone = {v for v, halves in self._ends.items() if self._is_superfluous(halves)}
        after = {}
        for part in split.parts:
            for loop in part.loops:
                for half, following in zip(loop, loop[1:] + loop[:1], strict=True):
                    require(half not in after, "loop", "a co-edge is in two loops")
                    after[half] = following
        drawn = sum(len(halves) for halves in self._ends.values())
        require(len(after) == drawn, "loop", "a co-edge is in no loop")
        self._after = after
        self._number = self._join()
        self.loops = [[self._renumber(loop) for loop in part.loops] for part in split.parts]
        self._check_closed()
        self._check_vertices()

    def _is_superfluous(self, leaving: list[int]) -> bool:
        """Whether the two half-edges that leave a vertex are one curve going on through it."""
        if len(leaving) != 2 or leaving[0] >> 1 == leaving[1] >> 1:
            return False
        arcs = [self._split.arcs[half >> 1] for half in leaving]
        if arcs[0].face is not None and arcs[1].face is not None:
            both_curved = all(len(arc.points) > 2 for arc in arcs)
            return both_curved and self._opposed(leaving, arcs)
        if arcs[0].edge is None or arcs[1].edge is None:
            return False
        if arcs[0].edge == arcs[1].edge:
            # A cut, or the vertex of a closed edge, which may be a true corner.
            return self._is_cut(leaving, arcs) or self._opposed(leaving, arcs)
        curves = [self._brep.edges[arc.edge].curve for arc in arcs]
        assert curves[0] is not None and curves[1] is not None
        if curves[0].is_line and curves[1].is_line:
            return self._opposed(leaving, arcs, 1e-4)
        if curves[0].is_circle and curves[1].is_circle:
            return curves[0].same_carrier(curves[1]) and self._opposed(leaving, arcs)
        if any(curve.is_line or curve.is_circle for curve in curves):
            return False
        return self._opposed(leaving, arcs)

    def _is_cut(self, leaving: list[int], arcs: list[Arc]) -> bool:
        params = {arc.params[half & 1] for half, arc in zip(leaving, arcs, strict=True)}
        return len(params) == 1

    def _opposed(self, leaving: list[int], arcs: list[Arc], angle: float | None = None) -> bool:
        a, b = (self._tangent(h, arc) for h, arc in zip(leaving, arcs, strict=True))
        bound = GOES_ON if angle is None else np.cos(angle)
        return float(a @ b) <= -bound

    def _tangent(self, half: int, arc: Arc) -> np.ndarray:
        """Unit tangent of an arc at the vertex that a half-edge leaves, away from it."""
        if arc.edge is not None:
            curve: EdgeCurve | None = self._brep.edges[arc.edge].curve
            assert curve is not None
            tangent = curve.tangent(arc.params[half & 1])
            if tangent.any():
                return -tangent if half & 1 else tangent
        points = arc.points[:: -1 if half & 1 else 1]
        step = points[1] - points[0]
        return step / max(float(np.linalg.norm(step)), 1e-15)

    def _tail(self, half: int) -> int:
        arc = self._split.arcs[half >> 1]
        return arc.head if half & 1 else arc.tail

    def _join(self) -> dict[int, int]:
        """Number the joined edges; signed edge number of every half-edge."""
        number: dict[int, int] = {}
        self.vertices = np.zeros((0, 3))
        self.edges: list[tuple[int, int, np.ndarray]] = []
        places: dict[int, int] = {}
        starts = [h for h in self._after if self._tail(h) not in self._gone]
        for start in starts + list(self._after):
            if start in number or start ^ 1 in number:
                continue
            run = [start]
            while True:
                following = self._after[run[-1]]
                if self._tail(following) not in self._gone or following == start:
                    break
                back = self._after[following ^ 1]
                require(back == run[-1] ^ 1, "loop", "a vertex of degree 2 turns back")
                run.append(following)
            tail, head = self._tail(start), self._tail(self._after[run[-1]])
            self.edges.append(
                (
                    places.setdefault(tail, len(places)),
                    places.setdefault(head, len(places)),
                    self._run_points(run, tail, head),
                )
            )
            for half in run:
                number[half] = len(self.edges)
                number[half ^ 1] = -len(self.edges)
        self.vertices = np.array([self._split.vertices[v] for v in places]).reshape(-1, 3)
        return number

    def _run_points(self, run: list[int], tail: int, head: int) -> np.ndarray:
        pieces = []
        for half in run:
            points = self._split.arcs[half >> 1].points
            assert points is not None
            pieces.append(points[::-1] if half & 1 else points)
        start, end = self._split.vertices[tail], self._split.vertices[head]
        if all(len(piece) == 2 for piece in pieces) and tail != head:
            return np.array([start, end])
        points = np.vstack([pieces[0], *(piece[1:] for piece in pieces[1:])])
        gap = max(float(np.linalg.norm(points[0] - start)), float(np.linalg.norm(points[-1] - end)))
        require(gap < EDGE_END, "edge-end", f"an edge ends {gap:g} from its vertex")
        points[0], points[-1] = start, end
        return points

    def _renumber(self, loop: list[int]) -> list[int]:
        out: list[int] = []
        # Start at an edge's first arc, so that a joined edge comes once.
        first = next((i for i, h in enumerate(loop) if self._tail(h) not in self._gone), 0)
        for half in loop[first:] + loop[:first]:
            if not out or out[-1] != self._number[half]:
                out.append(self._number[half])
        return out

    def _check_closed(self) -> None:
        used: set[int] = set()
        for loops in self.loops:
            for loop in loops:
                for k, following in zip(loop, loop[1:] + loop[:1], strict=True):
                    require(k not in used, "loop", f"co-edge {k} is used twice")
                    used.add(k)
                    end = self.edges[abs(k) - 1][1 if k > 0 else 0]
                    start = self.edges[abs(following) - 1][0 if following > 0 else 1]
                    require(end == start, "loop", "a loop does not close")
        require(len(used) == 2 * len(self.edges), "loop", "a co-edge is in no loop")

    def _check_vertices(self) -> None:
        """Around each vertex the faces make one cycle; two sheets that touch in a point do not."""
        following: dict[int, int] = {}
        leaving: dict[int, list[int]] = defaultdict(list)
        for loops in self.loops:
            for loop in loops:
                following.update(zip(loop, loop[1:] + loop[:1], strict=True))
        for k in following:
            leaving[self.edges[abs(k) - 1][0 if k > 0 else 1]].append(k)
        for members in leaving.values():
            k, steps = following[-members[0]], 1
            while k != members[0] and steps < len(members):
                k, steps = following[-k], steps + 1
            require(steps == len(members), "touching", f"{steps} of {len(members)} edges")
