"""The time to a limit against what changes it: the tilt of the torque, the momentum of a wheel."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.caveats import STEADY
from ...answers.stuck.fate import PATIENCE, scenario_of
from ...answers.stuck.wheel import times_over
from ...answers.tilt import SIDES, by_angle
from ...answers.when import limit_of
from ...numbers.principal import without_trace
from .. import style
from ..spans import limit_time
from ..units import SHORT, number
from . import canvas
from . import subject as which
from .subject import measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FAR = 10.0  # times the top of the picture: where a band ends that is open above
TALL = 8.0  # times the least: of times farther apart the logarithm is drawn
ANGLES = np.radians(np.geomspace(0.1, 10.0, 4))  # and more where times bend
EARLIEST = {"color": style.VERMILION, "linewidth": 2.0}
BAND = {"facecolor": style.VERMILION, "alpha": 0.22, "linewidth": 0}
SURE = {"facecolor": style.BLUE, "alpha": 0.18, "linewidth": 0}
NOW = {"color": style.BLACK, "linestyle": "--", "linewidth": 1.2}
STATED = {"color": style.GREY, "linestyle": "-.", "linewidth": 1.2}
KEEPS = {"facecolor": style.GREEN, "alpha": 0.25, "linewidth": 0}
NEVER = {"marker": "^", "linestyle": "none", "markersize": 5}
WHEELS = [{"color": colour, "linewidth": 1.8, "linestyle": dashes} for colour, dashes in (
    (style.BLUE, "-"), (style.PURPLE, "--"), (style.SKY, ":"), (style.BROWN, "-."))]


def tilt(case: Any, state: Any = None, ax: Axes | None = None, units: str | None = None,
         size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Draw the time to the limit against the tilt of the torque, and return the axes.

    The band goes from the earliest to the latest time of runs at directions round the edge of each cone; it
    is open above where some run does not come to the limit. Blue: times before which no torque of the cone
    reaches it, which is proved. The limit is that of the case, else twice the largest rate of the bounded
    motion. Raises InputError where no constant torque acts, or nothing is to be reached.
    """
    one = subject(case, state)
    which.check("tilt", one)
    scale, given = measures(one, units), one.case
    scene: Any = one.scene  # physical: `which` refuses the others
    found = by_angle(scene, one.state, ANGLES, given,
                     None if given is None or given.limits is None else limit_of(given), closer=True)
    finite = np.concatenate([times[np.isfinite(times) & (times > 0)] for times in
                             (found.earliest, found.latest, found.not_before)])
    unit, per = scale.time(float(finite.max(initial=0.0)) or 1.0)
    degrees = np.degrees(found.angles)
    with canvas.on(ax, size) as target:
        target.set(xscale="log", yscale="log")
        rows: list[tuple[str, dict[str, Any]]] = [("earliest, by runs", EARLIEST)]
        ends = np.isfinite(found.latest).all()
        top = (1.2 if ends else 3.0) * per * float(finite.max(initial=0.0))
        reached = np.isfinite(found.earliest)
        if reached.any():
            target.fill_between(degrees, per * found.earliest, np.minimum(per * found.latest, FAR * top),
                                where=reached, **BAND)
            target.plot(degrees[reached], per * found.earliest[reached], **EARLIEST)
            rows.append((f"to the latest of {SIDES} directions", BAND))
        if found.not_before.any():
            low = 0.3 * per * float(finite.min())
            target.fill_between(degrees, low, np.maximum(per * found.not_before, low), **SURE)
            target.set_ylim(bottom=low)
            rows.append(("not yet, proved", SURE))
        if (at := limit_time(one.motion)) is not None:
            target.axhline(per * at, **NOW)
            rows.append(("as it is", NOW))
        stated = [float(t.misalignment) for t in (() if given is None else given.thrusters)
                  if t.stuck and t.misalignment]
        if stated:
            target.axvline(np.degrees(max(stated)), **STATED)
            rows.append(("misalignment of the case", STATED))
        target.set_xlim(degrees[0], degrees[-1])
        target.set_ylim(top=top)
        if not found.not_before.any() and finite.max() < TALL * finite.min():
            target.set_yscale("linear")
            target.set_ylim(0.0, top)
        for axis in (target.xaxis, target.yaxis):
            axis.set_major_formatter("{x:g}")
        target.set_xlabel(f"tilt of {found.of} (deg)")
        least = f"{number(found.limit.least_rate() * scale.rate[1], SHORT)} {scale.rate[0]}"
        reaches = r"$|\omega|$ =" if found.limit.kind == "rate" else "a component of"
        target.set_ylabel(f"time to {reaches} {least} ({unit})")
        return canvas.explained(target, rows if legend else [], ax is None,
                                one.heading, canvas.answer(one, scale))


def wheel(case: Any, ax: Axes | None = None, units: str | None = None,
          size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Draw by how much later the limit is reached with another momentum of a wheel, and return the axes.

    A line for each wheel of the case, the others left as they are, by runs; a triangle where a run does not
    reach the limit within PATIENCE times the time of now. Green: momenta that keep the motion bounded.
    Raises InputError where the case has no wheel, or its motion does not reach a limit.
    """
    one = subject(case)
    which.check("wheel", one)
    scale, scenario, row = measures(one, units), scenario_of(one.case), one.stuck
    torque, first = scenario.torque([t for t in scenario.case.thrusters if t.stuck]), one.motion.first[1]
    time = float(first.low), float(first.high)
    curves = []
    for part, found in zip(scenario.case.wheels, row.wheels):
        axis = without_trace(scenario.axes.turned(part.axis), torque)
        curves.append((part, found, *times_over(scenario, torque, axis, part.momentum, time)))
    gains = [times - time[0] for *_, times in curves]
    unit, per = scale.time(max(float(np.abs(gain[np.isfinite(gain)]).max(initial=time[0])) for gain in gains))
    with canvas.on(ax, size) as target:
        rows: list[tuple[str, dict[str, Any]]] = []
        for (part, found, momenta, _), gain, look in zip(curves, gains, WHEELS):
            if found.gain is not None:
                after = int(np.searchsorted(momenta, found.best))
                momenta, gain = np.insert(momenta, after, found.best), np.insert(gain, after, found.gain)
            reached = np.isfinite(gain)
            target.plot(momenta, per * np.where(reached, gain, np.nan), **look)
            rows.append((f"wheel {part.name}", look))
            if not reached.all():
                top = per * float(gain[reached].max(initial=time[0]))
                target.plot(momenta[~reached], np.full((~reached).sum(), top), color=look["color"], **NEVER)
                rows.append((f"not within {PATIENCE} times as long", NEVER | {"color": look["color"]}))
            if found.gain is not None:
                best, later = found.best, per * found.gain
                words = f"{number(best, SHORT)} N m s: {number(later, SHORT)} {unit}"
                side = ("left", "center", "right")[int(np.digitize(best / found.searched[1], (-0.5, 0.5)))]
                target.annotate(words.replace("-", "\u2212"), (best, later), (0, 6), ha=side,
                                textcoords="offset points", color=look["color"])
                target.plot(best, later, marker="o", color=look["color"], markersize=4)
            target.plot([float(part.momentum)], [0.0], zorder=5, **style.MARKER["start"])
            kept = () if one.motion.fate in STEADY else found.keeps_bounded
            for low, high in kept:
                target.axvspan(max(low, momenta[0]), min(high, momenta[-1]), **KEEPS)
            rows += [("keeps the motion bounded", KEEPS)] if kept else []
        rows.append((f"now: {scale.system.time(time[0], SHORT)}", style.MARKER["start"]))
        target.axhline(0.0, color=style.GREY, linewidth=0.8)
        target.margins(y=0.12)
        target.set_xlabel("momentum of the wheel along its axis (N m s)")
        target.set_ylabel(f"later by ({unit})")
        return canvas.explained(target, list(dict(rows).items()) if legend else [], ax is None,
                                one.heading, canvas.answer(one, scale))
