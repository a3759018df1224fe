"""A point charge on axis 3 of the body in a uniform magnetic field: a Lorentz torque k omega x e3."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar

from ...errors import InputError
from ...numbers.exact import exact, precise
from ...numbers.units import ANGLE, CHARGE, FLUX, LENGTH, in_si
from ...numbers.vectors import Given, Number, Triple, cross
from ...reasons import Axis, Sentence
from .base import Effect, Limit

if TYPE_CHECKING:
    from types import SimpleNamespace

    from ..equations import MotionView
    from ..scene import Scene

ANGLE_SHARE = 0.1  # of the torque, by which a constant angle may be wrong
ANGLE_CHANGE = Sentence("charge-angle-change", "change of cos σ, held constant, with the attitude")()
TURNS_AWAY = Sentence(
    "charge-turns-away", "{axis} turns away from the field, and the charge's torque with it: angle = "
    "\"attitude\" follows that")(axis=Axis(3))


@dataclass(frozen=True)
class Charge(Effect):
    """Torque k omega x e3 with k = e H l^2 cos sigma, N m s (Galal et al., charged body: eq. (3) ff.).

    charge e, C; field H, T; arm l, m; angle sigma between axis 3 and the field, rad, or "attitude": cos sigma
    is then gamma3, taken from the motion. It acts like a gyrostatic moment -k along axis 3 in Euler's
    equations, yet it is no part of the angular momentum. It does no work.
    """

    name: ClassVar[str] = "charge"
    article: ClassVar[str] = "a"
    agent: ClassVar[str] = "the charge"
    keys: ClassVar[tuple[str, ...]] = ("charge", "field", "arm", "angle")
    works: ClassVar[bool] = False

    charge: Given
    field_strength: Given
    arm: Given
    angle: Given | str
    exact: Fraction = field(init=False, repr=False)
    strength: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        charge, arm = in_si(self.charge, CHARGE, "charge"), in_si(self.arm, LENGTH, "arm")
        strength = in_si(self.field_strength, FLUX, "field")
        angle = None if self.follows_attitude else in_si(self.angle, ANGLE, "angle")
        scale = charge * strength * arm**2 * (1 if angle is None else precise("cos", angle))
        object.__setattr__(self, "exact", scale)
        if abs(scale) >= 2**1024:
            raise InputError("charge x field x arm^2 is larger than the largest double (about 1.8e308)")
        object.__setattr__(self, "strength", float(scale))
        for name, value in (("charge", charge), ("field_strength", strength), ("arm", arm), ("angle", angle)):
            if value is not None:
                object.__setattr__(self, name, float(value))

    @classmethod
    def from_case(cls, table: Any, context: Any) -> Charge | None:
        if not table.required(*cls.keys):
            return None
        numbers = [table.number(key) for key in cls.keys[:3]]
        angle = table.data["angle"]
        if isinstance(angle, str) and angle != "attitude" and angle.isalpha():
            table.fault(f'expected a number (rad) or "attitude", got "{angle[:60]}"', "angle")
            return None
        angle = angle if angle == "attitude" else table.number("angle")
        charge, strength, arm = numbers
        return None if None in (*numbers, angle) else cls(charge, strength, arm, angle)

    @property
    def follows_attitude(self) -> bool:
        """Whether cos sigma comes from the motion."""
        return isinstance(self.angle, str) and self.angle == "attitude"

    @property
    # a constant of the other effects, here found by the values
    def approximate(self) -> bool:  # type: ignore[override]
        """A constant angle is an assumption about the motion."""
        return not self.follows_attitude

    def limits(self, scene: Scene) -> tuple[Limit, ...]:
        """How far cos sigma of the motion, e3 . (axis 3 of space, the field's), is from the constant one;
        given where the attitude is known, or gamma, which is axis 3 of space in the body."""
        if self.follows_attitude:
            return ()

        def departure(state: Mapping[str, Sequence[Number]]) -> Number | None:
            if "attitude" in state:
                a, b, c, d = state["attitude"]
                cosine = a * a - b * b - c * c + d * d
            elif "gamma" in state:
                cosine = state["gamma"][2]
            else:
                return None
            return abs(cosine / float(precise("cos", exact(self.angle))) - 1)
        return (Limit(ANGLE_CHANGE, ANGLE_SHARE, departure, TURNS_AWAY,
                      "Galal et al., charged body: eq. (3) ff.", "the attitude"),)

    @property
    # a constant of the other effects, here found by the values
    def needs(self) -> tuple[str, ...]:  # type: ignore[override]
        return ("gamma",) if self.follows_attitude else ()

    def terms(self) -> dict[str, Any]:
        if self.follows_attitude:
            return {"E": self.exact}
        return {"Lambda": (Fraction(0), Fraction(0), -shortened(self.exact)), "charged": bool(self.exact)}

    def parameters(self) -> dict[str, Fraction]:
        return {"eHl2" if self.follows_attitude else "k": self.exact}

    def _strength(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Number:
        return p["eHl2"] * motion.gamma[2] if self.follows_attitude else p["k"]

    def torque_along(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Triple:
        k = self._strength(motion, p)
        return cross(motion.omega, (0, 0, k))

    def area(self, motion: MotionView, p: Mapping[str, Number]) -> Number:
        """gamma3' = gamma . (omega x e3), so the torque's share is k gamma3, or e H l^2 gamma3^2/2."""
        if self.follows_attitude:
            return p["eHl2"] * motion.gamma[2] ** 2 / 2
        return p["k"] * motion.gamma[2]


def shortened(value: Fraction) -> Fraction:
    """A cosine known to 240 bits, cut to 96: far within a double, and polynomials with it stay short. Short
    numbers stay exact."""
    excess = value.denominator.bit_length() - 96
    if excess <= 32:
        return value
    shift = 96 + value.denominator.bit_length() - value.numerator.bit_length()
    return round(value * Fraction(2)**shift) / Fraction(2)**shift
