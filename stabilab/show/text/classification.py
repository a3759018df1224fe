"""What `stabilab classify` prints: the answer, the motion's numbers, the equilibria, why; proofs and algebra
on request; the same as JSON; and curves of equilibria with their numbers in the unit of rates."""
from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import asdict
from itertools import groupby
from typing import NamedTuple

from ...answers.equilibria import STOPPED
from ...numbers.vectors import CYCLE
from ...representation import values_of
from .. import frame, limiting
from ..axes import axes_of
from ..terminal.letters import lettered, written
from ..units import SI, Units, number
from . import attitude, when
from .headline import verdict
from .motion import followed, reason, row, state, table, tilt_lines, why

FEW = 3  # curves that one line has room for
WORDS = ("stable", "asymptotically stable", "unstable", "undecided")


def text(case, equilibria, motion, turning, units: Units, proofs: bool = False) -> str:
    """The lines for one case. turning: its `Attitude`, where that takes no run. proofs: with eigenvalues,
    equations of curves, reasons of every verdict and the principal axes."""
    answer = (f"{resting(equilibria, units)}; no [motion], so no fate" if motion is None
              else verdict(case, motion, units))
    lines = [f"{case.name}: {answer}", *([written(case.title)] if case.title else [])]
    if motion is not None:
        lines += [*table(case, motion, units), *(row(*fact) for fact in attitude.rows(turning, units)),
                  *tilt_lines(case, motion, units, proofs),
                  *why(case, motion, units, proofs)]
    lines += ["" if motion is None else f"equilibria: {resting(equilibria, units)}",
              *_equilibria(case, equilibria, units, proofs)]
    lines += frame.lines(case) if proofs else frame.note(case)
    return "\n".join(line for line in lines if line)


def resting(equilibria, units: Units) -> str:
    """How many states of equilibrium there are, and how many of them are stable, in one line."""
    if equilibria.kind == "undecided":
        return (f"UNDECIDED, {len(equilibria.points)} known ({_count(p.verdict for p in equilibria.points)})"
                if equilibria.points else "UNDECIDED")
    if equilibria.kind in ("none", "all"):
        return {"none": "none", "all": "every state is one"}[equilibria.kind]
    parts = ([f"{len(equilibria.points)} isolated ({_count(p.verdict for p in equilibria.points)})"]
             if equilibria.points else [])
    told = [(curve.name, _along(curve)) for curve in equilibria.curves]
    if len(told) > FEW:
        counts = Counter(words for _, words in told)
        return "; ".join([*parts,
                          f"{len(told)} curves ({', '.join(f'{n} {words}' for words, n in counts.items())})"])
    return "; ".join([*parts, *(f"{reason(name, units)} ({words})" for name, words in told)])


def _along(curve) -> str:
    verdicts = _ordered({piece.verdict for piece in curve.segments})
    if len(verdicts) == 1 and any(sample.verdict != verdicts[0] for sample in curve.samples):
        return f"{verdicts[0]} but at single points"
    return f"{verdicts[0]} throughout" if len(verdicts) == 1 else "in part " + " and in part ".join(verdicts)


def _count(verdicts) -> str:
    counts = Counter(verdicts)
    return ", ".join(f"{counts[word]} {word}" for word in _ordered(counts))


def _ordered(verdicts):
    return sorted(verdicts, key=lambda word: (WORDS.index(word) if word in WORDS else len(WORDS), word))


def _equilibria(case, equilibria, units, proofs):
    lines = [f"  {reason(equilibria.reason, units)}"] if proofs or equilibria.kind == "undecided" else []
    if not lines and equilibria.reason.endswith(STOPPED):
        lines.append(f"  {STOPPED}")
    if case.scene.plain and equilibria.kind != "none" and (units.scaled or units.name == SI.name):
        lines.append(_jacobian(case, units))  # its entries are 1/s for rates in rad/s alone
    for point in equilibria.points:
        lines += _point(case, point, units, proofs)
    if not proofs and (turning := [curve for curve in equilibria.curves if " Omega for t" in curve.name]):
        lines.append(
            lettered(
                f"  {turning[0].parametrisation.split(', omega')[0]}: the vertical gamma, about which the "
                f"body turns at the rate Omega"))
    for curve in equilibria.curves:
        lines += _curve(curve, units, proofs)
    return lines


def _jacobian(case, units) -> str:
    """The Jacobian of the rates with the numbers of the case, row by row; the matrix (11) of the paper."""
    form, rows = case.scene.quadratic(), [["0"] * 3 for _ in range(3)]
    kappa, rho, sigma, _ = form.coefficients
    for i, (j, k) in enumerate(CYCLE):
        rows[i][j] = _linear(kappa[i], case.scene.components[k], sigma[i])
        rows[i][k] = _linear(kappa[i], case.scene.components[j], rho[i])
    return lettered(f"  Jacobian: ({'), ('.join(', '.join(row) for row in rows)}){per_second(units)}")


def _linear(slope, name, constant) -> str:
    """slope name + constant, without what vanishes or is one."""
    factor = {1.0: "", -1.0: "-"}.get(slope, f"{number(slope, 6)} ")
    if not slope:
        return number(constant, 6)
    if not constant:
        return factor + name
    return f"{factor}{name} {'-' if constant < 0 else '+'} {number(abs(constant), 6)}"


def _point(case, point, units, proofs):
    lines = [row(point.verdict, state(point.at, units))]
    if case.scene.plain:
        rows = case.scene.quadratic().jacobian(tuple(map(float, point.at)))
        found = "), (".join(", ".join(number(v + 0.0, 6) for v in one) for one in rows)
        lines.append(f"    Jacobian ({found}){per_second(units)}")
    lines.append(f"    {spectrum(point, units)}")
    if proofs:
        lines += [f"    linear: {point.linear}", f"    {reason(point.because, units)}"]
    return lines


def spectrum(point, units) -> str:
    """The characteristic polynomial of three rates where its coefficients are doubles; the eigenvalues."""
    told = f"eigenvalues {', '.join(_pairs(map(complex, point.eigenvalues)))}{per_second(units)}"
    if len(point.eigenvalues) != 3 or not all(map(math.isfinite, point.characteristic)):
        return told
    terms = [f" {'-' if value < 0 else '+'} {number(abs(value), 6)}{power}"
             for value, power in zip(point.characteristic[1:], (" z²", " z", "")) if value]
    return f"z³{''.join(terms)}, {told}"


def per_second(units) -> str:
    """The unit of an eigenvalue after a blank; nothing in scaled variables."""
    return "" if units.scaled else " 1/s"


def _samples(curve, units):
    """States on every piece with verdict and eigenvalues: of all that are as good, the slowest."""
    rows = []
    for known, samples in groupby(curve.samples, lambda sample: sample.verdict):
        piece = list(samples)
        near = sorted(piece, key=lambda sample: max(map(abs, sample.at[:3])))[:FEW]
        rows += [(known, state(sample.at, units), spectrum(sample, units)) for sample in piece
                 if sample in near]
    wide = max((len(place) for _, place, _ in rows), default=0)
    return [f"    {known:<22}{place:<{wide}}  {roots}" for known, place, roots in rows]


def _curve(curve, units, proofs):
    """Its equation and states along it, with proofs also all pieces with their reasons; equations in rates
    are in the unit of rates, those of a field in rad/s and s."""
    told = in_units(curve, units)
    words = lettered(f"{units.axes.sentence(told.name)}: {told.equation}")
    if not proofs:
        return [f"  {words}, along it:", *_samples(curve, units)]
    lines = [f"  {words}" + (f"  (ω in {told.unit})" if told.unit else ""),
             f"    {lettered(told.parametrisation)}"]
    for piece in curve.segments:
        low, high = (number(t * told.one, 6).replace("unbounded", "∞") for t in piece.t)
        lines += [f"    t from {low} to {high}: {piece.verdict} (linear: {piece.linear})",
                  f"      {reason(piece.because, units)}"]
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


def _complex(z) -> str:
    z = complex(z)
    if z.imag == 0:
        return f"{z.real + 0.0:.6g}"
    return f"{z.imag:+.6g}i" if z.real == 0 else f"{z.real:.6g}{z.imag:+.6g}i"


# --- As JSON
def as_dict(case, equilibria, motion) -> dict:
    """One object of `stabilab classify --json`."""
    return {"schema": "stabilab.classify/1", "case": case.name, "variables": case.variables,
            "equilibria": {"kind": equilibria.kind, "reason": equilibria.reason,
                           "points": [_point_dict(case, p) | _input(case, p.at) for p in equilibria.points],
                           "curves": [values_of(c, "name equation parametrisation")
                                      | {"samples": [_point_dict(case, p) for p in c.samples],
                                         "folds": c.folds,
                                         "segments": [values_of(s, "t linear verdict because")
                                                      for s in c.segments]}
                                      for c in equilibria.curves]},
            "motion": None if motion is None else _motion_dict(case, motion) | _input(case, motion.at)
            } | ({} if motion is None else limiting.key(case, motion.caveats)) | frame.key(case)


def _input(case, at) -> dict:
    """The same vector in the frame of the file, where that is another one."""
    found = frame.back(case, at[:3])
    return {} if found is None else {"at_input": found}


def _point_dict(case, p) -> dict:
    """With the Jacobian, row by row, where the state is the three rates alone, and the coefficients of its
    characteristic polynomial, highest power first."""
    jacobian = case.scene.quadratic().jacobian(tuple(map(float, p.at))) if case.scene.plain else None
    return {"at": p.at, "jacobian": jacobian} | values_of(
        p, "characteristic eigenvalues linear verdict because")


def _motion_dict(case, m) -> dict:
    return {"at": m.at, "fate": m.fate.word, **axes_of(case).key(m.axis), "because": m.because,
            "margin": {"energy": m.margin_energy, "angular_velocity": m.margin_velocity,
                       "bounds": m.velocity_bounds,
                       "witness": m.velocity_witness, "because": m.velocity_because or None},
            **values_of(m, "period extremes invariants"),
            "energy_integral": None if m.energy_integral is None else asdict(m.energy_integral),
            "sense": m.sense or None, **values_of(m, "extremes_over evidence"),
            "tilt": when.tilt_dict(m.tilt)} | followed(m)


def undecided(equilibria, motion) -> bool:
    """True where a verdict or the fate is undecided."""
    parts = [*equilibria.points, *(part for c in equilibria.curves for part in (*c.segments, *c.samples))]
    unknown = equilibria.kind == "undecided" or any(p.verdict == "undecided" for p in parts)
    return unknown or (motion is not None and motion.fate.word == "undecided")


# --- A curve in the unit of rates
DIGITS = 6
RATE = r"(?:omega|x)\d"
NUMBER = r"(?<![\w.])\d+(?:\.\d+)?(?:e[-+]?\d+)?"
# what is left of a clause once names, numbers, the parameter and signs are taken out; an oblique plane or a
# field has other symbols
KNOWN = re.compile(
    rf"{RATE}|{NUMBER}|\bt\b|\b(?:arbitrary|and|on a straight "
    rf"line|plane|line|along|equilibrium|hyperbola|the gyrostatic moment)\b|[-+=/(), ]")
TURNS = re.compile(r" and its turns about axis \d$")
TERM = re.compile(rf"({NUMBER})(/t| t\b)?")


class Told(NamedTuple):
    """A curve in words. one: how many of `unit` make one in its variables; no unit where these are scaled."""

    name: str
    equation: str
    parametrisation: str
    unit: str
    one: float


def in_units(curve, units: Units) -> Told:
    """The name, the equation and the parametrisation of a curve whose numbers are all rates, or products of
    two, in the unit of rates; those of any other as they are, in rad/s."""
    words = (curve.name, curve.equation, TURNS.sub("", curve.parametrisation))
    name, one = units.rates
    if units.scaled or one == 1.0 or any(KNOWN.sub("", part) for part in words):
        return Told(curve.name, curve.equation, curve.parametrisation, "" if units.scaled else "rad/s", 1.0)
    title, equation, run = (", ".join(_clause(clause, one) for clause in part.split(", ")) for part in words)
    return Told(title, equation, run + curve.parametrisation[len(words[2]):], name, one)


def _clause(clause, one):
    """"omega1 = 0.4 + t", "(omega1 + 0.4) omega2 = 2" or "omega1 = 0.4 + 2/t" with its numbers in another
    unit of rates."""
    left, equals, right = clause.partition(" = ")
    product = len(re.findall(RATE, left)) == 2 and bool(equals)
    return _scaled(left, one, one) + equals + _scaled(right, one * one if product else one, one)


def _scaled(words, one, rate):
    """A number that stands alone times `one`; one over t, a product of two rates, times the square of that of
    a rate; one times t as it is."""
    factors = {"": one, "/t": rate * rate, " t": 1.0}
    return TERM.sub(lambda found: f"{float(found[1]) * factors[found[2] or '']:.{DIGITS}g}{found[2] or ''}",
                    words)
