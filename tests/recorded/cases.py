"""The cases whose answers are recorded: all that come with the program, and 60 random ones of every kind of
gyrostat."""
from __future__ import annotations

from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SEED, RANDOM = 30, 60
# followed for ten thousands of steps off the axes, where the last digits of a processor decide what is met
CHAOTIC = (29, 49, 54)
# Moments of a random body: apart, nearly equal, a rod's, on an axis of symmetry; then along what the torque
# acts, if at all
BODIES = "general", "nearly equal", "rod", "symmetric"
TORQUES = "minor", "middle", "major", "none", "across"


def written(folder: Path) -> list[Path]:
    """Paths of all cases; the random ones are written into the folder."""
    rng = np.random.default_rng(SEED)
    for number in range(RANDOM):
        body, torque = BODIES[number % len(BODIES)], TORQUES[number % len(TORQUES)]
        text = _case(rng, body, torque)
        if number not in CHAOTIC:
            (folder / f"random-{number:02}.toml").write_text(text, encoding="utf-8")
    return [*sorted((ROOT / "cases").glob("*.toml")), *sorted(folder.glob("random-*.toml"))]


def _case(rng, body, torque) -> str:
    moments = _moments(rng, body)
    momentum = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 1) * (rng.random(3) < 0.6)
    acting = np.zeros(3)
    if torque == "across":
        acting = rng.normal(size=3) * 0.1
    elif torque != "none":
        acting[np.argsort(moments)[TORQUES.index(torque)]] = rng.choice((-1, 1)) * 10.0 ** rng.uniform(-3, 0)
    rates = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 0.5)
    blocks = [f'title = "{body} body, torque: {torque}"', f"[body]\ninertia = {_list(moments)}"]
    blocks += [f"[effects.gyrostat]\nmomentum = {_list(momentum)}"] * bool(momentum.any())
    blocks += [f"[effects.constant_torque]\ntorque = {_list(acting)}"] * bool(acting.any())
    blocks += [f"[motion]\nangular_velocity = {_list(rates)}\nspan = [0.0, 20.0]"]
    return "\n\n".join(blocks) + "\n"


def _moments(rng, body):
    """Three principal moments that a body can have, in any order."""
    if body == "rod":
        moments = np.array([1.0, 1.0 - 10.0 ** rng.uniform(-6, -2), 10.0 ** rng.uniform(-3, -1)])
    else:
        moments = rng.uniform(0.5, 1.0, 3)
    if body == "nearly equal":
        moments[1] = moments[0] * (1 + 10.0 ** rng.uniform(-6, -3))
    if body == "symmetric":
        moments[1] = moments[0]
    return rng.permutation(moments) * 10.0 ** rng.uniform(-1, 2)


def _list(values) -> str:
    return "[" + ", ".join(repr(round(float(v), 9)) for v in values) + "]"
