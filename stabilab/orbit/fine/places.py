"""The places of states on circles and hyperbolas to 30 digits: where the centre stands far off, doubles lose
what a small motion lives on."""
from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

import numpy as np

from ...numbers.double_double import Twofold

SURE = 1e-20  # of the terms: a sum that is smaller may be zero, which exact arithmetic decides


class TwofoldConstants(NamedTuple):
    """The constants of a reduction as numbers of 32 digits."""

    G: Twofold
    c: Twofold
    d: Twofold
    mu: Twofold
    sj: Twofold
    sk: Twofold
    over_x: Twofold  # flip over rx
    over_z: Twofold


def twofold_constants(reduction) -> TwofoldConstants:
    """Those of a reduction to circles or hyperbolas."""
    g = reduction.exact_constants
    exact = *(g[name] for name in ("G", "c", "d", "mu", "sj", "sk")), g["flip"] / g["rx"], 1 / g["rz"]
    return TwofoldConstants(*map(twofold_constant, exact))


def twofold_constant(value: Fraction) -> Twofold:
    """A rational, or an exact root of many bits, to 32 digits."""
    high = float(value)
    # a double broadcasts as an array does
    return Twofold(np.float64(high), np.float64(float(value - Fraction(high))))  # type: ignore[arg-type]


def twofold_places(constants: TwofoldConstants, j: int, k: int, states) -> tuple[Twofold, Twofold]:
    """(X, Z) of states (n, 3), whose components across the axis are j and k."""
    return (constants.sj + states[:, j]) * constants.over_x, (constants.sk + states[:, k]) * constants.over_z
