"""Chaos as a picture: the Poincare section of a motion, beside it MEGNO of all motions that start on its plane; or MEGNO over time."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ....answers.chaos import Chaos, Order, chaos
from ....packages import demand
from ... import style
from ...files import endings
from ...plot import plane_section, which
from ...plot.measures import Measures, measures
from ...plot.subject import Subject, subject
from ...units import number
from ..shades import light

GRID = 41          # states of the map along each axis
NEIGHBOURS = 8     # of the section
SHORTER = 4        # of the map each motion is followed so much less long
SIZE = (13.0, 6.6)
TOP = 4.0          # of MEGNO's colours


def write(case: Any, found: Chaos, out: str | Path) -> Path:
    """Draw the motion of a case and write the picture; the same case gives the same bytes. Raises InputError for another ending."""
    demand(*style.PACKAGES)
    target, one = endings.file(out, endings.PICTURES), subject(case)
    with style.drawing() as plt:
        if which.why_not("section", one):
            figure, ax = plt.subplots(figsize=(7.6, 4.8), layout="constrained")
            _over_time(ax, case, found)
            return style.save(figure, target)
        figure, (left, right) = plt.subplots(1, 2, figsize=SIZE, layout="constrained")
        plane_section.section(one, ax=left, neighbours=NEIGHBOURS)
        _map(figure, right, left, one, float(found.times[-1]) / SHORTER)
        return style.save(figure, target)


def _over_time(ax: Any, case: Any, found: Chaos) -> None:
    ax.plot(found.times, found.history, marker="o", color=style.BLUE)
    ax.axhline(2, color=style.GREY, linewidth=0.8)
    if not np.isfinite(found.history).any():  # nothing that an axis could be made from
        ax.set_xlim(found.times[0], found.times[-1])
        ax.set_ylim(0, TOP)
        ax.text(0.5, 0.25, "not followed: it does not come back", transform=ax.transAxes, ha="center")
    ax.set_xscale("log")
    ax.set_xlabel(f"followed for ({case.scene.time_unit})")
    ax.set_ylabel("MEGNO (2 on tori)")
    ax.set_title(style.literal(f"{case.title or case.name}\n{Order(int(found.labels)).word}"), wrap=True)


def _map(figure: Any, ax: Any, beside: Any, one: Subject, until: float) -> None:
    """MEGNO of the motions from the window of the section; those that spin up in a colour of their own."""
    scale: Measures = measures(one)
    _, plane = plane_section.plane_of(one, which.certain_from(one))
    limits = beside.get_xlim(), beside.get_ylim()
    x, y = (np.linspace(low, high, 2 * GRID + 1)[1::2] for low, high in limits)
    states = np.full((GRID, GRID, 3), plane.level)
    states[..., plane.across[0]], states[..., plane.across[1]] = x[:, None] / scale.rate[1], y / scale.rate[1]
    found = chaos(one.twin, states, until)
    extent = (*limits[0], *limits[1])
    leaving = np.where(found.labels == Order.SPIN_UP, 1.0, np.nan)
    ax.grid(False)
    look = {"origin": "lower", "extent": extent, "aspect": "auto", "interpolation": "nearest"}
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch
    ax.imshow(leaving.T, cmap=ListedColormap([light(style.VERMILION)]), **look)
    shown = ax.imshow(found.megno.T, cmap="cividis", vmin=0, vmax=TOP, **look)
    figure.colorbar(shown, ax=ax, label="MEGNO (2 on tori, grows where chaotic)", extend="both")
    at = one.state
    if abs(at[plane.axis] - plane.level) < 1e-9 * max(map(abs, at)):
        ax.plot([at[plane.across[0]] * scale.rate[1]], [at[plane.across[1]] * scale.rate[1]], **style.MARKER["start"])
    ax.set_xlabel(beside.get_xlabel())
    ax.set_ylabel(beside.get_ylabel())
    ax.set_title(f"motions from this plane, each followed for {number(until)} {one.scene.time_unit}")
    told = beside.get_legend()
    handles, words = list(told.legend_handles), [text.get_text() for text in told.get_texts()]
    told.remove()
    if np.isfinite(leaving).any():
        handles, words = [*handles, Patch(facecolor=light(style.VERMILION))], [*words, "spins up"]
    figure.legend(handles, words, loc="outside lower center", ncols=5)
