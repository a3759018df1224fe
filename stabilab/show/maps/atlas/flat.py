"""The sphere of directions on a sheet: Hammer's map, on which areas are kept, turned so that no principal axis lies on its rim.

Axis 3 points up. Axes 1 and 2 stand 45 degrees left and right of the middle, so all six directions of the axes lie inside; the rim is half way from -1 to -2.
"""
from __future__ import annotations

import numpy as np

ACROSS, UP = 2 * np.sqrt(2), np.sqrt(2)  # half the width and half the height of the map
MIDDLE = np.pi / 4  # longitude, from axis 1 towards axis 2, of the map's middle


def on_sheet(directions: np.ndarray) -> np.ndarray:
    """(n, 2): where directions (n, 3) lie on the map."""
    directions = np.asarray(directions, float)
    size = np.linalg.norm(directions, axis=1)
    turn = np.arctan2(directions[:, 1], directions[:, 0]) - MIDDLE
    turn = (turn + np.pi) % (2 * np.pi) - np.pi
    sine = directions[:, 2] / size
    cosine = np.sqrt(np.maximum(1 - sine**2, 0.0))
    root = np.sqrt(1 + cosine * np.cos(turn / 2))
    return np.stack([ACROSS * cosine * np.sin(turn / 2) / root, UP * sine / root], axis=1)


def off_sheet(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """((n, 3) directions of places on the map, (n,) whether they lie on it)."""
    inside = (x / ACROSS) ** 2 + (y / UP) ** 2 <= 1
    root = np.sqrt(np.maximum(1 - (x / 4) ** 2 - (y / 2) ** 2, 0.5))
    turn = 2 * np.arctan2(root * x, 2 * (2 * root**2 - 1)) + MIDDLE
    sine = np.clip(root * y, -1, 1)
    cosine = np.sqrt(1 - sine**2)
    return np.stack([cosine * np.cos(turn), cosine * np.sin(turn), sine], axis=-1), inside


def pieces(directions: np.ndarray) -> list[np.ndarray]:
    """A line of directions on the map, cut where it leaves over the rim."""
    at = on_sheet(directions)
    breaks = np.flatnonzero(np.abs(np.diff(at[:, 0])) > ACROSS) + 1
    return np.split(at, breaks)


def circle(axis: int) -> np.ndarray:
    """(n, 3): the principal plane across an axis, 0 to 2."""
    turn = np.linspace(0, 2 * np.pi, 721)
    out = np.zeros((len(turn), 3))
    out[:, (axis + 1) % 3], out[:, (axis + 2) % 3] = np.cos(turn), np.sin(turn)
    return out


def rim() -> np.ndarray:
    """(n, 2): the outline of the map."""
    turn = np.linspace(0, 2 * np.pi, 361)
    return np.stack([ACROSS * np.cos(turn), UP * np.sin(turn)], axis=1)
