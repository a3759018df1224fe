"""The picture of a stuck thruster: |omega| and its components in deg/s against minutes, the limit marked."""
from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ..answers.simulate import trajectory
from ..answers.stuck.fate import scenario_of
from ..packages import demand
from . import style
from .files import endings
from .text.stuck import answer_line, row_name
from .units import Units

BEYOND = 1.25  # of the time to the limit: how far the picture goes
POINTS = 3001
NATURAL = 15  # units of the motion's own time, where nothing else says how far
MOST_PANELS = 4


def draw(case, found, path, units: Units) -> Path:
    """Write the picture of an answer (`answers.stuck`) to a file (.png, .svg or .pdf): a panel a row, the
    first four of them."""
    endings.file(path, endings.PICTURES)
    demand(*style.PACKAGES)
    scenario = scenario_of(case)
    rows = found.rows[:MOST_PANELS]
    with style.drawing() as plt:
        figure, axes = plt.subplots(len(rows), 1, figsize=(7.6, 1.0 + 3.4 * len(rows)), layout="constrained",
                                    squeeze=False)
        for ax, row in zip(axes[:, 0], rows):
            _panel(ax, scenario, row, units)
        figure.suptitle(style.literal(case.heading), fontsize=10.5, wrap=True)
        style.legend(figure, _meanings(rows), columns=6)
        return style.save(figure, path)


LOOKS = (("|ω|", {"color": style.BLACK, "linewidth": 3.0}),
         ("ω along x", {"color": style.BLUE, "linewidth": 1.1}),
         ("ω along y", {"color": style.ORANGE, "linewidth": 1.1}),
         ("ω along z", {"color": style.GREEN, "linewidth": 1.1}))
LIMIT = {"color": style.VERMILION, "linestyle": "--", "linewidth": 1.4}
REACHED = {"marker": "o", "color": style.VERMILION, "markersize": 6, "linestyle": "none"}


def _meanings(rows):
    limit = [("limit", LIMIT)] if any(row.limit is not None for row in rows) else []
    return [*LOOKS, *limit, *([("reached", REACHED)] if any(row.time_to_limit for row in rows) else [])]


def _panel(ax, scenario, row, units):
    rate, per_rate = units.rates
    chosen = [t for t in scenario.case.thrusters if t.name in row.thrusters]
    scene = scenario.scene(scenario.torque(chosen))
    until = _until(scenario, row, scene)
    time, per_time = units.times(until)
    t = np.linspace(0.0, until, POINTS)
    omega = np.asarray(trajectory(scene, scenario.start, t).states) @ np.array(scenario.rows).T
    size = np.linalg.norm(omega, axis=1)
    for values, (_, look) in zip((size, *omega.T), LOOKS):
        ax.plot(t * per_time, values * per_rate, **look)
    _limit(ax, row, t, np.column_stack([size, omega]), per_time, per_rate)
    ax.set_xlim(0, t[-1] * per_time)
    ax.set_xlabel(f"time ({time})")
    ax.set_ylabel(f"rate, frame of the file ({rate})")
    short = answer_line(row, units).rsplit(" (", 1)[0]
    ax.set_title(style.literal(f"{row_name(row)}: {short}"), wrap=True, fontsize=9.5)


def _limit(ax, row, t, values, per_time, per_rate):
    if row.limit is None:
        return
    limits = sorted(set(row.limit)) if isinstance(row.limit, tuple) else [row.limit]
    for limit in limits:
        ax.axhline(limit * per_rate, **LIMIT)
        if isinstance(row.limit, tuple):
            ax.axhline(-limit * per_rate, **LIMIT)
    if row.time_to_limit:
        when = sum(row.time_to_limit) / 2
        at = [np.interp(when, t, values[:, n]) for n in range(4)]
        where = (at[0] if not isinstance(row.limit, tuple)
                 else max(zip(at[1:], row.limit), key=lambda one: abs(one[0]) / one[1])[0])
        ax.plot([when * per_time], [where * per_rate], zorder=5, **REACHED)


def _until(scenario, row, scene) -> float:
    """s: past the limit; else so long as the motion was followed, or some of its own units of time."""
    if row.time_to_limit and row.time_to_limit[1] > 0:
        return BEYOND * row.time_to_limit[1]
    torque, weight = math.hypot(*row.torque), sum(scene.body.inertia) / 3
    own = NATURAL * math.sqrt(weight / torque) if torque else NATURAL / (max(map(abs, scenario.start)) or 1.0)
    return min(own, row.followed) if row.followed > 0 else own
