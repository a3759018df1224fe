"""The place of a hyperbola's branch of saddles at which xi = X + Z (or X - Z) is stationary, and the saddles about it."""
from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple

from .....numbers.exact import sqrt_fraction
from .bends import Span


class Turn(NamedTuple):
    """The place t of a branch where xi = X + flip Z is stationary, and there h, H = flip h, xi = r and eta = E.

    With s = 2 sinh(tau/2), tau from that place, and q = sqrt(1 + s^2/4) the saddles are (r + H s^2, E - 2 H s q).
    """

    t: float
    h: Fraction
    H: Fraction
    r: Fraction
    E: Fraction

    @staticmethod
    def of(seen, curve, flip):
        """None where xi is monotone."""
        g = seen.exact
        square = flip * curve.K / g["G"]
        if square <= 0:
            return None
        h = curve.sign * sqrt_fraction(square)
        r = 2 * flip * h - (g["c"] + flip * g["d"]) / g["G"]
        r = Fraction(0) if flip in seen.touched and abs(r) < abs(h) else r
        return Turn(curve.to(abs(h)), h, flip * h, r, (flip * g["d"] - g["c"]) / g["G"])

    def s_of(self, h):
        """s at the place h of the branch, which has the sign of the turn's."""
        return (h - self.h) / (self.h * sqrt_fraction(h / self.h))


def eta_over(H, E, s):
    """Spans of E - 2 H s q and its first two derivatives over one of s."""
    s2 = s * s
    low = max(abs(s.m) - s.r, 0.0)
    least, most = math.sqrt(1 + 0.25 * low * low), math.sqrt(1 + 0.25 * (abs(s.m) + s.r) ** 2)
    q = Span(0.5 * (least + most), 0.5 * (most - least))
    over = q.inverse()
    return (-2 * H) * (s * q) + E, (-2 * H) * ((0.5 * s2 + 1) * over), (-0.5 * H) * (s * (0.5 * s2 + 3) * (over * over * over))
