"""Motions in words: the numbers of one, its attitude, rest on a circular orbit.

A motion's lines say where it starts, how far its rates go, its margins and period, and why, every number
with its unit. Attitude and circular orbit have JSON here as well."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING

from ...equilibrium.circular_orbit import yaw_pitch_roll
from ...orbit.result import HEADS, Motion
from ...physics.symmetric_top import FAST, SLOW
from ...reasons import outward
from ...representation import values_of
from .. import ending, frame, limiting
from ..axes import axes_of
from ..terminal import lettered
from ..units import DEG, DIGITS, SHORT, Units, as_bound, but_for_rounding, number, vector
from .headline import largest_key, rate_margin, span_words

if TYPE_CHECKING:
    from ...answers.turning.result import Attitude
    from ...case.read import Case
    from ...physics.symmetric_top import TopRates

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


def row(name: str, text: str) -> str:
    """A name in its column, then the words."""
    return f"  {name:<{WIDE - 1}} {text}".rstrip()


Row = tuple[str, str]  # a name, or "" where its words go on, and the words


def in_columns(rows: Iterable[str | Row]) -> list[str]:
    """Lines of a text: names in their column with their words, and sentences as they are."""
    return [item if isinstance(item, str) else row(*item) for item in rows]


def table(case: Case, motion: Motion, units: Units) -> list[str]:
    """The start, the extremes, the bounds for all times, margins and period, a line each."""
    return [row("start", state(motion.at, units, case.scene.blocks)), *extreme_lines(case, motion, units),
            *bound_lines(case, motion, units),
            *(row(name, text) for name, text in margins(motion, units))]


def margins(motion: Motion, units: Units) -> list[tuple[str, str]]:
    """(name, words) of margins and period, as far as they are known."""
    energy = motion.margin_energy
    result = (("margin, rate", rate_margin(motion, units, DIGITS)),
             ("margin, energy", "" if energy is None else energy_margin(energy, units.energy)),
             *energy_integral(motion, units),
             ("period", "" if motion.period is None else units.time(motion.period)),
             ("time constants", ending.constants(motion.ending, units)), *top_rows(motion.top, units))
    return [(name, text) for name, text in result if text]


def energy_integral(motion: Motion, units: Units) -> list[tuple[str, str]]:
    """The paper's energy integral, its value on the separatrix and the difference; in scaled variables."""
    result = motion.energy_integral
    if result is None:
        return []
    text = number(result.value, DIGITS) + ("" if units.scaled else ", scaled variables")
    if result.difference is None:
        text += "; no saddle stands ahead"
    else:
        more = "more" if result.difference > 0 else "less"
        text += (f"; on the separatrix {result.name}s = {number(result.on_separatrix, DIGITS)}"
                  + (f", {number(abs(result.difference), DIGITS)} {more}" if result.difference else ""))
    if result.turned_about is not None:
        text += f"; of the state turned by half about axis {result.turned_about}, as the torque is negative"
    return [(f"energy integral {result.name}", text)]


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
    printed = [] if len(when) < WIDE else [f"  {when}:"]
    return [*printed, f"  {'' if printed else when + ',':<{WIDE}}{'least':>12}{'greatest':>14}"]


def pair_lines(case: Case, pairs: Sequence[tuple[float, float]], units: Units, side: int = 0) -> list[str]:
    """A line a component: its name, least, greatest, unit. side: 1 of bounds, which are rounded outward."""
    name, item = units.rates
    return [f"    {lettered(component):<{WIDE - 2}}{shown(low, item, side=-side):>12}"
            f"{shown(high, item, side=side):>14}  {name}".rstrip()
            for component, (low, high) in zip(case.scene.components, pairs)]


def shown(value: float | None, item: float = 1.0, digits: int = DIGITS, side: int = 0) -> str:
    """A number of a column; a word where it is unbounded or unknown. side: as of `Units.told`."""
    if value is None:
        return "unknown"
    # its column says downwards or upwards
    return "unbounded" if math.isinf(value) else number(as_bound(value, item, digits, side), digits)


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
    rows = [((*(QUANTITIES | reduced)[name], 0)[:3], value) for part in (motion.invariants, motion.evidence)
             for name, value in part.items()
             if value is not None and (name, value) != ("steps", 0)]  # a law needed no run
    return [(name.replace("ω", "x") if units.scaled else name, quantity(kind, value, units, side))
            for (name, kind, side), value in rows]


def quantity(kind: str, value, units: Units, side: int = 0) -> str:
    """An invariant, or what a run showed, with its unit. side: of a bound, as of `Units.told`."""
    if kind == "rates":
        return units.vector(value, units.rates)
    if kind == "direction":
        return vector(value)
    if kind in ("moment", "reversal") and isinstance(value, float):
        printed = units.moment(value, side=side) if units.scaled else units.time(value, side=side)
        return printed if value or kind == "moment" else "none after the start"
    if not kind or not isinstance(value, float):
        return number(value, DIGITS) if isinstance(value, float) else MEANINGS.get(str(value), str(value))
    if kind == "s":
        return units.time(value)
    per = " per unit of τ" * (units.scaled and kind.endswith(")^2/s"))
    return units.told(value, units.of(kind), side=side) + per


def tilt_lines(case, motion, units: Units, proofs: bool = False) -> list[str]:
    """What a tilt of the torque does, or how to ask for it."""
    result = motion.tilt
    if result is None or result.ranges:
        request = result is None and not units.scaled and limiting.condition(motion.caveats, units)
        return [row("off that axis", TILTED)] if request else []
    declared = "" if result.stated else ", twice the largest of this motion (no limit is stated)"
    limit = f"|ω| = {units.rate(result.limit)}{declared}"
    lines = [f"  tilted by {DEG.angle(result.angle)}: {result.of}, to {limit}"]
    if result.ends:
        lines.append(f"    shortest time found   {units.clock(result.low, result.high)} ({result.level})")
        if proofs:
            lines.append(f"    at azimuth            {DEG.angle(result.azimuth)}, torque "
                         f"{units.vector(result.torque, units.of('N m'))}")
    else:
        many, far = len(result.times), units.time(result.followed, side=-1)
        printed = (f"{many} azimuths were followed for {far} or more" if many > 1
                else f"one azimuth was followed for {far}, which is before it can be reached")
        lines.append(f"    shortest time found   none: {printed}")
    return [*lines,
            f"    not before            {units.time(result.not_before, side=-1)}, whatever the azimuth and "
            f"for any smaller tilt (proved)"]


def flips_dict(case, m) -> dict | None:
    """How often it turns over: axis and times (s) from one flip to the next; null where it does not, or where
    that is not known."""
    return m.flips and {**axes_of(case).key(m.flips.axis), "times": m.flips.times}


def followed(m) -> dict:
    """How well a fate is known; of a motion that was followed also when its certificate held (null: it did
    not), what was seen on the way, and the bounds of the rates for all times (null in them: unbounded); of
    an equilibrium its stability."""
    resolved = {"level": m.level} | ({} if m.stability is None else {"stability": values_of(
        m.stability, "verdict because growth")})
    if m.cause:
        resolved |= {"t": m.evidence.get("t_certificate"), "cause": m.cause, "bounds": m.bounds}
    return resolved


def numbers(m) -> dict:
    """What a text prints of a motion, in SI: null where it is not known, or was not asked."""
    return {"largest_rate": largest_key(m), "period": m.period,
            **values_of(m, "extremes extremes_over bounds"),
            "margin": {"energy": m.margin_energy, "rate": m.margin_velocity, "bounds": m.velocity_bounds},
            **values_of(m, "invariants evidence"),
            "energy_integral": None if m.energy_integral is None else asdict(m.energy_integral)}


# --- How it turns in space
# of a lean: whether it stays near that of a steady precession
STAYS = {True: "stable", False: "unstable", None: "of undecided stability"}
MODES = {"long-axis": "LONG-AXIS MODE", "short-axis": "SHORT-AXIS MODE", "separatrix": HEADS["separatrix"],
         "steady": HEADS["equilibrium"], "heavy top": "HEAVY TOP",
         "top in a field": "TOP IN A FIELD"}


def attitude_objects(rows) -> dict:
    """The object of `stabilab attitude --json`: a row a case, vectors in the frame of the file, s and rad."""
    return {"schema": "stabilab.attitude/1", "rows": rows}


def attitude_object(case, result) -> dict:
    """A row of it."""
    return {"case": case.name} | row_of(case, result)


def row_of(case: Case, item: Attitude) -> dict:
    """One motion; null is what it does not have."""
    return {"at": item.at, "fate": item.fate.word,
            **values_of(item, "rotation_period precession_period mode momentum"),
            "momentum_direction": in_file(case, item.momentum_direction),
            **values_of(item, "cone lean nutation_period turn_angle"), **top_key(item.top),
            "turn_axis": in_file(case, item.turn_axis),
            **values_of(item, "error decimals because"),
            "reason": item.reason.as_dict() if item.reason else None
            } | limiting.key(case, item.caveats) | frame.key(case)


def in_file(case: Case, along: Sequence[float]):
    """A vector along the principal axes in the frame of the file."""
    return frame.back(case, along) or along


def attitude_text(case, result, units: Units) -> str:
    """The answer first, then the numbers and why."""
    head, *rest = _answer(result, units)
    rest += [limiting.unstable(result.caveats, units), limiting.tilted(result.caveats, units)]
    lines = [f"{case.name}: " + limiting.fitted(lambda short: "; ".join(filter(None, [
        head + limiting.condition(result.caveats, units, short=short), *rest])), len(case.name) + 2)]
    if result.momentum_direction is not None:
        lines.append(row("angular momentum", f"{number(result.momentum, DIGITS)} N m s along "
                                             f"{_vector(case, result.momentum_direction)}"))
    if result.cone is not None:
        low, high = (units.angle(angle) for angle in result.cone)
        named = (result.mode or "").partition("-")[0]
        lines.append(row("cone", f"{low} to {high} between it and the {named} axis"))
    if result.lean is not None:
        low, high = (units.angle(angle) for angle in result.lean)
        lines.append(row("lean", f"{low} to {high} from the upward vertical" if low != high else
                         f"{low} from the upward vertical, always"))
    lines += [row(*fact) for fact in top_rows(result.top, units)]
    if result.turn_angle is not None:
        about = f" about {_vector(case, result.turn_axis)}" if result.turn_axis else ""
        lines.append(row("turn after one period", units.angle(result.turn_angle) + about))
    for name, digits in (result.decimals or {}).items():
        lines.append(row(name.replace("_", " "), f"{digits} s"))
    if result.error is not None and result.decimals is None:
        lines.append(row("relative error", f"at most {outward(result.error, 1, 1):.0e}"))
    return "\n".join([*lines, f"why: {units.said(result.reason)}", *frame.note(case)])


def top_key(top: TopRates | None) -> dict:
    """What is known of the spin of a top and its lean, in rad/s, rad and s, under `top`; nothing of other
    bodies."""
    return {} if top is None else {"top": {
        "spin": top.spin, "lean": top.lean, "steady_precession": list(top.steady),
        "steady_stable": list(top.stable),
        "steady_nutation_periods": [rate and 2 * math.pi / rate for rate in top.nutation],
        "least_spins": top.spins,
        "unstable_upright": top.upright, "unstable_hanging": top.hanging}}


def top_rows(top: TopRates | None, units: Units) -> list[tuple[str, str]]:
    """(name, words) of its steady precessions, and from which spin on it stays upright."""
    if top is None:
        return []
    lean, spin = units.angle(top.lean), units.rate(top.spin)
    rows = []
    if top.steady:
        rows.append(("steady precession", f"{_precessions(top, units)} at a lean of {lean} and a spin of "
                                          f"{spin}"))
        if nutations := _nutations(top, units):
            rows.append(("small nutation", f"period {nutations}"))
    elif top.spins is not None:
        rows.append(("steady precession", f"none at a lean of {lean} and a spin of {spin}, only "
                                          f"{_outside(top.spins, units)}"))
    for name, unstable in (("upright", top.upright), ("hanging", top.hanging)):
        if unstable is not None:
            # a spin is counted about the axis to the centre of mass, which may be that against z
            now = "" if unstable[0] == -unstable[1] else f" (now {spin})"
            rows.append((name, f"stable {_outside(unstable, units)}{now}"))
        elif name == "upright":
            rows.append((name, "stable at every spin"))
    return rows


def _named(top: TopRates) -> tuple[str, ...]:
    """What each rate is called, where there are two."""
    return (f"{SLOW} ", f"{FAST} ") if len(top.steady) == 2 else ("",)


def _precessions(top: TopRates, units: Units) -> str:
    """The rates, the slow one first, with their stability."""
    words = [STAYS[stable] for stable in top.stable]
    rates = [f"{name}{units.rate(rate, SHORT)}" for name, rate in zip(_named(top), top.steady)]
    if len(set(words)) == 1:
        return f"{' or '.join(rates)}, {'both ' * (len(words) == 2)}{words[0]},"
    return " or ".join(f"{rate} ({word})" for rate, word in zip(rates, words))


def _nutations(top: TopRates, units: Units) -> str:
    """The periods of small nutations about the stable ones; nothing where there are none."""
    return ", ".join(f"{units.time(2 * math.pi / rate)}{name and f' about the {name.strip()} one'}"
                     for name, rate in zip(_named(top), top.nutation) if rate)


def _outside(ends: tuple[float, float], units: Units) -> str:
    low, high = ends
    if low == -high:
        return f"from a spin of {units.rate(high)} on, either direction"
    return f"at spins below {units.rate(low)} and above {units.rate(high)}"


def attitude_rows(result: Attitude | None, units: Units) -> list[tuple[str, str]]:
    """(name, words) of the periods, for the lines of another answer; "found" None: nothing."""
    if result is None:
        return []
    times = (("rotation period", result.rotation_period), ("precession period", result.precession_period))
    return [*([("mode", result.mode)] if result.mode else []),
            *((name, units.time(time)) for name, time in times if time is not None)]


def _answer(result, units):
    time = "" if result.rotation_period is None else f" {units.time(result.rotation_period)}"
    yield MODES.get(result.mode, f"ROTATION PERIOD{time}" if time else "NO ROTATION PERIOD")
    if result.lean is not None:
        low, high = (units.angle(angle, SHORT) for angle in result.lean)
        yield f"leaning by {low} to {high}" if low != high else f"leaning by {low}"
    if time and result.mode in MODES:
        yield f"rotation period{time}"
    if result.nutation_period is not None:
        yield f"nutation period {units.time(result.nutation_period)}"
    if result.precession_period is not None:
        yield f"mean precession period {units.time(result.precession_period)}"
    elif result.nutation_period is not None:
        yield "no precession, for its axis passes through the vertical"


def _vector(case: Case, along: Sequence[float]) -> str:
    location = "in the frame of the file" if frame.back(case, along) else "along axes 1, 2, 3"
    return f"{vector(in_file(case, along))} {location}"


# --- Equilibria on a circular orbit
ASSUMED = ("a circular orbit about a sphere, wheels whose momentum relative to the body is constant, no "
           "other torque")


def circular_orbit_dict(case, out) -> dict:
    """The object of `stabilab orbit --json`: SI units, vectors in the frame of the file."""
    result = out.equilibria
    return {"schema": "stabilab.orbit/1", "case": case.name, **values_of(out, "rate period moments"),
            "momentum": in_file(case, out.momentum), "kind": result.kind, "reason": result.because,
            "why": result.reason.as_dict(),
            "equilibria": [{"number": n} | _object(case, out, point)
                           for n, point in enumerate(result.points, 1)],
            "families": [_object(case, out, item)
                         | {"family": item.family, "consists": item.consists.as_dict(),
                            "axis": item.axis and in_file(case, item.axis)} for item in result.families],
            "momentum_spans": None if out.spans is None else
            [{"low": span.low, "high": span.high, "families" if span.families else "equilibria": span.count,
              "minima": span.minima} for span in out.spans]}


def _object(case, result, item) -> dict:
    frame = _frame(case, item)
    return {**dict(zip(("velocity", "normal", "vertical"), frame)), "yaw_pitch_roll": yaw_pitch_roll(*frame),
            **values_of(item, "linear verdict because minimum eigenvalues frequencies"),
            "reason": item.reason.as_dict(),
            "growth_time": grows_in(item), "per_orbit": [f / result.rate for f in item.frequencies],
            "potential": item.potential}


def grows_in(item) -> float | None:
    """In which time a disturbance grows by the factor e, s; None where none does exponentially."""
    rate = max((complex(z).real for z in item.eigenvalues), default=0.0)
    return 1 / rate if item.verdict == "unstable" and rate > 0 else None


def _frame(case, item):
    """The orbital frame in the frame of the file."""
    return tuple(tuple(in_file(case, along)) for along in (item.velocity, item.normal, item.vertical))


def circular_orbit_text(case, out, units: Units) -> str:
    """The answer first, then each pair of equilibria, and why."""
    return "\n".join([f"{case.name}: {orbit_headline(out.equilibria)}",
                      *in_columns(circular_orbit_rows(case, out, units))])


def circular_orbit_rows(case, out, units: Units) -> list[str | Row]:
    """What stands below the answer: rows, and sentences without a name."""
    result = out.equilibria
    rows: list[str | Row] = [("orbit", f"rate {units.rate(out.rate)}, period {units.time(out.period)}"),
                             ("wheels", units.vector(in_file(case, out.momentum), ("N m s", 1.0)))]
    for number_, family in enumerate(result.points[::2]):
        rows += _lines(case, out, family, units, f"{2 * number_ + 1} and {2 * number_ + 2}",
                       result.points[2 * number_ + 1])
    for family in result.families:
        rows += [("family", units.said(family.consists)), *_lines(case, out, family, units, "one of it")]
    for span in out.spans or ():
        kind = "families" if span.families else "equilibria"
        rows.append(("momentum", f"{number(span.low, DIGITS)} to {number(span.high, DIGITS)} N m s: "
                                 f"{span.count} {kind}, {span.minima} of them stable (Lyapunov)"))
    reasons = dict.fromkeys((item.verdict, item.reason) for item in (*result.points, *result.families))
    return [*rows, f"why: {units.said(result.reason)}",
            *(f"  {verdict}: {units.said(because)}" for verdict, because in reasons), f"assumed: {ASSUMED}"]


def orbit_headline(result) -> str:
    """The answer of a satellite on a circular orbit in one line."""
    if result.kind == "all":
        return "EVERY ATTITUDE IS AN EQUILIBRIUM"
    stable = sum(family.verdict == "stable" for family in result.families)
    families = f"{len(result.families)} FAMILIES OF EQUILIBRIA, {stable} STABLE" if result.families else ""
    if result.families and not result.points:
        return families
    gyroscopic = sum(point.verdict == "undecided" and point.linear == "stable" for point in result.points)
    more = [*([f"{gyroscopic} undecided (gyroscopically stable)"] if gyroscopic else []),
            *([families] if families else [])]
    return ", ".join([f"{len(result.points)} EQUILIBRIA, {result.count('stable')} STABLE", *more])


def _lines(case, result, item, units: Units, name: str, other=None):
    """An attitude (and the other of its pair), its verdict and librations."""
    pair = (yaw_pitch_roll(*_frame(case, each)) for each in (item, other) if each is not None)
    angles = " and ".join(units.vector(each, units.angles)
                          for each in sorted(pair, key=lambda angles: sum(map(abs, angles))))
    word = item.verdict if item.linear != "degenerate" else f"{item.verdict}, degenerate"
    yield (name, f"{word}: yaw, pitch, roll {angles}")
    if (grows := grows_in(item)) is not None:
        yield ("", f"a disturbance grows e-fold in {units.time(grows, SHORT)}")
        return
    _, normal, vertical = map(vector, _frame(case, item))
    yield ("", f"orbit normal {normal}, up {'+-' if other else ''}{vertical} in the body")
    if item.frequencies:
        yield ("", f"librations {units.vector(item.frequencies, units.rates)[1:].replace(')', '')}, "
                      f"{', '.join(number(f / result.rate, DIGITS) for f in item.frequencies)} per orbit")
