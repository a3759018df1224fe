"""Numbers with a unit, exactly: "22 N", "30 deg/s", "0.3 N m s".

A table of our own rather than pint: pint's import takes longer than the whole of `stabilab classify`, its
numbers are doubles where ours are exact, and an unknown unit should be answered with the few that a
spacecraft needs. Exact decimals stay exact in every unit but those of a turn (deg, arcmin, arcsec, rev, rpm),
which hold pi: these are good to 240 bits.
"""
from __future__ import annotations

import math
import re
from collections.abc import Iterable
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple, TypeAlias

from ..errors import InputError
from .exact import exact, exact_vector, half_unit, precise
from .miswritten import INSTEAD, SUPERS, instead, meant, typed
from .vectors import Exact3

Dimension: TypeAlias = tuple[int, ...]  # exponents of m, kg, s, A, rad


class UnknownUnit(InputError):
    """A word that is no unit."""


class Unit(NamedTuple):
    """One of it in SI units, its dimension, and whether its size is exact."""

    size: Fraction
    dimension: Dimension
    exact: bool = True


PREFIXES = {"n": -9, "u": -6, "µ": -6, "μ": -6, "m": -3, "c": -2, "d": -1, "k": 3, "M": 6, "G": 9}
BASE = {"m": (1, 0, 0, 0, 0), "g": (0, 1, 0, 0, 0), "s": (0, 0, 1, 0, 0), "A": (0, 0, 0, 1, 0),
        "rad": (0, 0, 0, 0, 1),
        "N": (1, 1, -2, 0, 0), "J": (2, 1, -2, 0, 0), "W": (2, 1, -3, 0, 0), "Pa": (-1, 1, -2, 0, 0),
        "C": (0, 0, 1, 1, 0),
        "V": (2, 1, -3, -1, 0), "T": (0, 1, -2, -1, 0), "Nm": (2, 1, -2, 0, 0), "Nms": (2, 1, -1, 0, 0)}
TURNS = {"deg": 360, "°": 360, "arcmin": 21600, "arcsec": 1296000, "rev": 1}  # how many make a turn
OTHERS = {"min": ("60", "s"), "h": ("3600", "s"), "day": ("86400", "s"), "week": ("604800", "s"),
          "lb": ("453.59237", "g"), "t": ("1000000", "g"),
          "in": ("0.0254", "m"), "ft": ("0.3048", "m"), "lbf": ("4.4482216152605", "N"),
          "slug": ("44482216152605/3048000000", "g"), "Nmm": ("0.001", "Nm"), "Ncm": ("0.01", "Nm")}
SYMBOLS_BY_NAME = {name: symbol for symbol, names in {
    "s": "second sec", "min": "minute min", "h": "hour hr", "day": "day", "week": "week", "m": "metre meter",
    "g": "gram", "kg": "kilogram kg",
    "t": "tonne", "N": "newton", "J": "joule", "W": "watt", "Pa": "pascal", "C": "coulomb", "V": "volt",
    "T": "tesla", "A": "ampere amp",
    "rad": "radian rad", "deg": "degree deg", "arcmin": "arcminute arcmin", "arcsec": "arcsecond arcsec",
    "rev": "revolution rev turn",
    "rpm": "rpm", "in": "inch inches", "ft": "foot feet ft", "lb": "pound lb", "lbf": "lbf",
    "slug": "slug"}.items() for name in names.split()}
# alone they mean no other unit, as in DEG/S and KG M^2; N M S is three words, NM would be nm
CAPITALS = {"S": "s", "M": "m"}
ACCEPTED = ("m, kg, g, s, A, rad, N, J, W, Pa, C, V, T with the prefixes n u m c d k M G; deg, arcmin, "
            "arcsec, rev, rpm, dps; min, h, day, week; t; in, ft, lb, lbf, slug; their English names such as "
            "hours, degrees, newtons, in small or capital letters; and products, powers and quotients of "
            "these such as N m s, kg m^2, deg/s")
NONE, LENGTH, MASS, TIME, ANGLE = (0,) * 5, (1, 0, 0, 0, 0), (0, 1, 0, 0, 0), (0, 0, 1, 0, 0), (0, 0, 0, 0, 1)
RATE, FORCE, TORQUE, MOMENTUM = (0, 0, -1, 0, 1), (1, 1, -2, 0, 0), (2, 1, -2, 0, 0), (2, 1, -1, 0, 0)
INERTIA, VELOCITY, CHARGE, FLUX = (2, 1, 0, 0, 0), (1, 0, -1, 0, 0), (0, 0, 1, 1, 0), (0, 1, -2, -1, 0)
PER_SECOND, PER_SECOND_2, DENSITY, VISCOSITY = (0, 0, -1, 0,
                                                0), (0, 0, -2, 0, 0), (-3, 1, 0, 0, 0), (2, 0, -1, 0, 0)
MASS_FLOW, EDDY = (0, 1, -1, 0, 0), (2, -1, 3, 2, 0)
STIFFNESS = (0, 1, -2, 0, 0)
# an energy has the dimension of a torque
ATTRACTION, LENGTH_7, ENERGY = (3, 0, -2, 0, 0), (7, 0, 0, 0, 0), (2, 1, -2, 0, 0)
NAMES: dict[Dimension, str] = {
         NONE: "a number without a unit", LENGTH: "length (m)", MASS: "mass (kg)", TIME: "time (s)",
         ANGLE: "angle (rad)",
         RATE: "angular velocity (rad/s)", FORCE: "force (N)", TORQUE: "torque (N m)",
         MOMENTUM: "angular momentum (N m s)",
         INERTIA: "moment of inertia (kg m^2)", VELOCITY: "velocity (m/s)", CHARGE: "charge (C)",
         FLUX: "magnetic flux density (T)",
         PER_SECOND: "rate (1/s)", DENSITY: "density (kg/m^3)", VISCOSITY: "kinematic viscosity (m^2/s)",
         MASS_FLOW: "mass flow (kg/s)", STIFFNESS: "stiffness (N/m)",
         EDDY: "torque over rate and field squared (N m s/T^2)", (2, 1, -3, 0, 0): "power (W)",
         (-1, 1, -2, 0, 0): "pressure (Pa)", (0, 0, -2, 0, 1): "angular acceleration (rad/s^2)",
         (1, 1, -1, 0, 0): "momentum (N s)"}

# of the numbers of a case file; one that is not here is a number without a unit
DIMENSIONS: dict[str, Dimension] = {
    "body.inertia": INERTIA, "body.products.xy": INERTIA, "body.products.xz": INERTIA,
    "body.products.yz": INERTIA,
    "body.mass": MASS, "body.centre_of_mass": LENGTH,
    "thrusters.position": LENGTH, "thrusters.force": FORCE, "thrusters.force_tolerance": FORCE,
    "thrusters.misalignment": ANGLE,
    "thrusters.start": TIME, "thrusters.stop": TIME, "thrusters.period": TIME, "thrusters.on_time": TIME,
    "thrusters.profile": TIME, "thrusters.propellant": MASS, "thrusters.mass_flow": MASS_FLOW,
    "wheels.momentum": MOMENTUM, "wheels.inertia": INERTIA, "wheels.speed": RATE,
    "circular_orbit.rate": RATE, "circular_orbit.period": TIME, "circular_orbit.altitude": LENGTH,
    "circular_orbit.radius": LENGTH,
    "limits.rate": RATE, "motion.angular_velocity": RATE, "motion.span": TIME, "motion.attitude": ANGLE,
    "motion.velocity": VELOCITY, "motion.position": LENGTH, "expect.period": TIME,
    "effects.gyrostat.momentum": MOMENTUM, "effects.constant_torque.torque": TORQUE,
    "effects.body_force.force": FORCE,
    "effects.gravity.weight": FORCE, "effects.gravity.centre_of_mass": LENGTH,
    "effects.resistance.coefficient": PER_SECOND,
    "effects.newtonian_field.strength": PER_SECOND_2, "effects.newtonian_field.lambda": ATTRACTION,
    "effects.newtonian_field.R": LENGTH,
    "effects.charge.charge": CHARGE, "effects.charge.field": FLUX, "effects.charge.arm": LENGTH,
    "effects.charge.angle": ANGLE,
    "effects.liquid_cavity.density": DENSITY, "effects.liquid_cavity.viscosity": VISCOSITY,
    "effects.liquid_cavity.P0": LENGTH_7,
    "effects.liquid_cavity.radius": LENGTH,
    "effects.viscous_damper.inertia": INERTIA, "effects.viscous_damper.coefficient": MOMENTUM,
    "effects.damper_wheel.inertia": INERTIA, "effects.damper_wheel.coefficient": MOMENTUM,
    "effects.damper_wheel.stiffness": TORQUE,
    "effects.damper_mass.mass": MASS, "effects.damper_mass.place": LENGTH,
    "effects.damper_mass.stiffness": STIFFNESS, "effects.damper_mass.coefficient": MASS_FLOW,
    "effects.rate_damper.coefficient": MOMENTUM,
    "effects.eddy_currents.coefficient": EDDY, "effects.eddy_currents.field": FLUX,
    "effects.wheel_motor.torque": TORQUE, "effects.wheel_motor.duration": TIME,
    "motion.damper_wheel": RATE,
    "motion.damper": RATE, "motion.wheel": MOMENTUM, "motion.rotation_period": TIME,
    "motion.precession_period": TIME, "motion.amplitude": ANGLE, "motion.spin": RATE,
    "motion.nutation": ANGLE, "motion.lean": ANGLE,
}
# of vectors whose numbers are of several dimensions, one for each
MIXED: dict[str, tuple[Dimension, ...]] = {"motion.sprung_wheel": (ANGLE, RATE),
                                           "motion.damper_mass": (LENGTH, VELOCITY)}

# compiled where a unit is read
_NUMBER = r"(?as)\s*([+-]?(?:\d[\d_]*(?:\.[\d_]*)?|\.\d[\d_]*)(?:[eE][+-]?\d+)?(?:\s*/\s*\d+)?)\s*(.*)"
_FACTOR = re.compile(r"\s*([*·/.\-]|)\s*(1|[A-Za-zµμ°]+)(?:\^|\*\*)?([+-]?\d{1,2})?\s*")
# a mass and a length written as one word: squared it is a moment of inertia, kgm2, and nothing else
_GLUED = re.compile(r"(kg|g|t|slug|lb)(m|cm|mm|in|ft)")


def split(text: str) -> tuple[str, str] | None:
    """("22", "N") of "22 N"; None where the text does not begin with a number."""
    result = re.fullmatch(_NUMBER, typed(text)) if len(text) <= 400 else None
    return (result[1], result[2].strip()) if result else None


def quantity(text: str, wanted: Dimension) -> tuple[Fraction, bool]:
    """(the number in SI units, whether that is exact) of a number with its unit, or without, which is SI.
    Raises InputError."""
    parts = split(text)
    if parts is None:
        return _plain(text, wanted), True
    if not parts[1]:
        return exact(parts[0]), True
    value = exact(parts[0])
    try:
        unit = in_dimension(parts[1], wanted, text)
    except InputError as error:
        if not isinstance(error, UnknownUnit):
            parts_of_time = re.search(r"\d\s*[a-z]+\s*\d+\s*[a-z]", text) and instead(text, False)
            raise InputError(f"{error}; {parts_of_time}" if parts_of_time else str(error)) from None
        cure = instead(text, wanted == NONE)
        if cure:
            also = "" if wanted == NONE else ", alone or with a unit"
            raise InputError(f'expected a decimal or a ratio such as "0.1" or "2/3"{also}, got '
                             f'"{text[:60]}"; '
                             f'{cure}') from None
        raise InputError(f'expected a decimal or a ratio such as "0.1" or '
                         f'"2/3"{"" if wanted == NONE else ", alone or with a unit"}, '
                         f'got "{text[:60]}"{"" if wanted == NONE else f": {error}"}') from None
    return exact(value * unit.size), unit.exact or not value  # refuses what no double can hold


def _plain(text: str, wanted: Dimension) -> Fraction:
    """A text that does not begin with a number: one after all, or an error with what to write."""
    try:
        return exact(text)
    except InputError as error:
        cure = instead(text, wanted == NONE)
        raise InputError(f"{error}; {cure}" if cure else str(error)) from None


def in_si(value: object, wanted: Dimension, name: str = "") -> Fraction:
    """The number that is given, in SI units: alone, as of `exact`, or as text with its unit ("0.5 N m").
    Raises InputError, whose words begin with `name`, where there is one."""
    try:
        return quantity(value, wanted)[0] if isinstance(value, str) else exact(value)
    except InputError as error:
        raise InputError(f"{name}: {error}" if name else str(error)) from None


def vector_in_si(values: Iterable[object], wanted: Dimension, name: str) -> Exact3:
    """Three numbers, each as of `in_si`."""
    return exact_vector(values, name, lambda value: in_si(value, wanted))


def half_digit(value: Any, wanted: Dimension) -> Fraction:
    """Half a unit of the last digit of a number as it was written (see `half_unit`), in SI units."""
    number, unit = (isinstance(value, str) and split(value)) or (value, "")
    return half_unit(number) * (in_dimension(unit, wanted).size if unit else 1)


def in_dimension(phrase: str, wanted: Dimension, text: str = "") -> Unit:
    """The unit, which must have the dimension that is wanted. Raises InputError with both dimensions
    otherwise."""
    unit = unit_of(phrase)
    if unit.dimension != wanted:
        came = text or phrase
        if wanted == NONE:
            raise InputError(f'expected {named(wanted)}, got {named(unit.dimension)}: "{came[:60]}"')
        also = " or energy (J)" if wanted == ENERGY else ""
        raise InputError(
            f'expected {named(wanted)}{also}, got {named(unit.dimension)}: "{came[:60]}"'
            f'{meant(named(wanted), named(unit.dimension))}; a number alone is in SI units')
    return unit


def unit_of(text: str) -> Unit:
    """The unit that a product of units makes. Raises InputError for a word that is none, with those that are
    accepted."""
    text = re.sub(r"\bper\b", "/", typed(text))
    text = re.sub("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+", lambda power: f"^{power[0].translate(SUPERS)}", text)
    size, is_exact, at, divided = Fraction(1), True, 0, False
    dimension: Dimension = NONE
    while at < len(text):
        result = _FACTOR.match(text, at)
        if not result or (at == 0 and result[1]):
            raise UnknownUnit(f'unknown unit "{text[:60]}"; accepted are {ACCEPTED}')
        if result[1] == "/" and divided:
            raise InputError(
                f'"{text[:60]}" divides twice: write what is divided by in powers, such as m s^-2')
        divided = divided or result[1] == "/"
        power = int(result[3] or 1) * (-1 if divided else 1)
        glued = _GLUED.fullmatch(result[2]) if abs(power) == 2 else None
        for word, times in ((glued[1], power // 2), (glued[2], power)) if glued else ((result[2], power),):
            item = _single(word, text)
            size *= item.size ** times
            dimension = tuple(d + times * e for d, e in zip(dimension, item.dimension))
            is_exact = is_exact and item.exact
        at = result.end()
    return Unit(size, dimension, is_exact)


def dimension_of(path: tuple[Any, ...]) -> Dimension:
    """The dimension of the number at this path (list indices count in `MIXED` alone)."""
    name = ".".join(key for key in path if isinstance(key, str))
    if name in MIXED:
        return MIXED[name][path[-1]] if isinstance(path[-1], int) else NONE
    return DIMENSIONS.get(name, NONE)


def unit_of_key(path: tuple[Any, ...]) -> str:
    """The SI unit of the number at this path; nothing where it has none."""
    return NAMES.get(dimension_of(path), "").partition("(")[2].rstrip(")")


def named(dimension: Dimension) -> str:
    """The name of a dimension, with its SI unit."""
    result = NAMES.get(dimension)
    powers = zip(("m", "kg", "s", "A", "rad"), dimension)
    return result or " ".join(f"{name}^{power}" if power != 1 else name for name, power in powers if power)


def _single(word: str, text: str) -> Unit:
    if word == "1":
        return Unit(Fraction(1), NONE)
    if word == "dps":
        return Unit(2 * pi() / 360, RATE, False)
    if word == "rpm":
        return Unit(2 * pi() / 60, RATE, False)
    if word in TURNS:
        return Unit(2 * pi() / TURNS[word], BASE["rad"], False)
    if word in OTHERS:
        size, of = OTHERS[word]
        base = _single(of, text)
        return Unit(Fraction(size) * base.size, base.dimension)
    if word in BASE:
        return Unit(Fraction(1, 1000) if word == "g" else Fraction(1), BASE[word])
    if word[:1] in PREFIXES and word[1:] in BASE:
        base = _single(word[1:], text)
        return Unit(Fraction(10) ** PREFIXES[word[0]] * base.size, base.dimension)
    lower = word.lower()
    settled = SYMBOLS_BY_NAME.get(lower) or SYMBOLS_BY_NAME.get(lower.removesuffix("s")) or CAPITALS.get(word)
    if settled:
        return _single(settled, text)
    if lower == "hz":
        raise InputError(f'"{word}" may mean rad/s or turns a second: write rad/s, rev/s or 1/s')
    cure = f"; write {INSTEAD[word]}" if word in INSTEAD else _near(word)
    raise UnknownUnit(f'unknown unit "{word[:60]}"{cure}; accepted are {ACCEPTED}')


def _near(word: str) -> str:
    from difflib import get_close_matches
    resolved = [*BASE, *TURNS, *OTHERS, *SYMBOLS_BY_NAME, "mN", "cm", "mm", "km", "kN"]
    nearby = (get_close_matches(word, resolved, n=1, cutoff=0.6)
            or get_close_matches(word.lower(), resolved, n=1, cutoff=0.6))
    return f", did you mean {nearby[0]}?" if nearby else ""


@lru_cache(maxsize=1)
def pi() -> Fraction:
    """Pi within 2**-300."""
    return Fraction(math.floor(precise("pi", bits=400) * 2**304), 2**304)
