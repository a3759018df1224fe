"""A motion on the surface that it stays on: cylinder of the reduced motion, sphere of momentum."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.equilibria import equilibria
from ...answers.simulate import simulated
from ...equilibrium.momentum_sphere import INFLECTION, MAXIMUM, MINIMUM, SADDLE, MomentumSphere
from ...numbers.exact import floats, sqrt_fraction
from ...numbers.polynomial import halved
from ...numbers.vectors import dot
from ...orbit.phase_plane import PhasePlane, motion_curve, phase_plane, window
from ...physics.states import body_momentum
from .. import style
from ..space.box import Box
from ..space.reach import spread
from ..units import number, with_unit
from . import canvas, in_space
from . import subject as subjects
from .in_space import (
    CURVES,
    EQUILIBRIUM_LOOKS,
    SurfaceLines,
    between,
    disc,
    facing,
    grid_triangles,
    levels,
    plane_of,
    sight,
)
from .path import FINE, path, turning
from .phase_plane import SMALL, curves_of, equilibria_of, highest, rows_of, ways
from .subject import Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# --- The cylinder on which a motion under a torque on a principal axis stays: its phase plane, wrapped
# round the curve of the other two rates
GRID = (97, 161)  # of the surface: rates, places
FARTHER = {"linewidth": 0.8}
LEVELS, ROUNDS = 20, 8  # other energies; how often curves are followed round, at most
LEAST_RISE = 1 / 40  # of the energies in the picture, round the circle: a lesser one would need as many lines
AROUND = 2.2  # a small motion is shown in so many times its own size
ASIDE = 0.6  # of the way over this motion and all equilibria: how far a hyperbola or parabola is shown beyond


def cylinder(item: Subject, units: str | None) -> SurfaceLines:
    """All that a plot shows, in the units of the rates."""
    plane, scale = phase_plane(item.twin, item.state), measures(item, units)
    ys, Ws = motion_curve(plane, *window(plane))
    low, high, top = _range(plane, ys, Ws)
    at = lambda y, W: plane.states(np.asarray(y, float), np.asarray(W, float)) * scale.rate[1]
    y, W = np.linspace(low, high, GRID[1]), np.linspace(-top, top, GRID[0])
    surface = at(*np.broadcast_arrays(y[None, :], W[:, None]))
    axis = plane.reduction.axis
    view = facing(_broadside(plane, (low + high) / 2, axis) + 0.35 * np.eye(3)[axis])
    spread = np.ptp(surface.reshape(-1, 3), axis=0)
    pad = (0.04 * spread.max() if spread.min() > 0.04 * spread.max()
           else np.maximum(0.04 * spread, 0.1 * spread.max()))
    box = between(surface.min(axis=(0, 1)) - pad, surface.max(axis=(0, 1)) + pad)
    text = f"the rates across {item.axes.short(axis + 1)} stay on a {plane.land.base}"
    result = SurfaceLines(grid_triangles(surface), box, view,
                         tuple(with_unit(name, scale.rate[0]) for name in scale.names), text)
    for y, W, look in _curves(plane, low, high, top):
        shown = (np.abs(W) <= top) & ((y >= low - 1e-9) & (y <= high + 1e-9) | np.isfinite(plane.land.turn))
        result.add(np.where(shown[:, None], at(y, W), np.nan), look, _outward(plane, y, axis))
    rests = equilibria_of(plane, low, high)
    for kind, places in rests:
        for index in places:
            front = float(_outward(plane, [index], axis)[0] @ sight(view)) >= 0
            result.marks.append((at([index], [0.0]), style.MARKER[kind] | ({} if front else {"alpha": 0.35})))
    result.marks.append((at([0.0], [plane.W0]), style.MARKER["start"]))
    result.rows = rows_of(dict(rests))
    return result


def _curves(plane: PhasePlane, low: float, high: float, top: float):
    """As of `curves_of`. Round a whole circle a torque lifts the energy by the same each time: the others are
    so many energies that each line goes on beyond the place where the plane is cut, and separatrices and this
    motion are followed round until they leave the picture. A torque that lifts it by too little for that is
    not seen in them."""
    rise = float(plane.height(high)) - float(plane.height(low))
    y, W = np.linspace(low, high, 700), np.linspace(-top, top, 500)
    energy = W[:, None]**2 / 2 + plane.height(y)[None, :]
    if high - low < plane.land.turn * (1 - 1e-9) or abs(rise) < LEAST_RISE * float(np.ptp(energy)):
        yield from curves_of(plane, low, high, top)
        return
    step = abs(rise) / max(1, round(LEVELS * abs(rise) / float(np.ptp(energy))))
    values = np.arange(float(energy.min()) + step / 2, float(energy.max()), step)
    for line in levels(y, W, energy, values):
        yield *line.T, style.MEANING["level"]
    far = plane.land.turn * min(ROUNDS, 1 + int(top**2 / 2 / abs(rise)))
    for saddle in plane.repeated(plane.saddles, low, high):
        ys, Ws = plane.separatrix(saddle, low - far, high + far, 20_001)
        yield from _wound(ys, Ws, saddle, (1.0, -1.0), style.MEANING["separatrix"])
    ys, Ws = motion_curve(plane, low - far, high + far, 20_001)
    yield from _wound(ys, Ws, 0.0, ways(plane, Ws), style.MEANING["this motion"])


def _wound(y: np.ndarray, W: np.ndarray, start: float, signs: Sequence[float], look: dict[str, Any]):
    """A curve and its mirror, drawn thin where it has gone right round from where it starts."""
    near = np.abs(y - start) <= 2 * np.pi
    for sign in signs:
        yield np.where(near, y, np.nan), sign * W, look
        if not near.all():
            yield np.where(near, np.nan, y), sign * W, look | FARTHER


def _range(plane: PhasePlane, ys, Ws):
    """(from, to, largest W): one turn of a circle about the motion, the window of another base; of a small
    motion its surroundings."""
    low, high = window(plane)
    closed = Ws[[0, -1]].max() < 1e-6 * Ws.max()
    middle = (ys[0] + ys[-1]) / 2 if closed else 0.0
    half, top = (ys[-1] - ys[0]) / 2, highest(plane, low, high)
    if 0 < Ws.max() < SMALL * top and closed:
        return middle - AROUND * half, middle + AROUND * half, AROUND * float(Ws.max())
    if np.isfinite(plane.land.turn):
        return middle - np.pi, middle + np.pi, highest(plane, middle - np.pi, middle + np.pi)
    marks = np.clip([ys[0], ys[-1], *plane.saddles, *plane.centres], low, high)
    nearby = ASIDE * max(float(np.ptp(marks)), 0.1)
    return max(low, marks.min() - nearby), min(high, marks.max() + nearby), top


def _outward(plane, ys, axis):
    """(n, 3) the outward normal of a circular cylinder at places; zero of the others, which hide little."""
    ys = np.asarray(ys, float)
    if not np.isfinite(plane.land.turn):
        return np.zeros((len(ys), 3))
    points = plane.states(ys, np.zeros(ys.shape))
    turn = plane.states(np.linspace(0, 2 * np.pi, 64, endpoint=False), np.zeros(64)).mean(axis=0)
    out = points - turn
    out[:, axis] = 0.0
    return out / np.linalg.norm(out, axis=1, keepdims=True)


def _broadside(plane, y, axis):
    """A unit vector across the surface at a place: outward from a circle, to the upper side of the others."""
    out = _outward(plane, [y], axis)[0]
    if out.any():
        return out
    tangent = np.diff(plane.states(np.array([y - 1e-3, y + 1e-3]), np.zeros(2)), axis=0)[0]
    normal = np.cross(tangent, np.eye(3)[axis])
    return normal / (np.linalg.norm(normal) or 1.0) * (1 if normal[2] >= 0 else -1)


# --- The sphere of the angular momentum of a body that no torque acts on, its polhodes and separatrices
POLHODES = 13  # lines of other energies
SPHERE_GRID = (361, 721)  # latitudes, longitudes
BESIDE_SADDLE = 3e-4  # of the energies: so near to a saddle the two sides are less than two places apart
STEP = 3  # of these latitudes that a facet of what turns fill reaches over
FAR = {"alpha": 0.45, "markersize": 5.5}  # of a point behind the sphere
LIFT = 1.002  # of a line off the sphere
EXTREME = 1e-6  # of the range of energies: so near to its end a value is no saddle's
SAME = 1e-9  # of the energies: those of one saddle, found twice


def momentum_sphere(item: Subject) -> SurfaceLines:
    """All that a plot shows, in kg m^2/s; H = D omega + wheel, |H| constant, and the energy sum((H - wheel)^2
    / 2 D) tells the polhodes apart."""
    scene: Any = item.twin  # physical: `which` refuses the others
    D = np.array([float(v) for v in scene.body.exact])
    wheel = np.array([float(v) for v in scene.vector("gyrostat")])
    period = item.motion.period
    _, omega = path(item, 0.0, period or max(item.seen, key=abs))
    route = omega * D + wheel
    size = float(np.linalg.norm(route[0]))
    energy = lambda H: (((H - wheel) ** 2) / (2 * D)).sum(axis=-1)
    ball, round_, up, at = _ball(size)
    height = energy(ball)
    rest, circles = _rest(item, D, wheel, size)
    view = facing(route.mean(axis=0) if np.linalg.norm(route.mean(axis=0)) > 0.05 * size else route[0])
    result = SurfaceLines(grid_triangles(ball[::6, ::8]), Box((0.0,) * 3, (1.08 * size,) * 3), view,
                         tuple(rf"$H_{n}$ (kg m$^2$/s)" for n in (1, 2, 3)),
                         f"sphere of the angular momentum, |H| = {number(size, 5)} kg m²/s")
    flat = float(np.ptp(height)) <= SAME * float(np.abs(height).max())
    saddles = [] if flat else _saddles(height, [float(energy(H)) for kind, H in rest if kind == "unstable"])
    for values, look in ((_others(height, saddles), style.MEANING["level"]),
                         (saddles, style.MEANING["separatrix"])):
        for line in levels(round_, up, height, values):
            points = at(*line.T)
            result.add(LIFT * points, look, points)
    for kind, points in circles:
        result.add(LIFT * points, CURVES[kind], points)
    result.add(LIFT * route, style.MEANING["this motion"], route)
    result.marks = ([(LIFT * H[None], _seen(EQUILIBRIUM_LOOKS[kind], H, view)) for kind, H in rest]
                   + [(LIFT * route[:1], style.MARKER["start"])])
    result.rows = [("this motion", style.MEANING["this motion"]), ("start", style.MARKER["start"]),
                  *([("separatrix", style.MEANING["separatrix"])] if saddles else []),
                  *([] if flat else [("other energies", style.MEANING["level"])]),
                  *((f"{kind} equilibrium", EQUILIBRIUM_LOOKS[kind]) for kind in EQUILIBRIUM_LOOKS
                     if kind in dict(rest)),
                  *((f"{kind} equilibria", CURVES[kind]) for kind in CURVES if kind in dict(circles))]
    return result


def _ball(size: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, Callable[..., np.ndarray]]:
    """(points of a sphere (latitudes, longitudes, 3), its longitudes, its latitudes, both -> points)."""
    up = np.linspace(-np.pi / 2, np.pi / 2, SPHERE_GRID[0])
    round_ = np.linspace(-np.pi, np.pi, SPHERE_GRID[1])
    at = lambda round_, up: size * np.stack(
        [np.cos(up) * np.cos(round_), np.cos(up) * np.sin(round_), np.sin(up)], axis=-1)
    return at(*np.meshgrid(round_, up)), round_, up, at


# --- The same of a body that loses energy inside: H goes over the levels of the energy to a minimum
ROUTE = style.MEANING["this motion"] | {"linewidth": 1.1}
MANY_TURNS = 60  # of a component: of more, what they fill is drawn and some of them
ALL_TURNS = "all turns of this motion"
SWEPT: dict[str, Any] = {"facecolor": style.VIOLET, "alpha": in_space.SHEER[style.VIOLET]}
# of a rotation -> (words, its look as a point, as a circle)
NATURES: dict[str, tuple[str, dict[str, Any], dict[str, Any]]] = {
    MINIMUM: ("least energy: attracts", style.MARKER["centre"], style.MEANING["stable"]),
    MAXIMUM: ("most energy: unstable with losses", style.MARKER["turning"] | {"color": style.VERMILION},
              style.MEANING["unstable"]),
    SADDLE: ("saddle", style.MARKER["saddle"], style.MEANING["unstable"]),
    INFLECTION: ("inflection", style.MARKER["degenerate"], style.MEANING["unstable"])}


def losing_sphere(item: Subject) -> SurfaceLines:
    """All that a plot shows of a free body that something inside takes energy from, in kg m^2/s: its
    rotations at this |H|, the levels of the energy at rest inside, and the route of H over them."""
    scene: Any = item.scene
    sphere = _sphere_of(item)
    size = float(sqrt_fraction(sphere.square))
    ball, round_, up, at = _ball(size)
    D, wheel = (np.array(floats(v)) for v in (sphere.D, sphere.wheel))
    height = ((ball - wheel) ** 2 / (2 * D)).sum(axis=-1)
    run = simulated(scene, item.state, np.linspace(0.0, max(item.seen, key=abs), FINE), item.blocks)
    route = body_momentum(scene, {name: run.state[name] for name in ("omega", "damper")})
    ending = item.motion.ending
    end = (np.array(floats(sphere.rotations[0].momentum)) if ending is None or ending.rates is None
           else D * ending.rates + wheel)
    towards = (route[0] + end) / size
    view = facing(towards if np.linalg.norm(towards) > 0.2 else route[0])
    result = SurfaceLines(grid_triangles(ball[::6, ::8]), Box((0.0,) * 3, (1.08 * size,) * 3), view,
                          tuple(rf"$H_{n}$ (kg m$^2$/s)" for n in (1, 2, 3)),
                          "levels of the energy on the sphere of the angular momentum, "
                          f"|H| = {number(size, 5)} kg m²/s")
    flat = sphere.rotations[0].everywhere
    passes = [] if flat else sorted({float(r.energy) for r in sphere.rotations if r.nature == SADDLE})
    for values, look in (([] if flat else _others(height, passes), style.MEANING["level"]),
                         (passes, style.MEANING["separatrix"])):
        for line in levels(round_, up, height, values):
            points = at(*line.T)
            result.add(LIFT * points, look, points)
    many = turning(route[:, 0]) >= MANY_TURNS
    if many:
        values = ((route - wheel) ** 2 / (2 * D)).sum(axis=1)
        swept = _swept(ball, height, route, values, passes)
        front = np.einsum("nij,j->ni", swept, sight(view)).min(axis=1) >= 0
        result.swept = LIFT * swept[front]
        for value in (values[0], (values[0] + values[-1]) / 2, values[-1]):
            nearest = route[int(np.abs(values - value).argmin())]
            turns = [at(*line.T) for line in levels(round_, up, height, [value])]
            for points in sorted(turns, key=lambda line: np.linalg.norm(line - nearest, axis=1).min())[:1]:
                result.add(LIFT * points, ROUTE, points)
    else:
        result.add(LIFT * route, ROUTE, route)
    shown: list[tuple[str, dict[str, Any]]] = []
    for rotation in () if flat else sphere.rotations:
        H, (name, mark, circle) = np.array(floats(rotation.momentum)), NATURES[rotation.nature]
        if rotation.axis:
            around = _circle(H, rotation.axis - 1)
            result.add(LIFT * around, circle, around)
            shown.append((f"{name}, a circle", circle))
        elif (name, mark) not in shown:
            shown.append((name, mark))
        if not rotation.axis:
            result.marks.append((LIFT * H[None], _seen(mark, H, view)))
    result.marks.append((LIFT * route[:1], style.MARKER["start"]))
    whole = [("this motion", ROUTE)]
    if many:
        whole = [("this motion at its start, half-way in energy and end", ROUTE), (ALL_TURNS, SWEPT)]
    result.rows = [*whole, ("start", style.MARKER["start"]),
                   *([("level of a saddle", style.MEANING["separatrix"])] if passes else []),
                   *([] if flat else [("other energies", style.MEANING["level"])]), *shown]
    return result


def _swept(ball: np.ndarray, height: np.ndarray, route: np.ndarray, values: np.ndarray,
           passes: Sequence[float]) -> np.ndarray:
    """Triangles (n, 3, 3) of the part of the sphere that a route of falling energy goes over: between its
    first and last energy, above and below each saddle on the side on which it is."""
    from scipy.ndimage import label
    count_up, count_round = height.shape
    unit = route / np.linalg.norm(route, axis=1, keepdims=True)
    row = np.rint((np.arcsin(np.clip(unit[:, 2], -1, 1)) / np.pi + 0.5) * (count_up - 1)).astype(int)
    column = np.rint((np.arctan2(unit[:, 1], unit[:, 0]) / (2 * np.pi) + 0.5) * (count_round - 1)).astype(int)
    low, high = float(values.min()), float(values.max())
    gap = BESIDE_SADDLE * float(np.ptp(height))
    between = [value for value in passes if low < value < high]
    passed = np.zeros(height.shape, bool)
    for start, end in zip([low, *(v + gap for v in between)], [*(v - gap for v in between), high]):
        areas, _ = label((height >= start) & (height <= end))
        here = set(areas[row, column][(values >= start) & (values <= end)].tolist()) - {0}
        seam = {pair for pair in zip(areas[:, 0].tolist(), areas[:, -1].tolist()) if all(pair)}
        while more := {n for pair in seam if here & set(pair) for n in pair} - here:
            here |= more
        passed |= np.isin(areas, list(here))
    triangles, inside = (grid_triangles(values[::STEP, ::2 * STEP]) for values in (ball, np.repeat(
        passed[..., None], 3, axis=2).astype(float)))
    return triangles[inside.reshape(len(inside), -1).all(axis=1)]


def _seen(mark: dict[str, Any], H: np.ndarray, view: tuple[float, float]) -> dict[str, Any]:
    """The look of a point of the sphere, pale where it lies behind."""
    return mark if H @ sight(view) >= 0 else mark | FAR


def _sphere_of(item: Subject) -> MomentumSphere:
    """That of the angular momentum at the start."""
    scene: Any = item.scene
    sigma = item.blocks.get("damper", (0.0,) * 3)
    omega = item.exact_state or item.state
    inside = scene.effect("viscous_damper").exact[0]
    H = tuple(d * Fraction(w) + inside * Fraction(s) + l for d, w, s, l in zip(
        scene.body.exact, omega, sigma, scene.vector("gyrostat")))
    return MomentumSphere(scene.body.exact, scene.vector("gyrostat"), dot(H, H))


def _circle(through: np.ndarray, axis: int) -> np.ndarray:
    """Points of the circle about an axis through a point."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    result, turn = np.tile(through, (361, 1)), np.linspace(0, 2 * np.pi, 361)
    across = np.hypot(through[i], through[j])
    result[:, i], result[:, j] = across * np.cos(turn), across * np.sin(turn)
    return result


def _saddles(height, energies):
    """The energies of saddles, each once; an extremum is none."""
    low, high = float(height.min()), float(height.max())
    apart = EXTREME * (high - low)
    inner = sorted(value for value in energies if low + apart < value < high - apart)
    return [value for n, value in enumerate(inner) if not n or value - inner[n - 1] > SAME * abs(high)]


def _others(height, saddles):
    """Energies of the polhodes: as many shares of the sphere, none beside a separatrix."""
    area = np.cos(np.linspace(-np.pi / 2, np.pi / 2, height.shape[0]))[:, None] * np.ones(height.shape)
    values = np.quantile(height, (np.arange(POLHODES) + 0.5) / POLHODES, method="inverted_cdf",
                         weights=np.maximum(area, 0.0))
    apart = 0.02 * float(np.ptp(height))
    return [value for value in values if all(abs(value - s) > apart for s in saddles)]


def _rest(item, D, wheel, size):
    """([(verdict, H)] of the single equilibria whose momentum is of this size, [(verdict, points (n, 3))] of
    circles of them)."""
    result, circles = [], []
    excess = lambda curve: lambda t: float(np.linalg.norm(np.array(curve.point(float(t)), float) * D
                                                          + wheel)) - size
    for curve in equilibria(item.twin).curves:
        if curve.plane:
            if not wheel.any():
                circles.append((style.kind_of(curve.segments[0]), disc(plane_of(curve), size)))
            continue
        for segment in curve.segments:
            result += [(style.kind_of(segment), np.array(curve.point(t), float) * D + wheel)
                      for t in _roots(excess(curve), *segment.t, size / float(D.min()))]
    return result, circles


def _roots(function, low, high, unit):
    t = spread(low, high, 4001, unit)
    values = np.array([function(v) for v in t])
    with np.errstate(all="ignore"):
        change = np.nonzero(np.isfinite(values[:-1]) & np.isfinite(values[1:])
                            & (values[:-1] * values[1:] <= 0) & (values[:-1] != 0))[0]
    return [halved(function, t[n], t[n + 1]) for n in change]


# --- The surface on which a motion stays: the sphere of its momentum, or the cylinder of a torque on an
# axis
def sphere(case: Any, state: Any = None, ax: Axes | None = None, units: str | None = None,
           size: tuple[float, float] | None = None,
           legend: bool = True) -> Axes:
    """Draw the surface on which a motion stays, with the other motions on it, and return the
    (three-dimensional) axes.

    Without a torque: the sphere of the angular momentum H, wheels included, whose size is constant; its
    components are those in the body. The lines are polhodes, the motions of other energies; the separatrices
    run through the saddles. Where a damper inside takes energy the motion goes over these levels to a
    minimum. Under a torque on a principal axis (or of scaled variables, which know no
    momentum): the cylinder whose base is the curve that the two rates across that axis cannot leave (circle,
    hyperbola or parabola); the height is the rate about the axis, and the phase plane is wrapped round it.
    What lies behind the surface is pale, lines that are to be seen whole are dashed there. Raises InputError
    where no such surface is known; it names the kinds of plot that there are.
    """
    item = subject(case, state)
    subjects.check("sphere", item)
    result = (losing_sphere(item) if subjects.losing(item) else
              momentum_sphere(item) if item.physical and subjects.free(item) else cylinder(item, units))
    with canvas.on(ax, size, space=True) as target:
        in_space.facets(target, [(result.surface, style.GREY)], pale_by=0.22)
        in_space.veil(target, result.swept, style.VIOLET)
        for points, look, front in result.lines:
            behind = BEHIND if look is style.MEANING["level"] else HIDDEN
            in_space.line(target, points, look if front else look | behind, zorder=6 if front else 3)
        for points, look in result.marks:
            in_space.line(target, points, look, zorder=4 if FAR.items() <= look.items() else 8)
        in_space.furnish(target, result.box, result.labels, result.view)
        return canvas.explained(target, result.rows if legend else [], ax is None, item.heading, result.title,
                                notes=canvas.notes(item, measures(item, units), answered=False))


BEHIND = {"alpha": 0.3, "linewidth": 0.7}
# of separatrices, circles and the motion, which are to be seen whole
HIDDEN = {"alpha": 0.75, "linewidth": 1.2, "linestyle": (0, (4, 2))}
