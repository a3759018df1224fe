"""Figures 8-15 of Amer et al. 2024: torque on the major axis, along the momentum wheel; no motion is
bounded.

One figure more than they have: their formulas without a wheel, where these hold."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...answers.simulate import trajectory
from ...orbit.phase_plane import phase_plane
from ...orbit.separatrix.branches import separatrix
from ...physics.coefficients import to_scaled
from ...show import style
from ...unreduced.growth import captured_fate
from .. import table
from ..families import sweep
from ..printed_integrals import height
from .figure import PRINTED, farthest, listed
from .minor_axis import WINDOW, outline

PLANES = {"13": (0, 2), "23": (1, 2), "12": (0, 1)}
AFTER = 6.0  # tau for which a motion is followed beyond its release
RELEASE = {"marker": "D", "color": style.VERMILION, "markersize": 6, "linestyle": "none"}
PRINTED_LINE, LATER = {"color": style.BLUE, "linewidth": 0.7}, {"color": style.GREY, "linewidth": 0.6}


@lru_cache
def _trajectories(start, released=False):
    """lambda1 -> trajectory over the paper's span, or to a while after the release."""
    return {lam: trajectory(table.printed_scene("major", lam), start, _times(lam, start, released))
            for lam in table.LAMBDAS}


def _times(lam, start, released):
    """400 times a unit of tau: over the paper's span, or to `AFTER` beyond the release or the paper's span,
    whichever comes later."""
    end = max(table.SPAN[1], _release(lam, start) + AFTER) if released else table.SPAN[1]
    return np.arange(int(400 * end) + 1) / 400


@lru_cache
def _release(lam, start) -> float:
    """tau of the release of a run: the last time at which the turn about axis 1 reverses."""
    return captured_fate(table.printed_scene("major", lam), start).release_time


def _runs(start):
    """The three runs of a start: lambda1 -> states (n, 3) over tau in [0, 15]."""
    return {lam: np.asarray(run.states) for lam, run in _trajectories(start).items()}


def exactness(start) -> str:
    """How exact the runs of a start are: by their laws."""
    runs = [*_trajectories(start).values(), *(_trajectories(start, True).values() if captured(start) else ())]
    return ("Taylor integration, relative tolerance 1.1e-16, 400 points a unit of τ; the laws of the motion "
            f"drift by {table.drift(runs):.1e} at most")


def captured(start) -> bool:
    """Whether any run of a start is captured for a while."""
    return any(_release(lam, start) > 0 for lam in table.LAMBDAS)


def amplitudes(start, component) -> str:
    """Largest size of a component in each of the three runs of a start."""
    return listed([np.abs(states[:, component]).max() for states in _runs(start).values()], "{:.2f}")


def releases(start) -> str:
    """When each run of a start is released from its capture."""
    times = [_release(lam, start) for lam in table.LAMBDAS]
    return (f"This start is released at τ = {listed(times, '{:.1f}')} for λ1 = "
            f"{listed(table.LAMBDAS, '{}')}: released means that the turn about axis 1 reverses for the last "
            "time, and the body spins up for ever. Upper row: τ from 0 to 15, as in print; lower row: the "
            f"same motions to τ = {AFTER:g} after their release.")


def second() -> float:
    """Seconds of one unit of tau for the paper's body."""
    return float(to_scaled(table.physical("major", table.LAMBDAS[0]), mu=table.TORQUE["major"])[1].time)


def _rows(start):
    """[(words, lambda1 -> (states, number of them in print, place of the release or None))] a row of panels
    each."""
    rows = [(r"$\tau\in[0,15]$", {lam: (states, len(states), None) for lam, states in _runs(start).items()})]
    if captured(start):
        longer = {}
        for lam, run in _trajectories(start, True).items():
            states = np.asarray(run.states)
            longer[lam] = states, len(_times(lam, start, False)), int(round(400 * _release(lam, start)))
        rows.append(("to the release and beyond", longer))
    return rows


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
        for i, (text, runs) in enumerate(rows):
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
                ax.set_title(rf"$\lambda_1={lam}$, {text}; {scale}", fontsize=9.5)
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
    table.name_space(ax, 1.05)
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
        for axes, (text, runs) in zip(lines, rows):
            for ax, (lam, (states, printed, release)) in zip(axes, runs.items()):
                ax.plot(states[printed - 1:, i], states[printed - 1:, j], **LATER)
                ax.plot(states[:printed, i], states[:printed, j], **PRINTED_LINE)
                ax.plot(states[0, i], states[0, j], zorder=5, **style.MARKER["start"])
                if release is not None:
                    ax.plot(states[release, i], states[release, j], zorder=6, **RELEASE)
                ax.set_title(rf"$\lambda_1={lam}$, {text}", fontsize=8.5 if width < 10 else 9.5)
                ax.set_xlabel(f"$x_{i + 1}$")
                if plane == "23":
                    ax.set_aspect("equal")
            axes[0].set_ylabel(f"$x_{j + 1}$")
        _title(figure, start)
        later = [(r"later", LATER)] if len(rows) > 1 else []
        _legend(figure, start, [(r"$\tau\in[0,15]$", PRINTED_LINE | {"linewidth": 1.6}), *later])
        return figure
    return picture


CASE = "minor-axis-without-wheel"
REACH = 4.0  # largest circle, in radii of the fold circle
SIDES = {"left": 0.0, "right": 2 * np.pi}  # side -> the turn at whose end its saddle is
TRUE = {"left": style.MEANING["separatrix 2"], "right": style.MEANING["separatrix"]}


def _case():
    return sweep(CASE)[""]


def printed_energy(radius: float, alpha: np.ndarray, side: str):
    """x^2/2 on the separatrix by the printed (26) and (27), b = 0."""
    level = height(radius, 0.0)
    return level(table.saddle(radius, SIDES[side])) - level(alpha)


def printed_31(x1: np.ndarray, x2: np.ndarray, x3: np.ndarray, side: str):
    """The left side of the printed (31), b = 0; tan^-1(x1/x2) goes on as an angle from the saddle."""
    square = x1**2 + x2**2
    turn = np.arctan2(x1, x2) - (np.pi if side == "right" else 0.0)
    return (2 * x3**2 + x2**2 - x1**2 - np.sqrt(np.maximum(square**2 - 4, 0.0))
            - 2 * np.arcsin(np.minimum(2 / square, 1.0)) - 4 * turn)


def true_separatrices() -> dict:
    """side -> (alpha, x >= 0) of the separatrix on the circle of the start, from the exact potential."""
    case, result = _case(), {}
    plane = phase_plane(case.scene, case.state)
    start = 2 * float(np.arctan2(*plane.place))
    span = [(edge - start) / 2 for edge in WINDOW]
    for side, turn in SIDES.items():
        saddle = min(plane.repeated(plane.saddles, *span), key=lambda y: abs(start + 2 * y - turn))
        ys, rates = plane.separatrix(saddle, *span)
        result[side] = start + 2 * ys, 2 * rates
    return result


def true_surfaces() -> dict:
    """side -> its branch of the separatrix."""
    return {table.side(branch): branch for branch in separatrix(_case().scene, reach=REACH).branches}


def printed_ends(side: str) -> np.ndarray:
    """Where the printed (31) meets the plane x3 = 0: the line of saddles inward, the far ends of the loops
    outward; (n, 2)."""
    from scipy.optimize import brentq
    def ends(radius):
        saddle = table.saddle(radius, SIDES[side])
        centre = 2 * SIDES[side] - np.pi - saddle
        far = brentq(lambda alpha: printed_energy(radius, alpha, side), saddle - 2 * np.pi, centre)
        half = np.array([saddle, far]) / 2
        return radius * np.stack([np.sin(half), np.cos(half)], axis=-1)
    close, far = np.swapaxes([ends(radius) for radius in np.sqrt(2) * np.linspace(1.0, REACH, 201)[1:]], 0, 1)
    return np.concatenate([close[::-1], far])


def departures() -> tuple[float, float, float, float]:
    """Largest differences, printed from true: of x^2/2 on the separatrices, of (31) from 0 on the surfaces,
    both as shares of F^2; of the radius of the folds from sqrt 2; of a fold from that which the text gives
    its surface."""
    radius = np.hypot(*_case().state[:2])
    energy = max(float(np.abs(printed_energy(radius, alpha, side) - x**2 / 2).max()) / radius**2
                 for side, (alpha, x) in true_separatrices().items())
    surface, fold, named = 0.0, 0.0, 0.0
    for side, branch in true_surfaces().items():
        x1, x2, x3 = np.moveaxis(np.asarray(branch.points), -1, 0)
        surface = max(surface, float(np.abs(printed_31(x1, x2, x3, side) / (x1**2 + x2**2)).max()))
        location = np.asarray(branch.saddle)[:1]
        fold = max(fold, abs(float(np.hypot(*location[0, :2])) - np.sqrt(2)))
        named = max(named, farthest([NAMED[side]], [location]))
    return energy, surface, fold, named


NAMED = {"left": [(1.0, -1.0, 0.0)], "right": [(-1.0, 1.0, 0.0)]}  # folds, as the text names them


def words() -> str:
    """The caption, with the largest departures."""
    energy, surface, fold, named = departures()
    return (f"Not in the paper: its body and start without a wheel, the case {CASE}. Here (26), (27) and "
            f"(31) hold. Dashed, on the true curves: (26) and (27), whose x²/2 is off by {energy:.0e} F² at "
            f"most; the circle F = √2, on which the folds lie within {max(fold, 2**-52):.0e}; and where (31) "
            f"meets x3 = 0. On the true surfaces the left side of (31), which should vanish, is "
            f"{surface:.0e} F² at most. Wrong still: the text has the folds of the two surfaces exchanged, "
            f"{named:.2f} away.")


def draw(plt):
    """Phase plane of the start's circle, and the surfaces from above."""
    figure, (plane, above) = plt.subplots(1, 2, figsize=(11.4, 5.6), layout="constrained")
    radius = np.hypot(*_case().state[:2])
    for side, (alpha, x) in true_separatrices().items():
        line = np.concatenate([alpha[::-1], alpha]), np.concatenate([-x[::-1], x])
        plane.plot(*line, **TRUE[side])
        printed = np.sqrt(np.maximum(2 * printed_energy(radius, alpha, side), 0.0))
        for sign in (1, -1):
            plane.plot(alpha, sign * printed, **PRINTED)
    plane.set(xlim=WINDOW, xlabel=r"$\alpha = 2\,\mathrm{atan2}(x_1,\ x_2)$", ylabel=r"$x = 2\,x_3$",
              title=rf"on the circle of the start, $F={radius:.4f}$")
    for side, branch in true_surfaces().items():
        above.plot(*outline(np.asarray(branch.points))[:, :2].T, **TRUE[side])
        above.plot(*printed_ends(side).T, **PRINTED)
        above.plot(*np.asarray(branch.centre)[:, :2].T, **style.MEANING["stable"])
        above.plot(*np.asarray(branch.saddle)[:1, :2].T, zorder=6, **style.MARKER["degenerate"])
    above.plot(*table.circle(np.sqrt(2)), **PRINTED)
    above.set(xlim=(-6, 6), ylim=(-6, 6), aspect="equal", xlabel="$x_1$", ylabel="$x_2$",
              title="from above: where the surfaces meet $x_3=0$")
    figure.suptitle(r"Without a wheel, $\lambda_1=0$: the printed formulas on the exact separatrices")
    style.legend(figure, [("left separatrix", TRUE["left"]), ("right separatrix", TRUE["right"]),
                          (r"as printed: (26), (27); (31) and $F=\sqrt{2}$", PRINTED),
                          ("centres (stable)", style.MEANING["stable"]),
                          ("folds", style.MARKER["degenerate"])], columns=3)
    return figure
