"""What internal dissipation makes of a spin, in words and as JSON."""
from __future__ import annotations

import math

from ...answers.dissipation.ending import of_spin
from ...representation import values_of
from .. import ending
from ..axes import Axes, axes_of
from ..units import DIGITS, Units, number
from .motion import in_file, row

NAMES = {"phase": "phase", "nutation": "nutation angle", "coefficient": "the damper's coefficient alone",
         "inertia": "the sphere's moment of inertia alone, the moments of the whole as they are",
         "damping": "the damper's coefficient and its sphere's inertia together",
         "liquid": "the liquid's torque (density P0/viscosity)"}


def flat_spin_dict(case, found) -> dict:
    """The object of `stabilab flat-spin --json`: SI units, vectors in the frame of the file. Times: [s, error
    in s], null where past at the start or not reached; changes: null where none was found; phase_about: the
    positive direction of the minor axis, about which the phase is measured."""
    times = {name: one and [one.at, one.error]
             for name, one in values_of(found, "leaves crosses settles tenth").items()}
    return {"schema": "stabilab.flat_spin/1", "case": case.name, **values_of(found, "outcome level because"),
            "reason": found.reason.as_dict(),
            "minor_axis": found.minor, **values_of(found, "momentum final_rate"),
            "final_rates": found.rates and in_file(case, found.rates),
            **values_of(found, "energy final_energy"), "energy_lost": found.lost, "within": found.within,
            **times, "passage": found.passage, "nutation": found.nutation, "growth_time": found.growth,
            "decay_time": found.decay,
            "changes": {one.name: [one.down, one.up] for one in found.spans},
            "phase_about": in_file(case, tuple(float(n == found.minor - 1) for n in range(3))),
            "steps": found.steps} | axes_of(case).key(found.axis)


def flat_spin_text(case, found, units: Units) -> str:
    """The answer first, then when, the numbers, what changes the outcome and why; without its caveats."""
    within = units.angle(found.within, 4)
    lines = [f"{case.name}: {_headline(found, axes_of(case), units)}"]
    rates = "" if found.rates is None else f": {units.vector(in_file(case, found.rates), units.rates)}"
    lines.append(row("final rate", f"{units.rate(found.final_rate)}{rates}"))
    lines.append(row("energy", f"{units.energy(found.energy)}, of which {number(found.lost, DIGITS)} J are "
                               f"lost in the end"))
    if found.nutation is not None:
        lines.append(row("nutation", f"{units.angle(found.nutation)} at the start"))
    for name, one in ((f"nutation over {within}", found.leaves), ("separatrix crossed", found.crosses),
                      (f"within {within}", found.settles), ("a tenth of it", found.tenth)):
        if one is not None:
            lines.append(row(name, f"t = {units.time(one.at)}, known to {units.time(one.error, 1, 1)}"))
    if found.passage is not None:
        lines.append(row("passage", units.time(found.passage)))
    for name, one in (("growth", found.growth), ("decay", found.decay)):
        if one is not None:
            lines.append(row(f"nutation {name}", f"time constant {units.time(one)}, by eigenvalues"))
    for one in found.spans:
        size = ((lambda v: units.angle(v, 3)) if one.name == "phase"
                else lambda v: f"{number(100 * v, 3)} %")
        ends = [f"{sign}{size(v)}" for sign, v in (("-", one.down), ("+", one.up)) if math.isfinite(v)]
        about = (f" about the positive direction of {axes_of(case).whole(found.minor)}" if one.name == "phase"
                 else "")
        lines.append(row("outcome changes at", f"{' and '.join(ends)} of {NAMES[one.name]}{about}"
                         if ends else f"no change of {NAMES[one.name]} that was looked at"))
    if found.steps:
        lines.append(row("cost", f"{found.steps} steps"))
    return "\n".join([*lines, f"why: {units.said(found.reason)}"])


def _headline(found, axes: Axes, units: Units) -> str:
    if found.nutation is not None:
        one = of_spin(found)
        return f"{''.join(ending.words(one, units))}; {ending.when(one, units)}"
    name = axes.name(found.axis)
    if found.outcome == "undecided":
        one = found.crosses
        when = "" if one is None else f", separatrix crossed at {units.moment(one.at)}"
        return f"UNDECIDED: +{name} or -{name}{when}"
    if found.outcome.startswith("across"):
        return f"FLAT SPIN about an axis across {axes.name(found.minor)}"
    sign = "+" if found.outcome.startswith("positive") else "-"
    when = "" if found.crosses is None else f", separatrix crossed at {units.moment(found.crosses.at)}"
    return f"FLAT SPIN about {sign}{name}{when}"
