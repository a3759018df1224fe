"""The units of engineers, and times between two bounds in them."""
from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal, localcontext


@dataclass(frozen=True)
class Units:
    """(name, how many of it make one in SI) for rates, times and angles."""

    rate: tuple[str, float]
    time: tuple[str, float]
    angle: tuple[str, float]


ENGINEERING = Units(("deg/s", 180 / math.pi), ("min", 1 / 60), ("deg", 180 / math.pi))
SI = Units(("rad/s", 1.0), ("s", 1.0), ("rad", 1.0))


def bracket(low, high) -> tuple[str, str]:
    """Both ends with as many decimals as tell them apart, six digits at most; the lower rounded down and the upper up."""
    most = max(0, 5 - math.floor(math.log10(high)))
    decimals = most if not high > low else min(most, max(0, 1 - math.floor(math.log10(high - low))))
    step = Decimal(1).scaleb(-decimals)
    with localcontext() as context:
        context.prec = 800  # of any double
        return str(Decimal(low).quantize(step, ROUND_FLOOR)), str(Decimal(high).quantize(step, ROUND_CEILING))


def number(value, digits=4) -> str:
    """So many digits, no more than it has."""
    return f"{value:.{digits}g}"
