"""Figures 8-15 of Amer et al. 2024: torque on the major axis, along the momentum wheel; no motion is bounded.
"""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...answers.simulate import trajectory
from ...physics.coefficients import to_scaled
from ...show import style
from ...unreduced.growth.law import captured_fate
from . import paper
from .figure import listed

PLANES = {"13": (0, 2), "23": (1, 2), "12": (0, 1)}
AFTER = 6.0  # tau for which a motion is followed beyond its release
RELEASE = {"marker": "D", "color": style.VERMILION, "markersize": 6, "linestyle": "none"}
PRINTED, LATER = {"color": style.BLUE, "linewidth": 0.7}, {"color": style.GREY, "linewidth": 0.6}


@lru_cache
def _trajectories(start, released=False):
    """lambda1 -> trajectory over the paper's span, or to a while after the release."""
    return {lam: trajectory(paper.scene("major", lam), start, _times(lam, start, released))
            for lam in paper.LAMBDAS}


def _times(lam, start, released):
    """400 times a unit of tau: over the paper's span, or to `AFTER` beyond the release or the paper's span,
    whichever comes later."""
    end = max(paper.SPAN[1], _release(lam, start) + AFTER) if released else paper.SPAN[1]
    return np.arange(int(400 * end) + 1) / 400


@lru_cache
def _release(lam, start) -> float:
    """tau of the release of a run: the last time at which the turn about axis 1 reverses."""
    return captured_fate(paper.scene("major", lam), start).release_time


def _runs(start):
    """The three runs of a start: lambda1 -> states (n, 3) over tau in [0, 15]."""
    return {lam: np.asarray(run.states) for lam, run in _trajectories(start).items()}


def exactness(start) -> str:
    """How exact the runs of a start are: by their laws."""
    runs = [*_trajectories(start).values(), *(_trajectories(start, True).values() if captured(start) else ())]
    return ("Taylor integration, relative tolerance 1.1e-16, 400 points a unit of τ; the laws of the motion "
            f"drift by {paper.drift(runs):.1e} at most")


def captured(start) -> bool:
    """Whether any run of a start is captured for a while."""
    return any(_release(lam, start) > 0 for lam in paper.LAMBDAS)


def amplitudes(start, component) -> str:
    """Largest size of a component in each of the three runs of a start."""
    return listed([np.abs(states[:, component]).max() for states in _runs(start).values()], "{:.2f}")


def releases(start) -> str:
    """When each run of a start is released from its capture."""
    times = [_release(lam, start) for lam in paper.LAMBDAS]
    return (f"This start is released at τ = {listed(times, '{:.1f}')} for λ1 = "
            f"{listed(paper.LAMBDAS, '{}')}: released means that the turn about axis 1 reverses for the last "
            "time, and the body spins up for ever. Upper row: τ from 0 to 15, as in print; lower row: the "
            f"same motions to τ = {AFTER:g} after their release.")


def second() -> float:
    """Seconds of one unit of tau for the paper's body."""
    return float(to_scaled(paper.physical("major", paper.LAMBDAS[0]), mu=paper.TORQUE["major"])[1].time)


def _rows(start):
    """[(words, lambda1 -> (states, number of them in print, place of the release or None))] a row of panels
    each."""
    found = [(r"$\tau\in[0,15]$", {lam: (states, len(states), None) for lam, states in _runs(start).items()})]
    if captured(start):
        longer = {}
        for lam, run in _trajectories(start, True).items():
            states = np.asarray(run.states)
            longer[lam] = states, len(_times(lam, start, False)), int(round(400 * _release(lam, start)))
        found.append(("to the release and beyond", longer))
    return found


def _title(figure, start):
    figure.suptitle(
        f"Torque on the major axis from x(0) = ({', '.join(f'{v:g}' for v in start).replace('-', '−')})")


def _legend(figure, start, extra=()):
    rows = [("start", style.MARKER["start"]), *extra]
    style.legend(figure, rows + ([("release", RELEASE)] if captured(start) else []))


def space(start):
    """Figs 8 and 12: the motions in (x1, x2, x3), coloured by time."""
    def picture(plt):
        from matplotlib.ticker import MaxNLocator
        rows = _rows(start)
        figure = plt.figure(figsize=(12.6, 0.9 + 3.4 * len(rows)), layout="constrained")
        for i, (words, runs) in enumerate(rows):
            shared = i > 0 or not captured(start)
            limits = _limits([states for states, *_ in runs.values()]) if shared else None
            panels = [figure.add_subplot(len(rows), 3, 3 * i + j + 1, projection="3d")
                      for j in range(len(runs))]
            end = max(len(states) for states, *_ in runs.values()) / 400
            for ax, (lam, (states, _, release)) in zip(panels, runs.items()):
                pieces = _coloured(ax, states, end, limits or _limits([states]))
                ax.plot(*states[:1].T, **style.MARKER["start"])
                if release is not None:
                    ax.plot(*states[release:release + 1].T, zorder=9, **RELEASE)
                scale = "one scale" if shared else "own scale"
                ax.set_title(rf"$\lambda_1={lam}$, {words}; {scale}", fontsize=9.5)
            bar = figure.colorbar(pieces, ax=panels, shrink=0.6, pad=0.05, ticks=MaxNLocator(8, integer=True))
            bar.ax.set_title(r"$\tau$")
        _title(figure, start)
        _legend(figure, start)
        return figure
    return picture


def _coloured(ax, states, end, limits):
    """One motion as a line whose colour tells the time."""
    from matplotlib.colors import LinearSegmentedColormap
    from mpl_toolkits.mplot3d.art3d import Line3DCollection
    colours = LinearSegmentedColormap.from_list("time", [style.SKY, style.BLUE, "#1B1B3A"])
    pieces = Line3DCollection(np.stack([states[:-1], states[1:]], 1), cmap=colours, linewidth=0.9)
    pieces.set_array(np.arange(len(states) - 1) / 400)
    pieces.set_clim(0.0, end)
    ax.add_collection3d(pieces)
    for setter, pair in zip((ax.set_xlim, ax.set_ylim, ax.set_zlim), limits):
        setter(*pair)
    ax.view_init(22, -62)
    paper.name_space(ax, 1.05)
    return pieces


def _limits(runs):
    """[(low, high)] of each component of the runs, with some room."""
    states = np.concatenate(runs)
    room = 0.05 * np.ptp(states, axis=0)
    return list(zip(states.min(0) - room, states.max(0) + room))


def projection(start, plane):
    """Figs 9-11 and 13-15: the same motions seen along one axis."""
    i, j = PLANES[plane]

    def picture(plt):
        rows = _rows(start)
        width = 8.2 if plane == "23" and len(rows) > 1 else 11.4  # a tall plane of one scale
        figure, lines = plt.subplots(len(rows), 3, figsize=(width, 0.7 + 3.5 * len(rows)), sharex="row",
                                     sharey="row", layout="constrained", squeeze=False)
        for axes, (words, runs) in zip(lines, rows):
            for ax, (lam, (states, printed, release)) in zip(axes, runs.items()):
                ax.plot(states[printed - 1:, i], states[printed - 1:, j], **LATER)
                ax.plot(states[:printed, i], states[:printed, j], **PRINTED)
                ax.plot(states[0, i], states[0, j], zorder=5, **style.MARKER["start"])
                if release is not None:
                    ax.plot(states[release, i], states[release, j], zorder=6, **RELEASE)
                ax.set_title(rf"$\lambda_1={lam}$, {words}", fontsize=8.5 if width < 10 else 9.5)
                ax.set_xlabel(f"$x_{i + 1}$")
                if plane == "23":
                    ax.set_aspect("equal")
            axes[0].set_ylabel(f"$x_{j + 1}$")
        _title(figure, start)
        later = [(r"later", LATER)] if len(rows) > 1 else []
        _legend(figure, start, [(r"$\tau\in[0,15]$", PRINTED | {"linewidth": 1.6}), *later])
        return figure
    return picture
