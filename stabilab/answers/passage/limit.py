"""A limit as it is asked for: of the rate, of a component, of the kinetic energy, of the angle by which a
body axis has turned."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ...errors import InputError
from ...integrate.integer_flow import Threshold
from ...numbers.exact import exact, exact_vector, precise, sqrt_fraction, unit_vector
from ...numbers.vectors import Exact3, Float3, Number
from ...physics.scene import AnyScene

AXES = tuple(tuple(Fraction(int(i == j)) for j in range(3)) for i in range(3))
COSINE_BITS = 1200  # of the cosine of a tilt: more than any run has
SIGN = " (it is a size: give it without a sign)"


@dataclass(frozen=True)
class Limit:
    """kind: "rate", "component", "energy" or "tilt". parts: ((weights and vectors, limit), ...): sum c (a .
    omega)^2 reaches the limit's value `most`, the first of the parts counts; for a tilt vector and angle,
    rad. words: for the reader, in SI. origin: of a tilt, the direction in space that it counts from; None:
    that of its body axis at the start."""

    kind: str
    parts: tuple[Any, ...]
    words: str
    origin: Float3 | None = None

    def thresholds(self, unit: Fraction) -> list[Threshold]:
        """In the motion's own unit, as `crossing` takes them."""
        if self.kind == "tilt":
            ((_, vector),), angle = self.parts[0]
            zero = (Fraction(0),) * 3
            return [Threshold(((Fraction(1), zero + vector),), precise("cos", angle, bits=COSINE_BITS), True)]
        return [Threshold(terms, most / (unit * unit)) for terms, most in self.parts]

    @property
    def direction(self) -> Exact3 | None:
        """The body axis whose tilt is asked for, a unit vector; None for other limits."""
        return self.parts[0][0][0][1] if self.kind == "tilt" else None

    def reached_by(self, state: Sequence[Number]) -> bool:
        """Whether an exact state has reached it; a tilt is 0 at the start."""
        return self.kind != "tilt" and any(part.passed(state) for part in self.thresholds(Fraction(1)))

    def beyond(self, extremes: Iterable[Iterable[float]], slack: float) -> bool:
        """Whether rates within their extremes, ((least, greatest),) * 3, each wider by the share `slack`,
        stay below it."""
        if self.kind == "tilt":
            return False
        sizes = [max(abs(low), abs(high)) * (1 + slack) for low, high in extremes]

        def below(terms: Any, most: Fraction) -> bool:
            """In exact numbers, as squares of doubles may be none."""
            own = [size if any(vector[n] for _, vector in terms) else 0.0 for n, size in enumerate(sizes)]
            return all(map(math.isfinite, own)) and most > sum(
                c * sum(abs(a) * Fraction(size) for a, size in zip(vector, own)) ** 2 for c, vector in terms)
        return all(below(terms, most) for terms, most in self.parts)

    def least_rate(self) -> float:
        """The largest |omega| below which it is surely not reached."""
        return min(float(sqrt_fraction(Fraction(most) / max(c for c, _ in terms)))
                   for terms, most in self.parts)


def along_axes(terms: Iterable[Any]) -> list[float] | None:
    """Three weights of the squares of the rates; None where a direction is not a principal axis."""
    weights = [0.0, 0.0, 0.0]
    for c, vector in terms:
        entries = [n for n, v in enumerate(vector) if v]
        if len(entries) != 1:
            return None
        weights[entries[0]] += float(c * vector[entries[0]] ** 2)
    return weights


def asked(scene: AnyScene, rate: Any = None, component: Any = None, energy: Any = None,
          tilt: Any = None) -> Limit:
    """The one limit that is given; InputError for none, several, and for numbers that are none."""
    given = {name: value for name, value in (("rate", rate), ("component", component), ("energy", energy),
                                             ("tilt", tilt)) if value is not None}
    if len(given) != 1:
        raise InputError(
            f"time_to: expected one of rate, component, energy and tilt, got {', '.join(given) or 'none'}")
    (name, value), = given.items()
    return {"rate": _rate, "component": _component, "energy": _energy, "tilt": _tilt}[name](scene, value)


def _rate(scene: AnyScene, value: Any) -> Limit:
    unit = _unit(scene)
    if hasattr(value, "__len__") and not isinstance(value, str):
        limits = exact_vector(value, "rate")
        parts = tuple((((Fraction(1), axis),), _positive(most, "rate") ** 2)
                      for axis, most in zip(AXES, limits))
        return Limit("component", parts,
                     "|components| " + ", ".join(f"{float(v):.10g}" for v in limits) + f" {unit}")
    most = _positive(value, "rate")
    letter = "x" if scene.variables == "scaled" else "omega"
    return Limit("rate", ((tuple((Fraction(1), axis) for axis in AXES), most**2),),
                 f"|{letter}| = {float(most):.10g} {unit}".rstrip())


def _component(scene: AnyScene, value: Any) -> Limit:
    several = isinstance(value, list) and value and all(isinstance(one, tuple) for one in value)
    parts, words = [], []
    for axis, most in (_pair(one, "component") for one in (value if several else [value])):
        vector, named = _direction(axis, "component")
        most = _positive(most, "component")
        parts.append((((Fraction(1), vector),), most**2))
        words.append(f"|rate about {named}| = {float(most):.10g} {_unit(scene)}".rstrip())
    return Limit("component", tuple(parts), " or ".join(words))


def _energy(scene: AnyScene, value: Any) -> Limit:
    if scene.variables == "scaled":
        raise InputError("energy: scaled variables know no kinetic energy: give a body")
    most = _positive(value, "energy")
    return Limit("energy", ((tuple((d / 2, axis) for d, axis in zip(scene.body.exact, AXES)), most),),
                 f"kinetic energy = {float(most):.10g} J")


def _tilt(scene: AnyScene, value: Any) -> Limit:
    if scene.variables == "scaled":
        raise InputError("tilt: scaled variables know no attitude: give a body")
    axis, angle = _pair(value, "tilt")
    vector, named = _direction(axis, "tilt")
    angle = _positive(angle, "tilt")
    if not float(angle) < math.pi:
        raise InputError(f"tilt: expected an angle below half a turn (pi rad), got {float(angle):.10g} rad")
    return Limit("tilt", ((((Fraction(1), vector),), angle),), f"tilt of {named} = {float(angle):.10g} rad")


def _unit(scene: AnyScene) -> str:
    return "" if scene.variables == "scaled" else "rad/s"


def _pair(value: Any, name: str) -> tuple[Any, Any]:
    try:
        axis, most = value
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected (axis, limit), the axis 1, 2, 3 or three numbers along it, got "
                         f"{value!r:.80}") from None
    return axis, most


def _direction(axis: Any, name: str) -> tuple[Exact3, str]:
    """(unit vector along it, its name)."""
    if isinstance(axis, (int, float, str)) and not isinstance(axis, bool):
        if axis in (1, 2, 3):
            return AXES[int(axis) - 1], f"axis {int(axis)}"
        raise InputError(f"{name}: expected the axis 1, 2 or 3 or three numbers along it, got {axis!r}")
    vector = exact_vector(axis, name)
    if not any(vector):
        raise InputError(f"{name}: expected a direction, got zero: give a vector of any length but that")
    unit = unit_vector(vector)
    return unit, f"({', '.join(f'{float(v):.6g}' for v in unit)})"


def _positive(value: Any, name: str) -> Fraction:
    try:
        number = exact(value)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None
    if number <= 0:
        raise InputError(
            f"{name}: expected a positive limit, got {float(number):.10g}{SIGN if number < 0 else ''}")
    return number
