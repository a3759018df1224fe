"""Figures 8-15 of Amer et al. 2024: torque on the major axis, along the momentum wheel; no motion is bounded."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...answers.trajectory import trajectory
from ...physics.scaling import to_scaled
from ...unreduced.growth import captured_fate
from .. import style
from . import paper
from .figure import listed

PLANES = {"13": (0, 2), "23": (1, 2), "12": (0, 1)}


@lru_cache
def _trajectories(start):
    times = np.linspace(*paper.SPAN, 6001)
    return {lam: trajectory(paper.scene("major", lam), start, times) for lam in paper.LAMBDAS}


def _runs(start):
    """The three runs of a start: lambda1 -> states (n, 3) over tau in [0, 15]."""
    return {lam: np.asarray(run.states) for lam, run in _trajectories(start).items()}


def exactness(start) -> str:
    """How exact the runs of a start are: by their laws."""
    drift = max(d for run in _trajectories(start).values() for d in run.invariant_drift.values())
    return f"Taylor integration, relative tolerance 1.1e-16, 6001 points; the laws of the motion drift by {drift:.1e} at most"


def amplitudes(start, component) -> str:
    """Largest size of a component in each of the three runs of a start."""
    return listed([np.abs(states[:, component]).max() for states in _runs(start).values()], "{:.2f}")


def releases(start) -> str:
    """When each run of a start is released from its capture."""
    times = [captured_fate(paper.scene("major", lam), start).release_time for lam in paper.LAMBDAS]
    return f"This start is released at τ = {listed(times, '{:.1f}')} for λ1 = {listed(paper.LAMBDAS, '{}')}."


def second() -> float:
    """Seconds of one unit of tau for the paper's body."""
    return float(to_scaled(paper.physical("major", paper.LAMBDAS[0]), mu=paper.TORQUE["major"])[1].time)


def space(start):
    """Figs 8 and 12: the motions in (x1, x2, x3)."""
    def picture(plt):
        from matplotlib.colors import LinearSegmentedColormap
        from mpl_toolkits.mplot3d.art3d import Line3DCollection
        figure = plt.figure(figsize=(11.4, 4.2), layout="constrained")
        colours = LinearSegmentedColormap.from_list("time", [style.SKY, style.BLUE, "#1B1B3A"])
        for index, (lam, states) in enumerate(_runs(start).items()):
            ax = figure.add_subplot(1, 3, index + 1, projection="3d")
            pieces = Line3DCollection(np.stack([states[:-1], states[1:]], 1), cmap=colours, linewidth=0.9)
            pieces.set_array(np.linspace(*paper.SPAN, len(states) - 1))
            ax.add_collection3d(pieces)
            ax.plot(*states[:1].T, **style.MARKER["start"])
            for setter, column in zip((ax.set_xlim, ax.set_ylim, ax.set_zlim), states.T):
                room = 0.05 * np.ptp(column)
                setter(column.min() - room, column.max() + room)
            ax.view_init(22, -62)
            style.name_space(ax, 0.9)
            ax.set_title(rf"$\lambda_1={lam}$")
        bar = figure.colorbar(pieces, ax=figure.axes, shrink=0.6, pad=0.06)
        bar.ax.set_title(r"$\tau$")
        figure.suptitle(f"Torque on the major axis from x(0) = ({', '.join(f'{v:g}' for v in start)}), "
                        r"$\tau\in[0,15]$; square: start")
        return figure
    return picture


def projection(start, plane):
    """Figs 9-11 and 13-15: the same motions seen along one axis."""
    i, j = PLANES[plane]

    def picture(plt):
        figure, axes = plt.subplots(1, 3, figsize=(10.8, 3.9), sharey=True, layout="constrained")
        for ax, (lam, states), colour in zip(axes, _runs(start).items(), style.SERIES):
            ax.plot(states[:, i], states[:, j], color=colour, linewidth=0.7)
            ax.plot(states[0, i], states[0, j], **style.MARKER["start"])
            ax.set_title(rf"$\lambda_1={lam}$")
            ax.set_xlabel(f"$x_{i + 1}$")
            ax.set_aspect("equal" if plane == "23" and start == paper.START_MAJOR else "auto")
        axes[0].set_ylabel(f"$x_{j + 1}$")
        figure.suptitle(f"Torque on the major axis from x(0) = ({', '.join(f'{v:g}' for v in start)}), "
                        r"$\tau\in[0,15]$; square: start")
        return figure
    return picture
