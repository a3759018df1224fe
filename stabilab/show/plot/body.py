"""The body as the box of its moments, with what acts on it: a sketch of a case."""
from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from ...physics.effects.base import effect_words
from .. import labels, style
from ..axes import PLAIN
from ..text.notes import fitted
from ..units import number
from . import canvas
from . import subject as subjects
from .subject import Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d import Axes3D

    from ...numbers.vectors import Float3
    from ...physics.effects.base import Effect

CORNERS = np.array(list(product((-1.0, 1.0), repeat=3)))
# across axes 1, 1, 2, 2, 3, 3
FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
VIEW = (20, 38)  # degrees: elevation, azimuth
RIGHTWARD = np.array([-np.sin(np.radians(VIEW[1])), np.cos(np.radians(VIEW[1])), 1e-6])  # in the picture
LETTERS = {"fontsize": 11, "zorder": 12}
FARTHEST = 0.75  # of the longest side of the box: a thruster that is farther out stands there
SIZE = (7.2, 7.0)  # inches
# what a small picture leaves out of words
LETTER_ALONE = re.compile(r"\b(?:torque|momentum|force|field|weight|motor|charge) ")
ROOM = 4.2  # inches across: in a smaller picture a legend would leave no room for the body


def body(case: Any, state: Any = None, ax: Axes | None = None, units: str | None = None,
         size: tuple[float, float] | None = None, legend: bool = True, bare: bool = False) -> Axes:
    """Draw the body of a case as a box with its principal moments, its longest side 1, along the principal
    axes, and return the (three-dimensional) axes.

    Every effect of the scene is drawn, the rates at the start, the thrusters and wheels of the case, and the
    axes of its file where these are others. Directions and proportions are those of the case, lengths of
    arrows are not; a picture less than 4.2 inches wide has no legend. bare: the body and the effects alone,
    axes by number. Raises InputError for scaled variables.
    """
    item = subject(case, state)
    subjects.check("body", item)
    if item.burning is not None:  # at its start, not after the last closing
        item = replace(item, state=item.burning.craft.state)
    from matplotlib.patheffects import withStroke
    scene = subjects.bodily(item)
    sides = box_sides(scene.body.inertia)
    with canvas.on(ax, size or SIZE, space=True) as target:
        target.computed_zorder = False
        _box(target, sides, PLAIN if bare else item.axes)
        rows = [(f"{BOX}: D = {_vector(scene.body.inertia)} kg m²",
                 {"color": style.GREY, "linewidth": 8, "alpha": 0.4, "solid_capstyle": "butt"})]
        rows += [_effect(target, item, effect, sides) for effect in scene.effects]
        if not bare and item.physical:
            rows += _start(target, item) + ([] if item.case is None else _craft(target, item.case, sides))
        target.set(xlim=(-0.8, 0.8), ylim=(-0.8, 0.8), zlim=(-0.7, 0.9))
        target.set_axis_off()
        target.view_init(*VIEW)
        small = size is not None and size[0] < ROOM
        target.set_box_aspect((1, 1, 1), zoom=1.15 if small else 1.3)  # its words reach farther out
        halo = [withStroke(linewidth=2.5, foreground="white")]  # words lie on lines and arrows
        for text in target.texts:
            if small:
                text.set_text(LETTER_ALONE.sub("", text.get_text()))
            text.set(path_effects=halo, zorder=LETTERS["zorder"])
        if not bare:
            canvas.title(target, item.heading, most=style.TITLE_LINES if ax is None else None)
        if legend and not small:
            notes = [] if bare else canvas.notes_of_case(item, measures(item, units))
            style.legend(target.figure, rows, columns=1,
                         notes=fitted(notes, target.figure.bbox.width / target.figure.dpi))
        if ax is None:
            labels.apart(target)
    return target


def _effect(ax: Any, item: Subject, effect: Any, sides: np.ndarray) -> tuple[str, dict[str, Any]]:
    """What an effect is drawn by; a row of the legend alone where PARTS has no sketch of it."""
    if effect.name not in PARTS:
        return f"{effect_words(effect.name)}, not drawn", {"linestyle": "none"}
    return PARTS[effect.name][1](ax, item, effect, sides)


def _start(ax: Any, item: Subject) -> list[tuple[str, dict[str, Any]]]:
    """The axis about which the body turns at the start."""
    if item.state is None or not any(item.state):
        return []
    unit, per = measures(item).rate
    look = _arrow(ax, (0, 0, 0), _along(item.state, 0.85), r"$\omega$", style.VIOLET, 1.8)
    return [(f"rates at the start ω = {_vector(per * np.array(item.state))} {unit}", look)]


def _craft(ax: Any, case: Any, sides: np.ndarray) -> list[tuple[str, dict[str, Any]]]:
    """Thrusters and wheels where the case has them, and the axes of its file; rows of the legend."""
    turn = np.eye(3) if case.frame is None else np.array([[float(v) for v in row] for row in case.frame.axes])
    principal = lambda vector: turn @ np.array([float(v) for v in vector])
    arms = [principal(thruster.arm) for thruster in case.thrusters]
    per_metre = _per_metre(case.scene.body, arms, sides)
    rows = []
    for wheel, arm in zip(case.thrusters, arms):
        index = per_metre * arm
        index *= min(1.0, FARTHEST / max(float(np.linalg.norm(index)), 1e-12))
        colour = style.BLACK if wheel.stuck else style.GREY
        ax.plot(*np.array([np.zeros(3), index]).T, color=style.GREY, linewidth=0.8, linestyle=":", zorder=5)
        ax.plot(*index[:, None], marker="o", color=colour, markersize=6, zorder=9)
        look = _arrow(ax, index, 0.3 * principal(wheel.direction), "", colour, 2.0)
        ax.text(*index, f" {wheel.name}", color=colour, ha="left", va="top", **LETTERS)
        stuck = ", stuck" * wheel.stuck
        rows.append((f"force of {wheel.name} on the body, {number(float(wheel.force))} N{stuck}", look))
    for wheel in case.wheels if len(case.wheels) > 1 else ():
        turning = np.sign(float(wheel.momentum) or 1.0) * principal(wheel.axis)
        look = _arrow(ax, (0, 0, 0), 0.4 * turning, wheel.name, style.GREY, 1.6)
        rows.append((f"momentum of {wheel.name}, {number(float(wheel.momentum))} N m s", look))
    if case.frame is not None and not case.frame.as_given:
        for letter, axis in zip("xyz", turn.T):
            ax.plot(*np.array([-0.72 * axis, 0.72 * axis]).T, color=style.GREY, linewidth=1.0,
                    linestyle="--", zorder=4)
            ax.text(*(0.78 * axis), letter, color=style.GREY, **LETTERS)
        rows.append(("axes of the file", {"color": style.GREY, "linewidth": 1.0, "linestyle": "--"}))
    return rows


def _per_metre(body: Any, arms: list[np.ndarray], sides: np.ndarray) -> float:
    """How long a metre is in the picture: as the mass has it; without one the farthest thruster is at the
    corner of the box."""
    D = np.array(body.inertia, float)
    if body.mass:
        return float(sides.max() / np.sqrt(6 * (D.sum() - 2 * D).max() / body.mass))
    farthest = max((float(np.linalg.norm(arm)) for arm in arms), default=0.0)
    return float(np.linalg.norm(sides)) / 2 / farthest if farthest else 1.0


def box_sides(inertia: Sequence[float]) -> np.ndarray:
    """Sides of the homogeneous box with these moments, the longest 1: D_i is in proportion to the sum of the
    squares of the other two."""
    D = np.array(inertia, float)
    sides = np.sqrt(np.maximum(D.sum() - 2 * D, 0.0))
    return sides / sides.max()


def _box(ax, sides, axes):
    """The box, its edges, and the principal axes, which come out of it."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    corners = CORNERS * sides / 2
    ax.add_collection3d(Poly3DCollection([corners[list(face)] for face in FACES], facecolor=style.GREY,
                                         edgecolor="#444444", alpha=0.16, linewidth=0.9))
    for i, colour in enumerate(style.AXES):
        line = np.outer((-1.0, 1.0), np.eye(3)[i]) * (sides[i] / 2 + 0.22)
        ax.plot(*line.T, color=colour, linewidth=1.3, linestyle="-.")
        ax.text(*line[1], f" {axes.full(i + 1)} ", color=colour, ha="left" if i == 1 else "right",
                va="bottom", fontsize=9.5)


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


def _along(vector: Sequence[float], length: float):
    """The vector at another length."""
    return length * np.array(vector, float) / np.linalg.norm(vector)


def _vector(values: Float3 | np.ndarray) -> str:
    return f"({', '.join(number(float(v)) for v in values)})".replace("-", "−")


def _ring(ax: Axes3D, axis: np.ndarray, radius: float):
    """A rotor as a ring about its axis."""
    across = np.linalg.svd(axis[None])[2][1:]
    turn = np.linspace(0, 2 * np.pi, 91)
    ring = radius * (np.outer(np.cos(turn), across[0]) + np.outer(np.sin(turn), across[1]))
    ax.plot(*ring.T, color=style.GREY, linewidth=3.0, zorder=7)


def _vector_of(attribute: str, length: float, label: str, colour: str, text: str, width: float = 2.4,
               ring: float = 0.0) -> Callable:
    """What draws an effect that is a vector, along it; a rotor with a ring about it."""
    def draw(ax: Axes3D, item: Subject, effect: Effect, sides: np.ndarray):
        axis = _along(getattr(effect, attribute), 1.0)
        if ring:
            _ring(ax, axis, ring)
        duration = getattr(effect, "duration", None)
        end = "" if duration is None else f" for {float(duration):g} s"
        look = _arrow(ax, (0, 0, 0), length * axis, label, colour, width)
        return text.format(_vector(getattr(effect, attribute))) + end, look
    return draw


def _charge(ax, item, effect, sides):
    """The charge on axis 3, at its arm where the mass tells the size of the box, and lines of the field."""
    body = subjects.bodily(item).body
    mass, D = body.mass, np.array(body.inertia)
    longest = np.sqrt(6 * (D.sum() - 2 * D).max() / mass) if mass else 2 * effect.arm / sides[2]
    location = np.array([0.0, 0.0, effect.arm / longest])
    field = (item.blocks.get("gamma", (0, 0, 1)) if effect.follows_attitude
             else (0.0, np.sin(effect.angle), np.cos(effect.angle)))
    ax.plot(*location[:, None], marker="o", color=style.BLACK, markersize=11, linestyle="none", zorder=9)
    ax.text(*location, "charge e  ", color=style.BLACK, ha="right", va="bottom", **LETTERS)
    for shift, label in ((-0.85, ""), (0.75, "field H")):
        look = _arrow(ax, (0.0, shift, -0.3), _along(field, 0.75), label, style.GREY, 1.6)
    angle = "of the attitude" if effect.follows_attitude else f"= {effect.angle:g} rad"
    return (f"charge e = {effect.charge:g} C on axis 3 at l = {effect.arm:g} m, field H = "
            f"{effect.field_strength:g} T, σ {angle}", look)


def _ball(ax, sides, word):
    """A ball within the box, with a word at it; its look in the legend."""
    turn, up = np.meshgrid(np.linspace(0, 2 * np.pi, 41), np.linspace(0, np.pi, 21))
    ball = 0.3 * sides.min() * np.array([np.sin(up) * np.cos(turn), np.sin(up) * np.sin(turn), np.cos(up)])
    ax.plot_surface(*ball, color=style.GREY, alpha=0.45, linewidth=0, shade=False, zorder=3)
    ax.text(0.0, 0.3 * sides.min(), 0.0, f" {word}", color=style.GREY, ha="left", va="bottom", **LETTERS)
    return {"color": style.GREY, "marker": "o", "markersize": 10, "linestyle": "none", "alpha": 0.6}


def _liquid(ax, item, effect, sides):
    return (f"cavity of liquid: ρ = {effect.density:g} kg/m³, ν = {effect.viscosity:g} m²/s, P0 = "
            f"{effect.P0:g} m⁷", _ball(ax, sides, "liquid"))


def _damper(ax, item, effect, sides):
    return (f"damper: sphere of {effect.inertia:g} kg m² in a fluid of {effect.coefficient:g} N m s",
            _ball(ax, sides, "damper"))


def _damper_wheel(ax, item, effect, sides):
    look = _arrow(ax, (0, 0, 0), _along(effect.axis, 0.6), "damper wheel", style.GREY, 1.6)
    return (f"damper: wheel of {effect.inertia:g} kg m² on a bearing of {effect.coefficient:g} N m s, about "
            f"{_vector(effect.axis)}", look)


def _damper_mass(ax, item, effect, sides):
    place = _along(effect.place, 0.45) if np.any(effect.place) else np.zeros(3)
    look = _arrow(ax, place, _along(effect.line, 0.35), "damper mass", style.GREY, 1.6)
    return (f"damper: mass of {effect.mass:g} kg at {_vector(effect.place)} m on a line along "
            f"{_vector(effect.line)}, spring {effect.stiffness:g} N/m, dashpot {effect.coefficient:g} kg/s",
            look)


def _against(item: Subject, ax: Any, matrix: Any, label: str) -> dict[str, Any]:
    """An arrow against a multiple of the angular velocity at the start; its look in the legend."""
    torque = -np.array(matrix) @ np.array((0, 0, 0) if item.state is None else item.state)
    if not np.any(torque):
        return {"color": style.BLACK, "linewidth": 1.6}
    return _arrow(ax, (0, 0, 0), _along(torque, 0.8), label, style.BLACK, 1.6)


def _resistance(ax, item, effect, sides):
    look = _against(item, ax, np.diag(subjects.bodily(item).body.inertia), r"resistance $-cD\omega$")
    return f"resistance −c Dω, c = {effect.coefficient:g} 1/s, at the start", look


def _rate_damper(ax, item, effect, sides):
    return "linear damper −C ω, at the start", _against(item, ax, effect.coefficient, r"damping $-C\omega$")


def _eddy(ax, item, effect, sides):
    """Lines of the field, half of each on either side of the plane of axes 2 and 3."""
    field, look = _along(_down(item), 0.75), {}
    for shift, label in ((-0.75, ""), (0.75, "field B")):
        look = _arrow(ax, (0.0, shift, -0.3) - field / 2, field, label, style.GREY, 1.6)
    return (f"eddy currents in a field of {effect.field_strength:g} T, k = {effect.coefficient:g} N m s/T²",
            look)


def _down(item: Subject):
    return np.array(item.blocks.get("gamma", (0.0, 0.0, -1.0)), float)


def _weight(ax, item, effect, sides):
    """The fixed point, the centre of mass and its weight."""
    centre = _along(effect.centre_of_mass, 0.45) if np.any(effect.centre_of_mass) else np.zeros(3)
    ax.plot([0], [0], [0], zorder=9, marker="s", color=style.BLACK, markersize=8, linestyle="none")
    ax.text(0.0, 0.0, 0.0, "  fixed point O", color=style.BLACK, ha="left", va="bottom", **LETTERS)
    ax.plot(*np.array([np.zeros(3), centre]).T, color=style.BLACK, linewidth=1.0, linestyle=":", zorder=8)
    ax.plot(*centre[:, None], zorder=9, marker="o", color=style.BLACK, markersize=7, linestyle="none")
    look = _arrow(ax, centre, 0.5 * _down(item), "weight Mg", style.BLACK, side="left")
    return (f"weight Mg = {effect.weight:g} N at the centre of mass {_vector(effect.centre_of_mass)} m", look)


def _attraction(ax, item, effect, sides):
    """The attracting centre, far along gamma."""
    location = 1.15 * _down(item)
    ax.plot(*np.array([np.zeros(3), location]).T, color=style.BLACK, linewidth=1.2, linestyle="--", zorder=5)
    ax.plot(*location[:, None], marker="*", color=style.BLACK, markersize=15, linestyle="none", zorder=9)
    ax.text(*location + [0.0, 0.0, -0.07], "attracting centre", color=style.BLACK, ha="center", va="top",
            **LETTERS)
    away = "" if effect.distance is None else f", R = {effect.distance:g} m away"
    return (f"attracting centre{away}: N = {effect.strength:.3g} 1/s²",
            {"color": style.BLACK, "marker": "*", "markersize": 10, "linestyle": "--", "linewidth": 1.2})


BOX = "box with the body's principal moments"
PARTS: dict[str, tuple[str, Callable]] = {  # effect -> its words in the caption, and what draws it
    "gyrostat": ("the momentum of its wheel", _vector_of(
        "moment", 0.55, r"momentum $\lambda$", style.GREY, "momentum of the wheel λ = {} kg m²/s", 3.2, 0.2)),
    "constant_torque": ("the constant torque", _vector_of(
        "vector", 0.85, "torque M", style.BLACK, "constant torque M = {} N m")),
    "body_force": ("the constant force", _vector_of(
        "vector", 1.0, "force f", style.BLACK, "constant force f = {} N")),
    "charge": ("the charge and the field", _charge), "liquid_cavity": ("the cavity of liquid", _liquid),
    "resistance": ("the resistance", _resistance),
    "gravity": ("fixed point, centre of mass and weight", _weight),
    "newtonian_field": ("the attracting centre", _attraction), "viscous_damper": ("the damper", _damper),
    "damper_wheel": ("the wheel of the damper", _damper_wheel),
    "damper_mass": ("the mass of the damper", _damper_mass),
    "rate_damper": ("the linear damper", _rate_damper), "eddy_currents": ("the magnetic field", _eddy),
    "wheel_motor": ("the motor of the wheel", _vector_of(
        "motor", 0.8, "motor u", style.GREY, "torque of the motor on its wheel u = {} N m", 2.4, 0.27))}
