"""Equilibria on a circular orbit as data."""
from __future__ import annotations

from dataclasses import dataclass
from math import atan2, hypot

from ...numbers.vectors import Float3


@dataclass(frozen=True)
class OrbitEquilibrium:
    """An attitude at rest in the orbital frame.

    velocity, normal, vertical: unit vectors of the orbital frame (along the velocity, normal to the orbit in
    the sense of the angular momentum, up) in the body frame: the rows of the matrix of direction cosines.
    linear: "stable" (all eigenvalues imaginary, none zero), "unstable" or "degenerate"; verdict: "stable",
    "unstable" or "undecided" (Lyapunov's sense, for the full motion), because: its proof. minimum: whether
    the dynamic potential has a definite minimum here. eigenvalues: six, 1/s; frequencies: of librations,
    rad/s, rising. potential: the dynamic potential, J. family: of one attitude of a continuous family, what
    it consists of; "" of an isolated one. axis: of the body, about which the family turns, or None.
    """

    velocity: Float3
    normal: Float3
    vertical: Float3
    linear: str
    verdict: str
    because: str
    minimum: bool
    eigenvalues: tuple[complex, ...]
    frequencies: tuple[float, ...]
    potential: float
    family: str = ""
    axis: Float3 | None = None

    @property
    def angles(self) -> Float3:
        """Yaw, pitch and roll, rad, see `yaw_pitch_roll`."""
        return yaw_pitch_roll(self.velocity, self.normal, self.vertical)


@dataclass(frozen=True)
class OrbitEquilibria:
    """All of them. kind: "points" (isolated ones alone), "curves" (continuous families, perhaps with isolated
    ones) or "all" (every attitude); reason: why these and no others. points: isolated, in pairs that a half
    turn about the orbit normal leads into each other, the stable ones first; families: one attitude of each.
    """

    kind: str
    reason: str
    points: tuple[OrbitEquilibrium, ...] = ()
    families: tuple[OrbitEquilibrium, ...] = ()

    def count(self, verdict: str) -> int:
        """How many isolated ones have this verdict."""
        return sum(one.verdict == verdict for one in self.points)


def yaw_pitch_roll(velocity: Float3, normal: Float3, vertical: Float3) -> Float3:
    """Yaw, pitch and roll, rad, of the sequence 3-2-1 from the frame (velocity, against the orbit normal,
    down) to the body; where the pitch is a right angle only yaw and roll together are determined: the roll is
    0."""
    # body axes in that frame, without zeros of negative sign, which would be half turns backwards
    rows = [(0.0 + v, 0.0 - n, 0.0 - up) for v, n, up in zip(velocity, normal, vertical)]
    (xx, xy, xz), (yx, yy, yz), (_, _, zz) = rows
    across = hypot(xx, xy)
    if across < 1e-9:  # rounding alone turns yaw and roll there
        return atan2(0.0 - yx, yy), atan2(0.0 - xz, across), 0.0
    return atan2(xy, xx), atan2(0.0 - xz, across), atan2(yz, zz)
