"""A mass on a line in the body, with a spring and a dashpot, which takes energy wherever it moves."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar

from ...errors import InputError
from ...numbers.exact import floats, unit_vector
from ...numbers.principal import PrincipalAxes
from ...numbers.units import LENGTH, MASS, MASS_FLOW, NONE, STIFFNESS, in_si, vector_in_si
from ...numbers.vectors import Exact3, Given, Number, Triple, cross, dot
from .base import Effect, Part, of_a_damper

if TYPE_CHECKING:
    from types import SimpleNamespace

    from ..body import Body
    from ..equations import MotionView


@dataclass(frozen=True)
class DamperMass(Effect):
    """A point of mass m on a line in the body, at p + x n, p where its spring is relaxed and n a unit vector,
    with a spring k and a dashpot c: a nutation damper (Roithmayr and Hodges, Dynamics: Theory and Application
    of Kane's Method, section 9.6, has the particle across its line from the mass centre).

    mass: m, kg, part of the body's whole mass. place: p, m, from the mass centre of the whole where x = 0,
    about which the moments of the body are those of the whole. line: n, of any length. stiffness: k, N/m;
    coefficient: c, N s/m; mass_of_body: kg, of the whole, which the body states too. With mu = m (1 -
    m/mass of the whole), r = p/(1 - m/mass of the whole) the place from the mass centre of the rest, q = r
    x n, and

        J(x) = D + mu ((2 x r . n + x^2) 1 - x (r n^T + n r^T) - x^2 n n^T),

    H = J omega + mu v q about the mass centre of all, which moves uniformly where no force acts, and

        H' = H x omega + M,    x' = v,    mu v' = -mu q . omega' + omega . J' omega/2 - k x - c v,
        T = omega . J omega/2 + mu v q . omega + mu v^2/2 + k x^2/2, with the energy of the spring,

    J' = dJ/dx, so that it keeps |H| and T' = omega . M - c v^2. It is the spring's departure at rest that is
    left out of p: a rotation holds the mass elsewhere, where k x = omega . J' omega/2. Where a liquid cavity
    acts, too, its torque is taken along the motion without the mass.
    """

    name: ClassVar[str] = "damper_mass"
    article: ClassVar[str] = "a"
    takes: ClassVar[str] = "inside"
    agent: ClassVar[str] = "the damper"
    keys: ClassVar[tuple[str, ...]] = ("mass", "place", "line", "stiffness", "coefficient")
    certain: ClassVar[tuple[str, ...]] = ("line",)
    symbols: ClassVar[tuple[str, ...]] = ("mud", "ks", "cs", "rd1", "rd2", "rd3", "nd1", "nd2", "nd3")
    small: ClassVar[bool] = True
    keeps_volume: ClassVar[bool] = False
    displaced: ClassVar[bool] = True  # whether permanent rotations move it from where it is without them
    needs = ("damper_mass",)

    mass: Given
    place: Sequence[Given]
    line: Sequence[Given]
    stiffness: Given
    coefficient: Given
    mass_of_body: Given
    exact: tuple[Fraction, ...] = field(init=False, repr=False)
    supplied: tuple[Any, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        given = (in_si(self.mass, MASS, "mass"), in_si(self.stiffness, STIFFNESS, "stiffness"),
                 in_si(self.coefficient, MASS_FLOW, "coefficient"))
        for name, value in zip(("mass", "stiffness", "coefficient"), given):
            object.__setattr__(self, name, of_a_damper(name, value, zero=name == "stiffness"))
        place, line = vector_in_si(self.place, LENGTH, "place"), vector_in_si(self.line, NONE, "line")
        if not any(line):
            raise InputError("line: expected a direction, got zero: give a vector of any length but that")
        whole = in_si(self.mass_of_body, MASS, "mass_of_body")
        if whole <= given[0]:
            raise InputError(f"mass: expected less than the whole body has, {float(whole):g} kg, got "
                             f"{float(given[0]):g} kg")
        rest = 1 - given[0] / whole
        object.__setattr__(self, "supplied", (given[0], place, line, given[1], given[2], whole))
        object.__setattr__(self, "exact", (given[0] * rest, given[1], given[2], *(v / rest for v in place),
                                           *unit_vector(line)))
        object.__setattr__(self, "place", floats(place))
        object.__setattr__(self, "line", floats(self.exact[6:]))
        object.__setattr__(self, "mass_of_body", float(whole))

    @classmethod
    def from_case(cls, table: Any, context: Any) -> DamperMass | None:
        complete = table.required(*cls.keys)
        mass, coefficient = table.positive("mass"), table.positive("coefficient")
        stiffness = table.positive("stiffness", zero=True)
        place, line = table.vector("place"), table.vector("line")
        if None in (mass, coefficient, stiffness, place, line) or not complete:
            return None
        if not any(line):
            table.fault("expected a direction, got zero: give a vector of any length but that", "line")
            return None
        if context.body.mass is None:
            if not context.stand_in:
                table.fault("a mass that moves in the body moves the rest: give body.mass, of the whole")
            return None
        return cls(mass, place, line, stiffness, coefficient, context.body.mass)

    def terms(self) -> dict[str, Any]:
        return {"movers": (self,)}

    def written(self) -> dict[str, Any]:
        return dict(zip(self.keys, self.supplied))

    def turned(self, frame: PrincipalAxes) -> DamperMass:
        mass, place, line, stiffness, coefficient, whole = self.supplied
        return DamperMass(mass, frame.turned(place), frame.turned(line), stiffness, coefficient, whole)

    def change(self, omega: Sequence[float], block: Sequence[float]) -> tuple[float, ...]:
        """The rates of the block where those of the body do not change."""
        p = {name: float(value) for name, value in self.parameters().items()}
        mu, k, c = (p[name] for name in self.symbols[:3])
        _, slope, _ = self._tensors(p, block[0])
        pull = sum(w * dot(row, omega) for w, row in zip(omega, slope)) / 2
        return block[1], (pull - k * block[0] - c * block[1]) / mu

    def share(self, D: Exact3) -> Fraction:
        """Of the moments of the whole, at most the part that the mass has: the largest eigenvalue of D^-1 G
        is at most that of G over min D, mu |r|^2/min D, and the sum of all. The rest of the body has moments
        about its own mass centre of at least (1 - share) D."""
        own = self._own()
        return min(self.exact[0] * dot(self.exact[3:6], self.exact[3:6]) / min(D),
                   sum((own[i][i] / moment for i, moment in enumerate(D)), Fraction(0)))

    def _own(self) -> tuple[tuple[Fraction, ...], ...]:
        """G = mu (|r|^2 1 - r r^T), what the relaxed mass has of the moments of the whole."""
        mu, r = self.exact[0], self.exact[3:6]
        return tuple(tuple(mu * (int(i == j) * dot(r, r) - r[i] * r[j]) for j in range(3)) for i in range(3))

    def refused_by(self, body: Body) -> str:
        if body.mass != self.mass_of_body:
            return ("mass_of_body is that of the whole: give Body(.., mass=..) the same, got "
                    f"{body.mass} and {self.mass_of_body:g}")
        own = self._own()
        a, b, c = (tuple(int(i == j) * body.exact[i] - v for j, v in enumerate(row))
                   for i, row in enumerate(own))
        if not (a[0] > 0 and a[0] * b[1] > a[1] ** 2 and dot(a, cross(b, c)) > 0):
            part, whole = (", ".join(f"{float(v):.6g}" for v in row)
                           for row in ([own[i][i] for i in range(3)], body.exact))
            return (f"at its distance from the mass centre its mass has the moments ({part}) kg m^2 about "
                    f"the axes, and the body, which holds it, ({whole}): the rest would have none above zero "
                    "about some axis: give the moments of the whole, or a smaller mass")
        return ""

    def never_turns(self, D: Exact3, wheel: Exact3) -> bool:
        """Not known."""
        return True

    def _tensors(self, p: Mapping[str, Number], x: Number) -> tuple[Any, Any, Triple]:
        """(J(x) - D, dJ/dx, q)."""
        mu, _, _, *vectors = (p[name] for name in self.symbols)
        r, n = tuple(vectors[:3]), tuple(vectors[3:])
        along = dot(r, n)
        added, slope = ([[mu * (int(i == j) * (f * along + g) - h * (r[i] * n[j] + n[i] * r[j])
                                - g * n[i] * n[j]) for j in range(3)] for i in range(3)]
                        for f, g, h in ((2 * x, x * x, x), (2, 2 * x, 1)))
        return added, slope, cross(r, n)

    def part(self, motion: SimpleNamespace | MotionView, p: Mapping[str, Number]) -> Part:
        (x, v), omega = motion.damper_mass, motion.omega
        mu, k, c = (p[name] for name in self.symbols[:3])
        added, slope, q = self._tensors(p, x)
        gained = tuple(dot(row, omega) for row in added)
        changes = tuple(dot(row, omega) for row in slope)
        momentum = tuple(g + mu * v * a for g, a in zip(gained, q))
        pull = dot(omega, changes) / 2 - k * x - c * v  # on the mass along its line

        def rate(change: Triple) -> tuple[Number, ...]:
            return v, pull / mu - dot(q, change)
        torque = tuple(t - v * g - pull * a for t, g, a in zip(cross(momentum, omega), changes, q))
        energy = dot(omega, gained) / 2 + mu * v * dot(q, omega) + mu * v * v / 2 + k * x * x / 2
        taken = tuple(tuple(mu * a * b - w for b, w in zip(q, row)) for a, row in zip(q, added))
        return Part(0, momentum, energy, torque, c * v * v, rate, taken)
