"""The numbers of a fast top: what gravity, a Newtonian field and a gyrostatic moment weigh against its spin.

Everything is formed from exact fractions: near a resonance the divisors Omega^2 - m^2 keep all their digits.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from ...errors import InputError, told
from ...numbers.exact import exact
from ...numbers.vectors import Exact3

COVERED = ("gravity", "newtonian_field", "gyrostat")
UNIT_SLACK = 1e-6  # a vertical given to six decimals counts as a unit vector


@dataclass(frozen=True)
class FastTop:
    """A top turning fast about axis 3, in units of its own spin: time tau = r0 t, rates p/r0, q/r0, r/r0.

    a = A/C, b = B/C; force = M g (centre of mass)/(C r0^2); field = N/r0^2; tilt = (l_x, l_y)/(C r0); wheel =
    l_z/(C r0). omega: rad/s and gamma: unit vector, the start. All exact.
    """

    r0: Fraction
    a: Fraction
    b: Fraction
    force: Exact3
    field: Fraction
    tilt: tuple[Fraction, Fraction]
    wheel: Fraction
    omega: Exact3
    gamma: Exact3

    @property
    def spin(self) -> Fraction:
        """C*/C with C* = C + l_z/r0: everything depends on l_z through it alone."""
        return 1 + self.wheel

    @property
    def alpha(self) -> Fraction:
        """(C* - B)/A."""
        return (self.spin - self.b) / self.a

    @property
    def beta(self) -> Fraction:
        """(A - C*)/B."""
        return (self.a - self.spin) / self.b

    @property
    def Omega2(self) -> Fraction:
        """Square of the free precession's frequency over the spin, -alpha beta."""
        return -self.alpha * self.beta

    @property
    def size(self) -> float:
        """What the expansion is in: the largest of sqrt(M g L/C)/r0, sqrt|N|/r0 and |l_x, l_y|/(C r0)."""
        weight = math.hypot(*map(float, self.force))
        return max(math.sqrt(weight), math.sqrt(abs(self.field)), math.hypot(*map(float, self.tilt)))

    @property
    def epsilon(self) -> float:
        """The paper's small parameter sqrt(M g L |gamma0''|/C)/r0 (Amer et al. 2023, fast top: eq. (4))."""
        return math.sqrt(math.hypot(*map(float, self.force)) * abs(self.gamma[2]))


def fast_top(scene, state) -> FastTop:
    """The numbers of a scene and a start.

    state: {"omega": (3,) rad/s, "gamma": (3,) unit vector}, body frame, or the six numbers in a row. Raises
    InputError where the scene has other effects than gravity, Newtonian field and gyrostat, and for a top
    without spin.
    """
    other = [e.name for e in scene.effects if e.name not in COVERED]
    if other or scene.variables != "physical":
        raise InputError("the expansion of the fast top covers gravity, a Newtonian field and a gyrostat; "
                         f"the scene has {', '.join(other) or 'scaled variables'}")
    omega, gamma = _start(state)
    r0 = omega[2]
    if r0 == 0:
        raise InputError("angular_velocity: the third component is 0; the expansion is about a fast rotation "
                         "around axis 3")
    A, B, C = scene.body.exact
    weight, field = scene.effect("gravity"), scene.effect("newtonian_field")
    arm = weight.exact if weight else (Fraction(0),) * 3
    lx, ly, lz = scene.vector("gyrostat")
    return FastTop(r0, A / C, B / C, tuple(f / (C * r0**2) for f in arm),
                   (field.exact if field else Fraction(0)) / r0**2,
                   (lx / (C * r0), ly / (C * r0)), lz / (C * r0), omega, gamma)


def _start(state):
    expected = 'state: expected {"omega": three numbers, "gamma": three numbers}, or the six numbers in a row'
    try:
        rows = (state["omega"], state["gamma"]) if isinstance(state, dict) else (state[:3], state[3:])
        omega, gamma = (tuple(exact(v) for v in row) for row in rows)
    except (KeyError, TypeError, IndexError):
        raise InputError(f"{expected}; got {told(state)}") from None
    if len(omega) != 3 or len(gamma) != 3:
        raise InputError(f"{expected}; got {len(omega)} and {len(gamma)}")
    length = math.hypot(*map(float, gamma))
    if abs(length - 1) > UNIT_SLACK:
        raise InputError(f"gamma: expected a unit vector, got one of length {length:.12g}")
    return omega, gamma
