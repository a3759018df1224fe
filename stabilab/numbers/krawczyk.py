"""All common zeros of three polynomials in a box, by exclusion and by proof of existence (Krawczyk), none
lost.

A box is put aside where the linear part at its middle outweighs all higher terms (no zero), settled where
Krawczyk's test holds on the box half as large again (exactly one zero there), and halved otherwise. Rounding
is covered by a slack far above it.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

Polynomial: TypeAlias = Mapping[tuple[int, ...], Any]  # powers of x1, x2, x3 -> coefficient
BUDGET = 400_000
WIDER = 1.5       # a zero on the edge of a box is found from both sides
SLACK = 1e-11     # relative to the sum of the terms' sizes; some forty roundings of 1e-16 each


@dataclass(frozen=True)
class Zeros:
    """points: (n, 3) approximations, each with a zero of its own proved next to it; complete: False where the
    budget of boxes ran out."""

    points: np.ndarray
    complete: bool
    boxes: int


class _Polynomials:
    """Three polynomials {powers: coefficient} with all their derivatives, over batches of points (n, 3): one
    table of monomials serves them all."""

    def __init__(self, polynomials: Sequence[Polynomial]) -> None:
        first = [[_derivative(p, k) for k in range(3)] for p in polynomials]
        second = [[[_derivative(q, l) for l in range(3)] for q in row] for row in first]
        self.third = np.array([[[[_constant(_derivative(q, m)) for m in range(3)] for q in row]
                                for row in rows] for rows in second])
        self.f = _columns(polynomials)
        self.J = _columns([q for row in first for q in row])
        self.all = np.concatenate([self.f, self.J,
                                   _columns([q for rows in second for row in rows for q in row])], axis=1)

    def values(self, x: np.ndarray) -> np.ndarray:
        return _monomials(x) @ self.f

    def sizes(self, x: np.ndarray) -> np.ndarray:
        return _monomials(np.abs(x)) @ np.abs(self.f)

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        return (_monomials(x) @ self.J).reshape(-1, 3, 3)

    def at(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Values (n, 3), first derivatives (n, 3, 3), second ones (n, 3, 3, 3)."""
        result = _monomials(x) @ self.all
        return result[:, :3], result[:, 3:12].reshape(-1, 3, 3), result[:, 12:].reshape(-1, 3, 3, 3)


POWERS = [(i, j, k) for i in range(4) for j in range(4 - i) for k in range(4 - i - j)]


def _monomials(x: np.ndarray) -> np.ndarray:
    """(n, 20) the monomials of third degree at most."""
    powers = [np.ones_like(x), x, x * x, x * x * x]
    return np.stack([powers[i][:, 0] * powers[j][:, 1] * powers[k][:, 2] for i, j, k in POWERS], axis=1)


def _columns(polynomials: Sequence[Polynomial]) -> np.ndarray:
    """(20, m) coefficients."""
    return np.array([[float(p.get(powers, 0)) for p in polynomials] for powers in POWERS])


def _derivative(polynomial: Polynomial, k: int) -> Polynomial:
    out: dict[tuple[int, ...], Any] = {}
    for powers, value in polynomial.items():
        if powers[k]:
            lower = tuple(p - (i == k) for i, p in enumerate(powers))
            out[lower] = out.get(lower, 0) + value * powers[k]
    return out


def _constant(polynomial: Polynomial) -> float:
    if any(any(powers) for powers in polynomial):
        raise ValueError("the polynomials are of third degree at most")
    return float(sum(polynomial.values()))


def zeros(polynomials: Sequence[Polynomial], reach: Sequence[float]) -> Zeros:
    """All common zeros of three polynomials {(i, j, k): coefficient}, of third degree at most, with |x_i| <=
    reach_i."""
    system = _Polynomials(polynomials)
    # no zero of a symmetric system on an edge
    middles, halves = np.zeros((1, 3)), np.asarray(reach, float)[None] * 1.0123456789
    result: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    used = 0
    while len(middles):
        used += len(middles)
        if used > BUDGET:
            return Zeros(_distinct(result), False, used)
        keep, settled = _sieve(system, middles, halves)
        result += [(m, WIDER * h, _polished(system, m)) for m, h in zip(middles[settled], halves[settled])]
        middles, halves = _halved(middles[keep & ~settled], halves[keep & ~settled])
    return Zeros(_distinct(result), True, used)


def _sieve(system: _Polynomials, m: np.ndarray, h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(keep, settled) for boxes m +- h: not proved empty; proved to hold, half as large again, exactly one
    zero."""
    values, J, H = system.at(m)
    Y = _inverses(J)
    size = np.abs(Y) @ (SLACK * system.sizes(np.abs(m) + h))[..., None]
    g = np.abs((Y @ values[..., None])[..., 0])
    linear = np.abs(Y @ J)
    higher = lambda w: (np.abs(Y) @ (0.5 * np.einsum("nikl,nk,nl->ni", np.abs(H), w, w)
                                     + np.einsum("iklm,nk,nl,nm->ni", np.abs(system.third), w, w,
                                                 w) / 6)[..., None])[..., 0]
    empty = (g > (linear @ h[..., None])[..., 0] + higher(h) + size[..., 0]).any(axis=1)
    w = WIDER * h
    change = (np.einsum("nikl,nl->nik", np.abs(H), w)
              + 0.5 * np.einsum("iklm,nl,nm->nik", np.abs(system.third), w, w))
    spread = np.abs(Y @ J - np.eye(3)) + np.abs(Y) @ change
    settled = (g + (spread @ w[..., None])[..., 0] + size[..., 0] < w).all(axis=1) & ~empty
    return ~empty, settled


def _inverses(J: np.ndarray) -> np.ndarray:
    """Inverses of the Jacobians, the unit matrix where there is none."""
    scale = np.abs(J).max(axis=(1, 2), initial=0.0)
    good = (scale > 0) & (np.abs(np.linalg.det(J / np.where(scale > 0, scale, 1)[:, None, None])) > 1e-10)
    Y = np.tile(np.eye(3), (len(J), 1, 1))
    if good.any():
        Y[good] = np.linalg.inv(J[good])
    return Y


def _halved(m: np.ndarray, h: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    side = h.argmax(axis=1)
    step = np.zeros_like(h)
    rows = np.arange(len(m))
    step[rows, side] = h[rows, side] / 2
    smaller = h - step
    return np.concatenate([m - step, m + step]), np.concatenate([smaller, smaller])


def _polished(system: _Polynomials, x: np.ndarray) -> np.ndarray:
    for _ in range(20):
        step = np.linalg.solve(system.jacobian(x[None])[0], system.values(x[None])[0])
        x = x - step
        if np.abs(step).max() <= 1e-15 * np.abs(x).max():
            break
    return x


def _distinct(result: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> np.ndarray:
    """Each zero once: one that lies in another's box, where there is exactly one, is that other."""
    out: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for m, w, x in result:
        if not any((np.abs(x - other) <= wide).all() for other, wide, _ in out):
            out.append((m, w, x))
    return np.array([x for _, _, x in out]).reshape(-1, 3)
