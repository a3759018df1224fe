"""Turning a symmetric body so that its torque lies along a principal axis: every axis in the plane of two equal
moments is principal."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from ..numbers.exact import sqrt_fraction
from ..numbers.vectors import Number, dot
from .scene import AnyScene, Scene

if TYPE_CHECKING:
    import numpy as np


class Turn(NamedTuple):
    """twin: the scene with its torque along one axis. rotation: rows of Fractions, omega_twin = rotation @ omega, good to 240
    bits. exact: no row was rounded."""

    twin: Scene
    rotation: list[list[Fraction]]
    exact: bool

    def __call__(self, state: Sequence[Number]) -> tuple[Fraction, ...]:
        """The twin's state for a state of the scene, numbers exact."""
        return tuple(sum((r * Fraction(v) for r, v in zip(row, state)), Fraction(0)) for row in self.rotation)

    @property
    def matrix(self) -> np.ndarray:
        """(3, 3) array of the rotation's doubles."""
        import numpy as np
        return np.array([[float(v) for v in row] for row in self.rotation])


def aligned(scene: AnyScene) -> Turn | None:
    """The scene turned so that its torque lies along one axis, where its equal moments allow it.

    The twin has the same moments; its torque lies exactly along an axis, and its gyrostatic component along the torque
    is exactly zero where the scene's is.
    """
    if scene.variables != "physical":
        return None
    D, M, lam = scene.body.exact, scene.vector("constant_torque"), scene.vector("gyrostat")
    acting = [i for i in range(3) if M[i]]
    if len(acting) < 2 or len({D[i] for i in acting}) > 1:
        return None
    i = acting[0]
    length = sqrt_fraction(dot(M, M))
    unit = [m / length for m in M]
    # the second direction lies in the equal plane, across the torque
    j = acting[1]
    across = [Fraction(0)] * 3
    size = sqrt_fraction(unit[i] ** 2 + unit[j] ** 2)
    across[i], across[j] = -unit[j] / size, unit[i] / size
    third = [unit[1] * across[2] - unit[2] * across[1], unit[2] * across[0] - unit[0] * across[2],
             unit[0] * across[1] - unit[1] * across[0]]
    even = (i, j, 3 - i - j) in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
    rows = {i: unit, j: across, 3 - i - j: third if even else [-v for v in third]}
    rotation = [rows[n] for n in range(3)]
    turned = [dot(row, lam) for row in rotation]
    if sum(m * v for m, v in zip(M, lam)) == 0:
        turned[i] = Fraction(0)
    torque = [length if n == i else Fraction(0) for n in range(3)]
    exact = length**2 == sum(m * m for m in M) and size**2 == unit[i] ** 2 + unit[j] ** 2
    return Turn(_turned(scene, {"gyrostat": turned, "constant_torque": torque}), rotation, exact)


def _turned(scene: Scene, vectors: Mapping[str, Sequence[Fraction]]) -> Scene:
    """The scene with these vectors in place of those of its wheel and torque."""
    kinds: dict[str, Any] = {effect.name: type(effect) for effect in scene.effects}
    return Scene(scene.body, *(kind(tuple(vectors[name])) for name, kind in kinds.items()))


def torque_axis(scene: AnyScene) -> int:
    """The principal axis, 1 to 3, that the whole torque of a scene is along; 0 where there is none, or other effects act."""
    acting = [n for n, m in enumerate(scene.quadratic().m, 1) if m] if scene.plain else []
    return acting[0] if len(acting) == 1 else 0
