"""What internal dissipation makes of a spin, in words and as JSON."""
from __future__ import annotations

import math

from ...answers.dissipation.ending import of_spin
from ...answers.dissipation.rotations import Rotations
from ...representation import values_of
from .. import ending
from ..axes import Axes, axes_of
from ..units import DIGITS, Units, number
from .motion import in_file, row
from .rotations import rotations_dict, rotations_text

NAMES = {"phase": "phase", "nutation": "nutation angle", "coefficient": "the damper's coefficient alone",
         "inertia": "the sphere's moment of inertia alone, the moments of the whole as they are",
         "damping": "the damper's coefficient and its sphere's inertia together",
         "liquid": "the liquid's torque (density P0/viscosity)"}


def any_dict(case, result) -> dict:
    """The object of a body with wheels or without."""
    return rotations_dict(case, result) if isinstance(result, Rotations) else flat_spin_dict(case, result)


def any_text(case, result, units: Units) -> str:
    """The text of a body with wheels or without."""
    return (rotations_text if isinstance(result, Rotations) else flat_spin_text)(case, result, units)


def flat_spin_dict(case, result) -> dict:
    """The object of `stabilab flat-spin --json`: SI units, vectors in the frame of the file. Times: [s, error
    in s], null where past at the start or not reached; changes: null where none was found; phase_about: the
    positive direction of the minor axis, about which the phase is measured."""
    times = {name: value and [value.at, value.error]
             for name, value in values_of(result, "leaves crosses settles tenth").items()}
    return {"schema": "stabilab.flat_spin/1", "case": case.name, **values_of(result, "outcome level because"),
            "reason": result.reason.as_dict(),
            "minor_axis": result.minor, **values_of(result, "momentum final_rate"),
            "final_rates": result.rates and in_file(case, result.rates),
            **values_of(result, "energy final_energy"), "energy_lost": result.lost, "within": result.within,
            **times, "passage": result.passage, "nutation": result.nutation, "growth_time": result.growth,
            "decay_time": result.decay,
            "changes": {span.name: [span.down, span.up] for span in result.spans},
            "phase_about": in_file(case, tuple(float(n == result.minor - 1) for n in range(3))),
            "steps": result.steps} | axes_of(case).key(result.axis)


def flat_spin_text(case, out, units: Units) -> str:
    """The answer first, then when, the numbers, what changes the outcome and why; without its caveats."""
    within = units.angle(out.within, 4)
    lines = [f"{case.name}: {_headline(out, axes_of(case), units)}"]
    rates = "" if out.rates is None else f": {units.vector(in_file(case, out.rates), units.rates)}"
    lines.append(row("final rate", f"{units.rate(out.final_rate)}{rates}"))
    lines.append(row("energy", f"{units.energy(out.energy)}, of which {number(out.lost, DIGITS)} J are "
                               f"lost in the end"))
    if out.nutation is not None:
        lines.append(row("nutation", f"{units.angle(out.nutation)} at the start"))
    for name, span in ((f"nutation over {within}", out.leaves), ("separatrix crossed", out.crosses),
                      (f"within {within}", out.settles), ("a tenth of it", out.tenth)):
        if span is not None:
            lines.append(row(name, f"t = {units.time(span.at)}, known to {units.time(span.error, 1, 1)}"))
    if out.passage is not None:
        lines.append(row("passage", units.time(out.passage)))
    for name, span in (("growth", out.growth), ("decay", out.decay)):
        if span is not None:
            lines.append(row(f"nutation {name}", f"time constant {units.time(span)}, by eigenvalues"))
    for span in out.spans:
        size = ((lambda v: units.angle(v, 3)) if span.name == "phase"
                else lambda v: f"{number(100 * v, 3)} %")
        ends = [f"{sign}{size(v)}" for sign, v in (("-", span.down), ("+", span.up)) if math.isfinite(v)]
        about = (f" about the positive direction of {axes_of(case).whole(out.minor)}" if span.name == "phase"
                 else "")
        lines.append(row("outcome changes at", f"{' and '.join(ends)} of {NAMES[span.name]}{about}"
                         if ends else f"no change of {NAMES[span.name]} that was looked at"))
    if out.steps:
        lines.append(row("cost", f"{out.steps} steps"))
    return "\n".join([*lines, f"why: {units.said(out.reason)}"])


def _headline(result, axes: Axes, units: Units) -> str:
    if result.nutation is not None:
        item = of_spin(result)
        return f"{''.join(ending.words(item, units))}; {ending.when(item, units)}"
    name = axes.name(result.axis)
    if result.outcome == "undecided":
        item = result.crosses
        when = "" if item is None else f", separatrix crossed at {units.moment(item.at)}"
        return f"UNDECIDED: +{name} or -{name}{when}"
    if result.outcome.startswith("across"):
        return f"FLAT SPIN about an axis across {axes.name(result.minor)}"
    sign = "+" if result.outcome.startswith("positive") else "-"
    when = "" if result.crosses is None else f", separatrix crossed at {units.moment(result.crosses.at)}"
    return f"FLAT SPIN about {sign}{name}{when}"
