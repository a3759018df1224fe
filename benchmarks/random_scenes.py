"""Samples of random scenes with a reduction, from fixed seeds: any body, the torque along any principal axis,
the wheel across it."""
from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stabilab import Body, ConstantTorque, Gyrostat, Scene, fate

SEED = 20261123
KINDS = ("generic", "flat", "rod", "near")  # of `drawn`
EVERY_SEED, EVERY = 20261129, 200  # of `of_every_kind`, and how many these are
Numbers = tuple[list[float], list[float], list[float]]  # moments, wheel, torque


@dataclass(frozen=True)
class Drawn:
    """One scene of a sample: its numbers as they are named (moments, wheel, torque), and the seed of its
    states."""

    number: int
    kind: str
    moments: tuple[float, float, float]
    wheel: tuple[float, float, float]
    torque: tuple[float, float, float]
    seed: int = SEED

    @property
    def scene(self) -> Scene:
        """What is asked about."""
        return Scene(Body(self.moments), Gyrostat(self.wheel), ConstantTorque(self.torque))

    @property
    def name(self) -> str:
        """The numbers in words, to be typed in again."""
        axis = next(i for i in range(3) if self.torque[i])
        return f"D = {self.moments}, lambda = {self.wheel}, M{axis + 1} = {self.torque[axis]}".replace(
            ".0,", ",").replace(".0)", ")")

    def states(self, count: int, again: int = 0) -> np.ndarray:
        """(count, 3) states, from a tenth of the rates that wheel and torque bring about to ten times these,
        all directions alike; others when drawn again."""
        rng = np.random.default_rng([self.seed, self.number, again] if again else [self.seed, self.number])
        wheel, torque, least = math.hypot(*self.wheel), math.hypot(*self.torque), min(self.moments)
        rate = wheel / least + math.sqrt(torque / least)
        way = rng.normal(size=(count, 3))
        return way / np.linalg.norm(way, axis=1)[:, None] * rate * 10 ** rng.uniform(-1, 1, (count, 1))

    def beside(self, states: np.ndarray) -> np.ndarray:
        """The states (n, 3), every other one beside the separatrix: with the rate about the torque's axis
        with which its barrier is just reached, off by 1e-3 to 1e-12 of itself; all where there is a barrier
        that high."""
        rng, axis = np.random.default_rng([self.seed, self.number, 1]), next(
            i for i in range(3) if self.torque[i])
        states, still = states.copy(), states.copy()
        still[:, axis] = 0.0
        height = fate(self.scene, still).margins
        near = (np.arange(len(states)) % 2 == 0) & np.isfinite(height) & (height > 0)
        off = 1 + rng.choice((-1, 1), len(states)) * 10.0 ** rng.uniform(-12, -3, len(states))
        rate = np.copysign(np.sqrt(2 * np.abs(height) / self.moments[axis]), states[:, axis])
        states[near, axis] = (rate * off)[near]
        return states


# --- Ordinary numbers
def drawn(count: int, seed: int = SEED) -> list[Drawn]:
    """The first so many scenes of a sample of `KINDS`."""
    rng = random.Random(seed)
    return [_draw(rng, number) for number in range(count)]


def _draw(rng, number) -> Drawn:
    kind = rng.choices(KINDS, (3, 1, 1, 1))[0]
    # int x^2 dm and so on: their sums in pairs are moments of a body
    second = [rng.uniform(0.05, 1) for _ in range(3)]
    i = rng.randrange(3)
    if kind == "flat":
        second[i] = rng.uniform(0.001, 0.02)
    elif kind == "rod":
        second = [1 if k == i else rng.uniform(0.005, 0.05) for k in range(3)]
    elif kind == "near":
        second[(i + 1) % 3] = second[i] * (1 + 10 ** rng.uniform(-3, -1) * rng.choice((-1, 1)))
    size = 10 ** rng.uniform(0.3, 1)
    a, b, c = second
    moments = tuple(round(size * v, 3) for v in (b + c, a + c, a + b))
    axis = rng.randrange(3)
    wheel = [0.0 if k == axis else round(rng.choice((-1, 1)) * 10 ** rng.uniform(-1, 1.2), 3)
             for k in range(3)]
    if rng.random() < 0.5:
        wheel[(axis + rng.choice((1, 2))) % 3] = 0.0
    torque = [round(rng.choice((-1, 1)) * 10 ** rng.uniform(-2, 0.3), 4) if k == axis else 0.0
              for k in range(3)]
    return Drawn(number, kind, moments, tuple(wheel), tuple(torque))


# --- Every kind
def of_every_kind(count: int = EVERY, first: int = 0) -> list[Drawn]:
    """So many scenes, from the number `first` on, of which each `EVERY` hold the kinds of `DRAWS` in fixed
    shares: bodies in general, flat ones and rods; two moments equal to 1e-13 to 1e-3 or exactly, the torque
    about an axis of that pair, or about the third axis; spheres; circles, hyperbolas (of perpendicular
    asymptotes as well) and parabolas. A sixth is without a wheel."""
    kinds = [kind for kind, (times, _) in DRAWS.items() for _ in range(times)]
    random.Random(EVERY_SEED).shuffle(kinds)
    return [_of_kind(kinds[number % EVERY], number) for number in range(first, first + count)]


def _of_kind(kind: str, number: int) -> Drawn:
    moments, wheel, torque = DRAWS[kind][1](random.Random(f"{EVERY_SEED} {number}"))
    return Drawn(number, kind, (moments[0], moments[1], moments[2]), (wheel[0], wheel[1], wheel[2]),
                 (torque[0], torque[1], torque[2]), EVERY_SEED)


def _body(rng: random.Random, *spread: tuple[float, float]) -> list[float]:
    """Moments of three decimals; spread: from where to where int x^2 dm and so on are, in any order."""
    a, b, c = (rng.uniform(*limits) for limits in rng.sample(spread, 3))
    size = 10 ** rng.uniform(0.3, 1)
    return [round(size * value, 3) for value in (b + c, a + c, a + b)]


def _pair(rng: random.Random, apart: float) -> tuple[list[float], int, int]:
    """Moments of which two differ by a share of them, and these two axes."""
    first, second, other = rng.sample(range(3), 3)
    moments, size = [0.0] * 3, 10 ** rng.uniform(0.3, 1)
    moments[first] = round(size * rng.uniform(0.3, 1), 3)
    moments[second] = moments[first] * (1 + apart)
    moments[other] = round(moments[first] * rng.uniform(0.05, 1.95), 3)
    return moments, first, second


def _loaded(rng: random.Random, moments: list[float], axis: int, along: bool = False) -> Numbers:
    """The moments with a torque about an axis, and a wheel along it, or across it about one or both of the
    other axes, each of some decades; no wheel in one scene of six."""
    others = [axis] if along else [(axis + 1) % 3, (axis + 2) % 3]
    about = rng.choices(([], others[:1], others[-1:], others), (2, 2, 2, 6))[0]
    wheel, torque = [0.0] * 3, [0.0] * 3
    for k in about:
        wheel[k] = _sized(rng, -2, 1)
    torque[axis] = _sized(rng, -4, 1)
    return moments, wheel, torque


def _sized(rng: random.Random, low: float, high: float) -> float:
    """A number of either sign and three digits, its power of ten between two."""
    return float(f"{rng.choice((-1, 1)) * 10 ** rng.uniform(low, high):.3g}")


def _near(rng: random.Random) -> Numbers:
    moments, axis, _ = _pair(rng, rng.choice((-1, 1)) * 10 ** rng.uniform(-13, -3))
    return _loaded(rng, moments, axis)


def _across(rng: random.Random) -> Numbers:
    moments, axis, _ = _pair(rng, 0.0)
    return _loaded(rng, moments, axis)


def _along(rng: random.Random) -> Numbers:
    moments, first, second = _pair(rng, 0.0)
    return _loaded(rng, moments, 3 - first - second, rng.random() < 0.25)


def _sphere(rng: random.Random) -> Numbers:
    return _loaded(rng, [round(10 ** rng.uniform(-0.5, 1), 3)] * 3, rng.randrange(3))


def _right(rng: random.Random) -> Numbers:
    """Hyperbolas of perpendicular asymptotes: D_i = (D_j^2 + D_k^2)/(D_j + D_k), a double where the sum is a
    power of two."""
    total, axis = rng.choice((4, 8, 16)), rng.randrange(3)
    one = rng.choice([n for n in range(1, total) if 2 * n != total])
    moments = [0.0] * 3
    moments[axis], moments[axis - 1], moments[axis - 2] = (
        (one**2 + (total - one) ** 2) / total, float(one), float(total - one))
    return _loaded(rng, moments, axis)


# Kind -> how many of `EVERY`, and its numbers
DRAWS: dict[str, tuple[int, Callable[[random.Random], Numbers]]] = {
    "generic": (46, lambda rng: _loaded(rng, _body(rng, *((0.05, 1.0),) * 3), rng.randrange(3))),
    "flat": (18, lambda rng: _loaded(rng, _body(rng, (0.001, 0.02), (0.05, 1), (0.05, 1)), rng.randrange(3))),
    "rod": (18, lambda rng: _loaded(rng, _body(rng, (1, 1), (0.005, 0.05), (0.005, 0.05)), rng.randrange(3))),
    "near": (40, _near), "across": (26, _across), "along": (22, _along), "sphere": (16, _sphere),
    "right": (14, _right)}
