"""What `stabilab classify` prints: the answer, the motion's numbers, the equilibria, why; proofs and algebra
where they are asked for."""
from __future__ import annotations

import math
from collections import Counter
from itertools import groupby

from ..curve_units import in_units
from ..text import frame
from ..text.headline import headline
from ..units import Units, number
from .letters import lettered, written
from .motion import reason, row, state, table, tilt_lines, why

FEW = 3  # curves that one line has room for
WORDS = ("stable", "asymptotically stable", "unstable", "undecided")


def text(case, equilibria, motion, units: Units, proofs: bool = False) -> str:
    """The lines for one case. proofs: with eigenvalues, equations of curves, reasons of every verdict and the
    principal axes."""
    answer = (f"{resting(equilibria, units)}; no [motion], so no fate" if motion is None
              else headline(case, motion, units))
    lines = [f"{case.name}: {answer}", *([written(case.title)] if case.title else [])]
    if motion is not None:
        lines += [*table(case, motion, units), *tilt_lines(case, motion, units, proofs),
                  *why(case, motion, units, proofs)]
    lines += ["" if motion is None else f"equilibria: {resting(equilibria, units)}",
              *_equilibria(equilibria, units, proofs)]
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


def _equilibria(equilibria, units, proofs):
    lines = [f"  {reason(equilibria.reason, units)}"] if proofs or equilibria.kind == "undecided" else []
    for point in equilibria.points:
        lines += _point(point, units, proofs)
    if not proofs and (turning := [curve for curve in equilibria.curves if " Omega for t" in curve.name]):
        lines.append(
            lettered(
                f"  {turning[0].parametrisation.split(', omega')[0]}: the vertical gamma, about which the "
                f"body turns at the rate Omega"))
    for curve in equilibria.curves:
        lines += _proved_curve(curve, units) if proofs else _curve(curve, units)
    return lines


def _point(point, units, proofs):
    lines = [row(point.verdict, state(point.at, units))]
    if proofs:
        roots = ", ".join(_complex(z) for z in point.eigenvalues)
        lines += [f"    linear: {point.linear}; eigenvalues {roots} {'' if units.scaled else '1/s'}".rstrip(),
                  f"    {reason(point.because, units)}"]
    return lines


def _curve(curve, units):
    """A state on every piece with its verdict; neighbours of one verdict are told together."""
    lines = [f"  {reason(curve.name, units)}, along it:"]
    for verdict, samples in groupby(curve.samples, lambda sample: sample.verdict):
        # of all that are as good, the slowest
        near = min(samples, key=lambda sample: max(map(abs, sample.at[:3])))
        lines.append(f"    {verdict:<22}such as {state(near.at, units)}")
    return lines


def _proved_curve(curve, units):
    """All pieces with their reasons; equations in rates are in the unit of rates, those of a field in rad/s
    and s."""
    told = in_units(curve, units)
    words = lettered(f"{units.axes.sentence(told.name)}: {told.equation}")
    lines = [f"  {words}" + (f"  (ω in {told.unit})" if told.unit else ""),
             f"    {lettered(told.parametrisation)}"]
    for piece in curve.segments:
        low, high = (_end(t * told.one) for t in piece.t)
        lines += [f"    t from {low} to {high}: {piece.verdict} (linear: {piece.linear})",
                  f"      {reason(piece.because, units)}"]
    return lines + [f"    fold at {state(fold, units)}" for fold in curve.folds]


def _end(t) -> str:
    """An end of a piece of a curve."""
    return number(t, 6) if math.isfinite(t) else "∞" if t > 0 else "-∞"


def _complex(z) -> str:
    z = complex(z)
    if z.imag == 0:
        return f"{z.real + 0.0:.6g}"
    return f"{z.imag:+.6g}i" if z.real == 0 else f"{z.real:.6g}{z.imag:+.6g}i"
