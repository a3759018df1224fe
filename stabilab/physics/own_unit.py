"""The own units of a motion: by which powers of two its rates, its time and its mass are scaled.

Euler's equations with a gyrostatic moment, a constant torque and a resisting medium are homogeneous: with
omega = u y and t = s/u, y obeys them with moment/u, torque/u^2 and resistance/u. For u a power of two the
change is exact. So is a unit of mass, which leaves the motion as it is, but not the squares in its laws.

The unit is taken from the rates and from the root of what changes them, whichever is larger. What changes
them is their rate of change now where steps are to fit the motion (the control of Taylor series is relative
to the state above size 1 but absolute below: rates of 1e-5 rad/s would lose five digits, and coefficients of
a series in t underflow for slower ones still), and the torque where all coefficients are to stay doubles.
"""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import lru_cache
from typing import Any

from ..errors import InputError
from ..numbers.vectors import Number
from .body import Body
from .effects.base import Effect
from .scene import AnyScene, Rows, ScaledGyrostat, Scene

# exponents between which the unit stays: the control is at most 16 times coarser than asked
SLOW, FAST = -4, 20
LIGHT, HEAVY = 2.0**-200, 2.0**200  # moments whose squares underflow beside `compiled.FEATHER`, or overflow
TINY, HUGE = 2.0**-900, 2.0**900  # between these a power of two changes no digit of a double
ORDINARY = 100  # rates of 2^-100 to 2^100: fourth powers of them, beside ratios of moments, are doubles

# of the units of rate and of mass in an effect's strength
POWERS = {"gyrostat": (1, 1), "constant_torque": (2, 1), "resistance": (1, 0)}


def exponent(value: Number) -> int:
    """The least k with |value| < 2^k, of a float, a whole number or a Fraction that is not 0."""
    if isinstance(value, float):
        return math.frexp(value)[1]
    size = abs(Fraction(value))
    k = size.numerator.bit_length() - size.denominator.bit_length()
    return k + (size >= Fraction(2)**k)


def own_exponent(rates: Iterable[Number], changes: Iterable[Number] = ()) -> int | None:
    """The least k with |rates| < 2^k and |changes| < 4^k, of those that are not 0; None where all are, or one
    is not finite."""
    rates, changes = [v for v in rates if v], [v for v in changes if v]
    if not all(math.isfinite(v) for v in (*rates, *changes) if isinstance(v, float)):
        return None
    return max([*map(exponent, rates), *(-(-exponent(v) // 2) for v in changes)], default=None)


def exact_unit(scene: AnyScene, start: Sequence[Number]) -> Fraction:
    """2^k, above the rates of a plain scene at the start and the root of their change; 1 at rest."""
    exact = [Fraction(v) for v in start]
    return Fraction(2) ** (own_exponent(exact, scene.quadratic().rate(exact)) or 0)


def own_unit(scene: AnyScene, state: Sequence[float], changes: Sequence[float]) -> float:
    """The unit 2^k of a motion that is followed in steps, 1 where its rates are ordinary or the scene has
    other effects. changes: of the rates (three numbers), now."""
    k = own_exponent(state, changes) if _homogeneous(scene) else None
    return 1.0 if k is None or SLOW < k <= FAST else 2.0**k


@lru_cache(maxsize=64)
def scene_exponent(scene: AnyScene) -> int | None:
    """k of the size 2^k of the rates that wheel and torque bring about; None without either."""
    form = scene.quadratic()
    return own_exponent((*form.rho, *form.sigma), form.m)


def far_exponent(scene: AnyScene, state: Sequence[Number]) -> int | None:
    """k of the own unit 2^k in which the state (floats or Fractions) and all that acts are doubles; None
    where they are of ordinary size."""
    resolved = [k for k in (own_exponent(state), scene_exponent(scene)) if k is not None]
    return far(max(resolved, default=None))


def far(k: int | None) -> int | None:
    """k, None where rates of that size are ordinary."""
    return None if k is None or -ORDINARY <= k <= ORDINARY else k


@lru_cache(maxsize=32)
def natural(scene: AnyScene) -> tuple[AnyScene, float]:
    """(scene in natural units, unit of rates): the powers of two nearest to the mean moment and to the root
    of torque over moment. Kept, for a certificate and its proof ask for it in turn."""
    if scene.variables == "scaled":
        torque, mass = max(map(abs, scene.exact_mu)), Fraction(1)
    else:
        torque, mass = max(map(abs, scene.vector("constant_torque"))), sum(scene.body.exact, Fraction(0)) / 3
    if not torque:
        return scene, 1.0
    weight, unit = 2.0 ** (exponent(mass * mass) // 2), 2.0 ** (exponent(torque / mass) // 2)
    return scene if unit == weight == 1 else in_unit(scene, unit, weight), unit


def mass_unit(scene: AnyScene) -> float:
    """The power of two near the largest moment of a body, 1 where it is ordinary or the scene has other
    effects or no body."""
    if scene.variables == "scaled" or not _homogeneous(scene):
        return 1.0
    size = max(scene.body.inertia)
    return 1.0 if LIGHT <= size <= HEAVY else 2.0 ** math.frexp(size)[1]


def _homogeneous(scene: AnyScene) -> bool:
    """Whether a change of units is known here; not for equations without their scene, either."""
    if getattr(scene, "plain", False):
        return True
    return hasattr(scene, "effects") and all(e.name in POWERS for e in scene.effects)


def in_unit(scene: AnyScene, unit: float | Fraction, mass: float | Fraction = 1.0) -> AnyScene:
    """The scene whose rates are those of `scene` over `unit`, in a time that runs `unit` times as fast; its
    moments over `mass`.

    Raises InputError where torque or wheel are no doubles beside rates of this size.
    """
    try:
        return _changed(scene, unit, mass)
    except InputError as error:
        raise InputError(f"state: in the unit of rates of this size, {unit:.1e}, a number of the scene "
                         "leaves the range of doubles, and a run in doubles does not follow the motion "
                         f"({error})") from None


def rows_in_unit(rows: Rows, unit: float) -> Rows | None:
    """The coefficients (kappa, rho, sigma, m), doubles, of `in_unit`; None where one may leave their range:
    within it a power of two is exact. The unit of mass changes none."""
    kappa, *others = rows
    if not TINY < unit * unit < HUGE:
        return None
    out = tuple(tuple(v / scale for v in row) for row, scale in zip(others, (unit, unit, unit * unit)))
    usual = all(TINY < abs(v) < HUGE for row in (*others, *out) for v in row if v)
    return (kappa, *out) if usual else None


def _changed(scene: AnyScene, unit: float | Fraction, mass: float | Fraction) -> AnyScene:
    u, m = Fraction(unit), Fraction(mass)
    if scene.variables == "scaled":
        a, b = scene.exact_ab
        return ScaledGyrostat(a / u, b / u, tuple(v / (u * u) for v in scene.exact_mu))
    return Scene(Body(tuple(d / m for d in scene.body.exact)),
                 *(_divided(effect, u, m) for effect in scene.effects))


def _divided(effect: Any, u: Fraction, m: Fraction) -> Effect:
    """The effect with its strength in the units."""
    rate, mass = POWERS[effect.name]
    unit = u**rate * m**mass
    return type(effect)(tuple(v / unit for v in effect.exact) if isinstance(effect.exact, tuple)
                        else effect.exact / unit)
