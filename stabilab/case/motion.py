"""[motion] of a case file: the start, the other blocks of the state, the span."""
from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from types import ModuleType

from ..numbers.exact import floats, sqrt_fraction
from ..numbers.vectors import Exact3, dot
from ..physics.coefficients import Scaling
from ..physics.effects.base import effect_words
from ..physics.scene import INSIDE, NO_MOTION
from .sections import judge_attitude, vertical_of
from .table import OBSERVED, Table

STATES, SPANS = ("angular_velocity", "x"), ("span", "tau")
# key: block
BLOCKS = {"attitude": "attitude", "vertical": "gamma", "velocity": "velocity", "position": "position",
          "damper": "damper", "wheel": "wheel", "damper_wheel": "damper_wheel",
          "sprung_wheel": "sprung_wheel", "damper_mass": "damper_mass"}
OBSERVED_KEYS = frozenset(OBSERVED)
UNIT_SLACK = 1e-6  # a vertical given to six decimals counts as a unit vector and stays as it is


@dataclass(frozen=True)
class StatedMotion:
    """[motion] as it is written: which keys, and their numbers."""

    table: Table
    state_key: str | None = None
    state: tuple[float, ...] | None = None
    span_key: str | None = None
    span: tuple | None = None
    blocks: dict = field(default_factory=dict)
    exact: tuple | None = None
    exact_vertical: tuple | None = None


def motion_of(top: Table) -> StatedMotion:
    table = top.table("motion")
    if table is None:
        return StatedMotion(Table(("motion",), {}, top.faults))
    table.known(STATES + SPANS + tuple(BLOCKS) + OBSERVED)
    state_key, span_key = table.one_of(*STATES), table.one_of(*SPANS)
    states, spans = {k: table.vector(k) for k in STATES}, {k: table.numbers(k, 2) for k in SPANS}
    state, span = states.get(state_key), spans.get(span_key)
    if span and not float(span[0]) < float(span[1]):
        table.fault(f"expected two increasing numbers, got {float(span[0])!r} and {float(span[1])!r}: write "
                    "the start of the motion first, such as [0, 100]",
                    span_key)
        span = None
    if not OBSERVED_KEYS.isdisjoint(table.data):
        state_key = observed_reader().observed_key(table, state_key) or state_key
    if "scaled" in top:
        for key, other in (("angular_velocity", "x"), ("span", "tau"), *((key, "x") for key in OBSERVED)):
            if key in table:
                table.fault(f"a [scaled] system has no body to convert {key} with: give {other}", key)
    vectors = {block: vector for key, block in BLOCKS.items()
               if (vector := table.numbers(key, len(NO_MOTION.get(block, (0.0,) * 3)))) is not None}
    if "gamma" in vectors:
        vectors["gamma"] = _unit(table, vectors["gamma"])
    blocks = {block: floats(vector) for block, vector in vectors.items()}
    return StatedMotion(table, state_key, floats(state) if state else None, span_key, span, blocks, state,
                   vectors.get("gamma"))


def observed_reader() -> ModuleType:
    """What reads a start that is stated as it is observed."""
    from . import observed
    return observed


def _unit(table: Table, vertical: Exact3) -> Exact3:
    """The vertical as a unit vector, whatever its length is."""
    length = sqrt_fraction(dot(vertical, vertical))
    if not length:
        table.fault("expected a direction, got zero: give a vector of any length but that", "vertical")
        return (Fraction(0), Fraction(0), Fraction(1))
    return vertical if abs(length - 1) <= UNIT_SLACK else tuple(v / length for v in vertical)


def judge_blocks(motion: StatedMotion, scene):
    """Starting values beyond the angular velocity: possible for this scene, and complete."""
    table, supplied = motion.table, motion.blocks
    for key, block in BLOCKS.items():
        if block in supplied and getattr(scene, "variables", "") == "scaled":
            table.fault("a scaled system has no attitude and no place: give a body and its effects", key)
            return
    for key in ("velocity", "position"):
        if key in supplied and scene is not None and scene.body.mass is None:
            table.fault("motion through space needs the mass of the body: give body.mass in kg", key)
    if "damper" in supplied and scene is not None and "damper" not in scene.blocks:
        table.fault("no damper turns in this body: give [effects.viscous_damper], or take the key away",
                    "damper")
    if "sprung_wheel" in supplied and scene is not None and "sprung_wheel" not in scene.blocks:
        table.fault("no damper wheel is on a spring in this body: give [effects.damper_wheel] a stiffness, "
                    "or take the key away", "sprung_wheel")
    if "damper_wheel" in supplied and scene is not None and "sprung_wheel" in scene.blocks:
        table.fault("the damper wheel is on a spring: give its angle and its rate, sprung_wheel = [0, 0.5]",
                    "damper_wheel")
        return
    for key in ("damper_wheel", "damper_mass"):
        if key in supplied and scene is not None and key not in scene.blocks:
            table.fault(f"no {effect_words(key)} is in this body: give [effects.{key}], or take the key away",
                        key)
    if "wheel" in supplied and scene is not None and "wheel" not in scene.blocks:
        table.fault("no motor turns a wheel in this body: give [effects.wheel_motor]; the momentum of a "
                    "wheel that runs by itself is that of [effects.gyrostat]", "wheel")
    if "wheel" in supplied and (text := next((said for item in getattr(scene, "effects", ())
                                            if (said := item.refuses({"wheel": supplied["wheel"]}))), "")):
        table.fault(text.removeprefix("wheel: "), "wheel")
    if (motion.state is not None and scene is not None and "gamma" in scene.blocks and "gamma" not in supplied
            and "lean" not in table):
        angles = supplied.get("attitude")
        told = (f"; the attitude given has [{', '.join(f'{v:.10g}' for v in vertical_of(*angles))}]" if angles
                else "")
        need = [effect_words(effect.name) for effect in scene.effects if set(effect.needs) - set(INSIDE)]
        table.fault(f"vertical is missing: because of {' and '.join(need)} give the direction of inertial "
                    f"axis 3 (of the weight, down; of the field; to the centre) in the body at the start, as "
                    f"[0, 0, 1]{told}")
    judge_attitude(table, supplied, scene)


def span_of(motion: StatedMotion, variables: str, scaling: Scaling | None) -> tuple[float, ...] | None:
    """The span in the case's time: s, or tau = t/scaling.time."""
    supplied, wanted = motion.span_key, "tau" if variables == "scaled" else "span"
    if motion.span is None or supplied == wanted:
        return floats(motion.span) if motion.span else None
    if scaling is None:
        return None  # the fault is noted already
    factor = scaling.time if supplied == "tau" else 1 / scaling.time
    try:
        return floats(t * factor for t in motion.span)
    except OverflowError:
        motion.table.fault("exceeds the largest double (about 1.8e308) in the other time unit", supplied)
        return None
