"""The numbers of a result with their dimensions and units, in the frame of the file."""
from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...numbers.principal import PrincipalAxes
from ...orbit.result import Motion
from ...physics.scene import PARTS
from ...reasons import number
from ..axes import direction


@dataclass(frozen=True)
class Variables:
    """index: names of the dimensions that count times, states, equilibria; values: name -> (dimensions,
    array, attributes); coordinates: dimension -> (labels, attributes); attributes: of the whole."""

    index: tuple[str, ...]
    values: Mapping[str, tuple[tuple[str, ...], Any, dict[str, str]]]
    coordinates: Mapping[str, tuple[Any, dict[str, str]]] = field(default_factory=dict)
    attributes: Mapping[str, Any] = field(default_factory=dict)


AXIS: dict[str, tuple[Any, dict[str, str]]] = {"axis": ([1, 2, 3], {"long_name": "principal axis"})}


# --- In the frame of the file
FRAMES = ("file", "principal")
IN_FILE = ("Simulation", "Equilibria", "Motions")  # whose vectors turn; boxes of extremes do not
FILE_AXES = {"axis": (["x", "y", "z"], {"long_name": "axis of the file"})}
BODILY = ("omega", "gamma", "damper", "wheel", "start", "at")  # vectors, or several in a row
INERTIAL = ("momentum", "velocity", "position")


def frame_attributes(axes: PrincipalAxes, turned: bool) -> dict[str, Any]:
    """Which frame vectors are in, and where the principal axes lie in that of the file, row by row."""
    return {"frame": "file" if turned else "principal",
            "principal_axes": [float(v) for axis in axes.axes for v in axis],
            "principal_axes_of": "rows: principal axes 1, 2, 3 in the frame x, y, z of the file"}


def in_file(result: Variables, axes: PrincipalAxes) -> Variables:
    """The vectors of the body in the frame of the file; axes: the principal axes there."""
    matrix = matrix_of(axes)
    values = {name: (tuple("inertial_axis" if name in INERTIAL and dim == "axis" else dim for dim in dims),
                     turned_to_file(name, np.asarray(item), matrix), text)
              for name, (dims, item, text) in result.values.items()}
    coordinates = {name: coordinate for name, coordinate in result.coordinates.items() if name != "axis"}
    return replace(result, values=values, coordinates=coordinates | FILE_AXES)


def matrix_of(axes: PrincipalAxes) -> np.ndarray:
    """(3, 3): the principal axes in the frame of the file, a row each."""
    return np.array([[float(v) for v in axis] for axis in axes.axes])


def turned_to_file(name: str, values: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """A part of the state along the principal axes, the rows of `matrix`, in the frame of the file: of a
    vector w matrix^T w, of an attitude R (from the body to space) R matrix."""
    if name in BODILY:
        return np.concatenate([values[..., n:n + 3] @ matrix for n in range(0, values.shape[-1], 3)], axis=-1)
    if name == "matrix":
        return values @ matrix
    return _times(values, _quaternion(matrix)) if name == "quaternion" else values


def _times(values: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Products of quaternions (n, 4) with another, scalar last."""
    x, y, z, w = np.moveaxis(values, -1, 0)
    a, b, c, d = other
    return np.stack([w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a,
                     w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c], axis=-1)


def _quaternion(m: np.ndarray) -> np.ndarray:
    """Scalar last, of a rotation matrix: the last eigenvector of Bar-Itzhack's matrix."""
    sides = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    k = np.zeros((4, 4))
    k[:3, :3], k[:3, 3], k[3, :3] = m + m.T - np.trace(m) * np.eye(3), sides, sides
    k[3, 3] = np.trace(m)
    result = np.linalg.eigh(k)[1][:, -1]
    return result if result[3] >= 0 else -result


# --- Cells and words that kinds of results have in common
def texts(dims: tuple[str, ...], values: Iterable[Any], **text: str):
    return dims, np.array(list(values), dtype=object), text


def numbers(dims: tuple[str, ...], values: Iterable[Any], **text: str):
    """Numbers, NaN for None."""
    return dims, np.array([np.nan if v is None else v for v in values], float), text


def along_axes(values: Sequence[float], **text: str):
    """A vector along the principal axes, NaN where there is none."""
    return ("axis",), np.array(values or (math.nan,) * 3, float), text


def where_known(notes: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in notes.items() if value is not None}


def dimensions(array) -> tuple[str, ...]:
    return ("state",) if array.ndim == 1 else tuple(f"state_{n + 1}" for n in range(array.ndim))


def named(text: str, value: float | None, side: int = 0):
    return "" if value is None else f"{text} {number(value, 6, side)}"


def shares(text):
    return ", ".join(f"{number} {word}" for word, number in Counter(text).items())


def about_axis(result: Motion) -> str:
    return f" about axis {result.axis}, {direction(result.sense)}" if result.axis else ""


def of_parts(parts: Mapping[str, Any], time: str = "time",
             errors: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Parts of the state over time, with units and words; time: the name of their first dimension; errors: of
    their components, where known, of a matrix row by row as files take it."""
    resolved = errors or {}
    return {name: ((time, *_across(name, np.asarray(values))), np.asarray(values),
                   {"units": PARTS[name].unit or "1", "long_name": PARTS[name].description}
                   | ({"error": np.ravel(resolved[name]) if np.ndim(resolved[name]) > 1 else resolved[name]}
                      if name in resolved else {}))
            for name, values in parts.items()}


def _across(name: str, values: np.ndarray) -> tuple[str, ...]:
    if values.ndim == 3:
        return "inertial_axis", "axis"
    return () if values.ndim < 2 else ("axis",) if values.shape[-1] == 3 else (f"{name}_component",)
