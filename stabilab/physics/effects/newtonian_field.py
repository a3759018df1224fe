"""A distant centre of Newtonian attraction: its torque on the body to second order in size over distance."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar

from ...errors import InputError
from ...numbers.units import LENGTH, PER_SECOND_2, in_si
from ...numbers.vectors import Given, Number, Triple, cross
from ...reasons import Sentence
from .base import Effect, Limit

if TYPE_CHECKING:
    from types import SimpleNamespace

    from ..equations import MotionView
    from ..scene import Scene

# size over distance at which the next term of the field's torque is a tenth or so of the one that is kept
SMALL = 0.1
SIZE_RATIO = Sentence("field-size-ratio", "size of the body over the distance of the centre")()
TOO_NEAR = Sentence(
    "field-centre-too-near", "the field's torque is the first term of a series in this number, so near a "
    "centre the body does not move as computed")()


@dataclass(frozen=True)
class NewtonianField(Effect):
    """Torque N gamma x D gamma, N m, with N = 3 lambda/R^3 in 1/s^2; gamma along the line to the centre (Amer
    et al.
    2023, fast top: eq. (2); its eq. (1) has the opposite sign). Potential energy N gamma . D gamma/2.
    distance: R, m, where it is known: only with it can the law say how far it holds."""

    name: ClassVar[str] = "newtonian_field"
    article: ClassVar[str] = "a"
    agent: ClassVar[str] = "the field"
    keys: ClassVar[tuple[str, ...]] = ("strength", "lambda", "R")
    symbols: ClassVar[tuple[str, ...]] = ("N",)
    isotropic: ClassVar[bool] = True
    needs = ("gamma",)

    strength: Given
    distance: Given | None = None
    exact: Fraction = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "exact", in_si(self.strength, PER_SECOND_2, "strength"))
        object.__setattr__(self, "strength", float(self.exact))
        if self.distance is not None:
            distance = float(in_si(self.distance, LENGTH, "distance"))
            if distance <= 0:
                raise InputError(f"distance: expected a positive number of m, got {distance:g}")
            object.__setattr__(self, "distance", distance)

    @classmethod
    def from_case(cls, table: Any, context: Any) -> NewtonianField | None:
        if table.one_of("strength", "lambda") == "strength":
            if "R" in table:
                table.fault("R goes with lambda; strength is N = 3 lambda/R^3 already", "R")
            value, distance = table.number("strength"), None
        elif not table.data:
            table.fault("expected strength (N = 3 lambda/R^3, 1/s^2), or lambda (m^3/s^2) and R (m)")
            return None
        elif not table.required("lambda", "R"):
            return None
        else:
            attraction, distance = table.number("lambda"), table.positive("R")
            value = None if None in (attraction, distance) else 3 * attraction / distance**3
        return None if value is None else cls(value, distance)

    @property
    # a constant of the other effects, here found by the values
    def approximate(self) -> bool:  # type: ignore[override]
        """Whether its distance is known."""
        return self.distance is not None

    def limits(self, scene: Scene) -> tuple[Limit, ...]:
        """Size over distance; the size is sqrt(largest moment/mass). The mass is the body's, or that which
        the weight tells: g = N R/3 where the same centre pulls. None without either."""
        mass, gravity = scene.body.mass, scene.effect("gravity")
        if mass is None and gravity is not None:
            mass = gravity.weight / abs(self.strength * self.distance / 3)
        if not mass:
            return ()
        fraction = (max(scene.body.inertia) / abs(mass)) ** 0.5 / self.distance
        return (Limit(SIZE_RATIO, SMALL, lambda state: fraction, TOO_NEAR,
                      "Amer et al. 2023, fast top: eq. (2)"),)

    def terms(self) -> dict[str, Any]:
        return {"N": self.exact}

    def written(self) -> dict[str, Any]:
        if self.distance is None:
            return {"strength": self.exact}
        distance = Fraction(self.distance)
        return {"lambda": self.exact * distance**3 / 3, "R": distance}

    def torque_along(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Triple:
        spread = tuple(d * g for d, g in zip(motion.D, motion.gamma))
        return tuple(p["N"] * t for t in cross(motion.gamma, spread))

    def potential(self, motion: MotionView, p: Mapping[str, Number]) -> Number:
        return p["N"] * sum(d * g**2 for d, g in zip(motion.D, motion.gamma)) / 2

    def area(self, motion: MotionView, p: Mapping[str, Number]) -> Number:
        return 0 * motion.gamma[0]
