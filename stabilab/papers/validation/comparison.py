"""What other tools print beside what is found here, in words."""
from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import InputError
from ...numbers.balls import Digits, working
from ...physics.body import Body
from ...physics.effects.constant_torque import ConstantTorque
from ...physics.scene import Scene
from ...representation import values_of
from ...show.report import html
from ...show.terminal import lettered
from . import quantities
from .quantities import BALL_BITS, METHOD_LABELS, At, at, reproduced

if TYPE_CHECKING:
    from flint import arb

# --- Public numbers of other tools as data: motions, and what was printed of each (`numbers/*.toml`)
FOLDER = Path(__file__).parent / "numbers"
REPOSITORY = "https://github.com/"


@dataclass(frozen=True)
class Wheels:
    """Balanced wheels along the axes: momentum (N m s) at 6000 rpm, speeds (rpm) relative to the body at the
    start, motor torques (N m) until a time (s)."""

    momentum: Fraction
    speed: tuple[Fraction, ...]
    motor: tuple[Fraction, ...]
    until: Fraction


@dataclass(frozen=True)
class Motion:
    """A motion that was run by others. inertia (any unit where no torque acts), torque (3,), rates omega in
    `unit` at the time `begins` (s), attitude by modified Rodrigues parameters sigma, or by the angular
    momentum (against_momentum). case: the text of a case that is asked as it stands; all else is empty
    then."""

    id: str
    file: str
    inertia: tuple[Fraction, ...]
    omega: tuple[Fraction, ...]
    unit: str
    torque: tuple[Fraction, ...]
    sigma: tuple[Fraction, ...]
    begins: Fraction
    against_momentum: bool
    wheels: Wheels | None
    case: str = ""

    @property
    def scene(self) -> Scene:
        """The body and its torque, without wheels."""
        return Scene(Body(self.inertia), *([ConstantTorque(self.torque)] if any(self.torque) else []))


@dataclass(frozen=True)
class Printed:
    """Values that a tool prints of a quantity of a motion: rows (time, components) as they are printed.
    scheme: method and step that the tool seems to use."""

    motion: Motion
    quantity: str
    tool: str
    file: str
    tolerance: Fraction
    relative: bool
    tolerance_is: str
    scheme: dict
    values: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Source:
    """A repository at a commit, or a publication (no commit, its files are addresses), its licence, what its
    numbers are, and the numbers."""

    name: str
    title: str
    repository: str
    commit: str
    licence: str
    about: str
    printed: tuple[Printed, ...]

    def url(self, file: str) -> str:
        """Where a file of it can be read."""
        return f"{REPOSITORY}{self.repository}/blob/{self.commit}/{file}" if self.commit else file

    @property
    def place(self) -> str:
        """The repository at its commit, the publication."""
        return f"{self.repository} at {self.commit[:12]}" if self.commit else self.repository


def sources() -> tuple[str, ...]:
    """Names of the sources on record, in order."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))


def source(name: str) -> Source:
    """A source by its name. InputError names the known ones."""
    import tomllib
    if name not in sources():
        raise InputError(f"unknown source {name!r}: known are {', '.join(sources())}")
    data = tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
    motions = {row["id"]: _motion(row) for row in data.get("motion", ())}
    printed = tuple(_printed(row, motions[row["motion"]]) for row in data.get("set", ()))
    return Source(name, *(data[key] for key in ("title", "repository", "commit", "licence", "about")),
                  printed)


def _motion(row: Mapping[str, Any]):
    wheels = row.get("wheels")
    if wheels:
        wheels = Wheels(Fraction(wheels["momentum"]), _vector(wheels["speed"]), _vector(wheels["motor"]),
                        Fraction(wheels["until"]))
    zero = ("0", "0", "0")
    return Motion(row["id"], row["file"], _vector(row.get("inertia", ())), _vector(row.get("omega", ())),
                  row.get("unit", "rad/s"), _vector(row.get("torque", zero)),
                  _vector(row.get("sigma", zero)), Fraction(row.get("begins", "0")),
                  row.get("against_momentum", False), wheels, row.get("case", ""))


def _vector(texts: Sequence[str]):
    return tuple(map(Fraction, texts))


def _printed(row, motion):
    return Printed(motion, row["quantity"], row["tool"], row.get("file", motion.file),
                   Fraction(row["tolerance"]), row.get("relative", False),
                   row["tolerance_is"], row.get("cause", {}), tuple(map(tuple, row["values"])))


# --- Each printed value beside ours, the difference, and its cause where it is larger than the tolerance
VERDICTS = ("agrees", "explained", "differs")
SHOWN = 20  # digits of ours that are written at most
COMPONENTS = {"omega": ("omega1", "omega2", "omega3"), "sigma": ("sigma1", "sigma2", "sigma3"),
              "rate3": ("omega3",), "angle3": ("angle about axis 3",),
              "off_linear": ("angle off a constant rate",),
              "momentum_turn": ("turn of the angular momentum",),
              "rotation_period": ("period of rotation",),
              "half_precession": ("time of half a turn",),
              "rotation_and_precession": ("period of rotation", "period of precession"),
              "cone": ("angle of the cone",),
              "libration_in_plane": ("period in plane",),
              "libration_out_of_plane": ("period out of plane",),
              "libration_periods": ("period of the wobble", "period of the libration in longitude")}
UNITS = {"sigma": "", "angle3": "rad", "off_linear": "rad", "momentum_turn": "rad",
         "cone": "deg"}  # others: of the motion


@dataclass(frozen=True)
class Finding:
    """One value. ours: every digit written is right (to one unit of the last); bound: how far that is off at
    most; theirs: as printed. difference: ours from theirs, at most; tolerance: absolute. verdict: "agrees",
    "explained" (the method named in `explanation`, run here, gives theirs within the tolerance: `left` is
    what remains), or "differs"."""

    printed: Printed
    time: str
    component: str
    unit: str
    ours: str
    bound: float
    theirs: str
    difference: float
    tolerance: float
    verdict: str
    explanation: str
    left: float | None


def findings(source: Source, tell: Callable[[int, str], None] | None = None) -> tuple[Finding, ...]:
    """Every value of a source, in the order of its record; each motion is followed once. tell(how many are
    done, words): before each motion and value."""
    times: dict = {}
    for printed in source.printed:
        times.setdefault(printed.motion.id,
                         (printed.motion, set()))[1].update(Fraction(row[0]) for row in printed.values)
    followed = {}
    for name, (motion, wanted) in times.items():
        if tell:
            tell(0, f"{source.title}: following {name}")
        ordered = sorted(wanted)
        followed[name] = dict(zip(ordered, at(motion, ordered)))
    rows = []
    for done, (printed, row) in enumerate((item, row) for item in source.printed for row in item.values):
        if tell:
            tell(done, source.title)
        rows += _row(printed, row, followed[printed.motion.id])
    return tuple(rows)


def _row(printed: Printed, row: Sequence[str], followed: Mapping[Fraction, At]):
    time, motion = Fraction(row[0]), printed.motion
    with working(BALL_BITS) as numbers:
        balls = getattr(quantities, printed.quantity)(motion, followed[time], numbers)
        again = (reproduced(printed, float(time), [float(v.mid()) for v in balls]) if printed.scheme
                 else [None] * len(balls))
        return [_judged(printed, row[0], *item, numbers)
                for item in zip(COMPONENTS[printed.quantity], balls, row[1:], again)]


def _judged(printed: Printed, time: str, component: str, ball: arb, theirs: str, again: float | None,
            numbers: Digits):
    value = numbers.ball(Fraction(theirs))
    difference = float(numbers.upper(ball - value))
    tolerance = float(printed.tolerance * abs(Fraction(theirs)) if printed.relative else printed.tolerance)
    left = None if again is None else abs(again - float(theirs))
    verdict = ("agrees" if difference <= tolerance else "explained" if left is not None and left <= tolerance
               else "differs")
    cause = (f"{METHOD_LABELS[printed.scheme['method']].format(**printed.scheme)} gives theirs to {left:.1e}"
             if verdict == "explained" else "")
    ours = "0" if 0 in ball else ball.str(SHOWN, radius=False)
    return Finding(printed, time, component, UNITS.get(printed.quantity, printed.motion.unit), ours,
                   float(numbers.upper(ball - numbers.ball(Fraction(ours)))), theirs, difference, tolerance,
                   verdict, cause, left if verdict == "explained" else None)


# --- Findings of the validation as text, JSON and an HTML page
SCHEMA = "stabilab.validate/1"


def as_dict(validated) -> dict:
    """{"schema", "sources"} of (source, findings) pairs."""
    return {"schema": SCHEMA,
            "sources": [_source(source) | {"values": [_value(source, item) for item in result]}
                        for source, result in validated]}


def _source(source: Source):
    return {"source": source.name} | values_of(source, "title repository commit licence about")


def _value(source, item):
    return {"tool": item.printed.tool, "file": item.printed.file, "url": source.url(item.printed.file),
            "motion": item.printed.motion.id, "time_s": item.time,
            "quantity": item.component, "unit": item.unit, "ours": item.ours, "ours_within": item.bound,
            **values_of(item, "theirs difference tolerance"), "tolerance_is": item.printed.tolerance_is,
            "verdict": item.verdict, "cause": item.explanation, "left": item.left}


def counts(result: Sequence[Finding]) -> str:
    """How many values have which verdict, in words."""
    number = Counter(item.verdict for item in result)
    printed = {"agrees": "agree", "explained": "differ for a known cause", "differs": "differ"}
    phrase = {verdict: many if number[verdict] > 1
             else many.replace("agree", "agrees").replace("differ", "differs")
             for verdict, many in printed.items()}
    return (", ".join(f"{number[verdict]} {phrase[verdict]}" for verdict in VERDICTS if number[verdict])
            or "no values are printed")


def text(validated) -> str:
    """How many values agree, then a table a source: a row a value, and what explains a tool's differences
    below its rows."""
    all_of = ([f"{len(validated)} sources: {counts([item for _, result in validated for item in result])}"]
              if len(validated) > 1 else [])
    return "\n\n".join([*all_of, *("\n".join(_lines(source, result)) for source, result in told(validated))])


def told(validated) -> list:
    """The sources in the order in which people read them: those without values last."""
    return sorted(validated, key=lambda pair: not pair[1])


def _lines(source, result):
    yield f"{source.name}: {counts(result)}: {source.title}"
    yield f"  {source.place}, {source.licence}; {source.about}"
    for group in grouped(result):
        printed = group[0].printed
        yield (
            f"  {printed.tool} ({printed.file.rsplit('/', 1)[-1]}; tolerance {_tolerance(printed)}: "
            f"{printed.tolerance_is})")
        yield from _table([("t (s)", "quantity", "ours", "theirs", "differs by", "")] + [
            (item.time, lettered(item.component), _short(item.ours), item.theirs,
             f"{item.difference:.1e} {item.unit}".strip(), item.verdict) for item in group])
        if phrase := cause(group):
            yield f"    cause: {lettered(phrase)}"


def _table(rows):
    """Rows of cells, each column as wide as it needs; the words of the second and the last from the left,
    numbers from the right."""
    sizes = [max(len(row[n]) for row in rows) for n in range(len(rows[0]))]
    for row in rows:
        yield ("    " + "  ".join(cell.ljust(size) if n in (1, len(row) - 1) else cell.rjust(size)
                                  for n, (cell, size) in enumerate(zip(row, sizes)))).rstrip()


def _short(decimal: str) -> str:
    """A proved decimal, of more digits than a person reads, rounded to 14; JSON has them all."""
    from decimal import Context
    number = Context(prec=14).create_decimal(decimal)
    return f"{number.normalize():.14g}" if number else "0"


def _tolerance(printed: Printed):
    return f"{float(printed.tolerance):.2g}{' relative' * printed.relative}"


def unexplained(validated) -> list[str]:
    """A line for each value that is farther off than its tolerance without a cause."""
    return [f"{source.name}: {item.printed.tool}: {item.component} at {item.time} s differs by "
            f"{item.difference:.1e}, tolerance {item.tolerance:.1e}"
            for source, result in validated for item in result if item.verdict == "differs"]


def grouped(result: Sequence[Finding]) -> list[list]:
    """The findings of each set of printed values."""
    groups: dict = {}
    for item in result:
        groups.setdefault(id(item.printed), []).append(item)
    return list(groups.values())


def cause(group: Sequence[Finding]) -> str:
    """What explains the values of a set that are farther off than their tolerance: its worst remainder; empty
    where there is none."""
    explained = [item for item in group if item.verdict == "explained"]
    return max(explained, key=lambda item: item.left).explanation if explained else ""


def page(validated, path, **around) -> Path:
    """The page of (source, findings) pairs as a file; around: of the pages beside it (`html.render`)."""
    sources = [{"source": source, "count": counts(result),
                "groups": [_group(source, group) for group in grouped(result)]}
               for source, result in told(validated)]
    return html.write(Path(path), "validation.html", title="Numbers of other tools beside ours",
                      sources=sources, **around)


def _group(source: Source, group: Sequence[Finding]):
    printed = group[0].printed
    return {"printed": printed, "url": source.url(printed.file), "tolerance": _tolerance(printed),
            "rows": group, "cause": cause(group)}
