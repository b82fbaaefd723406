"""The recipes: each draws one kind of part and returns its body, not yet checked.

A recipe is a function of a :class:`~..dice.Dice` alone. Sizes are about 2 units; the weights are
tuned against real parts with ``python -m faceformer_training.statistics``.
"""

from collections.abc import Callable

from OCP.TopoDS import TopoDS_Shape

from ..dice import Dice
from . import basic, blocks, brackets, housings, joined, plates, turned

Recipe = Callable[[Dice], TopoDS_Shape]

# Share of each family; within it, its own table decides.
FAMILIES = {
    basic: 22.0,
    blocks: 20.0,
    brackets: 12.0,
    housings: 16.0,
    joined: 12.0,
    plates: 13.0,
    turned: 15.0,
}


def draw(dice: Dice) -> Recipe:
    """One recipe, by the families' weights and their own."""
    return dice.weighted(dice.weighted(FAMILIES).RECIPES)


def names() -> dict[str, Recipe]:
    """All recipes by name, ``family.recipe``."""
    return {
        f"{family.__name__.rpartition('.')[2]}.{recipe.__name__}": recipe
        for family in FAMILIES
        for recipe in family.RECIPES
    }
