"""Long runs: drift of first integrals.

How far the stepping method drifts from the integrals of the motion over very many turns: by chance, or
with a bias.

A rounding error a step, independent of the others, adds up to the square root of the number of steps (Brouwer
1937); one that always has the same sign adds up to the number itself. Bounded motions of the scaled minor
axis: A^2 = (x1 + a)^2 + x2^2 and the energy are constant. python -m benchmarks.long_runs [FOLDER]
writes long-runs.png, .csv and .txt (ten minutes).
"""
from __future__ import annotations

from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np

from stabilab.answers.fate import period
from stabilab.answers.simulate import trajectory
from stabilab.physics.scene import ScaledGyrostat
from stabilab.show import style
from stabilab.show.data import csv_lines
from stabilab.version import __version__

# --- How far invariants drift over many turns
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


NAMES = {"circle": "A², radius of the circle squared", "energy": "energy"}


def picture(plt, rows):
    """Drift against turns, a panel an integral, with lines for the square root of the steps and for their
    number."""
    figure, axes = plt.subplots(1, 2, figsize=(11.4, 4.8), layout="constrained", sharey=True)
    a_turn = max(r.steps for r in rows) / max(r.turns for r in rows)
    ends = np.array([1.0, max(r.turns for r in rows)])
    for ax, name in zip(axes, NAMES):
        for motion in sorted({r.motion for r in rows}):
            line = [(r.turns, abs(r.drift)) for r in rows if (r.integral, r.motion) == (name, motion)
                    and r.drift]
            ax.plot(*zip(*line), color=style.SKY, linewidth=0.8, zorder=1)
        ax.plot(*spread(rows, name), color=style.BLUE, linewidth=2.2, zorder=3)
        ax.plot(ends, EPS * np.sqrt(a_turn * ends), color=style.BLACK, linestyle="--", linewidth=1.3)
        ax.plot(ends, EPS * a_turn * ends, color=style.VERMILION, linestyle=":", linewidth=1.6)
        ax.set(xscale="log", yscale="log", xlabel="turns",
               title=rf"{NAMES[name]}: grows as turns$^{{{growth(rows, name):.2f}}}$", ylim=(1e-17, 1e-8))
    axes[0].set_ylabel("relative drift")
    style.legend(figure, [("root mean square over the motions", {"color": style.BLUE, "linewidth": 2.2}),
                          ("one motion", {"color": style.SKY, "linewidth": 0.8}),
                          ("2⁻⁵² × root of the steps",
                           {"color": style.BLACK, "linestyle": "--", "linewidth": 1.3}),
                          ("2⁻⁵² × steps", {"color": style.VERMILION, "linestyle": ":", "linewidth": 1.6})],
                 columns=4)
    return figure


def write(folder, turns: float = 1e6, others: float = 1e5, motions: int = 6) -> list[Path]:
    """Run one motion for `turns` and the rest for `others` turns; long-runs.png, .csv and .txt. Returns their
    paths."""
    rows = [row for n, state in enumerate(starts(motions))
            for row in drifts(state, others if n else turns, n)]
    path = Path(folder) / "long-runs.png"
    with style.drawing() as plt:
        style.save(picture(plt, rows), path)
    with style.whole_file(path.with_suffix(".csv")) as waiting:
        waiting.write_text(csv_lines([[f.name for f in fields(Drift)], *map(astuple, rows)]),
                           encoding="utf-8")
    words = ", ".join(f"{name} as turns to the power {growth(rows, name):.2f}" for name in NAMES)
    with style.whole_file(path.with_suffix(".txt")) as waiting:
        waiting.write_text(f"Drift of the integrals along bounded motions, Taylor series: {words} (1/2: "
                           f"independent roundings; 1: a bias)\n\n"
                           f"made by: python -m benchmarks.long_runs\nstabilab {__version__}\n"
                           "tolerance: half a unit in the last place a step; integrals in extended "
                           "precision\n", encoding="utf-8")
    return [path.with_suffix(s) for s in (".png", ".csv", ".txt")]


if __name__ == "__main__":
    import sys
    print(*write(sys.argv[1] if sys.argv[1:] else "figures", *map(float, sys.argv[2:4])), sep="\n")  # type: ignore[arg-type]
