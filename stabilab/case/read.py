"""A case file to a `Case`; every fault with its file, line and key."""
from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

from ..errors import CaseError, Caveat, InputError, Kind, printable
from ..numbers.exact import floats
from ..numbers.principal import PrincipalAxes, oblique
from ..numbers.vectors import Exact3, Float3
from ..physics.coefficients import Scaling
from ..physics.scene import INSIDE, NO_MOTION, ScaledGyrostat, Scene
from ..reasons import Reason, Sentence
from ..validation import came, checked_span
from .body import judge_oblique, turned_motion
from .correlations import correlations_of
from .cures import cure_of_units
from .far import in_doubles
from .hardware import Limits, Thruster, Wheel, judge_limits
from .lines import KeyLines, key_lines
from .motion import SPANS, STATES, judge_blocks, motion_of, observed_reader, span_of
from .notices import caveats_of
from .scene import craft_of, in_variables, physical_of, scaled_of
from .sections import BURN_KEYS, BURN_ONLY, Segment, judge_orbit, rate_squared, segments
from .source import TOGETHER, combinations, parsed, place, source_text, swept
from .table import OBSERVED, Faults, Table, described, dotted, expected
from .uncertain import Correlation, Uncertain
from .write import data_of_scene, plain, text_of

TABLES = ("title", "source", "caveats", "body", "effects", "thrusters", "wheels", "limits", "circular_orbit",
          "scaled", "motion", "correlations", "output", "expect", "sweep")
SYSTEMS = ("deg", "deg/day", "rpm", "rev/s", "si")  # of units in which text is printed
TURNED_BACK = Fraction(1, 10**15)
NO_START = Sentence("start-not-looked-at",
                    "the start in [motion] is not looked at: the attitudes are those at rest in the orbital "
                    "frame; of a symmetric satellite that spins about its axis a wheel along the axis "
                    "stands for the spin, with the momentum C (spin - rate of the orbit along the axis), C "
                    "the moment about it, the spin in space")


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
    return _orbiting(*_stated(given, "load_orbiting"))


def _orbiting(path: Any, text: str, data: dict, faults: Faults) -> Orbiting:
    craft = _built(path, text, data, faults, orbiting=True)
    if "period" in data["circular_orbit"]:  # its rate holds pi
        craft = replace(craft, inexact=(*craft.inexact, "circular_orbit.period"))
    if "motion" in data:
        craft = replace(craft, caveats=(*craft.caveats, Caveat(Kind.STATED, NO_START())))
    # it has no fault, or the case had not been built
    return Orbiting(craft, rate_squared(Table(("circular_orbit",), data["circular_orbit"], faults)))


def special(path: str | os.PathLike[str]) -> bool:
    """Whether this case file has [circular_orbit], or thrusters that fire on a schedule."""
    *_, data, faults = _read(path)
    return "circular_orbit" in data or bool(_scheduled(data, faults))


def special_of(case: Case) -> Burning | Orbiting | None:
    """What a case is the craft of: a burn, or a satellite on a circular orbit; None where it is the whole."""
    if any(thruster.burn is not None for thruster in case.thrusters):
        return Burning(case)
    if "circular_orbit" not in case.text:
        return None
    data, faults = parsed(case.path, case.text)
    return _orbiting(case.path, case.text, data, faults) if "circular_orbit" in data else None


def load_each(path: str | Path) -> list[Case]:
    """As `load_all`; of a burn or a satellite on a circular orbit its craft (`special_of`)."""
    if not special(path):
        return load_all(path)
    full = load_any(path)
    return [full if isinstance(full, Case) else full.craft]


def load_any(given: Any) -> Case | Burning | Orbiting:
    """The case that is given, of whatever kind: a satellite where it has [circular_orbit], a burn where
    thrusters fire on a schedule, else as `load` has it. Raises CaseError as these do."""
    if isinstance(given, (Burning, Orbiting)) or hasattr(given, "quadratic"):
        return given if not hasattr(given, "quadratic") else load(given)
    *_, data, faults = _stated(given, "load_any", "its text, a dict, or a scene")
    if "circular_orbit" in data:
        return load_orbiting(given)
    return load_burning(given) if _scheduled(data, faults) else load(given)


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
    craft = craft_of(top)
    motion = motion_of(top)
    physical, mu, frame = physical_of(top, craft, motion)
    motion, taken = (observed_reader().with_observed(motion, physical, frame) if motion.state_key in OBSERVED
                     else (motion, ()))
    scaled = scaled_of(top)
    judge_oblique(top, frame)
    judge_limits(top, craft.limits, None if motion.state_key == "x" else motion.exact)
    motion = turned_motion(motion, frame)
    expect = expected(top.table("expect"))
    units = _units(top.table("output"))
    scene, variables, scaling = in_variables(top, motion, physical, scaled, mu)
    judge_blocks(motion, scene)
    span = span_of(motion, variables, scaling)
    _judge_burns(top, burning)
    judge_orbit(top, physical.effects if physical else (), orbiting)
    correlations = correlations_of(top, tuple(faults.uncertain.values()))
    if faults.problems:
        raise CaseError(path, faults.ordered())
    uncertain = tuple(faults.uncertain.values())
    return Case(path, title, source, scene, variables, physical, scaling, motion.state, span, expect,
                motion.blocks, text,
                variant, uncertain, mu, motion.exact, frame if physical else None,
                craft.thrusters, craft.wheels, craft.limits,
                tuple(dict.fromkeys(map(dotted, sorted(faults.inexact, key=str)))),
                (*craft.assumed, *taken), units, observed=motion.state_key in OBSERVED,
                correlations=correlations,
                caveats=caveats_of(declared, physical, scene, craft.thrusters, uncertain, correlations))


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


