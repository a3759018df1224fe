"""Level curves of an integral in a plane, and how far printed curves are from true ones."""
from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...show import style

PRINTED = style.MEANING["printed"] | {"color": style.GREEN, "linestyle": "--", "linewidth": 1.6}
POINTS = 1201  # of the grid on which a level curve is traced, along each axis
PARTS = 16     # of a piece of a curve, where it is cut off at an edge


def level_curves(integral: Callable, level: float, x_range: Sequence, y_range: Sequence) -> list[np.ndarray]:
    """The curves integral(x, y) = level in a rectangle, arrays (n, 2) each, traced on a grid; where the
    integral has no real value there is no curve."""
    from contourpy import contour_generator
    x, y = (np.linspace(low, high, POINTS) for low, high in (x_range, y_range))
    with np.errstate(invalid="ignore", divide="ignore"):
        values = integral(*np.meshgrid(x, y))
    traced = contour_generator(x, y, np.ma.masked_invalid(values)).lines(level)
    return [np.asarray(curve, float) for curve in traced]


def within(curve: np.ndarray, x_range: Sequence, y_range: Sequence) -> np.ndarray:
    """The curve (n, 2), each of its pieces divided, with NaN for what lies outside of a rectangle."""
    low, high = np.transpose([x_range, y_range])
    place = np.arange(len(curve) * PARTS - PARTS + 1) / PARTS
    curve = np.stack([np.interp(place, np.arange(len(curve)), values) for values in curve.T], axis=-1)
    return np.where(((curve >= low) & (curve <= high)).all(axis=1, keepdims=True), curve, np.nan)


def farthest(printed: Sequence, true: Sequence) -> float:
    """Largest distance from a point of the printed curves to the nearest point of the true ones; arrays
    (..., 2) or (..., 3) of points each, the true ones close together; NaN is no point."""
    from scipy.spatial import cKDTree
    points, others = (np.concatenate([np.reshape(part, (-1, np.shape(part)[-1])) for part in curves])
                      for curves in (printed, true))
    points, others = (found[np.isfinite(found).all(axis=1)] for found in (points, others))
    return float(cKDTree(others).query(points)[0].max())
