"""[motion] as it is observed: the periods of a tumbling body, spin and nutation, or spin and lean of a top
that precesses steadily, in place of rates."""
from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

from ..errors import InputError
from ..numbers.exact import floats, precise, unit_vector
from ..numbers.principal import PrincipalAxes
from ..numbers.units import pi
from ..numbers.vectors import Exact3
from ..physics.observed_start import MODES, spinning, tumbling
from ..physics.scene import Scene
from ..physics.symmetric_top import FAST, SLOW, SymmetricTop
from ..reasons import Reason, Sentence
from .table import LEANING, OBSERVED, SPINNING, TUMBLING, Table, described

PERIODS = TUMBLING[:3]
AXES = tuple(tuple(Fraction(int(i == j)) for j in range(3)) for i in range(3))
PHASE = Sentence("observed-phase", "of all starts with these periods the one at which the {axis} axis is "
                 "nearest to the angular momentum")
LEANS = Sentence("observed-lean", "the angular momentum leans from the axis of the spin towards {axis} of "
                 "the file at the start: [motion] towards says otherwise")


def observed_key(table: Table, state_key: str | None) -> str | None:
    """The first key of [motion] by which the start is stated as observed, None where it is not; a fault where
    it is stated in two ways, or by half."""
    tumbles = [key for key in TUMBLING if key in table]
    if any(key in table for key in LEANING):
        return _leaning_key(table, state_key, tumbles)
    spins = [key for key in SPINNING if key in table]
    starts = [keys[0] for keys in ([state_key] if state_key else [], tumbles, spins) if keys]
    if len(starts) > 1:
        table.fault(f"{' and '.join(starts)} say the same thing in two ways: keep one of them", starts[1])
        return None
    if tumbles:
        supplied = [key for key in PERIODS if key in table]
        if len(supplied) != 2:
            table.fault(f"expected two of {', '.join(PERIODS)}, which say how a body tumbles, got "
                        f"{' and '.join(supplied) or 'none'}", (supplied or tumbles)[-1])
            return None
        return supplied[0]
    if spins and not ("spin" in table and "axis" in table):
        missing = "axis, a vector of any length" if "spin" in table else 'spin, such as spin = "60 rpm"'
        table.fault(f"expected {missing}, beside {' and '.join(spins)}", spins[0])
        return None
    if spins and "towards" in table and "nutation" not in table:
        table.fault("towards is the direction to which the angular momentum leans: give nutation as well",
                    "towards")
    return "spin" if spins else None


def _leaning_key(table: Table, state_key: str | None, tumbles: list[str]) -> str | None:
    """The same of a top that precesses steadily."""
    others = [key for key in (state_key, *tumbles, "nutation", "vertical", "attitude")
              if key and key in table]
    if others:
        table.fault(f"lean and {others[0]} say the start in two ways: keep one of them", others[0])
        return None
    if "axis" in table:
        table.fault("the spin of a top is about its axis of symmetry, from its fixed point to its centre of "
                    "mass: take axis away", "axis")
        return None
    missing = [f"{key} = {example}" for key, example in (
        ("lean", '"20 deg"'), ("spin", '"25 rev/s"'), ("precession", '"slow" or "fast"')) if key not in table]
    if missing:
        table.fault(f"a top precesses steadily with a spin, at a lean: give {' and '.join(missing)} as well",
                    next(key for key in LEANING if key in table))
        return None
    return "lean"


def with_observed(motion: Any, scene: Scene | None, frame: PrincipalAxes | None
                  ) -> tuple[Any, tuple[Reason, ...]]:
    """([motion] with the rates of an observed start, in the frame of the file; what was taken for granted).
    scene: along principal axes."""
    table, key = motion.table, motion.state_key
    if key not in OBSERVED:
        return motion, ()
    query = _tumbling(table) if key in TUMBLING else _leaning(table) if key in LEANING else _spinning(table)
    if query is None or scene is None:
        return motion, ()
    oblique = None if frame is None or frame.as_given else frame
    back = oblique.back if oblique else lambda vector: vector
    try:
        if key in LEANING:
            rates, vertical = map(back, _leans(scene, oblique, *query))
            return replace(motion, exact=rates, state=floats(rates), exact_vertical=vertical,
                           blocks=motion.blocks | {"gamma": floats(vertical)}), ()
        rates, taken = (_tumbles if key in TUMBLING else _spins)(scene, oblique, *query)
        exact = back(rates)
        return replace(motion, exact=exact, state=floats(exact)), taken
    except InputError as error:
        name, colon, rest = str(error).partition(": ")
        named = bool(colon) and name in OBSERVED
        table.fault(rest if named else str(error), name if name in table else key)
    except OverflowError:
        table.fault("the rates exceed the largest double (about 1.8e308)", key)
    return motion, ()


def _tumbling(table: Table) -> tuple | None:
    """(rotation period, precession period, amplitude, mode) as `tumbling` takes them; None with a fault."""
    periods = [table.positive(key) if key in table else None for key in PERIODS]
    mode = table.text("mode") or None
    if mode is not None and mode not in MODES:
        table.fault(f"expected {' or '.join(MODES)}, the axis that the angular momentum goes round, got "
                    f"{described(table.data['mode'])}", "mode")
        return None
    amplitude = periods[2]
    if amplitude is not None and not amplitude < pi() / 2:
        table.fault("expected an angle below 90 deg, the greatest between the axis that the angular momentum "
                    f"goes round and the angular momentum, got {_degrees(amplitude)}", "amplitude")
        return None
    complete = all(value is not None for key, value in zip(PERIODS, periods) if key in table)
    return (*periods, mode) if complete else None


def _spinning(table: Table) -> tuple | None:
    """(axis, spin, nutation or None, towards or None); None with a fault."""
    spin, axis = table.number("spin"), _direction(table, "axis")
    nutation, towards = table.number("nutation"), _direction(table, "towards")
    if nutation is not None and not 0 <= nutation <= pi():
        table.fault("expected an angle from 0 to 180 deg, between the axis and the angular momentum, got "
                    f"{_degrees(nutation)}", "nutation")
        return None
    if any(value is None for key, value in zip(SPINNING, (spin, axis, nutation, towards)) if key in table):
        return None
    return axis, spin, nutation, towards


def _leaning(table: Table) -> tuple | None:
    """(spin, lean, precession, towards or None); None with a fault."""
    spin, lean, which = table.number("spin"), table.number("lean"), table.text("precession")
    towards = _direction(table, "towards")
    if lean is not None and not 0 < lean < pi():
        table.fault("expected an angle between 0 and 180 deg, both left out, from the upward vertical to the "
                    f"axis, got {_degrees(lean)}; on the vertical a top has no precession: give "
                    "angular_velocity and vertical there", "lean")
        return None
    if which not in (SLOW, FAST):
        table.fault(f'expected "slow" or "fast", got {described(table.data["precession"])}', "precession")
        return None
    return None if spin is None or lean is None or ("towards" in table and towards is None) else (
        spin, lean, which, towards)


def _degrees(angle: Fraction) -> str:
    return f"{float(angle * 180 / pi()):.10g} deg"


def _direction(table: Table, key: str) -> Exact3 | None:
    vector = table.vector(key)
    if vector is not None and not any(vector):
        table.fault("expected a direction, got zero: give a vector of any length but that", key)
        return None
    return None if vector is None else unit_vector(vector)


def _tumbles(scene: Scene, frame: PrincipalAxes | None, rotation: Any, precession: Any, amplitude: Any,
             mode: str | None) -> tuple[Exact3, tuple[Reason, ...]]:
    if any(scene.vector("gyrostat")):
        raise InputError("rotation and precession periods say the motion of a body without wheels; this one "
                         "has a gyrostatic moment: give angular_velocity")
    result = tumbling(scene.body.exact, rotation, precession, amplitude, mode)
    return result.rates, (PHASE(axis=result.mode.removesuffix("-axis")),)


def _spins(scene: Scene, frame: PrincipalAxes | None, axis: Exact3, spin: Fraction, nutation: Fraction | None,
           towards: Exact3 | None) -> tuple[Exact3, tuple[Reason, ...]]:
    turn = frame.turned if frame else lambda vector: vector
    if nutation is None:
        return tuple(spin * v for v in turn(axis)), ()  # type: ignore[return-value]
    nearest = max(range(3), key=lambda i: abs(axis[i]))
    default = (nearest + 1) % 3
    rates = spinning(scene.body.exact, scene.vector("gyrostat"), turn(axis), spin, nutation,
                     turn(towards or AXES[default]))
    return rates, () if towards or not nutation else (LEANS(axis="xyz"[default]),)


def _leans(scene: Scene, frame: PrincipalAxes | None, spin: Fraction, lean: Fraction, which: str,
           towards: Exact3 | None) -> tuple[Exact3, Exact3]:
    top = SymmetricTop.of(scene)
    if top is None:
        raise InputError("lean: a start by lean, spin and precession is that of a symmetric top, which its "
                         "weight, a Newtonian centre or a charge that follows the attitude act on along its "
                         "axis of symmetry alone; this is none: give angular_velocity and vertical")
    turn = frame.turned if frame else lambda vector: vector
    default = AXES[(top.axis + 1) % 3]
    return top.start(spin, precise("cos", lean), which, turn(towards) if towards else default)


def plainly(case: Any, motion: dict[str, Any], text: Any) -> dict[str, Any]:
    """The table [motion] of a case, with the rates of an observed start as numbers; text: writes one."""
    if not case.observed:
        return motion
    rates = [text(v) for v in case.exact_state]
    vertical = {"vertical": [text(Fraction(v)) for v in case.blocks["gamma"]]} if "lean" in motion else {}
    return {key: value for key, value in motion.items()
            if key not in OBSERVED} | {"angular_velocity": rates} | vertical

