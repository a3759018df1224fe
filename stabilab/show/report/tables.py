"""The answer of a page at a glance, and its tables.

At a glance: outcome, time, largest rate, distance from another outcome. The tables have equilibria with
their verdicts, and what change gives the motion another fate."""
from __future__ import annotations

import math
from typing import Any

from ...case.limit_options import stated_limit
from ...equilibrium.description import FOR_ANGLES, OVER_RATE, holds_rates
from ...equilibrium.dissipative import FOLD
from ...equilibrium.gyrostat import WELL
from ...equilibrium.torque_free import CASIMIR
from ...errors import InputError, Kind
from ...orbit.potential import potential
from ...orbit.reduction import reduce
from ...orbit.result import Motion
from ...physics.coefficients import effective
from ...reasons import broad
from .. import ending, limiting
from ..terminal import listed, printed
from ..text import headline
from ..text.classification import called
from ..text.headline import cause, fate_parts, largest, rate_and_height
from ..text.motion import tilt_lines
from ..text.questions import asked
from ..text.stuck import MARGIN_LABELS, amount, holds_for, means
from ..units import DIGITS, SHORT, Units, number, vector
from .html import css


# --- The answer at a glance
def tiles(motion: Motion, units: Units) -> list[tuple[str, str, str]]:
    """(what, its value, what belongs to it) of four: when a limit is reached first."""
    rows = [("outcome", _outcome(motion, units)), ("when", _when(motion, units)),
             ("largest rate", _largest(motion, units)), ("to another outcome", _distance(motion, units))]
    if any(caveat.kind is Kind.LIMIT for caveat in motion.caveats):
        rows[:2] = reversed(rows[:2])
    return [(name, printed(value), printed(note)) for name, (value, note) in rows]


def _outcome(motion: Motion, units: Units):
    value, about, condition = fate_parts(motion, units, tilt=False)  # what a tilt does stands beside it
    if motion.fate.word == "undecided":
        note = cause(motion, units)
    else:
        note = limiting.unstable(motion.caveats, units) or f"{about}{condition}".strip()
    return value.capitalize(), "; ".join(filter(None, ["by a law that does not hold"
                                                       * headline.beyond(motion.validity), note]))


def _when(motion, units):
    """The limit of the case first, then what a tilt of the torque does, then a spin-up without a limit."""
    if motion.ending is not None and not (motion.first and math.isfinite(motion.first[1].high)):
        value, note = ending.first(motion.ending, units)
        unreached = motion.first and (f"; the limit, {units.filled(motion.first[0])}, is "
                                      f"{'never' if math.isinf(motion.first[1].low) else 'not known to be'} "
                                      f"reached ({motion.first[1].level})")
        return value, f"{note}{unreached or ''}"
    limit, result = motion.first or ("", None)
    limit = f"the limit, {units.filled(limit)},"
    if result is not None and math.isfinite(result.high):
        low, high = float(result.low), float(result.high)
        time = units.clock(low, high) if broad(low, high) else units.time(0.5 * (low + high), SHORT)
        return time, f"until {limit} is reached ({result.level})"
    tilt: Any = motion.tilt
    if tilt is not None and not tilt.ranges and tilt.ends:
        return (units.time(tilt.low, SHORT),
                f"until {units.rate(tilt.limit, SHORT)}, where the torque is tilted by "
                f"{units.angle(tilt.angle, SHORT)} ({tilt.level}); else never")
    if result is not None:
        never = math.isinf(result.low)
        return ("never" if never else "not known", f"{limit} is not reached" + (
            f" ({result.level})" if never else f" before {units.time(float(result.low), SHORT, -1)}"))
    if motion.fate.word == "spin-up":
        certain = motion.evidence.get("t_certificate")
        if certain is not None:
            return units.time(float(certain), SHORT, 1), "from then on the spin-up is certain"
        return ("from the start", "the spin-up is certain") if motion.level == "exact" else ("not known", "")
    return ("never" if motion.fate.word in ("bounded", "equilibrium") else "not known"), ""


def _largest(motion: Motion, units: Units):
    result = largest(motion, units)
    if motion.fate.word == "spin-up":
        return "without end", result
    if motion.fate.word == "equilibrium":
        return units.rate(math.hypot(*motion.at[:3]), SHORT), result
    value, _, note = result.removeprefix("largest rate ").partition(" (")
    return value or "not known", note.replace(")", "")


def _distance(motion: Motion, units: Units):
    rate, height = rate_and_height(motion, units)
    if rate:
        text = f"; in energy {height}" if height else ""
        return rate, f"the smallest change of the rates to the separatrix{text}"
    if height:
        return height, "of energy, to the barrier"
    if motion.fate.word == "separatrix":
        return "none", "the smallest change decides"
    return "not known", _explained(motion, units).removeprefix("not known: ")


def _explained(motion: Motion, units: Units) -> str:
    """Why the distance from the separatrix is not known, or its bounds are apart."""
    return "" if motion.velocity_reason is None else units.said(motion.velocity_reason)


# --- Tables
FOLDS = (WELL.odd.reason.sentence, CASIMIR.odd.reason.sentence, FOLD)
ROUNDING = 1e-12  # of a unit vector from the difference of two states in doubles
ASK_TILT = "`stabilab fate CASE --tilt \"1 deg\"` says what a tilt does."


def equilibrium_table(result, units) -> dict:
    """kind, reason, rows and the curves' equations; places and parameters that are rates in their unit."""
    rows = [_row(units.vector(p.at[:3], units.rates), p, units) for p in result.points]
    for curve in result.curves:
        for part in curve.segments:
            where = f"{_name(curve.description, units)}, {_piece(curve.description, part.t, units)}"
            rows.append(_row(where, part, units))
        for fold in curve.folds:
            row = _fold(curve, fold, units)
            rows += [] if row in rows else [row]  # a point where curves meet is one of each
    groups: dict = {}
    for curve in result.curves:
        groups.setdefault(curve.equation, []).append(curve.description)
    return {"kind": result.kind, "reason": printed(units.said(result.reason)), "rows": rows,
            "curves": [_equation(group, units) for group in groups.values()]}


def _row(where, part, units):
    return {"where": printed(where), "linear": part.linear, "verdict": part.verdict,
            "because": printed(units.said(part.reason)), "css": css(part.verdict)}


def _fold(curve, at, units):
    """A point between two pieces of a curve, with its verdict where it has one."""
    where = units.vector(at[:3], units.rates)
    result = next((sample for sample in curve.samples
                  if tuple(sample.at[:3]) == tuple(at[:3]) and sample.linear == "degenerate"), None)
    if result is None:
        blank = dict.fromkeys(("verdict", "because", "css"), "")
        return {"where": printed(f"fold at {where}"), "linear": "degenerate"} | blank
    return _row(f"{'fold' if result.reason.says(*FOLDS) else 'meeting point'} at {where}", result, units)


def _name(text, units):
    """The name of a curve without the range of its parameter, which its pieces tell."""
    return called(text.name.without(FOR_ANGLES), units)


def _equation(group, units):
    """(names, the equation that curves share with its unit, their parametrisations without ranges)."""
    names = list(dict.fromkeys(_name(text, units) for text in group))
    phrases = [units.said(text.parametrisation.without(OVER_RATE)) for text in group]
    measured = not units.scaled and holds_rates(group[0].equation)
    return (printed(" and ".join(names) if len(names) < 3 else f"{names[0]} to {names[-1]}"),
            printed(units.said(group[0].equation)) + (f" (ω in {units.rates[0]})" if measured else ""),
            list(dict.fromkeys(map(printed, phrases))))


def _piece(text, pair, units):
    """Between which values of its parameter a piece of a curve lies, with the parameter's name and unit."""
    return _between(text.symbol, pair, *(units.of(text.unit) if text.unit else ("", 1.0)))


def _between(name, pair, unit, item):
    """Both ends of a piece with as many digits as distinguish them; an end that is none is left out."""
    low, high = next(ends for digits in (DIGITS, 8, 10, 17)
                     if (ends := [number(t * item, digits) for t in pair])[0] != ends[1] or digits == 17)
    if math.isinf(pair[0]):
        return f"every {name}" if math.isinf(pair[1]) else f"{name} below {high} {unit}".rstrip()
    span = f"above {low}" if math.isinf(pair[1]) else f"from {low} to {high}"
    return f"{name} {span} {unit}".rstrip()


def sensitivity(item, units) -> dict:
    """Of a subject (`plot.subject`) with a case and a motion: rows (what changes, by how much, in which
    direction, what is to be said) and sentences on wheels, thrusters and a tilt of the torque. A tilt is that
    of the motion; where it has none, the command that asks for one is named. An empty table comes with the
    reason.
    """
    case, motion = item.case, item.motion
    try:
        row = item.stuck
    except InputError as error:
        return {"rows": _of_motion(case.scene, motion, units), "words": [],
                "reason": printed(f"No margin of wheel or torque: {units.axes.sentence(str(error))}.")}
    phrases = []
    if row.time_to_limit:
        limit, when = asked(stated_limit(case), units), units.clock(*row.time_to_limit)
        phrases.append(f"The limit of the case, {limit}, is reached after {when} ({row.time_level}).")
    phrases += [f"{line[0].upper()}{line[1:]}." for line in means(row, units)]
    why: dict[str, list] = {}
    for name, margin in row.margins.items():
        if margin.size is None:
            why.setdefault(margin.reason, []).append(MARGIN_LABELS[name])
    reasons = [f"No margin in {listed(names, 'or')}: {units.said(reason)}."
               for reason, names in why.items() if reason]
    rows = [_change(name, amount(name, margin.size, units), margin.direction, holds_for(margin, units))
            for name, margin in row.margins.items() if margin.size is not None]
    phrases += _tilt(case, motion if motion.tilt else row, units)
    return {"rows": rows, "words": list(map(printed, phrases)), "reason": printed(" ".join(reasons))}


def _change(name, size, along, because):
    """A row; a component of the direction that is rounding is zero."""
    direction = vector([0.0 if abs(v) < ROUNDING else v for v in along]) if along else ""
    return {"what": MARGIN_LABELS[name], "size": printed(size), "direction": printed(direction),
            "because": printed(because)}


def _of_motion(scene, motion, units):
    """The margin that the motion itself has, where nothing more can be asked."""
    if motion.margin_velocity is None or motion.velocity_witness is None:
        return []
    change = [b - a for a, b in zip(motion.at[:3], motion.velocity_witness)]
    size, because = math.hypot(*change), [_explained(motion, units)]
    along = [v / size for v in change] if size else None
    reduced = reduce(effective(scene))
    if reduced is not None and reduced.geometry.centred and (not reduced.sense or potential(reduced).walled):
        because.append("this does not change the fate: beyond the separatrix motions are bounded too, "
                       "about other centres or round the axis")
    size = units.rate(motion.margin_velocity, side=-bool(motion.velocity_reason))
    return [_change("rate", size, along, "; ".join(filter(None, because)))]


def _tilt(case, answer, units):
    """What a tilt of the torque does; answer: what was asked with it."""
    text = [f"{limiting.words(caveat, units)}." for caveat in answer.caveats if caveat.kind is Kind.TILT]
    text = [("This " if item.startswith("holds") else "") + item for item in text]
    if answer.tilt is None:
        return [f"{item} {ASK_TILT}" for item in text]
    if answer.tilt.ranges:
        return text
    lines = [" ".join(line.split()) for line in tilt_lines(case, answer, units)]
    return [*text, "; ".join(lines) + "."]
