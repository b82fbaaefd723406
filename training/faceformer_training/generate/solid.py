"""Solid ``k`` of a seed: recipes drawn until one gives a finished solid."""

import traceback
from collections.abc import Iterator
from dataclasses import dataclass

from .dice import Dice
from .finish import Finished, Limits, finish
from .kernel import Refused, from_kernel
from .recipes import draw, name_of, names

# A recipe is refused about one time in three, so this many in a row do not happen by chance.
MOST_ATTEMPTS = 60


@dataclass(frozen=True)
class Attempt:
    """One draw: the finished solid, or the reason why there is none."""

    recipe: str
    solid: Finished | None
    reason: str | None


def attempt(
    seed: int, k: int, number: int, limits: Limits, mix: str = "real", recipe: str | None = None
) -> Attempt:
    """Draw ``number`` of solid ``k``; it depends on these alone. ``recipe`` fixes the recipe."""
    dice = Dice(f"{seed}/{k}/{number}")
    make = names()[recipe] if recipe else draw(dice, mix)
    name = name_of(make)
    try:
        return Attempt(name, finish(make(dice), limits), None)
    except Refused as refused:
        return Attempt(name, None, str(refused))
    except Exception as fault:
        if from_kernel(fault):
            return Attempt(name, None, f"the kernel: {type(fault).__name__}")
        # A fault of the recipe itself: said at once, counted, and no reason to stop a long run.
        traceback.print_exc()
        return Attempt(name, None, f"a fault in {name}: {fault!r}")


def attempts(
    seed: int, k: int, limits: Limits, mix: str = "real", first: int = 0
) -> Iterator[Attempt]:
    """The draws of solid ``k`` from number ``first`` on, up to the first that succeeds."""
    for number in range(first, MOST_ATTEMPTS):
        result = attempt(seed, k, number, limits, mix)
        yield result
        if result.solid is not None:
            return
