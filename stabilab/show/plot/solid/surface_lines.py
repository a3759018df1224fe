"""What a plot of a surface with motions on it is made of, and which of its lines lie in front."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .in_space import Box

STEEP = 33  # degrees of elevation: from higher up the axes' labels run into each other
Look = dict[str, Any]


@dataclass
class SurfaceLines:
    """surface: triangles (n, 3, 3); box, view, labels: of the axes; words: for the title; lines: (points (n, 3), look, whether in front); marks:
    (points, look); rows: of the legend. All in the units of the axes."""

    surface: np.ndarray
    box: Box
    view: tuple[float, float]
    labels: tuple[str, ...]
    words: str
    lines: list[tuple[np.ndarray, Look, bool]] = field(default_factory=list)
    marks: list[tuple[np.ndarray, Look]] = field(default_factory=list)
    rows: list[tuple[str, Look]] = field(default_factory=list)

    def add(self, points: np.ndarray, look: Look, outward: np.ndarray) -> None:
        """A line, in parts that lie in front of the surface and behind it; outward (n, 3): normals of the surface, zero where it hides nothing."""
        front = outward @ sight(self.view) >= 0
        for side in (True, False):
            near = front == side
            near[:-1] |= near[1:] if side else False  # the part in front takes the step across the edge
            if near.any():
                self.lines.append((np.where(near[:, None], points, np.nan), look, side))


def sight(view: tuple[float, float]) -> np.ndarray:
    """The direction from the centre to the eye."""
    up, round_ = np.radians(view)
    return np.array([np.cos(up) * np.cos(round_), np.cos(up) * np.sin(round_), np.sin(up)])


def facing(direction: np.ndarray, aside: float = 25.0) -> tuple[float, float]:
    """A view in which a direction points to the eye, somewhat aside."""
    size = float(np.linalg.norm(direction)) or 1.0
    up = float(np.degrees(np.arcsin(np.clip(direction[2] / size, -1, 1))))
    return float(np.clip(up + 12, -STEEP, STEEP)), float(np.degrees(np.arctan2(direction[1], direction[0])) + aside)


def grid_triangles(points: np.ndarray) -> np.ndarray:
    """Triangles (n, 3, 3) of a grid of points (r, c, 3)."""
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[:-1, 1:], points[1:, 1:]
    return np.concatenate([np.stack([a, b, d], 2).reshape(-1, 3, 3), np.stack([a, d, c], 2).reshape(-1, 3, 3)])


def levels(x: np.ndarray, y: np.ndarray, height: np.ndarray, values: Any) -> list[np.ndarray]:
    """The lines (n, 2) in (x, y) on which a function, height (y, x), has one of the values."""
    from contourpy import contour_generator
    contours: Any = contour_generator(x, y, height)
    return [line for value in values for line in contours.lines(float(value)) if len(line) > 1]
