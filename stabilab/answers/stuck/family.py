"""One start under one torque, asked with many wheel momenta or many sizes of the torque: which of them keep it bounded, exactly."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from ...numbers.vectors import CYCLE, Exact3
from ...orbit.ball_orbit import Orbit
from ...orbit.fate.one_state import fate_of
from ...orbit.reduction import Reduction, reduce
from ...orbit.result import Fate
from ...physics.alignment import Turn, aligned
from ...physics.body import Body
from ...physics.effects.constant_torque import ConstantTorque
from ...physics.effects.gyrostat import Gyrostat
from ...physics.scene import Scene

STEADY = (Fate.BOUNDED, Fate.EQUILIBRIUM)


@dataclass(frozen=True)
class Family:
    """A torque along principal axis `axis` (0-based) of a body, and a start; exact, along the axes of the body or, where the torque lies between
    two equal moments, of the body turned so that it does. back(vector): along the scene's own axes; turned(vector): from them."""

    body: Body
    axis: int
    torque: Fraction
    wheel: Exact3
    state: Exact3
    turn: Turn | None = None

    def scene(self, wheel: Sequence[Fraction] | None = None, torque: Fraction | None = None) -> Scene:
        """With this wheel momentum, and this torque about the axis."""
        size = self.torque if torque is None else torque
        return Scene(self.body, Gyrostat(tuple(self.wheel if wheel is None else wheel)), ConstantTorque(tuple(size * (n == self.axis) for n in range(3))))

    def fate(self, wheel: Sequence[Fraction] | None = None, torque: Fraction | None = None) -> Fate:
        """The fate of the start, decided exactly; SPIN_UP where a wheel along the torque lets no motion be bounded."""
        return self._decided(wheel, torque)[0]

    def _decided(self, wheel: Sequence[Fraction] | None, torque: Fraction | None) -> tuple[Fate, float]:
        """(fate, margin in energy)."""
        scene = self.scene(wheel, torque)
        reduction = reduce(scene)
        if reduction is None:
            return Fate.SPIN_UP, math.nan
        found = fate_of(scene, Orbit(reduction, self.state))
        return found.label, found.margin

    def clearly(self, wanted: bool = True, wheel: Sequence[Fraction] | None = None, torque: Fraction | None = None) -> tuple[bool, float]:
        """(whether the start stays bounded, or with wanted=False does not; how clearly: the margin in energy, positive where so, NaN where it tells not)."""
        label, margin = self._decided(wheel, torque)
        steady = label in STEADY
        holds, sign = steady == wanted, 1 if wanted else -1
        return holds, sign * margin if math.isfinite(margin) and (sign * margin > 0) == holds and label != Fate.EQUILIBRIUM else math.nan

    def steady(self, wheel: Sequence[Fraction] | None = None, torque: Fraction | None = None) -> bool:
        """Whether the start stays bounded."""
        return self.fate(wheel, torque) in STEADY

    def reduction(self, wheel: Sequence[Fraction]) -> Reduction | None:
        """About the torque's axis; None where the wheel has momentum along it."""
        return reduce(self.scene(wheel))

    def along(self, start: Sequence[Fraction], step: Sequence[Fraction], s: Fraction) -> Exact3:
        """start + s step."""
        return tuple(a + s * b for a, b in zip(start, step))

    @property
    def across(self) -> tuple[int, int]:
        """The two other axes."""
        return CYCLE[self.axis]

    @property
    def momentum_unit(self) -> float:
        """A size that wheel momenta of this motion are measured by: that of the body's own, and of what its torque makes of it."""
        weight = max(self.body.inertia)
        return weight * max(math.hypot(*map(float, self.state)), math.sqrt(abs(float(self.torque)) / weight))

    def turned(self, vector: Sequence[Fraction]) -> Exact3:
        """A vector along the scene's axes, along those of the family."""
        return tuple(vector) if self.turn is None else self.turn(vector)

    def back(self, vector: Sequence[Fraction]) -> Exact3:
        """The inverse of `turned`."""
        if self.turn is None:
            return tuple(vector)
        return tuple(sum((self.turn.rotation[i][j] * Fraction(vector[i]) for i in range(3)), Fraction(0)) for j in range(3))


def family_of(scene: Scene, state: Sequence[Fraction]) -> Family | None:
    """The family of a scene and an exact state; None where the torque is off the axes, or there is none."""
    turn, torque = None, scene.vector("constant_torque")
    if sum(m != 0 for m in torque) > 1:
        turn = aligned(scene)
        if turn is None:
            return None
        scene, state = turn.twin, turn(state)
        torque = scene.vector("constant_torque")
    acting = [n for n in range(3) if torque[n]]
    if len(acting) != 1:
        return None
    return Family(scene.body, acting[0], torque[acting[0]], scene.vector("gyrostat"), tuple(map(Fraction, state)), turn)
