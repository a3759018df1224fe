"""The picture of a motion: its phase plane (turn angle against rate) where it reduces, else three projections."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ..answers.trajectory import trajectory
from ..errors import InputError
from ..orbit.far_states import far_exponent
from ..orbit.phase_plane import PhasePlane, motion_curve, phase_plane, window
from ..packages import demand
from ..theories.comparison import side_by_side
from . import style
from .files import endings
from .text import comparison


def draw(ax, plane: PhasePlane, scale=1.0, offset=0.0, rate_scale=1.0, span=None, levels=22, motion=True):
    """Draw level curves, separatrices, equilibria and the motion on `ax`; x axis: offset + scale*y."""
    low, high = span or window(plane)
    y = np.linspace(low, high, 700)
    heights = plane.height(y)
    tops = [float(plane.height(s)) for s in plane.repeated(plane.saddles, low, high)]
    lift = max(plane.W0**2 / 2, *(tops or [0.0])) - float(np.min(heights))
    top = np.sqrt(2 * lift) * 1.12 + 1e-12
    W = np.linspace(-top, top, 500)
    energy = W[:, None] ** 2 / 2 + heights[None, :]
    limits = np.linspace(energy.min(), np.quantile(energy, 0.93), levels + 1)[1:]
    ax.contour(offset + scale * y, rate_scale * plane.rate(W), energy, levels=limits, colors=style.MEANING["level"]["color"],
               linewidths=0.5, linestyles="solid")
    for saddle in plane.repeated(plane.saddles, low, high):
        ys, Ws = plane.separatrix(saddle, low, high)
        for sign in (1, -1):
            ax.plot(offset + scale * ys, rate_scale * plane.rate(sign * Ws), **style.MEANING["separatrix"])
    if motion:
        ys, Ws = motion_curve(plane, low, high)
        for sign in (1, -1):
            ax.plot(offset + scale * ys, rate_scale * plane.rate(sign * Ws), **style.MEANING["this motion"])
        ax.plot([offset], [rate_scale * plane.rate(plane.W0)], zorder=5, **style.MARKER["start"])
    for kind, places in (("centre", plane.centres), ("saddle", plane.saddles)):
        shown = np.array(plane.repeated(places, low, high))
        ax.plot(offset + scale * shown, rate_scale * plane.rate(np.zeros(shown.shape)), zorder=5, **style.MARKER[kind])
    ax.set_xlim(*sorted((offset + scale * low, offset + scale * high)))
    ends = rate_scale * plane.rate(np.array([-top, top]))
    ax.set_ylim(min(ends), max(ends))


def plot(case, path) -> Path:
    """The picture of a case, written to `path` (.png, .svg or .pdf): its phase plane where the motion reduces to one degree of
    freedom, else three projections of the trajectory. Needs case.state; raises InputError without one."""
    endings.file(path, endings.PICTURES)  # before the motion is computed
    demand(*style.PACKAGES)
    if case.state is None:
        raise InputError(f"{case.path}: a picture needs a motion: add [motion] with angular_velocity or x")
    if not case.scene.plain:
        return _histories(case, path)
    if far_exponent(case.scene, case.state) is not None:
        raise InputError("no picture: rates, torque or wheel are so large or so small that their squares leave the range of "
                         "doubles: choose other units")
    plane = phase_plane(case.scene, case.state)
    with style.drawing() as plt:
        figure = _plane_picture(plt, case, plane) if plane else _projections(plt, case)
        return style.save(figure, path)


def _histories(case, path):
    """Every part of the state over time, the analytic models beside the exact motion."""
    runs, _ = side_by_side(case, np.linspace(*(case.span or (0.0, 15.0)), 801))
    parts = [name for name in comparison.NAMES if name in runs["exact"].state]
    with style.drawing() as plt:
        figure, law = comparison.picture(plt, case, runs, parts), runs["exact"].validity
        if law is not None and not law.held:
            figure.suptitle(f"{case.heading}\n{law.short}", fontsize=10, parse_math=False, wrap=True)
        return style.save(figure, path)


def _plane_picture(plt, case, plane):
    figure, ax = plt.subplots(figsize=(7.2, 4.8), layout="constrained")
    draw(ax, plane, scale=plane.unit)
    i = plane.reduction.axis
    letter = rf"\alpha_{i + 1}"
    unit = " (rad)" if case.variables == "physical" else ""
    ax.set_xlabel(f"turn ${letter}$ about axis {i + 1} from the start{unit}")
    ax.set_ylabel(style.axis_labels(case.scene)[i])
    ax.set_title(case.heading, wrap=True, parse_math=False)
    rows = [("this motion", style.MEANING["this motion"]), ("separatrix", style.MEANING["separatrix"]),
            ("other energies", style.MEANING["level"]), ("start", style.MARKER["start"]),
            ("centre", style.MARKER["centre"]), ("saddle", style.MARKER["saddle"])]
    present = {"separatrix": bool(plane.saddles), "saddle": bool(plane.saddles), "centre": bool(plane.centres)}
    style.legend(figure, [row for row in rows if present.get(row[0], True)], columns=6)
    return figure


def _projections(plt, case):
    span = case.span or (0.0, 15.0)
    run = trajectory(case.scene, case.state, np.linspace(*span, 4001))
    states, labels = np.asarray(run.states), style.axis_labels(case.scene)
    figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.7), layout="constrained")
    for ax, (i, j) in zip(axes, ((0, 1), (0, 2), (1, 2))):
        ax.plot(states[:, i], states[:, j], color=style.BLUE, linewidth=1.0)
        ax.plot(states[0, i], states[0, j], **style.MARKER["start"])
        ax.set_xlabel(labels[i])
        ax.set_ylabel(labels[j])
    unit = case.scene.time_unit.replace("tau", "τ")
    figure.suptitle(f"{case.heading}\n{span[0]:g} to {span[1]:g} {unit}; the square marks the start", fontsize=10,
                    parse_math=False)
    return figure
