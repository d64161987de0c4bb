"""When a study has samples enough: `--until "30%"` or `--until "below 1e-2"`."""
from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ..errors import Usage
from .estimates import Estimate

#: samples of the first look, factor of the next, most where --samples does not say
FIRST, GROWTH, MOST = 100, 2.0, 100_000


@dataclass(frozen=True)
class Rule:
    """Half width of the interval over the probability, or a bound that the interval has to leave on one side."""
    share: float = 0.0
    bound: float = 0.0

    def met(self, one: Estimate) -> bool:
        """Whether an estimate is decided."""
        if self.bound:
            return one.high < self.bound or one.low > self.bound
        return one.probability > 0.0 and 0.5 * (one.high - one.low) <= self.share * one.probability

    def verdict(self, one: Estimate) -> str:
        """The state of the estimate in words."""
        if self.bound and one.lost < one.samples:
            word = ("is below" if one.high < self.bound else "is above" if one.low > self.bound
                    else "cannot be distinguished from")
            return f"the probability {word} {self.bound:g}"
        if one.lost == one.samples:
            return "not assessed, because no sample has a margin"
        if not one.probability > 0.0:
            return "no sample with a margin failed, so that the interval has no relative width"
        return (f"half of the interval is {50.0 * (one.high - one.low) / one.probability:.3g} % of the probability, "
                f"requested {100 * self.share:g} %")


def rule(text: str) -> Rule:
    """Of the text of the option."""
    share = re.fullmatch(r"\s*([0-9.eE+-]+)\s*%\s*", text)
    bound = re.fullmatch(r"\s*(?:below\s*)?([0-9.eE+-]+)\s*", text)
    try:
        if share and 0.1 <= float(share[1]) <= 100.0:
            return Rule(share=float(share[1]) / 100.0)
        if bound and 1e-9 <= float(bound[1]) < 1.0 and not share:
            return Rule(bound=float(bound[1]))
    except ValueError:
        pass
    raise Usage(f'--until {text!r}: write a share of the probability within 0.1 % .. 100 %, as "30%", or a bound '
                'within 1e-9 .. 1, as "below 1e-2"')


def looks(most: int) -> int:
    """Number of looks at most."""
    count, samples = 0, 0
    while samples < most:
        count, samples = count + 1, following(samples, most)
    return count


def spent(confidence: float, most: int) -> float:
    """Confidence of the interval of one look, with which the intervals of all looks hold together with the given one
    (Bonferroni). Without it a study that stops as soon as its interval leaves a bound does so wrongly in more than 20
    of 100 cases instead of 5 (probability at the bound, nine looks: test_questions, test_verdicts_hold)."""
    return 1.0 - (1.0 - confidence) / looks(most)


def following(samples: int, most: int) -> int:
    """Number of samples of the next look."""
    return min(most, max(FIRST, math.ceil(samples * GROWTH)))
