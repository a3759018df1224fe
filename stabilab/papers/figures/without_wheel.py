"""A figure that Amer et al. 2024 do not have: their formulas without a wheel, where they hold."""
from __future__ import annotations

import numpy as np

from ...orbit.phase_plane import phase_plane
from ...orbit.separatrix.branches import separatrix
from ...show import style
from ..families import sweep
from . import paper
from .figure import PRINTED, farthest
from .minor_axis import WINDOW
from .minor_map import outline

CASE = "minor-axis-without-wheel"
REACH = 4.0  # largest circle, in radii of the fold circle
SIDES = {"left": 0.0, "right": 2 * np.pi}  # side -> the turn at whose end its saddle is
TRUE = {"left": style.MEANING["separatrix 2"], "right": style.MEANING["separatrix"]}


def _case():
    return sweep(CASE)[""]


def printed_energy(radius, alpha, side):
    """x^2/2 on the separatrix by the printed (26) and (27), b = 0."""
    level = paper.height(radius, 0.0)
    return level(paper.saddle(radius, SIDES[side])) - level(alpha)


def printed_31(x1, x2, x3, side):
    """The left side of the printed (31), b = 0; tan^-1(x1/x2) goes on as an angle from the saddle."""
    square = x1**2 + x2**2
    turn = np.arctan2(x1, x2) - (np.pi if side == "right" else 0.0)
    return (2 * x3**2 + x2**2 - x1**2 - np.sqrt(np.maximum(square**2 - 4, 0.0))
            - 2 * np.arcsin(np.minimum(2 / square, 1.0)) - 4 * turn)


def true_separatrices() -> dict:
    """side -> (alpha, x >= 0) of the separatrix on the circle of the start, from the exact potential."""
    case, found = _case(), {}
    plane = phase_plane(case.scene, case.state)
    start = 2 * float(np.arctan2(*plane.place))
    span = [(edge - start) / 2 for edge in WINDOW]
    for side, turn in SIDES.items():
        saddle = min(plane.repeated(plane.saddles, *span), key=lambda y: abs(start + 2 * y - turn))
        ys, rates = plane.separatrix(saddle, *span)
        found[side] = start + 2 * ys, 2 * rates
    return found


def true_surfaces() -> dict:
    """side -> its branch of the separatrix."""
    return {paper.side(branch): branch for branch in separatrix(_case().scene, reach=REACH).branches}


def printed_ends(side) -> np.ndarray:
    """Where the printed (31) meets the plane x3 = 0: the line of saddles inward, the far ends of the loops
    outward; (n, 2)."""
    from scipy.optimize import brentq
    def ends(radius):
        saddle = paper.saddle(radius, SIDES[side])
        centre = 2 * SIDES[side] - np.pi - saddle
        far = brentq(lambda alpha: printed_energy(radius, alpha, side), saddle - 2 * np.pi, centre)
        half = np.array([saddle, far]) / 2
        return radius * np.stack([np.sin(half), np.cos(half)], axis=-1)
    near, far = np.swapaxes([ends(radius) for radius in np.sqrt(2) * np.linspace(1.0, REACH, 201)[1:]], 0, 1)
    return np.concatenate([near[::-1], far])


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
        place = np.asarray(branch.saddle)[:1]
        fold = max(fold, abs(float(np.hypot(*place[0, :2])) - np.sqrt(2)))
        named = max(named, farthest([NAMED[side]], [place]))
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
    above.plot(*paper.circle(np.sqrt(2)), **PRINTED)
    above.set(xlim=(-6, 6), ylim=(-6, 6), aspect="equal", xlabel="$x_1$", ylabel="$x_2$",
              title="from above: where the surfaces meet $x_3=0$")
    figure.suptitle(r"Without a wheel, $\lambda_1=0$: the printed formulas on the exact separatrices")
    style.legend(figure, [("left separatrix", TRUE["left"]), ("right separatrix", TRUE["right"]),
                          (r"as printed: (26), (27); (31) and $F=\sqrt{2}$", PRINTED),
                          ("centres (stable)", style.MEANING["stable"]),
                          ("folds", style.MARKER["degenerate"])], columns=3)
    return figure
