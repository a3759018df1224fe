"""The attitudes at rest of a satellite on a circular orbit: the body in the orbital frame, a panel for each
pair of them and for each family."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InputError
from .. import labels, limiting, style
from ..terminal import written
from ..text import notes
from ..text.motion import grows_in, orbit_headline
from ..units import SHORT, Units, number, units_of
from . import canvas
from .body import CORNERS, FACES, box_sides
from .subject import Subject, measures

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ...answers.circular_orbit import CircularOrbit
    from ...equilibrium.circular_orbit import OrbitEquilibrium

ACROSS = 4  # panels beside each other
PANEL = (2.5, 2.75)  # inches
VIEW = (18, -62)  # degrees: elevation, azimuth; the velocity points to the right
# rows of the direction cosines: the velocity, the orbit normal, up; each with its word and its end in a panel
FRAME = (("velocity", (0.95, 0, 0)), ("orbit normal", (0, 1.1, 0)), ("to the Earth", (0, 0, -1.1)))
COLOURS = {"stable": style.BLUE, "unstable": style.VERMILION, "undecided": style.AMBER}
LOOKS = {f"{verdict} attitude": {"facecolor": colour} for verdict, colour in COLOURS.items()}


def attitudes(item: Subject, ax: Axes | None = None, units: str | None = None,
              size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Draw the body at every attitude at rest (a Subject with `orbiting`), and return the axes of the first.

    Each panel is seen from outside the orbit: the velocity to the right, the Earth below. The box is that of
    the body's moments, in the colour of the verdict; its axes have their colours and letters. A half turn
    about the orbit normal leads to the other of each pair; of a family one attitude stands for all, and the
    axis about which it turns is drawn through. Raises InputError where axes are given, and where every
    attitude is at rest.
    """
    import matplotlib
    import matplotlib.pyplot as plt
    if item.orbiting is None:
        raise InputError("plot: expected a satellite: a case with [circular_orbit]")
    if ax is not None:
        raise InputError("ax: the attitudes at rest are panels of a figure of their own: leave ax out")
    result = item.orbit
    shown = _shown(result)
    if not shown:
        raise InputError(f"plot equilibria: there is nothing to draw: {result.equilibria.reason.text()}")
    system = measures(item, units).system or units_of(item.orbiting.craft)
    across = min(ACROSS, len(shown))
    down = math.ceil(len(shown) / across)
    with matplotlib.rc_context(style.RC | style.letters(size)):
        figure = plt.figure(figsize=size or (max(across, 2) * PANEL[0], down * PANEL[1] + 0.9),
                            layout="constrained")
        figure.get_layout_engine().set(h_pad=canvas.BELOW)
        panels = [_panel(figure.add_subplot(down, across, n, projection="3d"), item, result, words, attitude,
                         system) for n, (words, attitude) in enumerate(shown, 1)]
        rest = style.over(figure, item.heading, written(_title(result)))
        if legend:
            verdicts = {attitude.verdict for _, attitude in shown}
            rows = [(words, look) for words, look in LOOKS.items() if words.split()[0] in verdicts]
            style.legend(figure, [*rows, *((f"axis {item.axes.full(n)}", {"color": colour, "linewidth": 2.0})
                                           for n, colour in enumerate(style.AXES, 1))],
                         notes=notes.fitted([*map(notes.as_note, rest), *limiting.notes(
                             result.caveats, _title(result), system)], figure.get_figwidth()))
        labels.apart(*panels)
    return panels[0]


def _title(result: CircularOrbit) -> str:
    text = orbit_headline(result.equilibria)
    return f"{text[0]}{text[1:].lower()}, in the orbital frame"


def _shown(result: CircularOrbit) -> list[tuple[str, OrbitEquilibrium]]:
    """(its words, the attitude) of each panel: of each pair the first, of each family one."""
    found = result.equilibria
    pairs = [(f"{2 * n + 1} and {2 * n + 2}", point) for n, point in enumerate(found.points[::2])]
    return pairs + [("one of a family", family) for family in found.families]


def _panel(ax: Any, item: Subject, result: CircularOrbit, words: str, attitude: OrbitEquilibrium,
           units: Units) -> Any:
    """One attitude in the orbital frame, and how it is known."""
    from matplotlib.patheffects import withStroke
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    turn = np.array([attitude.velocity, attitude.normal, attitude.vertical])  # of the body into the frame
    sides, colour = box_sides(result.moments), COLOURS[attitude.verdict]
    ax.computed_zorder = False
    corners = 1.1 * (CORNERS * sides / 2) @ turn.T
    ax.add_collection3d(Poly3DCollection([corners[list(face)] for face in FACES], facecolor=colour,
                                         alpha=0.35, edgecolor=colour, linewidth=0.9, zorder=3))
    for name, end in FRAME:
        ax.quiver(0, 0, 0, *end, color=style.GREY, linewidth=0.9, arrow_length_ratio=0.1, zorder=2)
        ax.text(*(1.12 * np.array(end)), name, color=style.GREY, fontsize=7 * style.share(), ha="center",
                va="center", zorder=9)
    for n, axis in enumerate(turn.T):
        tip = (0.55 * sides[n] + 0.25) * axis
        ax.plot(*np.array([np.zeros(3), tip]).T, color=style.AXES[n], linewidth=1.8, zorder=6)
        ax.text(*(1.18 * tip), item.axes.label(n + 1), color=style.AXES[n], fontsize=9 * style.share(),
                fontweight="bold", ha="center", va="center", zorder=10)
    if attitude.axis is not None:
        axis = turn @ np.array(attitude.axis)
        ax.plot(*np.array([-1.05 * axis, 1.05 * axis]).T, color=style.BLACK, linewidth=1.0,
                linestyle="--", zorder=5)
    if any(result.momentum):
        wheel = 0.75 * (turn @ np.array(result.momentum)) / np.linalg.norm(result.momentum)
        ax.quiver(0, 0, 0, *wheel, color=style.BLACK, linewidth=1.4, arrow_length_ratio=0.14, zorder=7)
        ax.text(*(1.15 * wheel), "λ", fontsize=9 * style.share(), ha="center", va="center", zorder=10)
    ax.set(xlim=(-0.9, 0.9), ylim=(-0.9, 0.9), zlim=(-0.95, 0.85))
    ax.set_axis_off()
    ax.patch.set_visible(False)  # words reach into the next panel
    ax.view_init(*VIEW)
    ax.set_box_aspect((1, 1, 1), zoom=1.25)
    halo = [withStroke(linewidth=2.0, foreground="white")]
    for text in ax.texts:
        text.set_path_effects(halo)
    ax.set_title(f"{words}: {attitude.verdict}\n{_detail(result, attitude, units)}",
                 fontsize=8.5 * style.share())
    return ax


def _detail(result: CircularOrbit, attitude: OrbitEquilibrium, units: Units) -> str:
    """How fast a disturbance grows; else the slowest libration."""
    if (grows := grows_in(attitude)) is not None:
        return f"grows e-fold in {units.time(grows, SHORT)}"
    moving = [frequency for frequency in attitude.frequencies if frequency > 0]
    return (f"librates in {units.time(2 * math.pi / min(moving), SHORT)} and less" if moving
            else f"{number(result.rate, SHORT)} rad/s")
