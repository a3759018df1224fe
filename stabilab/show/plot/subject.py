"""What a picture is of: case or scene and state, which kinds of picture it has, and their units."""
from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from importlib import import_module
from typing import Any

import numpy as np

from ...answers.caveats import of_case
from ...answers.circular_orbit import CircularOrbit, circular_orbit
from ...answers.equilibria import equilibria
from ...answers.limit import Momentum
from ...answers.motion import motion
from ...answers.stuck.ask import stuck
from ...answers.stuck.burn import Burned, burn
from ...answers.stuck.margins import Row
from ...answers.time_to import time_to
from ...case.read import Burning, Case, Orbiting, load_any
from ...errors import Caveat, InputError, Kind, printable, without
from ...maps.percentiles import Percentiles
from ...orbit.reduction import reduce
from ...orbit.result import Fate, Motion
from ...physics.coefficients import content, effective
from ...physics.own_unit import far_exponent
from ...physics.scene import AnyScene, Scene, torque_axis
from ...physics.states import body_momentum, checked_states, start_of
from ...physics.symmetric_top import SymmetricTop
from ...theories.follow import models_of
from ...unreduced.periodic import LEAST, crossed
from ...validation import checked_scene, checked_span
from ..assumed import Assumed, assumed
from ..axes import PLAIN, Axes, axes_of
from ..picture_kinds import KINDS
from ..space.span import limit_time, natural, seen
from ..text import headline
from ..units import SYSTEMS, Units, suited

# --- What a plot is of: a scene, one motion of it where there is one, and what a case says besides


@dataclass(frozen=True)
class Subject:
    """scene: as it was given; state: the three rates at t = 0 in the scene's variables (rad/s, or x), None
    without a motion; blocks: the rest of the state by name; span: (from, to) or None; heading: for titles,
    may be empty; case: where all this stands, or None; neighbours: how many motions a section shows beside
    it, None for the usual number; axis: of the body, whose nutation is shown, by name; known: its motion,
    where that is worked out already; asked: the span that its pictures show, None for what is worth seeing;
    draws: percentiles over its uncertain numbers, where they are found already. burning: a burn, after whose
    last closing scene and state are, in a time that counts from there; burned: what it leaves; orbiting: a
    satellite on a circular orbit, whose scene is its body with its wheels."""

    scene: AnyScene
    state: tuple[float, ...] | None
    blocks: Mapping[str, Any]
    span: tuple[float, ...] | None
    heading: str = ""
    case: Case | None = field(default=None, repr=False)
    neighbours: int | None = None
    axis: str | None = None
    known: Motion | None = field(default=None, repr=False)
    asked: tuple[float, ...] | None = None
    draws: Percentiles | None = field(default=None, repr=False)
    burning: Burning | None = field(default=None, repr=False)
    burned: Burned | None = field(default=None, repr=False)
    orbiting: Orbiting | None = field(default=None, repr=False)

    @cached_property
    def caveats(self) -> tuple[Caveat, ...]:
        """What limits every answer about it; of a burn all but when it reaches the limit of its case, as its
        pictures count time from the last closing."""
        if self.burned is not None:
            return without(self.burned.caveats, Kind.LIMIT)
        if self.orbiting is not None:
            return self.orbit.caveats
        return () if self.case is None else of_case(self.case)

    @property
    def physical(self) -> bool:
        """Whether there is a body with rates in rad/s; scaled scenes have x and tau."""
        return self.scene.variables == "physical"

    @property
    def variables(self) -> str:
        """"physical" or "scaled"."""
        return self.scene.variables

    @property
    def name(self) -> str:
        """The case's name, or a word where there is none."""
        return "motion" if self.case is None else self.case.name

    @property
    def path(self) -> str:
        """How messages name it."""
        return "plot" if self.case is None else self.case.path

    @property
    def axes(self) -> Axes:
        """The names of its axes."""
        return PLAIN if self.case is None else axes_of(self.case)

    @cached_property
    def twin(self) -> AnyScene:
        """The scene of a wheel and a torque with the same rates, where there is one; else the scene itself.
        """
        return effective(self.scene)

    @cached_property
    def start(self) -> Any:
        """The state as `trajectory` takes it: three numbers, or all blocks by name."""
        if self.scene.variables == "scaled" or self.scene.blocks == ("omega",):
            return self.state
        return start_of(self.scene, self.state, self.blocks)

    @property
    def exact_state(self) -> tuple[Any, ...] | None:
        """The rates at t = 0 as their decimals were written in a case."""
        return None if self.case is None else self.case.exact_state

    @cached_property
    def motion(self) -> Motion:
        """What is known of the motion: its fate, period and extremes."""
        if self.known is not None:
            return self.known
        own = {name: row for name, row in self.blocks.items() if name in self.scene.blocks}
        start = {"omega": self.state, **own} if own else self.state
        result = motion(self.scene, start, self.span, exact=self.exact_state)
        return result if self.case is None else headline.judged(self.case, result)

    @cached_property
    def paths(self) -> dict[tuple[float, float], tuple[np.ndarray, np.ndarray]]:
        """(times, rates) of what its pictures have followed, by (from, to): `path.path` fills it."""
        return {}

    @cached_property
    def orbit(self) -> CircularOrbit:
        """The attitudes at rest of a satellite on a circular orbit."""
        return circular_orbit(self.orbiting)

    @cached_property
    def stuck(self) -> Row:
        """What the stuck thrusters of the case do together. Raises InputError as `answers.stuck` does."""
        return stuck(self.case).rows[0]

    @cached_property
    def seen(self) -> tuple[float, ...]:
        """(from, to): the span that its pictures show, in the scene's time."""
        return self.asked or seen(self.span, self.motion, natural(self.scene, self.state),
                                        self.assumed_time)

    @cached_property
    def assumed(self) -> Assumed | None:
        """The limit to which pictures are drawn where the case states none."""
        if self.state is None:
            return None
        until = max(self.span or (0.0, natural(self.scene, self.state)))
        return assumed(self.case, self.scene, self.state, self.motion, lambda rate, end: time_to(
            self.scene, self.start, rate=rate, t_max=end, work=0), until)

    @property
    def assumed_time(self) -> float | None:
        """When the assumed limit is reached."""
        return None if self.assumed is None else self.assumed.time


def subject(source: Any, state: Any = None, span: Any = None) -> Subject:
    """The subject of a Case, of what `load` makes one of, or of a scene with a state: three rates, or a dict
    of blocks {"omega": ..., "gamma": ...}. A state or span given beside a case takes the place of the case's
    own. span: (from, to), or the end alone. Raises InputError for anything else."""
    ends = checked_span(span)
    if isinstance(source, Subject):
        return source
    if isinstance(source, Case):
        own = Subject(source.scene, source.state, source.blocks, ends or source.span, source.heading, source,
                      asked=ends)
        return own if state is None else replace(own, case=None, **_blocks_of(source.scene, state))
    if isinstance(source, Burning):
        return _burned(source, ends)
    if isinstance(source, Orbiting):
        craft = source.craft
        return Subject(craft.physical, None, {}, None, craft.heading, craft, orbiting=source)
    if not hasattr(source, "quadratic"):
        return subject(load_any(source), state, span)
    start = {"state": None, "blocks": {}} if state is None else _blocks_of(source, state)
    return Subject(checked_scene(source), span=ends, asked=ends, **start)


def _burned(burning: Burning, ends: tuple[float, ...] | None) -> Subject:
    """What follows a burn."""
    result, craft = burn(burning), burning.craft
    after = replace(craft, state=result.closed.rates, decimals=None, span=None)
    return Subject(craft.physical, result.closed.rates, {}, None, craft.heading, after, asked=ends,
                   burning=burning, burned=result)


def _blocks_of(scene: AnyScene, state: Any) -> dict[str, Any]:
    blocks = dict(state) if isinstance(state, Mapping) else {"omega": state}
    omega = blocks.pop("omega", blocks.pop("x", None))
    if omega is None:
        raise InputError(f"state: expected three rates, or a dict with the block omega, got {state!r:.80}")
    row = checked_states(omega)
    if row.shape != (3,):
        raise InputError(
            f"state: a plot is of one motion: expected three rates, got an array of shape {row.shape}")
    if isinstance(scene, Scene):
        start_of(scene, row.tolist(), blocks)  # says what is wrong with the rest
    return {"state": tuple(row.tolist()), "blocks": blocks}


# --- Which kinds of plot a scene has, and why it has not the others
FAR = (
    "rates, torque or wheel are so large or so small that their squares leave the range of doubles: choose "
    "other units")


ALIKE = "no approximate theory comes with {}: the rates over time are the exact motion"
ON_ORBIT = ("equilibria", "body")
NO_MOTION_ON_ORBIT = ("a motion on a circular orbit is not followed; its attitudes at rest are drawn: "
                      "--kind equilibria")
NOT_OF_BURNS = {
    "tilt": "the torque of a burn ends, and after it nothing has a tilt",
    "wheel": "the torque of a burn ends; by when thrusters must close: stabilab burn --below",
    "budget": "what accuracy costs is measured of a torque that never changes"}
NO_BODY = "scaled variables have no body: give the case in physical units"


def why_not(kind: str, item: Subject) -> str:
    """Why a subject has no plot of a kind; empty where it has one."""
    if kind not in KINDS:
        return f"there is no such kind; expected one of {', '.join(KINDS)}"
    if item.orbiting is not None and kind not in ON_ORBIT:
        return NO_MOTION_ON_ORBIT
    if item.burning is not None and kind in NOT_OF_BURNS:
        return NOT_OF_BURNS[kind]
    needed, why = NEEDS[KINDS[kind].needs]
    if needed and item.state is None:
        return ("it needs a motion: add [motion] with angular_velocity or x" if item.case is not None
                else "it needs a state: three rates at t = 0")
    return why(item)


def check(kind: str, item: Subject) -> None:
    """Raise InputError where a subject has no plot of a kind; it names those that there are."""
    why = why_not(kind, item)
    if not why:
        return
    if kind not in KINDS:
        raise InputError(f"kind {printable(kind)!r:.60}: {why}")
    raise InputError(f"plot {kind}: {why}; this one has {', '.join(offered(item))}")


def elsewhere(kind: str, item: Subject) -> Callable[..., Any] | None:
    """What draws a kind of picture of a burn or of a satellite on an orbit, where that has one of its own."""
    drawn = {"time": "switches.rates"} if item.burning is not None else (
        {"equilibria": "orbital.attitudes"} if item.orbiting is not None else {})
    if kind not in drawn:
        return None
    module, _, name = drawn[kind].partition(".")
    function: Callable[..., Any] = getattr(import_module(f".{module}", __package__), name)
    return function


def offered(item: Subject) -> tuple[str, ...]:
    """The kinds of plot that a subject has."""
    return tuple(kind for kind in KINDS if not why_not(kind, item))


def default(item: Subject) -> str:
    """The kind that says most of a subject: its plane where it reduces, all parts of a longer state, else the
    rates over time."""
    usual = ("phase", "time" if rates_alone(item) else "state", "time", "equilibria")
    kinds = ("time",) if item.burning is not None else usual
    return next(kind for kind in kinds if not why_not(kind, item))


def rates_alone(item: Subject) -> bool:
    """Whether the picture of the state has no more than that of the rates: no theory comes with the effects,
    and of a damper or a wheel's motor it draws nothing."""
    return models_of(item.scene) == ("exact",) and {"omega", "damper", "wheel"}.issuperset(item.scene.blocks)


def _tilt(item: Subject) -> str:
    if not isinstance(item.scene, Scene) or not item.scene.plain:
        return "it is drawn of a body with wheels and a torque alone"
    if not any(item.scene.vector("constant_torque")):
        return "no constant torque acts"
    limited = item.case is not None and item.case.limits is not None
    if not limited and not (item.motion.fate == Fate.BOUNDED and torque_axis(item.scene)):
        return "the case states no limit to be reached: add [limits]"
    return _far(item)


def _wheel(item: Subject) -> str:
    if not item.physical or not item.scene.plain:
        return "it is drawn of a body with wheels and a torque alone"
    if item.case is None or not item.case.wheels:
        return "the case has no wheel of its own: describe it in a table [[wheels]]"
    return "the motion is not known to reach a limit" if limit_time(item.motion) is None else _far(item)


def bodily(item: Subject) -> Any:
    """The scene with the body of a subject; None where there are scaled variables alone."""
    return item.case.physical if item.case is not None else item.scene if item.physical else None


def _equilibria(item: Subject) -> str:
    # there always are some with other effects, and they take longer
    out = equilibria(item.scene) if item.twin.plain else None
    return (f"there is none: {out.because}" if out is not None and not out.points and not out.curves
            else "")


def _far(item: Subject) -> str:
    return FAR if item.twin.plain and far_exponent(item.twin, item.state) is not None else ""


def _phase(item: Subject) -> str:
    if not item.twin.plain:
        return f"with {_beyond(item)} the motion does not reduce to one degree of freedom"
    if reduce(item.twin) is None:
        return f"the motion does not reduce to one degree of freedom: {_unreduced(item)}"
    return _far(item)


def _unreduced(item: Subject) -> str:
    """What of a scene with the rates of a gyrostat leaves no reduction."""
    acting = sum(m != 0 for m in item.twin.quadratic().m)
    if acting > 1:
        return "the torque is off the principal axes"
    return ("the gyrostatic moment has a component along the torque" if acting
            else "the gyrostatic moment has components along all three axes")


def _theory(item: Subject) -> str:
    if not item.scene.plain:
        return ""
    body = bodily(item)
    wheel = body is None or any(body.vector("gyrostat"))
    torque = any(item.scene.quadratic().m)
    return ALIKE.format(" and ".join(filter(None, ("a wheel" * wheel, "a constant torque" * torque)))
                        or "a body on which nothing acts")


def losing(item: Subject) -> bool:
    """Whether a damper inside a free body, with wheels or without, takes energy, and nothing else acts."""
    names = {effect.name for effect in item.scene.effects}
    return item.physical and "viscous_damper" in names and names <= {"viscous_damper", "gyrostat"}


def _sphere(item: Subject) -> str:
    if losing(item):
        return "" if _turns(item) else "the angular momentum is zero: its sphere is a point"
    if not item.twin.plain:
        return f"with {_beyond(item)} no surface is known on which the motion stays"
    if free(item) and item.physical:
        return _far(item)
    if reduce(item.twin) is None:
        return f"no surface is known on which the motion stays: {_unreduced(item)}"
    return _far(item)


def certain_from(item: Subject) -> float:
    """The time (scene's time) from which on spin-up is certain; inf of a motion that is not known to spin up.
    """
    result = item.motion
    return float(result.evidence.get("t_certificate") or 0.0) if result.fate == Fate.SPIN_UP else math.inf


def _section(item: Subject) -> str:
    if not item.twin.plain:
        return f"it is drawn of a body with a wheel and a torque alone, not with {_beyond(item)}"
    if why := _far(item):
        return why
    if item.motion.fate == Fate.EQUILIBRIUM:
        return "the motion is an equilibrium: it passes no plane"
    until = certain_from(item)
    if crossed(item.twin, item.state, until) is not None:
        return ""
    if math.isinf(until):
        return f"the motion does not come back: it passes no plane {LEAST} times"
    when = "from its start on" if not until else f"from {until:.4g} {item.scene.time_unit} on"
    return (
        f"spin-up about {item.axes.short(item.motion.axis)} is certain {when}, before the motion has passed "
        f"any plane {LEAST} times")


def momentum_at_start(item: Subject) -> np.ndarray:
    """(3,) N m s, the angular momentum at the start, along the principal axes."""
    scene: Any = item.scene
    start = item.start if isinstance(item.start, Mapping) else {"omega": item.start}
    return body_momentum(scene, {name: np.asarray(values, float) for name, values in start.items()})


def _turns(item: Subject) -> bool:
    """Whether a body with a damper inside has an angular momentum."""
    return any(momentum_at_start(item))


def nutates(item: Subject) -> bool:
    """Whether a damper inside a body lets its nutation grow or die out: a page shows it."""
    parts = content(item.scene) if item.physical and item.state is not None else None
    return (parts is not None and (parts.damper_inside or bool(parts.movers)) and not parts.kappa
            and Momentum.made(item.scene).stays and item.motion.ending is not None)


def _nutation(item: Subject) -> str:
    if not item.physical:
        return "scaled variables have no body: give the case in physical units"
    if item.motion.fate == Fate.EQUILIBRIUM:
        return "the motion is an equilibrium: each axis keeps its angle to the angular momentum"
    if SymmetricTop.of(item.scene) is None and not _turns(item):
        return "the angular momentum is zero, so that no axis has an angle to it"
    return ""


def free(item: Subject) -> bool:
    """Whether no torque acts on the body of a scene of wheel and torque."""
    return not any(item.twin.quadratic().m)


def _beyond(item: Subject) -> str:
    *others, last = (effect.with_article for effect in item.scene.beyond)
    return f"{', '.join(others)} and {last}" if others else last


# what a kind of picture needs -> (whether a motion, why a subject has none)
NEEDS: dict[str, tuple[bool, Callable[[Subject], str]]] = {
    "motion": (True, lambda item: ""), "range": (True, _far), "plane": (True, _phase),
    "surface": (True, _sphere), "section": (True, _section), "tilt": (True, _tilt), "wheel": (True, _wheel),
    "equilibria": (False, _equilibria), "nutation": (True, _nutation),
    "body": (False, lambda item: NO_BODY * (bodily(item) is None)),
    "draws": (True, lambda item: "no number of the case has an uncertainty, from which draws could be made"
              * (item.case is None or not item.case.uncertain)),
    "body that turns": (True, lambda item: "scaled variables have no body to turn: give the case in physical "
                                          "units" * (not item.physical)),
    "theory": (True, _theory),
    "span": (True, lambda item: "it needs a span: the time up to which the motion is followed"
             * (item.span is None))}


# --- The units of the axes of a plot: name and factor of rates, times and angles, and the names of
# components
@dataclass(frozen=True)
class Measures:
    """rate, angle: (name, how many make one of the scene's); names: of the three components, in TeX; size: of
    |omega|, empty when scaled."""

    rate: tuple[str, float]
    angle: tuple[str, float]
    names: tuple[str, ...]
    size: str
    system: Units | None

    def time(self, longest: float) -> tuple[str, float]:
        """(name, factor) of the times of a plot that goes so far."""
        return (r"$\tau$", 1.0) if self.system is None else self.system.times(longest)

    def plain(self, axis: int) -> str:
        """The name of a component for text that is not typeset."""
        return ("ω" if self.size else "x") + "₁₂₃"[axis]


def measures(item: Subject, units: str | None = None) -> Measures:
    """Those of a subject: units "deg" (deg/s, deg; seconds, minutes or hours), "deg/day", "rpm", "rev/s" or
    "si" (rad/s, rad, s), None for those of the case, else those that suit; scaled scenes have none."""
    if units is not None and units not in SYSTEMS:
        raise InputError(f"units: expected one of {', '.join(SYSTEMS)}, got {units!r:.40}")
    if not item.physical:
        return Measures(("", 1.0), ("", 1.0), ("$x_1$", "$x_2$", "$x_3$"), "", None)
    result = SYSTEMS[units or ("deg" if item.case is None else item.case.units or suited(item.case))]
    return Measures(result.rates, result.angles, (r"$\omega_1$", r"$\omega_2$", r"$\omega_3$"), r"$|\omega|$",
                    result)
