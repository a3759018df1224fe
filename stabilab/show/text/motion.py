"""Motions in words: the numbers of one, its attitude, rest on a circular orbit.

A motion's lines say where it starts, how far its rates go, its margins and period, and why, every number
with its unit. Attitude and circular orbit have JSON here as well."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

from ...equilibrium.circular_orbit import yaw_pitch_roll
from ...orbit.result import HEADS, Motion
from ...reasons import outward
from ...representation import values_of
from .. import frame, limiting
from ..axes import axes_of
from ..terminal import lettered
from ..units import DEG, DIGITS, SHORT, Units, as_bound, but_for_rounding, number, vector
from .headline import largest_key, rate_margin, span_words

if TYPE_CHECKING:
    from ...answers.attitude_result import Attitude
    from ...case.read import Case

# --- The numbers of a motion
WIDE = 24  # columns of a name
# Of invariants and of what a run showed: what it is called, its unit in SI or what else it is, and of a bound
# its side.
QUANTITIES = {
    "Q": ("invariant Q", "(rad/s)^2"), "energy": ("energy", "J"), "momentum": ("angular momentum", "N m s"),
    "rate_bound": ("|ω| never exceeds", "rad/s", 1),
    "late_rate_bound": ("|ω| in the end at most", "rad/s", 1),
    "J": ("J of the law", "(N m s)^2"), "J_rate": ("J changes by", "(N m s)^2/s"),
    "span": ("followed for", "s"), "size_start": ("|ω| at the start", "rad/s"),
    "size_end": ("|ω| at the end", "rad/s"), "size_largest": ("largest |ω| seen", "rad/s"),
    "energy_start": ("energy at the start", "J"), "energy_end": ("energy at the end", "J"),
    "energy_change": ("change of energy", "J"), "t_certificate": ("certificate holds from", "moment", 1),
    "followed_until": ("followed until", "moment", -1),
    "release_time": ("last reversal of the turn", "reversal"),
    "release_estimate": ("barrier gone by about", "moment"), "rate_end": ("rates at the end", "rates"),
    "vertical_end": ("vertical at the end", "direction"),
    "energy_trend": ("the energy", ""), "certificate": ("how it is certified", ""),
    "steps": ("steps of the run", ""), "invariant_drift": ("first integrals vary by", ""),
    "steps_followed": ("steps of the certified run", ""),
    "small_change_grew": ("a small change grew by a factor of", "")}
MEANINGS = {  # of a word among them
    "well": "the barrier ahead outgrows the energy", "spin-up": "the turn can reverse no more",
    "bound": "a bound of the rate that grows for ever", "axis": "a pure spin about the torque",
    "law": "an exact law of the motion", "none": "not at all",
    "rises": "higher in the last quarter of the run than ever in the first",
    "falls": "lower in the last quarter of the run than ever in the first",
    "oscillates": "up and down: the last quarter of the run overlaps with the first"}
TILTED = 'any tilt of the torque may end this: --tilt "1 deg" says how soon'


def row(name: str, words: str) -> str:
    """A name in its column, then the words."""
    return f"  {name:<{WIDE - 1}} {words}".rstrip()


def table(case: Case, motion: Motion, units: Units) -> list[str]:
    """The start, the extremes, the bounds for all times, margins and period, a line each."""
    return [row("start", state(motion.at, units, case.scene.blocks)), *extreme_lines(case, motion, units),
            *bound_lines(case, motion, units),
            *(row(name, words) for name, words in margins(motion, units))]


def margins(motion: Motion, units: Units) -> list[tuple[str, str]]:
    """(name, words) of margins and period, as far as they are known."""
    energy = motion.margin_energy
    found = (("margin, rate", rate_margin(motion, units, DIGITS)),
             ("margin, energy", "" if energy is None else energy_margin(energy, units.energy)),
             *energy_integral(motion, units),
             ("period", "" if motion.period is None else units.time(motion.period)))
    return [(name, words) for name, words in found if words]


def energy_integral(motion: Motion, units: Units) -> list[tuple[str, str]]:
    """The paper's energy integral, its value on the separatrix and the difference; in scaled variables."""
    found = motion.energy_integral
    if found is None:
        return []
    words = number(found.value, DIGITS) + ("" if units.scaled else ", scaled variables")
    if found.difference is None:
        words += "; no saddle stands ahead"
    else:
        more = "more" if found.difference > 0 else "less"
        words += (f"; on the separatrix {found.name}s = {number(found.on_separatrix, DIGITS)}"
                  + (f", {number(abs(found.difference), DIGITS)} {more}" if found.difference else ""))
    return [(f"energy integral {found.name}", words)]


def state(at, units: Units, blocks=("omega", "gamma")) -> str:
    """The rates of a state with their unit; the vertical, and the rates of a damper, after them, where they
    are part of it. blocks: of the scene."""
    rest = at[3:]
    vertical = f", γ = {units.vector(rest[:3], ('', 1.0))}" if rest and "gamma" in blocks else ""
    damper = f", σ = {units.vector(rest[-3:], units.rates)}" if rest and "damper" in blocks else ""
    return units.vector(at[:3], units.rates) + vertical + damper


def energy_margin(value: float, tell: Callable[[float], str]) -> str:
    """The energy missing to the barrier, or by how much it is above. tell: of a size, with its unit."""
    return f"{tell(-value)} above the barrier" if value < 0 else tell(value)


def extreme_lines(case: Case, motion: Motion, units: Units) -> list[str]:
    """Least and greatest of every component under a head that says over which time."""
    pairs = but_for_rounding(motion.extremes, motion.tolerance)
    if pairs is None:
        return []
    when = span_words(motion.over, units)
    return [*_head(when if motion.for_all_time else when.removeprefix("over ")),
            *pair_lines(case, pairs, units, motion.extremes_side)]


def _head(when: str) -> list[str]:
    """Over which time, beside the heads of the columns, or above them where it is longer than its column."""
    told = [] if len(when) < WIDE else [f"  {when}:"]
    return [*told, f"  {'' if told else when + ',':<{WIDE}}{'least':>12}{'greatest':>14}"]


def pair_lines(case: Case, pairs: Sequence[tuple[float, float]], units: Units, side: int = 0) -> list[str]:
    """A line a component: its name, least, greatest, unit. side: 1 of bounds, which are rounded outward."""
    name, one = units.rates
    return [f"    {lettered(component):<{WIDE - 2}}{shown(low, one, side=-side):>12}"
            f"{shown(high, one, side=side):>14}  {name}".rstrip()
            for component, (low, high) in zip(case.scene.components, pairs)]


def shown(value: float | None, one: float = 1.0, digits: int = DIGITS, side: int = 0) -> str:
    """A number of a column; a word where it is unbounded or unknown. side: as of `Units.told`."""
    if value is None:
        return "unknown"
    # its column says downwards or upwards
    return "unbounded" if math.isinf(value) else number(as_bound(value, one, digits, side), digits)


def bound_lines(case: Case, motion: Motion, units: Units) -> list[str]:
    """The bounds of the rates for all times, where they are not the extremes given already."""
    if motion.bounds is None or motion.bounds == motion.extremes:
        return []
    return [*_head("bounds for all times"), *pair_lines(case, motion.bounds, units, 1)]


def why(case: Case, motion: Motion, units: Units, proofs: bool) -> list[str]:
    """The reason; with `proofs` also what is not known of the margin, invariants, and what a run showed."""
    lines = [f"why: {units.said(motion.reason)}"]
    if motion.ending is not None:
        lines.append(f"  its end: {units.said(motion.ending.reason)}")
    if proofs and motion.velocity_reason:
        rate = "" if motion.velocity_bounds else "margin, rate: "
        lines.append(f"  {rate}{units.said(motion.velocity_reason)}")
    if proofs:
        lines += [row(*fact) for fact in constants(motion, units)]
    return lines


def constants(motion: Motion, units: Units) -> list[tuple[str, str]]:
    """(name, words) of the invariants and of what a run showed. A potential is in the energy of a reduced
    motion, and none of its parts is that of the whole body."""
    reduced = {"energy": ("energy, reduced motion", "J")} if "Q" in motion.invariants else {}
    found = [((*(QUANTITIES | reduced)[name], 0)[:3], value) for part in (motion.invariants, motion.evidence)
             for name, value in part.items()
             if value is not None and (name, value) != ("steps", 0)]  # a law needed no run
    return [(name.replace("ω", "x") if units.scaled else name, quantity(kind, value, units, side))
            for (name, kind, side), value in found]


def reason(words: str, units: Units) -> str:
    """Words of the analysis: names as letters, rates and times in these units."""
    return lettered(units.words(words))


def quantity(kind: str, value, units: Units, side: int = 0) -> str:
    """An invariant, or what a run showed, with its unit. side: of a bound, as of `Units.told`."""
    if kind == "rates":
        return units.vector(value, units.rates)
    if kind == "direction":
        return vector(value)
    if kind in ("moment", "reversal") and isinstance(value, float):
        told = units.moment(value, side=side) if units.scaled else units.time(value, side=side)
        return told if value or kind == "moment" else "none after the start"
    if not kind or not isinstance(value, float):
        return number(value, DIGITS) if isinstance(value, float) else MEANINGS.get(str(value), str(value))
    if kind == "s":
        return units.time(value)
    per = " per unit of τ" * (units.scaled and kind.endswith(")^2/s"))
    return units.told(value, units.of(kind), side=side) + per


def tilt_lines(case, motion, units: Units, proofs: bool = False) -> list[str]:
    """What a tilt of the torque does, or how to ask for it."""
    found = motion.tilt
    if found is None or found.ranges:
        asked = found is None and not units.scaled and limiting.condition(motion.caveats, units)
        return [row("off that axis", TILTED)] if asked else []
    stated = "" if found.stated else ", twice the largest of this motion (no limit is stated)"
    limit = f"|ω| = {units.rate(found.limit)}{stated}"
    lines = [f"  tilted by {DEG.angle(found.angle)}: {found.of}, to {limit}"]
    if found.ends:
        lines.append(f"    shortest time found   {units.clock(found.low, found.high)} ({found.level})")
        if proofs:
            lines.append(f"    at azimuth            {DEG.angle(found.azimuth)}, torque "
                         f"{units.vector(found.torque, units.of('N m'))}")
    else:
        many, far = len(found.times), units.time(found.followed, side=-1)
        told = (f"{many} azimuths were followed for {far} or more" if many > 1
                else f"one azimuth was followed for {far}, which is before it can be reached")
        lines.append(f"    shortest time found   none: {told}")
    return [*lines,
            f"    not before            {units.time(found.not_before, side=-1)}, whatever the azimuth and "
            f"for any smaller tilt (proved)"]


def flips_dict(case, m) -> dict | None:
    """How often it turns over: axis and times (s) from one flip to the next; null where it does not, or where
    that is not known."""
    return m.flips and {**axes_of(case).key(m.flips.axis), "times": m.flips.times}


def followed(m) -> dict:
    """How well a fate is known; of a motion that was followed also when its certificate held (null: it did
    not), what was seen on the way, and the bounds of the rates for all times (null in them: unbounded); of
    an equilibrium its stability."""
    known = {"level": m.level} | ({} if m.stability is None else {"stability": values_of(
        m.stability, "verdict because growth")})
    if m.cause:
        known |= {"t": m.evidence.get("t_certificate"), "cause": m.cause, "bounds": m.bounds}
    return known


def numbers(m) -> dict:
    """What a text prints of a motion, in SI: null where it is not known, or was not asked."""
    return {"largest_rate": largest_key(m), "period": m.period,
            **values_of(m, "extremes extremes_over bounds"),
            "margin": {"energy": m.margin_energy, "rate": m.margin_velocity, "bounds": m.velocity_bounds},
            **values_of(m, "invariants evidence"),
            "energy_integral": None if m.energy_integral is None else asdict(m.energy_integral)}


# --- How it turns in space
MODES = {"long-axis": "LONG-AXIS MODE", "short-axis": "SHORT-AXIS MODE", "separatrix": HEADS["separatrix"],
         "steady": HEADS["equilibrium"], "heavy top": "HEAVY TOP"}


def attitude_objects(rows) -> dict:
    """The object of `stabilab attitude --json`: a row a case, vectors in the frame of the file, s and rad."""
    return {"schema": "stabilab.attitude/1", "rows": rows}


def attitude_object(case, found) -> dict:
    """A row of it."""
    return {"case": case.name} | row_of(case, found)


def row_of(case: Case, one: Attitude) -> dict:
    """One motion; null is what it does not have."""
    return {"at": one.at, "fate": one.fate.word,
            **values_of(one, "rotation_period precession_period mode momentum"),
            "momentum_direction": in_file(case, one.momentum_direction),
            **values_of(one, "cone lean nutation_period turn_angle"),
            "turn_axis": in_file(case, one.turn_axis),
            **values_of(one, "error decimals because"),
            "reason": one.reason.as_dict() if one.reason else None
            } | limiting.key(case, one.caveats) | frame.key(case)


def in_file(case: Case, along: Sequence[float]):
    """A vector along the principal axes in the frame of the file."""
    return frame.back(case, along) or along


def attitude_text(case, found, units: Units) -> str:
    """The answer first, then the numbers and why."""
    condition = limiting.condition(found.caveats, units)
    departs = limiting.unstable(found.caveats, units)
    told = f"{case.name}: {', '.join(_answer(found, units))}{',' * bool(condition)}{condition}"
    lines = ["; ".join(filter(None, (told, departs, limiting.tilted(found.caveats, units))))]
    if found.momentum_direction is not None:
        lines.append(row("angular momentum", f"{number(found.momentum, DIGITS)} N m s along "
                                             f"{_vector(case, found.momentum_direction)}"))
    if found.cone is not None:
        low, high = (units.angle(angle) for angle in found.cone)
        named = (found.mode or "").partition("-")[0]
        lines.append(row("cone", f"{low} to {high} between it and the {named} axis"))
    if found.lean is not None:
        low, high = (units.angle(angle) for angle in found.lean)
        lines.append(row("lean", f"{low} to {high} from the upward vertical" if low != high else
                         f"{low} from the upward vertical, always"))
    if found.turn_angle is not None:
        about = f" about {_vector(case, found.turn_axis)}" if found.turn_axis else ""
        lines.append(row("turn after one period", units.angle(found.turn_angle) + about))
    for name, digits in (found.decimals or {}).items():
        lines.append(row(name.replace("_", " "), f"{digits} s"))
    if found.error is not None and found.decimals is None:
        lines.append(row("relative error", f"at most {outward(found.error, 1, 1):.0e}"))
    return "\n".join([*lines, f"why: {units.said(found.reason)}", *frame.note(case)])


def attitude_rows(found: Attitude | None, units: Units) -> list[tuple[str, str]]:
    """(name, words) of the periods, for the lines of another answer; "found" None: nothing."""
    if found is None:
        return []
    times = (("rotation period", found.rotation_period), ("precession period", found.precession_period))
    return [*([("mode", found.mode)] if found.mode else []),
            *((name, units.time(time)) for name, time in times if time is not None)]


def _answer(found, units):
    yield MODES.get(found.mode, "ROTATION PERIOD KNOWN" if found.rotation_period else "NO ROTATION PERIOD")
    if found.lean is not None:
        low, high = (units.angle(angle, SHORT) for angle in found.lean)
        yield f"leaning by {low} to {high}" if low != high else f"leaning by {low}"
    if found.rotation_period is not None:
        yield f"rotation period {units.time(found.rotation_period)}"
    if found.nutation_period is not None:
        yield f"nutation period {units.time(found.nutation_period)}"
    if found.precession_period is not None:
        yield f"mean precession period {units.time(found.precession_period)}"
    elif found.nutation_period is not None:
        yield "no precession, for its axis passes through the vertical"


def _vector(case: Case, along: Sequence[float]) -> str:
    place = "in the frame of the file" if frame.back(case, along) else "along axes 1, 2, 3"
    return f"{vector(in_file(case, along))} {place}"


# --- Equilibria on a circular orbit
ASSUMED = ("a circular orbit about a sphere, wheels whose momentum relative to the body is constant, no "
           "other torque")


def circular_orbit_dict(case, found) -> dict:
    """The object of `stabilab orbit --json`: SI units, vectors in the frame of the file."""
    result = found.equilibria
    return {"schema": "stabilab.orbit/1", "case": case.name, **values_of(found, "rate period moments"),
            "momentum": in_file(case, found.momentum), "kind": result.kind, "reason": result.because,
            "why": result.reason.as_dict(),
            "equilibria": [_object(case, found, one) for one in result.points],
            "families": [_object(case, found, one)
                         | {"family": one.family, "consists": one.consists.as_dict(),
                            "axis": one.axis and in_file(case, one.axis)} for one in result.families],
            "momentum_spans": None if found.spans is None else
            [{"low": one.low, "high": one.high, "families" if one.families else "equilibria": one.count,
              "minima": one.minima} for one in found.spans]}


def _object(case, found, one) -> dict:
    frame = _frame(case, one)
    return {**dict(zip(("velocity", "normal", "vertical"), frame)), "yaw_pitch_roll": yaw_pitch_roll(*frame),
            **values_of(one, "linear verdict because minimum eigenvalues frequencies"),
            "reason": one.reason.as_dict(),
            "per_orbit": [f / found.rate for f in one.frequencies], "potential": one.potential}


def _frame(case, one):
    """The orbital frame in the frame of the file."""
    return tuple(tuple(in_file(case, along)) for along in (one.velocity, one.normal, one.vertical))


def circular_orbit_text(case, found, units: Units) -> str:
    """The answer first, then each pair of equilibria, and why."""
    result = found.equilibria
    lines = [f"{case.name}: {_orbit_headline(result)}",
             row("orbit", f"rate {units.rate(found.rate)}, period {units.time(found.period)}"),
             row("wheels", f"{units.vector(in_file(case, found.momentum), ('N m s', 1.0))}")]
    for number_, one in enumerate(result.points[::2]):
        lines += _lines(case, found, one, units, f"{2 * number_ + 1} and {2 * number_ + 2}",
                        result.points[2 * number_ + 1])
    for one in result.families:
        lines += [row("family", units.said(one.consists)), *_lines(case, found, one, units, "one of it")]
    for span in found.spans or ():
        kind = "families" if span.families else "equilibria"
        lines.append(row("momentum", f"{number(span.low, DIGITS)} to {number(span.high, DIGITS)} N m s: "
                                     f"{span.count} {kind}, {span.minima} of them stable (Lyapunov)"))
    reasons = dict.fromkeys((one.verdict, one.reason) for one in (*result.points, *result.families))
    lines += [f"why: {units.said(result.reason)}",
              *(f"  {verdict}: {units.said(because)}" for verdict, because in reasons),
              f"assumed: {ASSUMED}"]
    return "\n".join(lines)


def _orbit_headline(result) -> str:
    if result.kind == "all":
        return "EVERY ATTITUDE IS AN EQUILIBRIUM"
    stable = sum(one.verdict == "stable" for one in result.families)
    families = f"{len(result.families)} FAMILIES OF EQUILIBRIA, {stable} STABLE" if result.families else ""
    if result.families and not result.points:
        return families
    gyroscopic = sum(one.verdict == "undecided" and one.linear == "stable" for one in result.points)
    more = [*([f"{gyroscopic} undecided (gyroscopically stable)"] if gyroscopic else []),
            *([families] if families else [])]
    return ", ".join([f"{len(result.points)} EQUILIBRIA, {result.count('stable')} STABLE", *more])


def _lines(case, found, one, units: Units, name: str, other=None):
    """An attitude (and the other of its pair), its verdict and librations."""
    pair = (yaw_pitch_roll(*_frame(case, each)) for each in (one, other) if each is not None)
    angles = " and ".join(units.vector(each, units.angles)
                          for each in sorted(pair, key=lambda angles: sum(map(abs, angles))))
    word = one.verdict if one.linear != "degenerate" else f"{one.verdict}, degenerate"
    yield row(name, f"{word}: yaw, pitch, roll {angles}")
    if one.verdict == "unstable":
        grows = max(z.real for z in one.eigenvalues)
        yield row("", f"a disturbance grows e-fold in {units.time(1 / grows, SHORT)}")
        return
    _, normal, vertical = map(vector, _frame(case, one))
    yield row("", f"orbit normal {normal}, up {'+-' if other else ''}{vertical} in the body")
    if one.frequencies:
        yield row("", f"librations {units.vector(one.frequencies, units.rates)[1:].replace(')', '')}, "
                      f"{', '.join(number(f / found.rate, DIGITS) for f in one.frequencies)} per orbit")
