"""Figure 1 of each paper: its model, drawn from a case by what the scene contains."""
from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np

from ...case.read import Case
from ...show import style
from . import panels
from .figure import Figure

SKETCH = ("a sketch: directions and the proportions of the box are those of the case, lengths of arrows are "
          "not")
# of eight corners
FACES = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))
VIEW = (20, 38)  # degrees: elevation, azimuth
RIGHTWARD = np.array([-np.sin(np.radians(VIEW[1])), np.cos(np.radians(VIEW[1])), 1e-6])  # in the picture
LETTERS = {"fontsize": 11, "zorder": 12}


def model_figure(name: str, paper: str = "") -> Figure:
    """Figure 1 of a paper, from a case file of the repository."""
    return Figure(1, "The model", lambda: words(panels.sweep(name)[""]),
                  lambda plt: draw(plt, panels.sweep(name)[""]), SKETCH, paper)


def words(case: Case) -> str:
    """The caption: the case, and what is drawn of it."""
    parts = ", ".join([BOX, *(PARTS[effect.name][0] for effect in case.physical.effects)])
    return f"Drawn from the case {case.name} by what its scene contains: {parts}."


def draw(plt, case: Case):
    """The body as a box of its moments, longest side 1, along its principal axes, and every effect of the
    scene; an effect that the scene does not have is not drawn."""
    figure = plt.figure(figsize=(7.2, 6.6), layout="constrained")
    ax = figure.add_subplot(projection="3d")
    ax.computed_zorder = False
    sides = box_sides(case.physical.body.inertia)
    _box(ax, sides)
    rows = [(f"{BOX}: D = {_vector(case.physical.body.inertia)} kg m²",
             {"color": style.GREY, "linewidth": 8, "alpha": 0.4, "solid_capstyle": "butt"})]
    rows += [PARTS[effect.name][1](ax, case, effect, sides) for effect in case.physical.effects]
    ax.set(xlim=(-0.8, 0.8), ylim=(-0.8, 0.8), zlim=(-0.7, 0.9))
    ax.set_axis_off()
    ax.view_init(*VIEW)
    ax.set_box_aspect((1, 1, 1), zoom=1.25)
    style.legend(figure, rows, columns=1)
    return figure


def box_sides(inertia) -> np.ndarray:
    """Sides of the homogeneous box with these moments, the longest 1: D_i is in proportion to the sum of the
    squares of the other two."""
    D = np.array(inertia, float)
    sides = np.sqrt(np.maximum(D.sum() - 2 * D, 0.0))
    return sides / sides.max()


def _box(ax, sides):
    """The box, its edges, and the principal axes, which come out of it."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    corners = np.array(list(product((-0.5, 0.5), repeat=3))) * sides
    ax.add_collection3d(Poly3DCollection([corners[list(face)] for face in FACES], facecolor=style.GREY,
                                         edgecolor="#444444", alpha=0.16, linewidth=0.9))
    for i in range(3):
        line = np.outer((-1.0, 1.0), np.eye(3)[i]) * (sides[i] / 2 + 0.22)
        ax.plot(*line.T, color=style.GREY, linewidth=0.9, linestyle="-.")
        ax.text(*line[1], f" axis {i + 1} ", color="#444444", ha="left" if i == 1 else "right", va="bottom",
                fontsize=9.5)


def _arrow(ax, start, direction, label, colour, width=2.4, side=""):
    """An arrow with its label beside the tip, above it, or below it where the arrow points to the left; its
    look in a legend."""
    start, direction = np.array(start, float), np.array(direction, float)
    ax.quiver(*start, *direction, color=colour, linewidth=width, arrow_length_ratio=0.13, zorder=8)
    left = direction @ RIGHTWARD < 0
    if label:
        ax.text(*(start + direction), f"{label}  " if left else f"  {label}", color=colour,
                ha=side or ("right" if left else "left"), va="top" if left else "bottom", **LETTERS)
    return {"color": colour, "linewidth": width}


def _along(vector, length):
    """The vector at another length."""
    return length * np.array(vector, float) / np.linalg.norm(vector)


def _vector(values) -> str:
    return f"({', '.join(f'{float(v):.4g}' for v in values)})".replace("-", "−")


def _wheel(ax, case, effect, sides):
    """The rotor as a ring about its axis, and its momentum."""
    axis = _along(effect.moment, 1.0)
    across = np.linalg.svd(axis[None])[2][1:]
    turn = np.linspace(0, 2 * np.pi, 91)
    ring = 0.2 * (np.outer(np.cos(turn), across[0]) + np.outer(np.sin(turn), across[1]))
    ax.plot(*ring.T, color=style.BLUE, linewidth=3.0, zorder=7)
    look = _arrow(ax, (0, 0, 0), 0.55 * axis, r"momentum $\lambda$", style.BLUE, 3.2)
    return f"momentum of the wheel λ = {_vector(effect.moment)} kg m²/s", look


def _torque(ax, case, effect, sides):
    look = _arrow(ax, (0, 0, 0), _along(effect.vector, 1.0), "torque M", style.VERMILION)
    return f"constant torque M = {_vector(effect.vector)} N m", look


def _force(ax, case, effect, sides):
    look = _arrow(ax, (0, 0, 0), _along(effect.vector, 1.1), "force f", style.GREEN)
    return f"constant force f = {_vector(effect.vector)} N", look


def _charge(ax, case, effect, sides):
    """The charge on axis 3, at its arm where the mass tells the size of the box, and lines of the field."""
    mass, D = case.physical.body.mass, np.array(case.physical.body.inertia)
    longest = np.sqrt(6 * (D.sum() - 2 * D).max() / mass) if mass else 2 * effect.arm / sides[2]
    place = np.array([0.0, 0.0, effect.arm / longest])
    field = (case.blocks.get("gamma", (0, 0, 1)) if effect.follows_attitude
             else (0.0, np.sin(effect.angle), np.cos(effect.angle)))
    ax.plot(*place[:, None], marker="o", color=style.ORANGE, markersize=11, linestyle="none", zorder=9)
    ax.text(*place, "charge e  ", color=panels.INK["printed"], ha="right", va="bottom", **LETTERS)
    for shift, label in ((-0.85, ""), (0.75, "field H")):
        look = _arrow(ax, (0.0, shift, -0.3), _along(field, 0.75), label, panels.INK["corrected"], 1.6)
    angle = "of the attitude" if effect.follows_attitude else f"= {effect.angle:g} rad"
    return (f"charge e = {effect.charge:g} C on axis 3 at l = {effect.arm:g} m, field H = "
            f"{effect.field_strength:g} T, σ {angle}", look)


def _ball(ax, sides, word):
    """A ball within the box, with a word at it; its look in the legend."""
    turn, up = np.meshgrid(np.linspace(0, 2 * np.pi, 41), np.linspace(0, np.pi, 21))
    ball = 0.3 * sides.min() * np.array([np.sin(up) * np.cos(turn), np.sin(up) * np.sin(turn), np.cos(up)])
    ax.plot_surface(*ball, color=style.SKY, alpha=0.45, linewidth=0, shade=False, zorder=3)
    ax.text(0.0, 0.3 * sides.min(), 0.0, f" {word}", color=style.BLUE, ha="left", va="bottom", **LETTERS)
    return {"color": style.SKY, "marker": "o", "markersize": 10, "linestyle": "none", "alpha": 0.6}


def _liquid(ax, case, effect, sides):
    return (f"cavity of liquid: ρ = {effect.density:g} kg/m³, ν = {effect.viscosity:g} m²/s, P0 = "
            f"{effect.P0:g} m⁷", _ball(ax, sides, "liquid"))


def _damper(ax, case, effect, sides):
    return (f"damper: sphere of {effect.inertia:g} kg m² in a fluid of {effect.coefficient:g} N m s",
            _ball(ax, sides, "damper"))


def _resistance(ax, case, effect, sides):
    """Against the momentum of the body at the start."""
    look = {"color": style.BLACK, "linewidth": 1.6}
    if case.state is not None and np.any(case.state):
        spin = -np.array(case.physical.body.inertia) * case.state
        look = _arrow(ax, (0, 0, 0), _along(spin, 0.8), r"resistance $-cD\omega$", style.BLACK, 1.6)
    return f"resistance −c Dω, c = {effect.coefficient:g} 1/s, at the start", look


def _down(case):
    return np.array(case.blocks.get("gamma", (0.0, 0.0, -1.0)), float)


def _weight(ax, case, effect, sides):
    """The fixed point, the centre of mass and its weight."""
    centre = _along(effect.centre_of_mass, 0.45) if np.any(effect.centre_of_mass) else np.zeros(3)
    ax.plot([0], [0], [0], zorder=9, marker="s", color=style.BLACK, markersize=8, linestyle="none")
    ax.text(0.0, 0.0, 0.0, "  fixed point O", color=style.BLACK, ha="left", va="bottom", **LETTERS)
    ax.plot(*np.array([np.zeros(3), centre]).T, color=style.BLACK, linewidth=1.0, linestyle=":", zorder=8)
    ax.plot(*centre[:, None], zorder=9, marker="o", color=style.VERMILION, markersize=7, linestyle="none")
    look = _arrow(ax, centre, 0.5 * _down(case), "weight Mg", style.VERMILION, side="left")
    return (f"weight Mg = {effect.weight:g} N at the centre of mass {_vector(effect.centre_of_mass)} m", look)


def _attraction(ax, case, effect, sides):
    """The attracting centre, far along gamma."""
    place = 1.15 * _down(case)
    ax.plot(*np.array([np.zeros(3), place]).T, color=style.GREEN, linewidth=1.2, linestyle="--", zorder=5)
    ax.plot(*place[:, None], marker="*", color=style.GREEN, markersize=15, linestyle="none", zorder=9)
    ax.text(*place + [0.0, 0.0, -0.07], "attracting centre", color=style.GREEN, ha="center", va="top",
            **LETTERS)
    away = "" if effect.distance is None else f", R = {effect.distance:g} m away"
    return (f"attracting centre{away}: N = {effect.strength:.3g} 1/s²",
            {"color": style.GREEN, "marker": "*", "markersize": 10, "linestyle": "--", "linewidth": 1.2})


BOX = "box with the body's principal moments"
PARTS: dict[str, tuple[str, Callable]] = {  # effect -> its words in the caption, and what draws it
    "gyrostat": ("the momentum of its wheel", _wheel), "constant_torque": ("the constant torque", _torque),
    "body_force": ("the constant force", _force), "charge": ("the charge and the field", _charge),
    "liquid_cavity": ("the cavity of liquid", _liquid), "resistance": ("the resistance", _resistance),
    "gravity": ("fixed point, centre of mass and weight", _weight),
    "newtonian_field": ("the attracting centre", _attraction), "viscous_damper": ("the damper", _damper)}
