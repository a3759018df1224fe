"""A case file to a `Case`; every fault with its file, line and key."""
from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, replace
from fractions import Fraction
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from ..errors import CaseError, Caveat, InputError, Kind, printable
from ..numbers.exact import floats, sqrt_fraction
from ..numbers.principal import PrincipalAxes, oblique
from ..numbers.vectors import Exact3, Float3, dot
from ..physics.coefficients import Scaling, to_scaled, torque_from_mu
from ..physics.effects import REGISTRY, effect_class
from ..physics.effects.base import Effect, effect_words
from ..physics.scene import INSIDE, NO_MOTION, Body, ScaledGyrostat, Scene
from ..reasons import Quantity, Reason, Sentence, chained
from ..validation import came, checked_span
from .aliases import cure_of_key, cure_of_units
from .body import (
    Limits,
    Thruster,
    Wheel,
    added,
    body_of,
    centre_of_mass,
    far_off,
    fitted,
    judge_limits,
    judge_oblique,
    limits_of,
    thrusters_of,
    turned_effects,
    turned_motion,
    wheels_of,
)
from .correlations import correlations_of
from .far import in_doubles
from .lines import KeyLines, key_lines
from .sections import (
    BURN_KEYS,
    BURN_ONLY,
    Segment,
    judge_attitude,
    judge_orbit,
    rate_squared,
    segments,
    vertical_of,
)
from .source import TOGETHER, combinations, parsed, place, source_text, swept
from .table import OBSERVED, Faults, Table, described, did_you_mean, dotted, expected
from .uncertain import BEYOND, NORMAL, SIGMAS, Correlation, Uncertain
from .write import data_of_scene, plain, text_of

# --- A case file: a body, its effects and one motion, read from TOML; every fault with file, line and key
TABLES = ("title", "source", "caveats", "body", "effects", "thrusters", "wheels", "limits", "circular_orbit",
          "scaled",
          "motion", "correlations", "output", "expect", "sweep")
SYSTEMS = ("deg", "deg/day", "rpm", "rev/s", "si")  # of units in which text is printed
STATES, SPANS = ("angular_velocity", "x"), ("span", "tau")
# key: block
BLOCKS = {"attitude": "attitude", "vertical": "gamma", "velocity": "velocity", "position": "position",
          "damper": "damper", "wheel": "wheel", "damper_wheel": "damper_wheel",
          "sprung_wheel": "sprung_wheel", "damper_mass": "damper_mass"}
OBSERVED_KEYS = frozenset(OBSERVED)
TURNED_BACK = Fraction(1, 10**15)
UNIT_SLACK = 1e-6  # a vertical given to six decimals counts as a unit vector and stays as it is
SIZES = Sentence("tolerance-not-looked-at", "the tolerance of the force of {thrusters} is not looked at "
                 "here; stabilab fate and stabilab when look at it")
TILTS = Sentence("misalignment-not-looked-at", "the misalignment of {thrusters} is not looked at here; "
                 "stabilab fate and stabilab when look at it")
MIDDLES = Caveat(Kind.UNCERTAIN, Sentence(
    "of-the-middles", "of the middles of the uncertain numbers; stabilab fate says what their box does")())
NORMALS = Sentence(
    "normal-numbers", "{keys}: normal; what is said of all values of the uncertain numbers is said of those "
    "within {sigmas} sigma, beyond which at most {percent} % of the draws lie")
CORRELATED = Sentence(
    "correlated-numbers", "correlations of uncertain numbers ({pairs}) count in samples (--samples); what is "
    "said of all values holds for every correlation")
PAIR = Sentence("correlated-pair", "{first} with {second}: {value}")
NO_CENTRE = Sentence("no-centre-of-mass",
                     "the file gives no centre_of_mass: thrusters are placed from it")()
NO_START = Sentence("start-not-looked-at",
                    "the start in [motion] is not looked at: the attitudes are those at rest in the orbital "
                    "frame; of a symmetric satellite that spins about its axis a wheel along the axis "
                    "stands for the spin, with the momentum C (spin - rate of the orbit along the axis), C "
                    "the moment about it, the spin in space")
STATED = Sentence("stated-by-the-file", "{statement}")
SILENT = Sentence("no-thruster-fires",
                  "no thruster fires: stuck = true in a table [[thrusters]] makes one act for ever "
                  "({thrusters})")
STAND_IN = Body((3, 2, 1))  # lets the faults of the effects show where the body itself is at fault


@dataclass(frozen=True)
class Case:
    """One case file. `stabilab.study.Case` is the same with its questions as methods.

    scene: the Scene (rad/s, s) or ScaledGyrostat (x, tau) in the variables of the case, which `variables`
    names ("physical" or "scaled"); physical: the Scene in kg m^2, N m, or None where the file gives [scaled];
    scaling: the change between the two, None where it is undefined. state: three components at time 0 in the
    case's variables, body frame, or None; blocks: the other blocks of the state by name ("gamma", "velocity",
    "position", "damper" as three numbers, "attitude" as psi, phi, theta of the 3-1-2 sequence, rad), where
    the file gives them; span: (from, to) in the case's time or None; expect: facts the case's test asserts;
    text: the source. uncertain: the numbers given with an uncertainty, whose middles everything else holds;
    mu: the dimensionless torque where the file gives it for a body. decimals: those of the state as they were
    written, before the one rounding to doubles (`exact_state`).

    A file gives vectors in its own frame; scene, state and vertical are along the principal axes, which
    `frame` tells (None where the file gives [scaled]); where the tensor is diagonal the two frames are one.
    thrusters, wheels, limits: as stated, in the frame of the file; torques of the stuck ones and momenta of
    the wheels are in the scene. inexact: the keys whose unit holds pi, good to
    240 bits. assumed: what was taken for granted, notes: in words. units: "deg" or "si", in which people want
    to read answers (empty where the file does not say); swept: (key, value as written) of every key of
    [sweep].
    caveats: what the file itself says that limits every answer. observed: whether the start is stated by
    periods, or by spin and nutation or lean, from which the state was found. correlations: of uncertain
    numbers.
    """

    path: str = field(compare=False)
    title: str
    source: str
    scene: Scene | ScaledGyrostat
    variables: str
    physical: Scene | None = None
    scaling: Scaling | None = None
    state: Float3 | None = None
    span: tuple[float, ...] | None = None
    expect: dict = field(default_factory=dict)
    blocks: dict = field(default_factory=dict)
    text: str = field(default="", repr=False, compare=False)
    variant: str = ""
    uncertain: tuple[Uncertain, ...] = ()
    mu: tuple | None = None
    decimals: Exact3 | None = None
    frame: PrincipalAxes | None = None
    thrusters: tuple[Thruster, ...] = ()
    wheels: tuple[Wheel, ...] = ()
    limits: Limits | None = None
    inexact: tuple[str, ...] = ()
    assumed: tuple[Reason, ...] = ()
    units: str = ""
    swept: tuple[tuple[str, Any], ...] = ()
    caveats: tuple[Caveat, ...] = ()
    observed: bool = False
    correlations: tuple[Correlation, ...] = ()

    def __eq__(self, other: object) -> bool:
        """By what it holds, whether it has methods or not."""
        if not isinstance(other, Case):
            return NotImplemented
        return all(getattr(self, x.name) == getattr(other, x.name) for x in fields(Case) if x.compare)

    @property
    def notes(self) -> tuple[str, ...]:
        """What was taken for granted, in words."""
        return tuple(map(str, self.assumed))

    def to_toml(self) -> str:
        """The case as text that `stabilab.load` reads."""
        return text_of_case(self)

    def __repr__(self) -> str:
        return f"Case({self.place}: {self.variables}, {self._motion()})"

    def _motion(self) -> str:
        """The start in the frame and the span, with their units."""
        exact, axes = self.exact_state, oblique(self.frame)
        if exact is None:
            return "no motion"
        state = exact if axes is None else axes.back(exact)
        # below it stands what turning there and back left
        smallest = TURNED_BACK * max(map(abs, state)) if axes is not None else 0
        numbers = ", ".join(f"{float(v) if abs(v) > smallest else 0.0:.6g}" for v in state)
        rate = "" if self.variables == "scaled" else " rad/s"
        where = "" if axes is None else " in the frame of the file"
        span = (f", span {self.span[0]:.6g} to {self.span[1]:.6g} {self.scene.time_unit}"
                if self.span else "")
        return f"state ({numbers}){rate}{where}{span}"

    @property
    def exact_state(self) -> Exact3 | None:
        """The state exactly: its decimals as they were written, or, where it was replaced since, the new
        numbers themselves."""
        if self.state is None:
            return None
        return (self.decimals if self.decimals and floats(self.decimals) == self.state
                else tuple(map(Fraction, self.state)))

    @property
    def start(self) -> tuple[float, ...] | None:
        """The state at time 0, followed by the vertical (gamma) where an effect of the scene needs it, and by
        what a damper or a wheel inside has."""
        if self.state is None:
            return None
        vertical = self.blocks["gamma"] if "gamma" in self.scene.blocks else ()
        inside = [self.blocks.get(name, NO_MOTION[name]) for name in INSIDE if name in self.scene.blocks]
        return (*self.state, *vertical, *(v for part in inside for v in part))

    @property
    def name(self) -> str:
        """The file's stem, and which combination of its [sweep] this is (`-2-1`: second value of the first
        key)."""
        return printable(Path(self.path).stem) + self.variant

    @property
    def heading(self) -> str:
        """Its title, or its name where it has none, with the label of a combination."""
        return f"{self.title} ({self.name})" if self.title and self.variant else self.title or self.name

    @property
    def place(self) -> str:
        """How messages name the case: its file, and which combination of its [sweep]."""
        return printable(self.path) + (f" ({self.name})" if self.variant else "")


@contextmanager
def blamed_on(case: Case):
    """What the analysis cannot use becomes an error of the case's file, with the line of the key it speaks
    of; so does what leaves the range of doubles."""
    try:
        with in_doubles(case):
            yield
    except CaseError:
        raise
    except InputError as error:
        word, colon, rest = str(error).partition(": ")
        keys = {"state": STATES, "span": SPANS}.get(word, ()) if colon else ()
        table = key_lines(case.text).line if keys else {}
        key, line = next(((k, table[("motion", k)]) for k in keys if ("motion", k) in table), (None, None))
        raise InputError(f"{printable(case.path)}:{line}: motion.{key}: {rest}" if line
                         else f"{case.place}: {error}") from None


def load(given: Any, state: Any = None, span: Any = None) -> Case:
    """The case that is given: the path of a TOML file, such text itself (a string of more than one line), a
    dict with the tables of a file, a case, or a scene, whose motion `state` and `span` are.

    state, span: of a scene alone; three rates in its variables, or blocks by name ("omega", "gamma", ...),
    and (from, to) in its time, or the end alone. Raises CaseError, an InputError, with all faults of a file
    at once.

    The case is scaled where the file has [scaled], gives the motion as x, or gives no motion and the torque
    as mu (and the scaling is defined); else physical. Decimals are read exactly, the motion is rounded once.
    """
    if hasattr(given, "quadratic"):
        return _built("scene", *_tables("scene", data_of_scene(given, state, checked_span(span))))
    if state is not None or span is not None:
        raise InputError("load: state and span are those of a scene; a case or a file has its own [motion]")
    if isinstance(given, Case):
        return given
    if isinstance(given, Burning):
        raise InputError("load: expected a case whose torque never changes; thrusters of this one fire on a "
                         "schedule: ask its burn, simulate or when, or write stuck = true in place of "
                         "start, stop and the other keys of the schedule")
    return _built(*_stated(given, "load", "its text, a dict, or a scene"))


def _tables(path: str, data: dict) -> tuple[str, dict, Faults]:
    """(text, data, faults) of tables that stand in no file, so that their faults have no lines."""
    text = text_of(data)
    return text, parsed(path, text)[0], Faults(KeyLines())


def text_of_case(case: Case) -> str:
    """The text of a case file with this case: its own, with its comments, where that states it; of a
    combination of a [sweep], of a case with another motion and of a scene the numbers alone."""
    if not case.text:
        return text_of(_data_of(case))
    def is_read(found: Case) -> bool:
        """Whether it is the case, but for what a question adds to one."""
        return case == replace(found, swept=case.swept, caveats=case.caveats)
    if not case.variant and is_read(read_text(case.path, case.text)):
        return case.text
    top = Table((), *parsed(case.path, case.text))
    data = dict(combinations(top)).get(case.variant, top.data)
    if is_read(_built(case.path, case.text, data, top.faults, case.variant)):
        return text_of(data)
    return text_of(plain({"title": case.title, "source": case.source}) | _data_of(case))


def _data_of(case: Case) -> dict[str, Any]:
    """The tables with the scene of a case and its motion."""
    motion = {"omega": case.exact_state, **case.blocks} if case.state else None
    return data_of_scene(case.scene, motion, case.span)


def with_text(case: Case) -> Case:
    """The case itself, or that of the text that a scene makes, for questions that vary what is written."""
    return case if case.text else replace(read_text(case.path, text_of_case(case)), caveats=case.caveats)


@dataclass(frozen=True)
class Burning:
    """A case whose thrusters fire on a schedule. craft: the case, its scene without the torque of these
    thrusters; no question but these may take it for the whole."""

    craft: Case

    @property
    def place(self) -> str:
        """Its file and combination, as messages name it."""
        return self.craft.place

    def segments(self, until: Fraction | None = None) -> list[Segment]:
        """From time 0 to the last closing, `until` at the latest: which thrusters fire, between exact times.
        """
        return segments([thruster.burn for thruster in self.craft.thrusters], until)


def fires_on_schedule(given: str | os.PathLike[str] | Mapping[str, Any]) -> bool:
    """Whether a thruster of this case file, text or dict has a start, stop, pulses or propellant."""
    *_, data, faults = _stated(given, "load_burning")
    return bool(_scheduled(data, faults))


def load_burning(given: Any) -> Burning:
    """The case, or that of a file, a text of several lines or a dict, whose thrusters fire on a schedule
    (start, stop, period, duty, on_time, profile, propellant, mass_flow), for `burn`. Where none does, the
    stuck ones fire from 0 on. Raises CaseError as `load` does."""
    path, text, data, faults = _stated(given, "load_burning")
    return Burning(_built(path, text, _firing(data, faults), faults, burning=True))


def _firing(data: dict, faults: Faults) -> dict:
    """Where no thruster has a schedule, the stuck ones fire from 0 on."""
    declared = data.get("thrusters")
    return data if _scheduled(data, faults) or not isinstance(declared, list) else (
        data | {"thrusters": [_from_start(item) for item in declared]})


def _from_start(thruster: Any) -> Any:
    """A stuck thruster as one that opens at 0; any other as it is."""
    if not isinstance(thruster, dict) or thruster.get("stuck") is not True:
        return thruster
    return {key: value for key, value in thruster.items() if key != "stuck"} | {"start": 0}


def _stated(supplied: Any, name: str, others: str = "its text, or a dict") -> tuple[Any, str, dict, Faults]:
    """(path, text, data, faults) of a case, the path of a file, a text of several lines or a dict."""
    if isinstance(supplied, Mapping):
        return "dict", *_tables("dict", plain(supplied))
    if isinstance(supplied, Case):
        path, text = supplied.path, text_of_case(supplied)
    elif isinstance(supplied, str) and "\n" in supplied:
        path, text = "text", supplied
    elif isinstance(supplied, (str, os.PathLike)):
        return _read(supplied)
    else:
        raise InputError(f"{name}: expected a case: the path of a case file, {others}; got {came(supplied)}")
    return path, text, *parsed(path, text)


@dataclass(frozen=True)
class Orbiting:
    """A satellite on a circular orbit. craft: the case, whose scene is without the gravity gradient; no
    question but `circular_orbit` may take it for the whole. rate_squared: of the orbit, 1/s^2."""

    craft: Case
    rate_squared: Fraction


def load_orbiting(given: Any) -> Orbiting:
    """The case of a file, of a text of several lines or of a dict, that has [circular_orbit] (rate, period,
    altitude or radius), for `circular_orbit`. Raises CaseError as `load` does."""
    path, text, data, faults = _stated(given, "load_orbiting")
    craft = _built(path, text, data, faults, orbiting=True)
    if "period" in data["circular_orbit"]:  # its rate holds pi
        craft = replace(craft, inexact=(*craft.inexact, "circular_orbit.period"))
    if "motion" in data:
        craft = replace(craft, caveats=(*craft.caveats, Caveat(Kind.STATED, NO_START())))
    # it has no fault, or the case had not been built
    return Orbiting(craft, rate_squared(Table(("circular_orbit",), data["circular_orbit"], faults)))


def _judge_burns(top: Table, burning: bool):
    """Note every thruster with a schedule where the question takes a constant torque; where it does not,
    combinations of values, and that there is no schedule: of a file without another fault, which may be what
    hides it."""
    result = _scheduled(top.data, top.faults)
    if not burning:
        for table, keys in result:
            table.fault(BURN_ONLY.format(", ".join(keys)), keys[0])
        return
    if not result and not top.faults.problems:
        top.fault('no thruster fires on a schedule: give one of [[thrusters]] start = 0 in place of stuck, '
                  'and stop = "12 s", or a span in [motion] to look for the time to close it in',
                  *(["thrusters"] if "thrusters" in top else []))
    if "sweep" in top:
        top.fault("a burn takes one case at a time: take away [sweep]", "sweep")


def _scheduled(data: dict, faults: Faults) -> list[tuple[Table, list[str]]]:
    """(table, keys of its schedule) of every thruster that has one."""
    declared = data.get("thrusters")
    return [(Table(("thrusters", n), item, faults), keys)
            for n, item in enumerate(declared if isinstance(declared, list) else ())
            if isinstance(item, dict) and (keys := [key for key in BURN_KEYS if key in item])]


def load_all(path: str | Path) -> list[Case]:
    """The case in the file, or, where it has [sweep], one case for every combination of the values there.

    [sweep] has keys such as "effects.gyrostat.momentum" = [[0, 0, 1], [0, 0, 2]]; each must stand in the file
    with some value of its own, which the sweep replaces. [expect] speaks of the file's own values and is left
    out. Raises CaseError as `load` does.
    """
    path = os.fspath(path)
    return read_all(path, source_text(path))


def read_all(path: str, text: str) -> list[Case]:
    """The cases of `load_all` in a text; `path` is named in its faults."""
    data, faults = parsed(path, text)
    base = _built(path, text, data, faults)
    result = combinations(Table((), data, faults))
    if not result:
        return [base]
    keys = {key: values for key, values in data["sweep"].items() if key != TOGETHER}
    moved = {place(data, key): ("sweep", key) for key in keys}
    return [replace(_built(path, text, values, Faults(faults.lines, moved), suffix),
                    swept=_swept(keys, suffix)) for suffix, values in result]


def _swept(sweep: Mapping[str, Any], suffix: str) -> tuple:
    """(key, value) of a combination: "-2-1" is the second value of the first key and the first of the second,
    "-2" alone the second of every key."""
    numbers = suffix.split("-")[1:]
    numbers = numbers * len(sweep) if len(numbers) == 1 else numbers
    return tuple((key, values[int(n) - 1]) for (key, values), n in zip(sweep.items(), numbers))


def read_text(path: str | Path, text: str) -> Case:
    """The case in a text that is not a file yet; `path` is named in its faults."""
    return _built(path := os.fspath(path), text, *parsed(path, text))


def with_data(path: str, text: str, data: dict, burning: bool = False) -> Case:
    """The case in TOML data that is the text's but for numbers that were put in; its faults are
    reported as of the text. Numbers that were put in are certain, so that correlations are left out.
    burning: as of `load_burning`, the craft alone."""
    data = {key: value for key, value in data.items() if key != "correlations"}
    faults = Faults(key_lines(text))
    return _built(path, text, _firing(data, faults) if burning else data, faults, burning=burning)


def _read(path: str | os.PathLike[str]):
    path = os.fspath(path)
    text = source_text(path)
    return path, text, *parsed(path, text)


def _built(path, text, data, faults, variant="", burning=False, orbiting=False) -> Case:
    top = Table((), data, faults)
    top.known(TABLES, "table or key")
    swept(top)  # notes the faults of [sweep]
    title, source, declared = top.text("title"), top.text("source"), top.texts("caveats")
    craft = _craft(top)
    motion = _motion(top)
    physical, mu, frame = _physical(top, craft, motion)
    motion, taken = (_observed().with_observed(motion, physical, frame) if motion.state_key in OBSERVED
                     else (motion, ()))
    scaled = _scaled(top)
    judge_oblique(top, frame)
    judge_limits(top, craft.limits, None if motion.state_key == "x" else motion.exact)
    motion = turned_motion(motion, frame)
    expect = expected(top.table("expect"))
    units = _units(top.table("output"))
    scene, variables, scaling = _variables(top, motion, physical, scaled, mu)
    _judge_blocks(motion, scene)
    span = _span(motion, variables, scaling)
    _judge_burns(top, burning)
    judge_orbit(top, physical.effects if physical else (), orbiting)
    correlations = correlations_of(top, tuple(faults.uncertain.values()))
    if faults.problems:
        raise CaseError(path, faults.ordered())
    return Case(path, title, source, scene, variables, physical, scaling, motion.state, span, expect,
                motion.blocks, text,
                variant, tuple(faults.uncertain.values()), mu, motion.exact, frame if physical else None,
                craft.thrusters, craft.wheels, craft.limits,
                tuple(dict.fromkeys(map(dotted, sorted(faults.inexact, key=str)))),
                (*craft.assumed, *taken), units, observed=motion.state_key in OBSERVED,
                correlations=correlations,
                caveats=(*(Caveat(Kind.STATED, STATED(statement=item)) for item in declared),
                         *(physical.body.caveats if physical else ()),
                         *(far_off(physical.body, craft.thrusters) if physical else ()),
                         *(caveat for effect in scene.effects for caveat in effect.caveats),
                         *_silent(craft.thrusters),
                         *_middles(tuple(faults.uncertain.values()), craft.thrusters),
                         *_distributed(tuple(faults.uncertain.values()), correlations)))


def _silent(thrusters: tuple[Thruster, ...]) -> tuple[Caveat, ...]:
    """That there are thrusters and none of them acts: whoever describes them asks what they do."""
    if not thrusters or any(thruster.stuck or thruster.burn for thruster in thrusters):
        return ()
    return (Caveat(Kind.THRUSTERS, SILENT(thrusters=", ".join(thruster.name for thruster in thrusters))),)


def _middles(uncertain: tuple[Uncertain, ...], thrusters: tuple[Thruster, ...]) -> list[Caveat]:
    """That an answer is of the middles of the uncertain numbers; of forces by itself, as more questions look
    at these than at others."""
    firing = [thruster for thruster in thrusters if thruster.stuck or thruster.burn]
    sized = tuple(item.name for item in firing if item.force_tolerance)
    tilts = tuple(item.name for item in firing if item.misalignment)
    return [*([MIDDLES] if len(uncertain) > len(sized) else []),
            *(Caveat(kind, sentence(thrusters=names)) for kind, sentence, names in (
                (Kind.TOLERANCE, SIZES, sized), (Kind.MISALIGNMENT, TILTS, tilts)) if names)]


def _distributed(uncertain: tuple[Uncertain, ...], correlations: tuple[Correlation, ...]) -> Iterator[Caveat]:
    """How far the box of normal numbers reaches, and what correlations count for."""
    normal = tuple(item.key for item in uncertain if item.law == NORMAL)
    if normal:
        outside = Quantity(100 * BEYOND * len(normal), digits=3).upper
        yield Caveat(Kind.DISTRIBUTION, NORMALS(keys=normal, sigmas=SIGMAS, percent=outside))
    if correlations:
        pairs = [PAIR(first=row.first, second=row.second, value=Quantity(float(row.value), digits=6))
                 for row in correlations]
        yield Caveat(Kind.DISTRIBUTION, CORRELATED(pairs=chained(*pairs, joint=", ")))


def _units(output: Table | None) -> str:
    """The units of [output]; "" where the file does not say."""
    if output is None:
        return ""
    output.known(("units",))
    wanted = output.text("units").lower()
    if wanted and wanted not in SYSTEMS:
        output.fault(
            f"expected {', '.join(SYSTEMS)} (deg/s and min, or rad/s and s), got {described(wanted)}"
            f"{cure_of_units(wanted)}",
            "units")
    return wanted


class _Craft(NamedTuple):
    """What the file says a spacecraft carries."""

    thrusters: tuple[Thruster, ...] = ()
    wheels: tuple[Wheel, ...] = ()
    limits: Limits | None = None
    assumed: tuple[Reason, ...] = ()


def _craft(top: Table) -> _Craft:
    if "scaled" in top:
        return _Craft()
    centre = centre_of_mass(top)
    thrusters = thrusters_of(top, centre)
    assumed = (NO_CENTRE,) if thrusters and centre is None else ()
    return _Craft(thrusters, wheels_of(top), limits_of(top), assumed)


class _Context(NamedTuple):
    """What an effect may need of the rest of the case."""

    body: Body
    stand_in: bool = False  # the body itself is at fault: judge nothing by it

    def torque_from_mu(self, mu: Sequence[Fraction]):
        return torque_from_mu(self.body, mu)


def _physical(top: Table, craft: _Craft,
              motion: _Motion) -> tuple[Scene | None, tuple | None, PrincipalAxes | None]:
    """The scene of [body], [effects] and hardware along principal axes, the dimensionless torque where the
    file gives it, the axes."""
    if "scaled" in top:
        for key in ("body", "effects", "thrusters", "wheels", "limits"):
            if key in top:
                top.fault("[scaled] stands for [body] and [effects]: keep one or the other", key)
        return None, None, None
    body, frame = body_of(top)
    built = _effects(top, body)
    if body is None or None in built:
        return None, None, frame
    try:
        full = added(built, craft.thrusters, craft.wheels)
        frame = fitted(frame, full, motion)
        full = turned_effects(top, full, frame)
    except InputError as error:  # numbers that are good one by one, but not added up or turned
        top.fault(f"added up along principal axes, {error}",
                  next(key for key in ("thrusters", "wheels", "effects") if key in top))
        return None, None, frame
    refused = [(effect, why) for effect in full if (why := effect.refused_by(body))]
    for effect, why in refused:
        top.fault(why, "effects", effect.name, effect.keys[0])
    if refused:
        return None, None, frame
    torque = (top.data.get("effects", {}).get("constant_torque") if isinstance(top.data.get("effects"), dict)
              else None)
    if not isinstance(torque, dict):  # absent, or no table, which is noted already
        return _scene(body, full, frame), None, frame
    mu = Table(("effects", "constant_torque"), torque, Faults(top.faults.lines)).vector("mu")
    if mu and any(thruster.stuck for thruster in craft.thrusters):
        top.fault("mu cannot be added to the torque of a thruster: give torque in N m", "effects",
                  "constant_torque", "mu")
    return _scene(body, full, frame), mu, frame


def _scene(body: Body, effects: Sequence[Effect], frame: PrincipalAxes | None) -> Scene:
    """The scene, which knows where its axes lie in the frame of the file."""
    scene = Scene(body, *effects)
    if frame is not None and not frame.as_given:
        object.__setattr__(scene, "frame", frame)
    return scene


def _effects(top: Table, body: Body | None) -> list:
    """The effects as the file gives them, None for one at fault."""
    effects = top.table("effects")
    if effects is None:
        return []
    built = []
    for name in effects.data:
        if name not in REGISTRY:
            cure = cure_of_key(effects.path, name, effects.data, REGISTRY)
            hint = f"; {cure}" if cure else did_you_mean(name, REGISTRY)
            resolved = f" Known effects: {', '.join(REGISTRY)}" if "did you mean" in hint else ""
            effects.fault(f"unknown effect{hint}{resolved}", name)
            continue
        table = effects.table(name)
        if table is None:
            continue
        cls = effect_class(name)
        table.known(cls.keys)
        try:
            built.append(cls.from_case(table, _Context(body or STAND_IN, body is None)))
        except InputError as error:  # numbers that are good one by one, but not together
            effects.fault(str(error), name)
    return built


def _scaled(top: Table) -> ScaledGyrostat | None:
    """The system of [scaled]: the paper's a, b, mu, any real numbers."""
    table = top.table("scaled")
    if table is None:
        return None
    table.known(("a", "b", "mu"))
    table.required("a", "b", "mu")
    a, b, mu = table.number("a"), table.number("b"), table.vector("mu")
    return None if a is None or b is None or mu is None else ScaledGyrostat(a, b, mu)


@dataclass(frozen=True)
class _Motion:
    """[motion] as it is written: which keys, and their numbers."""

    table: Table
    state_key: str | None = None
    state: tuple[float, ...] | None = None
    span_key: str | None = None
    span: tuple | None = None
    blocks: dict = field(default_factory=dict)
    exact: tuple | None = None
    exact_vertical: tuple | None = None


def _motion(top: Table) -> _Motion:
    table = top.table("motion")
    if table is None:
        return _Motion(Table(("motion",), {}, top.faults))
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
        state_key = _observed().observed_key(table, state_key) or state_key
    if "scaled" in top:
        for key, other in (("angular_velocity", "x"), ("span", "tau"), *((key, "x") for key in OBSERVED)):
            if key in table:
                table.fault(f"a [scaled] system has no body to convert {key} with: give {other}", key)
    vectors = {block: vector for key, block in BLOCKS.items()
               if (vector := table.numbers(key, len(NO_MOTION.get(block, (0.0,) * 3)))) is not None}
    if "gamma" in vectors:
        vectors["gamma"] = _unit(table, vectors["gamma"])
    blocks = {block: floats(vector) for block, vector in vectors.items()}
    return _Motion(table, state_key, floats(state) if state else None, span_key, span, blocks, state,
                   vectors.get("gamma"))


def _observed() -> ModuleType:
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


def _judge_blocks(motion: _Motion, scene):
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


def _variables(top: Table, motion: _Motion, physical: Scene | None, scaled: ScaledGyrostat | None,
               mu: Sequence[Fraction] | None):
    """(scene, "physical" or "scaled", change of variables or None), by the rule in `load`."""
    if physical is None:
        return _in_range(top, scaled), "scaled", None
    try:
        physical.quadratic()  # refuses effects that the scaled system does not have
        twin, scaling = to_scaled(physical, mu)
    except InputError as error:
        for key in ("x", "tau"):
            if key in motion.table:
                motion.table.fault(f"{error}", key)
        return _in_range(top, physical), "physical", None
    if motion.state_key == "x" or (mu is not None and motion.state_key is None):
        return _in_range(top, twin), "scaled", scaling
    return _in_range(top, physical), "physical", scaling


def _in_range(top: Table, scene):
    """The scene, if its rates can be formed in doubles."""
    try:
        scene is None or scene.quadratic().coefficients
    except OverflowError:
        top.fault("the coefficients of the equations of motion exceed the largest double (about 1.8e308): "
                  "choose other units", "scaled" if "scaled" in top else "body")
    except InputError:  # other effects: their parameters, and these as rates
        for effect in scene.effects:
            if _too_large(effect, scene.body):
                top.fault("its numbers, or these over the moments of inertia, exceed the largest double "
                          "(about 1.8e308): "
                          "choose other units", "effects", effect.name)
    return scene


def _too_large(effect: Effect, body: Body) -> bool:
    try:
        return not all(math.isfinite(float(v)) and math.isfinite(float(v / min(body.exact)))
                       for v in effect.parameters().values())
    except OverflowError:
        return True


def _span(motion: _Motion, variables: str, scaling: Scaling | None) -> tuple[float, ...] | None:
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
