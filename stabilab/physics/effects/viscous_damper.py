"""A spherical damper: a sphere that turns in a viscous fluid at the mass centre and takes energy."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar

from ...numbers.units import INERTIA, MOMENTUM, in_si
from ...numbers.vectors import Given, Number, Triple, cross, dot
from .base import Effect, Part, of_a_damper

if TYPE_CHECKING:
    from types import SimpleNamespace

    from ..body import Body
    from ..equations import MotionView


@dataclass(frozen=True)
class ViscousDamper(Effect):
    """A sphere of moment of inertia k in a fluid whose torque on it is -c sigma, sigma its angular velocity
    relative to the body (rad/s, body frame): Kane's damper, a slug of propellant (Rahn and Barba, J. Guidance
    14(4), 1991, pp. 724-728; there k is J and c is mu).

    inertia: k, kg m^2, about any axis; the moments of the body hold it, as of a sphere at rest in the body.
    coefficient: c, N m s. With D those moments and M the outer torque

        (D - k) omega' = D omega x omega + c sigma + M,    sigma' = -c sigma/k - omega x sigma - omega',
        H = D omega + k sigma,    T = omega . D omega/2 + k omega . sigma + k |sigma|^2/2,

    so that the damper keeps |H| and T' = omega . M - c |sigma|^2. Where a liquid cavity acts, too, its torque
    is taken along the motion without the damper.
    """

    name: ClassVar[str] = "viscous_damper"
    article: ClassVar[str] = "a"
    takes: ClassVar[str] = "inside"
    agent: ClassVar[str] = "the damper"
    keys: ClassVar[tuple[str, ...]] = ("inertia", "coefficient")
    symbols: ClassVar[tuple[str, ...]] = ("kd", "cd")
    isotropic: ClassVar[bool] = True
    small: ClassVar[bool] = True
    keeps_volume: ClassVar[bool] = False
    needs = ("damper",)

    inertia: Given
    coefficient: Given
    exact: tuple[Fraction, Fraction] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        exact = in_si(self.inertia, INERTIA, "inertia"), in_si(self.coefficient, MOMENTUM, "coefficient")
        for name, value in zip(self.keys, exact):
            object.__setattr__(self, name, of_a_damper(name, value))
        object.__setattr__(self, "exact", exact)

    @classmethod
    def from_case(cls, table: Any, context: Any) -> ViscousDamper | None:
        complete = table.required(*cls.keys)
        inertia, coefficient = table.positive("inertia"), table.positive("coefficient")
        if inertia is None or coefficient is None or not complete:
            return None
        return cls(inertia, coefficient)

    def terms(self) -> dict[str, Any]:
        return dict(zip(("inside", "friction"), self.exact))

    def written(self) -> dict[str, Any]:
        return dict(zip(self.keys, self.exact))

    def refused_by(self, body: Body) -> str:
        lower = min(body.exact)
        return "" if self.exact[0] < lower else (
            f"the sphere's moment of inertia, {float(self.exact[0]):.6g} kg m^2, must be smaller than every "
            f"principal moment of the body, which hold it: the least is {float(lower):.6g}; give the moments "
            "of the whole, or a smaller sphere")

    def part(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Part:
        k, c, sigma, omega = p["kd"], p["cd"], motion.damper, motion.omega

        def rate(change: Triple) -> Triple:
            turned = cross(omega, sigma)
            return tuple(-c * s / k - t - w for s, t, w in zip(sigma, turned, change))
        return Part(k, tuple(k * s for s in sigma), k * dot(omega, sigma) + k * dot(sigma, sigma) / 2,
                    tuple(c * s for s in sigma), c * dot(sigma, sigma), rate)
