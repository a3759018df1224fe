"""Equilibria on a circular orbit over the momentum of the wheels as a picture."""
from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ...answers.circular_orbit.ask import CircularOrbit, followed
from ...case.read import Case
from ...equilibrium.circular_orbit.result import OrbitEquilibrium
from ...numbers.vectors import dot
from .. import style
from ..units import Units
from .over_values import counts_above
from .shades import mark_own

WORDS = {"stable": "stable (Lyapunov)", "unstable": "unstable",
         "undecided": "undecided by energy (gyroscopic)"}


def write(case: Case, found: CircularOrbit, out: str | Path, units: Units) -> Path:
    """Draw two angles of each equilibrium over the momentum: of the orbit normal to that momentum, and of the
    vertical to the body's minor axis. Raises InputError where there are no branches."""
    rows = followed(found)
    return style.write(out, lambda plt: _drawn(case, found, rows, units, plt))


def _drawn(case: Case, found: CircularOrbit, rows: Any, units: Units, plt: Any) -> Any:
    name, one = units.angles
    wheel, minor = _unit(found.momentum), min(range(3), key=lambda i: found.moments[i])
    panels: list[tuple[str, float, Callable[[OrbitEquilibrium], float]]] = [
        ("orbit normal to momentum", math.pi, lambda at: math.acos(_within(dot(at.normal, wheel)))),
        ("vertical to minor axis", math.pi / 2, lambda at: math.acos(_within(abs(at.vertical[minor]))))]
    figure, axes = plt.subplots(2, 1, sharex=True, layout="constrained", figsize=(8, 7))
    ends = 0.0, found.spans[-1].high  # type: ignore[index]
    for ax, (words, most, angle) in zip(axes, panels):
        for branch in rows:
            ax.plot(branch.momenta, [angle(at) * one for at in branch.points],
                    **style.MEANING[branch.verdict])
        for span in found.spans:  # type: ignore[union-attr]
            ax.axvline(span.high, color=style.GREY, linewidth=0.7, linestyle=":", zorder=0)
        ax.set_ylim(-0.03 * most * one, 1.03 * most * one)
        ax.set_ylabel(f"{words} ({name})")
    axes[-1].set_xlim(*ends)
    own = [mark_own(ax, [math.hypot(*found.momentum)]) for ax in axes]
    axes[-1].set_xlabel("momentum of the wheels (N m s)")
    counts_above(axes[0], ends, [(span.low, span.high, str(span.count)) for span in found.spans],
                 [span.low for span in found.spans])
    figure.suptitle(f"{style.literal(case.title or case.name)}\nin bold: the number of equilibria, two or "
                    "more a line", x=0.02, ha="left", fontsize=10.5, wrap=True)
    kinds = dict.fromkeys(branch.verdict for branch in rows)
    style.legend(figure, {WORDS[kind]: style.MEANING[kind] for kind in kinds} | own[0])
    return figure


def _within(cosine: float) -> float:
    return min(1.0, max(-1.0, cosine))


def _unit(vector: Any) -> tuple[float, ...]:
    return tuple(v / math.hypot(*vector) for v in vector)
