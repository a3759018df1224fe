"""All rotations of a free body at one angular momentum, and where a gyrostat with losses ends, in words
and as JSON."""
from __future__ import annotations

from ...answers.dissipation.gyrostat import CIRCLE, STEADY, GyrostatSpin
from ...answers.dissipation.rotations import Rotations, SteadyRotation, WheelThreshold
from ...representation import values_of
from ..axes import axes_of
from ..units import DIGITS, SHORT, SYSTEMS, Units, number
from .motion import in_file, row

NATURES = {"minimum": "least energy", "maximum": "most energy", "saddle": "saddle of the energy",
           "inflection": "inflection of the energy", "degenerate": "a flat place of the energy"}
# by (with losses, without)
STABILITIES = {("stable", "stable"): "stable", ("unstable", "unstable"): "unstable",
               ("stable", "unstable"): "stable with losses",
               ("unstable", "stable"): "stable only without losses",
               ("unstable", "undecided"): "unstable with losses"}
UNKNOWN = "of undecided stability"


def rotations_dict(case, result: Rotations) -> dict:
    """The object of `stabilab flat-spin --json` of a case with wheels, and with --momentum: SI units,
    vectors in the frame of the file. Times: [s, error in s], null where past at the start or not reached;
    end, reachable: places in `rotations`, from 0; outcome null of a momentum alone."""
    spin = result if isinstance(result, GyrostatSpin) else None
    own = values_of(spin, "outcome level end reachable") if spin else dict.fromkeys(
        ("outcome", "level", "end", "reachable"))
    times = {name: spin and (value := getattr(spin, name)) and [value.at, value.error]
             for name in ("crosses", "settles", "tenth")}
    numbers = (values_of(spin, "energy final_energy barrier within steps") | {"energy_lost": spin.lost}
               if spin else {})
    return {"schema": "stabilab.rotations/1", "case": case.name, **own, "because": result.because,
            "reason": result.reason.as_dict(), "momentum": result.momentum,
            "final_rates": in_file(case, spin.rates) if spin and spin.rates else None, **numbers, **times,
            "stable_with_losses": result.stable,
            "rotations": [{"number": n} | _rotation(case, item)
                          for n, item in enumerate(result.rotations, 1)],
            "threshold": None if result.threshold is None else _threshold(case, result.threshold)}


def _rotation(case, item: SteadyRotation) -> dict:
    return {"nature": item.nature, "rates": in_file(case, item.rates), "momentum": in_file(case,
            item.momentum), **values_of(item, "energy with_losses without_losses"),
            "circle_about": item.axis or None, "everywhere": item.everywhere,
            "growth_time": item.growth, "decay_time": item.decay,
            **({} if item.displacement is None else values_of(item, "displacement"))}


def _threshold(case, item: WheelThreshold) -> dict:
    return {**values_of(item, "factor moment"), "rates": in_file(case, item.rates),
            "wheel_speeds": dict(item.wheels), "rate": item.rate, "moment_at_rate": item.at_rate,
            "factor_at_rate": item.at_rate_factor, "wheel_speeds_at_rate": dict(item.at_rate_wheels)}


def rotations_text(case, result: Rotations, units: Units) -> str:
    """The answer first, then all rotations, the threshold, the times and why; without its caveats."""
    spin = result if isinstance(result, GyrostatSpin) else None
    lines = [f"{case.name}: {_headline(case, result, spin, units)}",
             row("|H|", f"{number(result.momentum, DIGITS)} N m s")]
    if spin:
        lines += _course(spin, units)
    lines += [row(*fact) for fact in rotation_rows(case, result, units)]
    if spin and spin.steps:
        lines.append(row("cost", f"{spin.steps} steps"))
    return "\n".join([*lines, f"why: {units.said(result.reason)}"])


def rotation_rows(case, result: Rotations, units: Units) -> list[tuple[str, str]]:
    """(name, words) of each rotation, and from which speed of the wheels on one alone attracts."""
    rows = [(f"rotation {n}", _line(case, item, units)) for n, item in enumerate(result.rotations, 1)]
    return rows if result.threshold is None else rows + _threshold_rows(result.threshold, units)


def _headline(case, result: Rotations, spin: GyrostatSpin | None, units: Units) -> str:
    of = "rotation is" if result.stable == 1 else "rotations are"
    if spin is None:
        verb = "attracts" if result.stable == 1 else "attract"
        return f"{_counted(result)}, of which {result.stable} {verb} with losses"
    when = "" if spin.crosses is None else f"; passes the saddle at {units.moment(spin.crosses.at)}"
    if spin.outcome == STEADY and spin.rates:
        how = " (by a run)" if spin.level == "run" else ""
        at = units.vector(in_file(case, spin.rates), units.rates, SHORT)
        return f"TENDS TO STEADY ROTATION at {at}{how}{when}"
    if spin.outcome == CIRCLE and spin.end is not None:
        about = axes_of(case).short(spin.rotations[spin.end].axis)
        return f"TENDS TO A CIRCLE OF ROTATIONS about {about}"
    return f"UNDECIDED: {result.stable} {of} stable with losses{when}"


def _counted(result: Rotations) -> str:
    many = len(result.rotations)
    return f"{many} ROTATION{'S' * (many != 1)}"


def _course(spin: GyrostatSpin, units: Units) -> list[str]:
    """Energies and times."""
    lost = "" if spin.lost is None else f", of which {number(spin.lost, DIGITS)} J are lost in the end"
    lines = [row("energy", f"{units.energy(spin.energy)}{lost}")]
    if spin.barrier is not None:
        lines.append(row("pass between two ends", units.energy(spin.barrier)))
    named = (("T at the pass", spin.crosses),
             (f"within {units.angle(spin.within, 4)} of its end", spin.settles),
             ("a tenth of its departure", spin.tenth))
    lines += [row(name, f"t = {units.time(span.at)}, known to {units.time(span.error, 1, 1)}")
              for name, span in named if span is not None]
    return lines


def _line(case, item: SteadyRotation, units: Units) -> str:
    """One rotation: its rates, energy, stability and time constant."""
    if item.everywhere:
        size = sum(v * v for v in item.rates) ** 0.5
        return f"about every axis at {units.rate(size, SHORT)}: each stays as it is"
    rates = units.vector(in_file(case, item.rates), units.rates)
    if item.axis:
        rates = f"a circle about {axes_of(case).short(item.axis)} through {rates}"
    parts = [rates, f"{number(item.energy, DIGITS)} J", f"{NATURES[item.nature]}, "
             f"{STABILITIES.get((item.with_losses, item.without_losses), UNKNOWN)}"]
    if item.displacement is not None:
        parts.insert(1, f"mass at {number(item.displacement, DIGITS)} m")
    for verb, value in (("grows", item.growth), ("decays", item.decay)):
        if value is not None:
            parts.append(f"a departure {verb} e-fold in {units.time(value, SHORT)}")
    return "; ".join(parts)


def _threshold_rows(item: WheelThreshold, units: Units) -> list[tuple[str, str]]:
    if not item.factor:
        return [("one alone attracts", "at this |H|, however fast the wheels")]
    at = f"{number(item.moment, DIGITS)} N m s of the wheels, {number(item.factor, SHORT)} times that of now"
    rows = [("one alone attracts from", f"{at}{_speeds(item.wheels)}, at this |H|")]
    if item.at_rate is not None and item.rate is not None:
        at = f"{number(item.at_rate, DIGITS)} N m s{_speeds(item.at_rate_wheels)}"
        rows.append(("", f"{at}, at a spin of {units.rate(item.rate)} about their axis"))
    return rows


def _speeds(wheels: tuple[tuple[str, float], ...]) -> str:
    rpm = SYSTEMS["rpm"].rates
    return "".join(f", {name} at {number(speed * rpm[1], SHORT)} rpm" for name, speed in wheels)
