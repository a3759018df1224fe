"""How long a motion bounded by a torque on an axis surely stays below a rate when the torque is a little off
that axis.

Axis i carries the torque, j, k follow it cyclically, and the wheel has no momentum along i. Let a_j = D_j -
D_i, a_k = D_k - D_i be of one sign (the major or the minor axis), c_j = -l_j/a_j, c_k = -l_k/a_k, and

    p = (D_j |a_j|)^(1/2) (omega_j - c_j),  q = (D_k |a_k|)^(1/2) (omega_k - c_k),  p + i q = rho exp(-i
    theta),
    n = sgn(a) (a_j a_k / (D_j D_k))^(1/2).

With the torque (M_i, s_j, s_k) Euler's equations give (p + i q)' = -i n omega_i (p + i q) + mu, mu =
(|a_j|/D_j)^(1/2) s_j + i (|a_k|/D_k)^(1/2) s_k. So

    |rho'| <= |mu|,    |theta' - n omega_i| <= |mu|/rho,    T' = M_i omega_i + s_j omega_j + s_k omega_k

for the kinetic energy T, and E = T - (M_i/n)(theta - theta(0)) drifts by no more than |s||omega_perp| +
|M_i/n||mu|/rho. On the axis (s = 0) rho and E are the integrals of the motion. As D_i omega_i^2/2 = E - V, V
= T_perp(rho, theta) - (M_i/n)(theta - theta(0)), the phase cannot pass a place theta_b while E < V there.
Given a time t: rho lies within |mu| t of its start, E within its drift; if at some theta_a behind and theta_b
ahead the least V over these rho exceeds the most E, the phase stays between them until t, and |omega| stays
below its most there.
"""
from __future__ import annotations

import math

import numpy as np

from ...numbers.vectors import CYCLE, Float3
from ...physics.scene import Scene

ROUNDING = 1e-9  # of the limit's square: far beyond the rounding of these lines
POINTS = 720  # to a turn of the phase; between them a bound of the slope counts
BEHIND = 4  # turns that are looked at against the torque
HALVINGS = 50


def stays_below(scene: Scene, state: Float3, rate: float, sideways: float,
                along: tuple[float, float]) -> float:
    """A time before which |omega| < `rate`, for every torque whose component along its axis is within `along`
    (N m) and whose part across it is at most `sideways`; constant, but otherwise any. scene: with the torque
    on an axis; state: three floats, rad/s. 0 where nothing is proved."""
    crude = _by_energy(scene, state, rate, math.hypot(sideways, max(map(abs, along))))
    D, l = (np.array([float(v) for v in row]) for row in (scene.body.exact, scene.vector("gyrostat")))
    i = next(n for n, m in enumerate(scene.vector("constant_torque")) if m)
    j, k = CYCLE[i]
    a = np.array([D[j] - D[i], D[k] - D[i]])
    if not a[0] * a[1] > 0 or l[i]:
        return crude
    well = _Well(D[[i, j, k]], l[[j, k]], a, np.array(state, float)[[i, j, k]], rate, sideways, along)
    if not well.rho > 0 or not sideways > 0:
        return crude
    low, high = 0.0, well.rho / well.pull
    if not well.holds(low):
        return crude
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if well.holds(middle) else (low, middle)
    return float(max(crude, low))


def _by_energy(scene: Scene, state: Float3, rate: float, torque: float) -> float:
    """T = W^2/2: |W'| <= |D^(-1/2) M| bounds |omega| <= W/min(D)^(1/2)."""
    D = [float(v) for v in scene.body.exact]
    least = math.sqrt(min(D))
    return (max(0.0, rate * least - math.sqrt(sum(d * w * w for d, w in zip(D, state)))) * least / torque
            * (1 - ROUNDING))


class _Well:
    def __init__(self, D: np.ndarray, l: np.ndarray, a: np.ndarray, omega: np.ndarray, rate: float,
                 sideways: float, along: tuple[float, float]) -> None:
        self.D, self.rate, self.sideways, self.along = D, rate, sideways, along
        self.centre, self.scale = -l / a, np.sqrt(D[1:] * np.abs(a))
        self.n = math.copysign(math.sqrt(a[0] * a[1] / (D[1] * D[2])), a[0])
        p, q = self.scale * (omega[1:] - self.centre)
        self.rho, self.theta = math.hypot(p, q), -math.atan2(q, p)
        self.energy = 0.5 * float(D @ omega**2)
        self.pull = sideways * math.sqrt(max(abs(a) / D[1:]))  # of |mu|
        ahead = math.copysign(1.0, along[0] * self.n)
        self.step = 2 * math.pi / POINTS
        self.behind, self.ahead = (sense * np.arange(turns * POINTS + 1) * self.step for sense,
                                   turns in ((-ahead, BEHIND), (ahead, 1)))

    def holds(self, t: float) -> bool:
        """Whether |omega| is surely below the rate up to t."""
        rhos = self.rho - self.pull * t, self.rho + self.pull * t
        if not rhos[0] > 0:
            return False
        tilt = max(map(abs, self.along)) / abs(self.n)
        across = math.hypot(*self.centre) + rhos[1] / min(self.scale)
        energy = self.energy + t * (self.sideways * across + tilt * self.pull / rhos[0])
        ends = [self._first_closed(way, rhos, energy) for way in (self.behind, self.ahead)]
        known = [end for end in ends if end is not None]
        if len(known) < 2:
            return False
        inside = np.concatenate([way[:end + 1] for way, end in zip((self.behind, self.ahead), known)])
        return self._most(inside, rhos, energy) < self.rate**2 * (1 - ROUNDING)

    def _first_closed(self, way: np.ndarray, rhos: tuple[float, float], energy: float) -> int | None:
        """Index of the first place of a way that the phase cannot pass, None where there is none."""
        least = -self._greatest(way, rhos, -0.5 * self.D[1:], 1.0)
        closed = np.nonzero(least > energy * (1 + ROUNDING))[0]
        return int(closed[0]) if closed.size else None

    def _most(self, way: np.ndarray, rhos: tuple[float, float], energy: float) -> float:
        """Most of |omega|^2 at these places and half a step around them."""
        weights = 1 - self.D[1:] / self.D[0]
        value = 2 * energy / self.D[0] + self._greatest(way, rhos, weights, 2 / self.D[0])
        fastest = np.abs(self.centre) + rhos[1] / self.scale
        slope = (2 * np.abs(weights) * fastest * rhos[1]
                 / self.scale).sum() + 2 / self.D[0] * max(map(abs, self.along)) / abs(self.n)
        return float(value.max()) + slope * self.step / 2

    def _greatest(self, way: np.ndarray, rhos: tuple[float, float], weights: np.ndarray,
                  factor: float) -> np.ndarray:
        """Greatest of weights . omega_perp^2 + factor (M_i/n)(theta - theta(0)) over the radii and the torque
        along the axis, at each place."""
        theta = self.theta + way
        across = np.stack([np.cos(theta), -np.sin(theta)], axis=-1) / self.scale
        square, linear, constant = across**2 @ weights, 2 * across @ (weights * self.centre), float(
            self.centre**2 @ weights)
        ends = np.maximum(*(square * r * r + linear * r for r in rhos))
        with np.errstate(all="ignore"):
            top = -linear / (2 * square)
            ends = np.where((square < 0) & (rhos[0] < top) & (top < rhos[1]),
                            np.maximum(ends, -linear**2 / (4 * square)), ends)
        return ends + constant + factor * np.maximum(*(m / self.n * way for m in self.along))
