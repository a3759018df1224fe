"""How far the stepping method drifts from the integrals of the motion over very many turns: by chance, or
with a bias.

A rounding error a step, independent of the others, adds up to the square root of the number of steps (Brouwer
1937); one that always has the same sign adds up to the number itself. Bounded motions of the scaled minor
axis: A^2 = (x1 + a)^2 + x2^2 and the energy are constant. python -m stabilab.papers.cost.long_runs [FOLDER]
writes long-runs.png, .csv and .txt (ten minutes).
"""
from __future__ import annotations

from dataclasses import astuple, fields
from pathlib import Path

import numpy as np

from ...show import style
from ...show.files import comma
from ...version import __version__
from .drift import EPS, Drift, drifts, growth, spread, starts

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
        waiting.write_text(comma.lines([[f.name for f in fields(Drift)], *map(astuple, rows)]),
                           encoding="utf-8")
    words = ", ".join(f"{name} as turns to the power {growth(rows, name):.2f}" for name in NAMES)
    with style.whole_file(path.with_suffix(".txt")) as waiting:
        waiting.write_text(f"Drift of the integrals along bounded motions, Taylor series: {words} (1/2: "
                           f"independent roundings; 1: a bias)\n\n"
                           f"made by: python -m stabilab.papers.cost.long_runs\nstabilab {__version__}\n"
                           "tolerance: half a unit in the last place a step; integrals in extended "
                           "precision\n", encoding="utf-8")
    return [path.with_suffix(s) for s in (".png", ".csv", ".txt")]


if __name__ == "__main__":
    import sys
    print(*write(sys.argv[1] if sys.argv[1:] else "figures", *map(float, sys.argv[2:4])), sep="\n")  # type: ignore[arg-type]
