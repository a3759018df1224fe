"""A case with its thrusters stuck one way or another: what turns the body then."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from ...asked import came
from ...errors import InputError
from ...numbers.principal import IDENTITY, NOTHING, PrincipalAxes, without_trace
from ...numbers.vectors import Exact3, Float3, Number
from ...physics.effects.constant_torque import ConstantTorque
from ...physics.effects.gyrostat import Gyrostat
from ...physics.scene import Body, Scene


@dataclass(frozen=True)
class Scenario:
    """What a case says, ready to be asked with any torque and any wheel momentum; vectors exact, along the
    scene's axes.

    state: rad/s; base: torque of the case without its thrusters, N m; wheel: N m s; limit: rad/s, a number,
    three (frame of the file) or None; thrusters, wheels: as the case holds them, in the frame of the file.
    """

    case: Any
    body: Body
    axes: PrincipalAxes
    state: Exact3
    base: Exact3
    wheel: Exact3
    limit: float | Float3 | None

    def scene(self, torque: Sequence[Fraction], wheel: Sequence[Fraction] | None = None) -> Scene:
        """The scene under a torque (N m), with another wheel momentum (N m s) where one is given."""
        wheel = without_trace(tuple(self.wheel if wheel is None else wheel), tuple(torque))
        return Scene(self.body, Gyrostat(wheel), ConstantTorque(tuple(torque)))

    def torque(self, thrusters: Sequence[Any]) -> Exact3:
        """The whole torque while these thrusters fire, along the scene's axes."""
        return tuple(sum(column, Fraction(0))
                     for column in zip(self.base, *(self.axes.turned(t.torque) for t in thrusters)))

    def torque_in_file(self, thrusters: Sequence[Any]) -> Float3:
        """The same in the frame of the file; what a thruster alone gives is rounded once."""
        whole = ([sum(column) for column in zip(*(t.torque for t in thrusters))] if thrusters
                 else [Fraction(0)] * 3)
        base = self.in_file(self.base) if any(self.base) else (0.0,) * 3
        return tuple(float(a) + b for a, b in zip(whole, base))

    def in_file(self, vector: Sequence[Number]) -> Float3:
        """A vector along the scene's axes in the frame of the file."""
        found = self.axes.back([Fraction(v) for v in vector])
        least = max(map(abs, found)) * NOTHING
        return tuple(float(v) + 0.0 if abs(v) > least else 0.0 for v in found)

    @property
    def start(self) -> Float3:
        """The state in doubles."""
        return tuple(map(float, self.state))

    @property
    def rows(self) -> list[list[float]]:
        """Axis n of the file's frame along the scene's axes."""
        return [[float(self.axes.axes[i][n]) for i in range(3)] for n in range(3)]


def scenario_of(case: Any) -> Scenario:
    """The scenario of a case. InputError where it has no body, no motion, or effects that no stuck thruster
    is answered with."""
    if not hasattr(case, "thrusters"):
        raise InputError(f"stuck: expected a case, as of stabilab.load(...), got {came(case)}")
    if case.variables == "scaled" or case.physical is None:
        raise InputError(
            "the motion is in scaled variables; a stuck thruster is asked of a body in kg m^2 and "
            "angular_velocity in rad/s")
    if case.state is None:
        raise InputError(
            "motion: expected angular_velocity in [motion]; a stuck thruster is asked of a motion")
    case.scene.quadratic()  # says which effect is not covered
    case = case if case.frame else replace(case, frame=PrincipalAxes(case.scene.body.exact, IDENTITY, True))
    axes = case.frame
    fixed = [axes.turned(t.torque) for t in case.thrusters if t.stuck]
    torque = case.scene.vector("constant_torque")
    base = tuple(m - sum(t[i] for t in fixed) for i, m in enumerate(torque))
    limits = case.limits
    limit = (None if limits is None else float(limits.rate) if limits.rate is not None
             else tuple(map(float, limits.rates)))
    return Scenario(case, case.scene.body, axes, case.exact_state, base, case.scene.vector("gyrostat"), limit)
