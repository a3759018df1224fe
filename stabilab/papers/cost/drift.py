"""How far invariants drift over many turns."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...answers.extremes import period
from ...answers.simulate import trajectory
from ...physics.scene import ScaledGyrostat

SCENE = ScaledGyrostat("0.2", "0.4", (0, 0, 1))
PIECE = 10_000  # turns a call: a run of the method has a limit of steps
FIT_FROM = 10  # turns: before, the roundings of the integrals themselves show
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Drift:
    """Of one motion after so many turns and steps of the method: relative departure of an integral from its
    first value."""

    integral: str
    motion: int
    turns: float
    steps: int
    drift: float


def starts(motions: int) -> np.ndarray:
    """(motions, 3) bounded states about the centre x1 = 2.9, x2 = -0.3, each on an orbit of its own."""
    share = np.arange(motions) / max(motions, 2)
    return np.stack([2.75 + 0.11 * share, 0.125 - 0.4 * share, 1.0 + 0.7 * share], axis=1)


def integrals(states) -> dict[str, np.ndarray]:
    """A^2 and the energy of states (n, 3), in extended precision, so that only the states' own errors show.

    With X = x1 + a = A sin t, x2 = A cos t: t' = x3 and t'' = 1 + x2 (X + b - a), whence U = -t - X (X + 2 (b
    - a))/2; these motions stay on the side X > 0 of their circle, where t = pi/2 - atan(x2/X) has no jump.
    """
    x1, x2, x3 = np.asarray(states, np.longdouble).T
    a, c = np.longdouble(1) / 5, np.longdouble(1) / 5
    X = x1 + a
    return {"circle": X * X + x2 * x2, "energy": x3 * x3 / 2 + np.arctan(x2 / X) - X * (X + 2 * c) / 2}


def drifts(state, turns: float, motion: int = 0, a_decade: int = 8) -> list[Drift]:
    """Drift of both integrals along one motion at `a_decade` times a decade, up to so many turns; never
    relative to less than the terms that the integral is made of."""
    length = float(period(SCENE, np.array(state)))
    marks = 10.0 ** (np.arange(1 + int(a_decade * np.log10(turns) + 1e-9)) / a_decade)
    now, done, steps, found = np.array(state, float), 0.0, 0, []
    first = {name: value[0] for name, value in integrals(now[None]).items()}
    sizes = {"circle": float(first["circle"]), "energy": 0.5 * float(now[2] ** 2 + first["circle"])}
    while done < marks[-1]:
        part = marks[(marks > done) & (marks <= done + PIECE)]
        end = min(done + PIECE, marks[-1])
        at = np.unique(np.append(part, end))
        run = trajectory(SCENE, now, (at - done) * length, laws=False)
        before, steps = steps, steps + run.counters["steps"]
        for name, values in integrals(run.states[:len(part)]).items() if len(part) else ():
            found += [Drift(name, motion, float(t),
                            int(before + (steps - before) * (t - done) / (end - done)),
                            float(v - first[name]) / sizes[name]) for t, v in zip(part, values)]
        now, done = run.states[-1], end
    return found


def growth(rows, integral: str) -> float:
    """Exponent with which the drift grows with turns: slope of the root mean square over motions, in
    logarithms; 1/2 for independent errors, 1 for a bias."""
    turns, rms = spread(rows, integral)
    keep = (turns >= FIT_FROM) & (rms > 0)
    return float(np.polyfit(np.log(turns[keep]), np.log(rms[keep]), 1)[0])


def spread(rows, integral: str) -> tuple[np.ndarray, np.ndarray]:
    """(turns, root mean square of the drift over the motions that all went so far)."""
    mine = [r for r in rows if r.integral == integral]
    motions = {r.motion for r in mine}
    by_turns = {t: [r.drift for r in mine if r.turns == t] for t in sorted({r.turns for r in mine})}
    full = {t: values for t, values in by_turns.items() if len(values) == len(motions)}
    return np.array(list(full)), np.array([np.sqrt(np.mean(np.square(v))) for v in full.values()])
