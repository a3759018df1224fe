"""A sample of random scenes with a reduction, from a fixed seed: any body, the torque along any principal
axis, the wheel across it."""
from __future__ import annotations

import math
import random
from dataclasses import dataclass

import numpy as np

from stabilab import Body, ConstantTorque, Gyrostat, Scene

SEED = 20261123
KINDS = ("generic", "flat", "rod", "near")


@dataclass(frozen=True)
class Drawn:
    """One scene of the sample: its numbers as they are named (moments, wheel, torque), and the seed of its
    states."""

    number: int
    kind: str
    moments: tuple[float, float, float]
    wheel: tuple[float, float, float]
    torque: tuple[float, float, float]

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
        rng = np.random.default_rng([SEED, self.number, again] if again else [SEED, self.number])
        wheel, torque, least = math.hypot(*self.wheel), math.hypot(*self.torque), min(self.moments)
        rate = wheel / least + math.sqrt(torque / least)
        way = rng.normal(size=(count, 3))
        return way / np.linalg.norm(way, axis=1)[:, None] * rate * 10 ** rng.uniform(-1, 1, (count, 1))


def drawn(count: int, seed: int = SEED) -> list[Drawn]:
    """The first so many scenes of the sample."""
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
