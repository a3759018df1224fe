"""A wheel or a ring on a viscous bearing, perhaps with a spring, which takes energy wherever the rate about
its axis changes."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar

from ...errors import InputError
from ...numbers.exact import floats, unit_vector
from ...numbers.principal import PrincipalAxes
from ...numbers.units import INERTIA, MOMENTUM, NONE, TORQUE, in_si, vector_in_si
from ...numbers.vectors import Exact3, Given, Number, Triple, cross, dot
from .base import Effect, Part, of_a_damper

if TYPE_CHECKING:
    from types import SimpleNamespace

    from ..body import Body
    from ..equations import MotionView


@dataclass(frozen=True)
class DamperWheel(Effect):
    """A rotor of moment J about its axis a, a unit vector fixed in the body, on a bearing whose torque on it
    is -c s, s its rate relative to the body (rad/s): a ring of liquid about a, or a damper wheel, which is
    the same (Savransky, Nutation Damper Animation, MATLAB Central File Exchange 129304, after Kasdin and
    Paley, has these equations for a symmetric body).

    inertia: J, kg m^2, about its axis; the moments of the body hold the rotor as if it were at rest there,
    and about other axes it turns with the body. coefficient: c, N m s. axis: of any length. stiffness: k,
    N m, of a torsion spring between body and rotor, relaxed at the angle phi = 0; zero for none, and then phi
    is no part of the state. With D those moments and M the outer torque

        (D - J a a^T) omega' = (D omega + J s a) x omega + (c s + k phi) a + M,
        phi' = s,    s' = -(c s + k phi)/J - a . omega',
        H = D omega + J s a,    T = omega . D omega/2 + J s a . omega + J s^2/2 + k phi^2/2,

    so that it keeps |H| and T' = omega . M - c s^2, T with the energy of the spring. At every permanent
    rotation s = phi = 0. Where a liquid cavity acts, too, its torque is taken
    along the motion without the wheel.
    """

    name: ClassVar[str] = "damper_wheel"
    article: ClassVar[str] = "a"
    takes: ClassVar[str] = "inside"
    agent: ClassVar[str] = "the damper"
    keys: ClassVar[tuple[str, ...]] = ("inertia", "coefficient", "axis", "stiffness")
    certain: ClassVar[tuple[str, ...]] = ("axis",)
    symbols: ClassVar[tuple[str, ...]] = ("Jw", "cw", "aw1", "aw2", "aw3")
    small: ClassVar[bool] = True
    displaced: ClassVar[bool] = False  # whether permanent rotations move it from where it is without them
    keeps_volume: ClassVar[bool] = False
    inertia: Given
    coefficient: Given
    axis: Sequence[Given]
    stiffness: Given = 0
    exact: tuple[Fraction, ...] = field(init=False, repr=False)
    spring: Fraction = field(init=False, repr=False)
    supplied: Exact3 = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        numbers = in_si(self.inertia, INERTIA, "inertia"), in_si(self.coefficient, MOMENTUM, "coefficient")
        spring = in_si(self.stiffness, TORQUE, "stiffness")
        object.__setattr__(self, "stiffness", of_a_damper("stiffness", spring, zero=True))
        object.__setattr__(self, "spring", spring)
        for name, value in zip(self.keys, numbers):
            object.__setattr__(self, name, of_a_damper(name, value))
        axis = vector_in_si(self.axis, NONE, "axis")
        if not any(axis):
            raise InputError("axis: expected a direction, got zero: give a vector of any length but that")
        object.__setattr__(self, "supplied", axis)
        object.__setattr__(self, "exact", (*numbers, *unit_vector(axis)))
        object.__setattr__(self, "axis", floats(self.exact[2:]))

    @classmethod
    def from_case(cls, table: Any, context: Any) -> DamperWheel | None:
        complete = table.required(*cls.keys[:3])
        inertia, coefficient = table.positive("inertia"), table.positive("coefficient")
        axis = table.vector("axis")
        spring = table.positive("stiffness", zero=True) if "stiffness" in table else Fraction(0)
        if inertia is None or coefficient is None or axis is None or spring is None or not complete:
            return None
        if not any(axis):
            table.fault("expected a direction, got zero: give a vector of any length but that", "axis")
            return None
        return cls(inertia, coefficient, axis, spring)

    @property
    # a constant of the other effects, here found by the values
    def needs(self) -> tuple[str, ...]:  # type: ignore[override]
        return ("sprung_wheel",) if self.spring else ("damper_wheel",)

    def parameters(self) -> dict[str, Fraction]:
        return super().parameters() | ({"kw": self.spring} if self.spring else {})

    def terms(self) -> dict[str, Any]:
        return {"movers": (self,)}

    def written(self) -> dict[str, Any]:
        return {"inertia": self.exact[0], "coefficient": self.exact[1], "axis": self.supplied} | (
            {"stiffness": self.spring} if self.spring else {})

    def turned(self, frame: PrincipalAxes) -> DamperWheel:
        return DamperWheel(self.exact[0], self.exact[1], frame.turned(self.supplied), self.spring)

    def change(self, omega: Sequence[float], block: Sequence[float]) -> tuple[float, ...]:
        """The rates of the block where those of the body do not change."""
        if not self.spring:
            return (-float(self.exact[1]) * block[0] / float(self.exact[0]),)
        pull = float(self.exact[1]) * block[1] + float(self.spring) * block[0]
        return block[1], -pull / float(self.exact[0])

    def share(self, D: Exact3) -> Fraction:
        """J a . D^-1 a: of the moment of the whole; the rest of the body has one about a as long as it is
        below 1."""
        return self.exact[0] * dot(self.exact[2:], tuple(a / d for a, d in zip(self.exact[2:], D)))

    def refused_by(self, body: Body) -> str:
        share = self.share(body.exact)
        return "" if share < 1 else (
            f"the wheel's moment of inertia, {float(self.exact[0]):.6g} kg m^2, must be smaller than "
            f"{float(self.exact[0] / share):.6g}, up to which the moments of the body can hold it about this "
            "axis; give the moments of the whole, or a smaller wheel")

    def never_turns(self, D: Exact3, wheel: Exact3) -> bool:
        """Whether the wheel is at rest in some motion of a free gyrostat that is no permanent rotation, so
        that it takes no energy there.

        It is where a . omega stays, which is linear in H = D omega + lambda: the path of H on its sphere is
        then a circle, n . H constant for n = D^-1 a. The energy is constant on a circle where D^-1 - mu is
        the symmetric part of n m^T for some m, and D^-1 lambda = p m/2 + q n, p = n . H: with two equal
        moments for n along the third axis, and lambda along it; with three equal moments for n along
        lambda; with three different ones, mu = 1/D2, for n normal to a circular section of the ellipsoid of
        D^-1, and no lambda along axis 2.
        """
        n = tuple(a / d for a, d in zip(self.supplied, D))
        if D[0] == D[1] == D[2]:
            return any(wheel) and not any(cross(n, wheel))
        one, two, three = sorted(range(3), key=lambda i: -D[i])
        if D[one] > D[two] > D[three]:
            square = lambda i, j: n[i] ** 2 * abs(1 / D[j] - 1 / D[two])
            return not n[two] and square(one, three) == square(three, one) and not wheel[two]
        alone = one if D[two] == D[three] else three
        others = [i for i in range(3) if i != alone]
        return not any(n[i] or wheel[i] for i in others)

    def part(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Part:
        J, c, *axis = (p[name] for name in self.symbols)
        a, omega = tuple(axis), motion.omega
        angle, s = motion.sprung_wheel if self.spring else (0, *motion.damper_wheel)
        pull, stored = (c * s + p["kw"] * angle, p["kw"] * angle * angle / 2) if self.spring else (c * s, 0)

        def rate(change: Triple) -> tuple[Number, ...]:
            turn = -pull / J - dot(a, change)
            return (s, turn) if self.spring else (turn,)
        turning = tuple(J * s * t + pull * v for t, v in zip(cross(a, omega), a))
        energy = J * s * dot(a, omega) + J * s * s / 2 + stored
        return Part(0, tuple(J * s * v for v in a), energy, turning, c * s * s, rate,
                    tuple(tuple(J * v * w for w in a) for v in a))
