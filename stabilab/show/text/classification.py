"""What `stabilab classify` prints, as text and as JSON.

Text has the answer, the motion's numbers, the equilibria, and why; proofs and algebra on request; curves of
equilibria with their numbers in the unit of rates; and what uncertain numbers do to the verdicts."""
from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import asdict, replace
from fractions import Fraction
from itertools import groupby
from typing import TYPE_CHECKING, Any

from ...answers.equilibria import once_stopped
from ...answers.uncertain.verdicts import ALSO_ANOTHER, reason_of
from ...case.uncertain import NORMAL, SIGMAS, UNIFORM
from ...equilibrium.description import GREATER, LESSER, RATE, Description, holds_rates
from ...numbers.units import unit_of_key
from ...numbers.vectors import CYCLE
from ...reasons import Quantity, Reason
from ...representation import values_of
from .. import ending, frame
from ..axes import axes_of
from ..terminal import LINE, lettered, plain, written
from ..units import DIGITS, SI, Unit, Units, as_bound, number
from . import questions
from .headline import largest_key, verdict
from .motion import (
    attitude_rows,
    flips_dict,
    followed,
    row,
    state,
    table,
    tilt_lines,
    top_key,
    why,
)

if TYPE_CHECKING:
    from ...answers.turning.result import Attitude
    from ...case.read import Case
    from ...equilibrium.result import Equilibria, EquilibriumCurve, EquilibriumPoint
    from ...orbit.result import Motion

FEW = 3  # curves that one line has room for
VERDICTS = ("stable", "asymptotically stable", "unstable", "undecided")


def text(case: Case, equilibria: Equilibria, motion: Motion | None, turning: Attitude | None, units: Units,
         proofs: bool = False) -> str:
    """The lines for one case. turning: its `Attitude`, where that takes no run. proofs: with eigenvalues,
    equations of curves, reasons of every verdict and the principal axes."""
    answer = (f"{resting(equilibria, units)}; no [motion], so no fate" if motion is None
              else verdict(case, motion, units))
    lines = [f"{case.name}: {answer}", *([written(case.title)] if case.title else [])]
    if motion is not None:
        lines += [*table(case, motion, units), *(row(*fact) for fact in attitude_rows(turning, units)),
                  *tilt_lines(case, motion, units, proofs),
                  *why(case, motion, units, proofs)]
    lines += ["" if motion is None else f"equilibria: {resting(equilibria, units)}",
              *_equilibria(case, equilibria, units, proofs)]
    lines += frame.lines(case) if proofs else frame.note(case)
    return "\n".join(line for line in lines if line)


def resting(equilibria: Equilibria, units: Units) -> str:
    """How many states of equilibrium there are, and how many of them are stable, in one line."""
    if equilibria.kind == "undecided":
        return (f"UNDECIDED, {len(equilibria.points)} known ({_count(p.verdict for p in equilibria.points)})"
                if equilibria.points else f"UNDECIDED, {len(equilibria.curves)} curves known "
                f"({_listed(Counter(map(_along, equilibria.curves)))})" if equilibria.curves else "UNDECIDED")
    if equilibria.kind in ("none", "all"):
        return {"none": "none", "all": "every state is one"}[equilibria.kind]
    parts = ([f"{len(equilibria.points)} isolated ({_count(p.verdict for p in equilibria.points)})"]
             if equilibria.points else [])
    told = [(curve.description.name, _along(curve)) for curve in equilibria.curves]
    if len(told) > FEW:
        return "; ".join([*parts, f"{len(told)} curves ({_listed(Counter(phrase for _, phrase in told))})"])
    return "; ".join([*parts, *(f"{called(name, units)} ({phrase})" for name, phrase in told)])


def _along(curve: EquilibriumCurve) -> str:
    verdicts = _ordered({piece.verdict for piece in curve.segments})
    if len(verdicts) == 1 and any(sample.verdict != verdicts[0] for sample in curve.samples):
        return f"{verdicts[0]} but at single points"
    return f"{verdicts[0]} throughout" if len(verdicts) == 1 else "in part " + " and in part ".join(verdicts)


def _count(verdicts) -> str:
    return _listed(_counts(verdicts))


def _listed(counts) -> str:
    return ", ".join(f"{count} {phrase}" for phrase, count in counts.items())


def _counts(verdicts) -> dict[str, int]:
    """How many points have each verdict, the best first."""
    counts = Counter(verdicts)
    return {word: counts[word] for word in _ordered(counts)}


def _ordered(verdicts: set[str] | Counter[Any]):
    return sorted(verdicts, key=lambda word: (VERDICTS.index(word) if word in VERDICTS else len(VERDICTS),
                                             word))


def _equilibria(case, equilibria, units, proofs):
    lines = [f"  {units.said(equilibria.reason)}"] if proofs or equilibria.kind == "undecided" else []
    if not lines and (stopped := once_stopped(equilibria)):
        lines.append(f"  {units.said(stopped)}")
    if case.scene.plain and equilibria.kind != "none" and (units.scaled or units.name == SI.name):
        lines.append(_jacobian(case, units))  # its entries are 1/s for rates in rad/s alone
    for point in equilibria.points:
        lines += _point(case, point, units, proofs)
    if not proofs and (turning := [curve for curve in equilibria.curves
                                   if curve.description.name.says(LESSER.sentence, GREATER.sentence)]):
        lines.append(f"  {units.said(turning[0].description.parametrisation.alone)}: the vertical γ, about "
                     "which the body turns at the rate Ω")
    for curve in equilibria.curves:
        lines += _curve(curve, units, proofs)
    return lines


def _jacobian(case: Case, units: Units) -> str:
    """The Jacobian of the rates with the numbers of the case, row by row; the matrix (11) of the paper."""
    rows = [[_linear(*entry) if entry else "0" for entry in row] for row in _jacobian_entries(case)]
    return lettered(f"  Jacobian: ({'), ('.join(', '.join(row) for row in rows)}){per_second(units)}")


def _jacobian_entries(case: Case) -> list[list[tuple[float, str, float] | None]]:
    """Of each entry (factor, component, constant), None where it is zero; in SI."""
    kappa, rho, sigma, _ = case.scene.quadratic().coefficients
    rows: list[list[tuple[float, str, float] | None]] = [[None] * 3 for _ in range(3)]
    for i, (j, k) in enumerate(CYCLE):
        rows[i][j] = kappa[i], case.scene.components[k], sigma[i]
        rows[i][k] = kappa[i], case.scene.components[j], rho[i]
    return rows


def _linear(slope, name, constant) -> str:
    """slope name + constant, without what vanishes or is one."""
    factor = {1.0: "", -1.0: "-"}.get(slope, f"{number(slope, 6)} ")
    if not slope:
        return number(constant, 6)
    if not constant:
        return factor + name
    return f"{factor}{name} {'-' if constant < 0 else '+'} {number(abs(constant), 6)}"


def _point(case: Case, point: EquilibriumPoint, units: Units, proofs: bool):
    lines = [row(point.verdict, state(point.at, units))]
    if case.scene.plain:
        rows = case.scene.quadratic().jacobian(tuple(map(float, point.at)))
        result = "), (".join(", ".join(number(v + 0.0, 6) for v in item) for item in rows)
        lines.append(f"    Jacobian ({result}){per_second(units)}")
    lines.append(f"    {spectrum(point, units)}")
    if proofs:
        lines += [f"    linear: {point.linear}", f"    {units.said(point.reason)}"]
    return lines


def spectrum(point: EquilibriumPoint, units: Units) -> str:
    """The characteristic polynomial of three rates where its coefficients are doubles; the eigenvalues."""
    printed = f"eigenvalues {', '.join(_pairs(map(complex, point.eigenvalues)))}{per_second(units)}"
    if len(point.eigenvalues) != 3 or not all(map(math.isfinite, point.characteristic)):
        return printed
    terms = [f" {'-' if value < 0 else '+'} {number(abs(value), 6)}{power}"
             for value, power in zip(point.characteristic[1:], (" z²", " z", "")) if value]
    return f"z³{''.join(terms)}, {printed}"


def per_second(units: Units) -> str:
    """The unit of an eigenvalue after a blank; nothing in scaled variables."""
    return "" if units.scaled else " 1/s"


def _samples(curve: EquilibriumCurve, units: Units):
    """States on every piece with verdict and eigenvalues: of all that are as good, the slowest."""
    rows = []
    for resolved, samples in groupby(curve.samples, lambda sample: sample.verdict):
        piece = list(samples)
        nearby = sorted(piece, key=lambda sample: max(map(abs, sample.at[:3])))[:FEW]
        rows += [(resolved, state(sample.at, units), spectrum(sample, units)) for sample in piece
                 if sample in nearby]
    wide = max((len(location) for _, location, _ in rows), default=0)
    return [f"    {settled:<22}{location:<{wide}}  {roots}" for settled, location, roots in rows]


def _curve(curve, units, proofs):
    """Its equation and states along it, with proofs also all pieces with their reasons; numbers that are
    rates are in the unit of rates, angles in rad."""
    printed = curve.description
    phrase = f"{called(printed.name, units)}: {units.said(printed.equation)}"
    if not proofs:
        return [f"  {phrase}, along it:", *_samples(curve, units)]
    lines = [f"  {phrase}" + ("" if units.scaled else f"  (ω in {rates_of(printed, units)[0]})"),
             f"    {units.said(printed.parametrisation)}"]
    item = units.rates[1] if printed.unit == RATE else 1.0
    for piece in curve.segments:
        low, high = (number(t * item, 6).replace("unbounded", "∞") for t in piece.t)
        lines += [f"    t from {low} to {high}: {piece.verdict} (linear: {piece.linear})",
                  f"      {units.said(piece.reason)}"]
    return [*lines, *(f"    fold at {state(fold, units)}" for fold in curve.folds), *_samples(curve, units)]


def _pairs(roots):
    """Each root in words, z and -z or a conjugate pair as one."""
    left = list(roots)
    while left:
        z = left.pop(0)
        if left and left[0] == -z != 0:
            yield f"±{_complex(z).lstrip('+-')}"
            left.pop(0)
        elif left and z.imag and left[0] == z.conjugate():
            yield f"{z.real:.6g}±{abs(z.imag):.6g}i"
            left.pop(0)
        else:
            yield _complex(z)


def _complex(z: complex) -> str:
    z = complex(z)
    if z.imag == 0:
        return f"{z.real + 0.0:.6g}"
    return f"{z.imag:+.6g}i" if z.real == 0 else f"{z.real:.6g}{z.imag:+.6g}i"


# --- As JSON
def as_dict(case: Case, equilibria: Equilibria, motion: Motion | None) -> dict:
    """One object of `stabilab classify --json`."""
    return {"schema": "stabilab.classify/1", "case": case.name, "variables": case.variables,
            "equilibria": {"kind": equilibria.kind, "reason": equilibria.because,
                           "why": equilibria.reason.as_dict(), "counts": _counts_dict(equilibria),
                           "jacobian": _jacobian_dict(case) if case.scene.plain else None,
                           "points": [_point_dict(case, p) | _input(case, p.at) for p in equilibria.points],
                           "curves": [_curve_dict(case, c) for c in equilibria.curves]},
            "motion": None if motion is None else _motion_dict(case, motion) | _input(case, motion.at),
            **top_key(None if motion is None else motion.top)}


def _counts_dict(equilibria: Equilibria) -> dict:
    """How many there are, and how many of them with each verdict."""
    points, curves = equilibria.points, equilibria.curves
    return {"points": {"all": len(points)} | _counts(point.verdict for point in points),
            "curves": {"all": len(curves)} | Counter(map(_along, curves))}


def _jacobian_dict(case: Case) -> list[list[dict | None]]:
    """Row by row; an entry is factor times component plus constant."""
    return [[entry and dict(zip(("factor", "component", "constant"), entry)) for entry in row]
            for row in _jacobian_entries(case)]


def _input(case: Case, at: Sequence[float]) -> dict:
    """The same vector in the frame of the file, where that is another one."""
    result = frame.back(case, at[:3])
    return {} if result is None else {"at_input": result}


def _curve_dict(case, curve) -> dict:
    """With its words as sentences under `description`, and its parameter with the unit in SI."""
    printed = curve.description
    return values_of(curve, "name equation parametrisation") | {
        "description": {name: getattr(printed, name).as_dict()
                        for name in ("name", "equation", "parametrisation")},
        "parameter": {"symbol": plain(printed.symbol), "unit": printed.unit * (case.variables != "scaled")},
        "samples": [_point_dict(case, p) for p in curve.samples], "folds": curve.folds,
        "segments": [values_of(s, "t linear verdict because") | {"reason": s.reason.as_dict()}
                     for s in curve.segments]}


def _point_dict(case, p) -> dict:
    """With the Jacobian, row by row, where the state is the three rates alone, and the coefficients of its
    characteristic polynomial, highest power first."""
    jacobian = case.scene.quadratic().jacobian(tuple(map(float, p.at))) if case.scene.plain else None
    return {"at": p.at, "jacobian": jacobian} | values_of(
        p, "characteristic eigenvalues linear verdict because") | {"reason": p.reason.as_dict()}


def _motion_dict(case: Case, m: Motion) -> dict:
    return {"at": m.at, "fate": m.fate.word, **axes_of(case).key(m.axis), "because": m.because,
            "reason": m.reason.as_dict(),
            "margin": {"energy": m.margin_energy, "angular_velocity": m.margin_velocity,
                       "bounds": m.velocity_bounds,
                       "witness": m.velocity_witness, "because": m.velocity_because or None,
                       "reason": m.velocity_reason and m.velocity_reason.as_dict()},
            "largest_rate": largest_key(m), **values_of(m, "period extremes invariants"),
            "flips": flips_dict(case, m),
            "energy_integral": None if m.energy_integral is None else asdict(m.energy_integral),
            "sense": m.sense or None, **values_of(m, "extremes_over evidence"),
            "tilt": questions.tilt_dict(m.tilt)} | followed(m) | ending.key(case, m.ending)


def undecided(equilibria, motion) -> bool:
    """True where a verdict or the fate is undecided."""
    parts = [*equilibria.points, *(part for c in equilibria.curves for part in (*c.segments, *c.samples))]
    unknown = equilibria.kind == "undecided" or any(p.verdict == "undecided" for p in parts)
    return unknown or (motion is not None and motion.fate.word == "undecided")


# --- A curve in the unit of rates
def called(name: Reason, units: Units) -> str:
    """The name of a curve, with the unit of the rate at its end where it has one."""
    return f"{units.said(name)} {units.rates[0] if holds_rates(name) else ''}".rstrip()


def rates_of(printed: Description, units: Units) -> Unit:
    """The unit of the rates in the formulas of a curve; rad/s where they have no number that is one."""
    return units.rates if printed.measured else SI.rates


SUBJECTS = {"equilibria": ("hold", "depend"), "fate": ("holds", "depends")}
LONG = 8  # letters of a number in a line
# of the numbers of a witness
UNITS = {"inertia": "kg m²", "products": "kg m²", "momentum": "N m s", "torque": "N m", "force": "N",
         "wheel_momentum": "N m s", "wheel_inertia": "kg m²", "wheel_speed": "rad/s"}


def uncertain_dict(result) -> dict:
    """{"uncertain": ...} to be joined to a command's object; nothing where no number is uncertain. Numbers of
    witnesses are texts, to be written into a case file as they stand."""
    if result is None:
        return {}
    numbers = [{"key": u.key, "middle": bare_number(u.middle), "half_width": bare_number(u.half),
                "distribution": u.law, "sigma": None if u.sigma is None else bare_number(u.sigma)}
               for u in result.numbers]
    return {"uncertain": {"numbers": numbers, "equilibria": _over(result.equilibria),
                          "fate": _over(result.fate)}}


def _over(over) -> dict | None:
    if over is None:
        return None
    samples = over.samples and (values_of(over.samples, "number seed counts corners")
                                | {"margin_quantiles": over.samples.margins})
    return values_of(over, "answer verdict because") | {
        "reason": over.reason.as_dict(), "except": over.but or None, "proved_up_to": over.proved,
        **values_of(over, "changes_at parts"), "samples": samples,
        "neighbours": over.neighbours and values_of(over.neighbours,
                                                    "verdict growth number angle rate turned"),
        # a state is rounded to doubles as it is read
        "witnesses": [{"verdict": w.verdict} | {
            name: [repr(float(v)).removesuffix(".0") if name == "state" else bare_number(v) for v in values]
            for name, values in w.values.items()} for w in over.witnesses]}


def bare_number(value: Fraction) -> str:
    """An exact number as a case file can state it: the shortest decimal where that is exact, else a ratio."""
    shown = repr(float(value)).removesuffix(".0")
    return shown if Fraction(shown) == value else str(value)


def rounded(value: Fraction) -> str:
    """The same for a reader: rounded where the ratio is long (degrees bring digits of pi)."""
    exact = bare_number(value)
    return exact if len(exact) <= LONG else number(float(value), DIGITS)


def in_si(result, units: Units) -> str:
    """Lines that follow what a command says of a case, with rates and angles as a file can state them."""
    return uncertain_text(result, replace(SI, axes=units.axes))


def uncertain_text(result, units: Units) -> str:
    """The same in the units of the case; nothing where no number is uncertain."""
    if result is None:
        return ""
    numbers = []
    for u in result.numbers:  # the middle and half the width, with the unit
        unit, item = _of_file(units, unit_of_key(u.path))
        in_unit = rounded if item == 1.0 else lambda v, entry=item: number(float(v) * entry, DIGITS)
        law = {UNIFORM: ", uniform", NORMAL: f", sigma {in_unit(u.sigma or u.half)} {unit}".rstrip()
               }.get(u.law, "")
        numbers.append(f"{u.key} = {in_unit(u.middle)} ± {in_unit(u.half)} {unit}".rstrip() + law)
    lines = [f"uncertain: {', '.join(numbers)}"]
    for name in SUBJECTS:
        over = getattr(result, name)
        lines += [] if over is None else _lines(name, over, units)
    return "\n" + "\n".join(lines)


def _of_file(units: Units, unit: str) -> tuple[str, float]:
    """The unit of a number that the file states, and how many of it are one of SI; scaled cases state SI."""
    return (SI if units.scaled else units).of(unit)


# Behind the outcome on a first line that has no room for all that uncertain numbers do to it
# behind an outcome, in full and where a line has no room for that
IN_SHORT = {"holds": ("", ""), "depends": (", BUT not over all uncertainties", ", BUT not always"),
            "sampled": (", uncertainties sampled", ", box sampled"),
            "undecided": (", uncertainties undecided", ", box undecided")}


def first(result, printed: str, units: Units) -> str:
    """The text with what the box does to its answer at the end of the first line."""
    text = what_changes(result, units)
    answer, *rest = printed.split("\n")
    return "\n".join([f"{answer}; {text}", *rest]) if text else printed


def in_short(result, text: str, outcome: str) -> str:
    """The text with what the box does in short behind the outcome, where its first line is to be broken."""
    over = result and (result.fate or result.equilibria)
    answer, *rest = text.split("\n")
    if not over or len(answer) <= LINE:
        return text
    full, short = IN_SHORT[over.answer]
    shown = full if answer.index(outcome) + len(outcome + full) <= LINE else short
    return "\n".join([answer.replace(outcome, outcome + shown, 1), *rest])


def what_changes(result, units: Units) -> str:
    """Whether the answer holds for all uncertain numbers, as a clause; nothing where all are certain."""
    over = result and (result.fate or result.equilibria)
    if not over:
        return ""
    fate = over is result.fate
    subject = "the fate is" if fate else "they are"
    nearby = fate and over.neighbours
    elsewhere = units.said(over.elsewhere if fate else ALSO_ANOTHER)
    sigmas = f" within {SIGMAS} sigma" * any(u.law == NORMAL for u in result.numbers)
    phrase = {"holds": f"{subject} the same for all that the uncertain numbers may be{sigmas}"
             + (", but for a set of measure zero" if over.exception else ""),
             "depends": f"BUT within the uncertainties {elsewhere}",
             "sampled": f"{subject} the same at {over.samples and over.samples.points} within the "
                        f"uncertainties, without a proof",
             "undecided": f"{subject} undecided within the uncertainties"}[over.answer]
    if nearby and (stability := units.said(nearby.reason)) not in phrase:
        phrase += f"; the equilibrium is {stability}{beside(nearby, units)}"
    return phrase


def beside(nearby, units: Units) -> str:
    """How far the neighbours of an equilibrium go, as a clause; nothing where none departs from it."""
    departure = units.filled(nearby.departure, DIGITS - 1)
    return (f", and at {nearby.number} sampled points beside it the motion departs from its start by up to "
            f"{departure}" if nearby.rate else "")


def _lines(subject, over, units) -> list[str]:
    holds, depends = SUBJECTS[subject]
    lead = {"holds": f"{holds} all over the box", "depends": f"{depends} on them",
            "sampled": "the same at all sampled points of the box, without a proof",
            "undecided": "undecided over the box"}
    lines = [f"  {subject}: {lead[over.answer]}"
             + (f": {units.said(reason_of(over.verdict))}" if over.answer in ("holds", "sampled") else ""),
             f"    {units.said(over.reason)}"]
    if over.neighbours:
        lines.append(f"    the equilibrium is {units.said(over.neighbours.reason)}"
                     f"{beside(over.neighbours, units)}")
    if over.exception:
        lines.append(f"    but for a set of measure zero: {units.said(over.exception)}")
    if over.proved and math.isfinite(over.proved):
        smallest = number(as_bound(over.proved, 1.0, DIGITS, -1), DIGITS)
        lines.append(f"    proved to stay for every change below {smallest} times the uncertainties")
    if over.changes_at == 0:
        lines.append("    flips however small the uncertainties are")
    elif over.changes_at is not None:
        flips = units.filled(Quantity(over.changes_at).upper, DIGITS)
        lines.append(f"    flips at {flips} times the uncertainties (found by search, checked exactly)")
    elif over.answer == "holds" and over.proved < math.inf:
        lines.append("    no change was found up to 100 times the uncertainties")
    for w in over.witnesses:  # to six digits: JSON has them all
        resolved, numbers = UNITS | ({"state": "rad/s"} if "torque" in w.values else {}), []
        for name, values in w.values.items():
            unit, item = _of_file(units, resolved.get(name, ""))
            row = ", ".join(number(float(v) * item, DIGITS) for v in values)
            numbers.append(f"{lettered(name.replace('_', ' '))} = {row} {unit}".rstrip())
        lines.append(f"    {units.said(reason_of(w.verdict))} at {'; '.join(numbers)}")
    return lines


def open_fate(result) -> bool:
    """Whether the fate is not the same all over the box."""
    return result is not None and result.fate is not None and result.fate.answer != "holds"


def open_in_box(result) -> bool:
    """Whether a verdict is not proved to be the same all over the box."""
    return (result is not None and any(over is not None and over.answer != "holds"
                                      for over in (result.equilibria, result.fate)))
