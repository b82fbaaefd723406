"""Random draws with the few shapes of distribution that the recipes need."""

import math
import random


class Dice(random.Random):
    """A reproducible source of draws; :class:`random.Random` with short names added."""

    def chance(self, p: float) -> bool:
        """True with probability ``p``."""
        return self.random() < p

    def weighted(self, table: dict):
        """One key of ``table``, by its weight."""
        return self.choices(list(table), weights=list(table.values()))[0]

    def length(self, low: float, high: float) -> float:
        """A length between ``low`` and ``high``, uniform in its logarithm.

        Sizes of parts spread over ratios: a plate is as likely to be half as thick as twice.
        Half of the draws are rounded to two digits, as dimensions are.
        """
        x = math.exp(self.uniform(math.log(low), math.log(high)))
        return float(f"{x:.2g}") if self.random() < 0.5 else x

    def part(self, low: float = 0.25, high: float = 0.75) -> float:
        """A share; simple ones such as a half or a third are likely."""
        simple = [s for s in (1 / 4, 1 / 3, 1 / 2, 2 / 3, 3 / 4) if low <= s <= high]
        if simple and self.random() < 0.4:
            return self.choice(simple)
        return self.uniform(low, high)

    def few(self, most: int, keep: float = 0.5) -> int:
        """A number from 1 to ``most``, each ``keep`` times as likely as the one before."""
        n = 1
        while n < most and self.random() < keep:
            n += 1
        return n

    def angle(self) -> float:
        """An angle in radians, in (0, pi/2); 30, 45 and 60 degrees are likely."""
        if self.random() < 0.6:
            return math.radians(self.choice([15, 30, 30, 45, 45, 45, 60]))
        return math.radians(self.uniform(8, 82))
