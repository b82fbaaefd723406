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
# Parts with smooth edges, cones, tori and spheres: what a network sees too little of.
CURVED = {
    basic.ball: 1.0,
    basic.frustum: 0.7,
    basic.nut_blank: 0.7,
    basic.pin: 0.7,
    basic.ring: 0.7,
    brackets.bearing_block: 1.0,
    brackets.hook_strip: 1.0,
    housings.cap: 1.5,
    housings.cast: 5.0,
    housings.drafted: 3.0,
    housings.shelled: 1.0,
    housings.soft_block: 4.0,
    joined.bent_rod: 2.5,
    joined.lofted: 1.0,
    joined.odd_union: 1.5,
    plates.lever: 1.0,
    turned.crossed_shaft: 1.5,
    turned.flange: 1.5,
    turned.pulley: 1.0,
    turned.ring_sector: 1.0,
    turned.screw: 1.5,
    turned.shaft: 5.0,
    turned.spun: 1.5,
}
MIXES = ("real", "curved")


def draw(dice: Dice, mix: str = "real") -> Recipe:
    """One recipe of a mix: ``real`` is like real parts, ``curved`` has curved ones only."""
    if mix == "curved":
        return dice.weighted(CURVED)
    return dice.weighted(dice.weighted(FAMILIES).RECIPES)


def names() -> dict[str, Recipe]:
    """All recipes by name, ``family.recipe``."""
    return {name_of(recipe): recipe for family in FAMILIES for recipe in family.RECIPES}


def name_of(recipe: Recipe) -> str:
    return f"{recipe.__module__.rpartition('.')[2]}.{recipe.__name__}"
