"""The phase plane of the reduced motion, plane sections, and the reduced potential with the motion's
energy, its wells and the barrier ahead."""
from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence, Sized
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InputError
from ...orbit.phase_plane import PhasePlane, motion_curve, phase_plane, window
from ...orbit.reduction import reduce
from ...orbit.result import Fate
from ...physics.states import checked_states
from ...unreduced.periodic import (
    LEAST,
    Periodic,
    Section,
    crossed,
    in_the_middle,
    neighbours_of,
    one_place,
    returns,
)
from .. import style
from ..units import SHORT, number, with_unit
from . import canvas, rings
from . import subject as subjects
from .in_space import levels as level_lines
from .subject import Measures, Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ...case.given import Given, Start
    from ...physics.scene import Scene

# --- The phase plane of a motion that reduces to one degree of freedom
def phase(case: Given | Subject, state: Start | None = None, ax: Axes | None = None, units: str | None = None,
          size: tuple[float, float] | None = None,
          legend: bool = True) -> Axes:
    """Draw the phase plane of a motion, and return the axes.

    case: a Case, or a scene with `state`. Across: the turn about the axis of the torque since the start; up:
    the rate about it. The reduced potential decides all lines: this motion, the separatrices through the
    saddles, and the motions of other energies at the same value of the invariant. units: "deg" or "si".
    A figure of its own has a second plane where the motion is too small to be seen in the first. Raises
    InputError where the motion has no such plane; it names the kinds of plot that there are.
    """
    item = subject(case, state)
    subjects.check("phase", item)
    scale, plane = measures(item, units), phase_plane(item.twin, item.state)
    i = plane.reduction.axis
    with canvas.on(ax, size) as target:
        factors = {"scale": plane.unit * scale.angle[1], "rate_scale": scale.rate[1]}
        small = ax is None and _small(plane)
        draw(target, plane, start=not small, **factors)
        if small:
            _enlarged(target, plane, factors)
        target.set_xlabel(with_unit(rf"turn $\alpha_{i + 1}$ about {item.axes.short(i + 1)} from the start",
                                    scale.angle[0]))
        target.set_ylabel(with_unit(scale.names[i], scale.rate[0]))
        rows = rows_of({"centre": plane.centres, "saddle": plane.saddles})
        return canvas.explained(target, rows if legend else [], ax is None,
                                item.heading, canvas.answer(item, scale), notes=canvas.notes(item, scale))


# of the walls: a motion below it would be a line, and the grid may miss the bottom of its well
RESTING = 1e-4
# of the picture's height: a motion below it is shown enlarged, in a window so much larger than itself
SMALL, AROUND = 0.07, 1.6
BESIDE_IT = 0.4  # of the plane's width: that of the window
# of the largest W: more of it at its ends has a motion that leaves the picture; at a turning point rounding
# of the place leaves some 1e-6
CLOSED = 1e-3


def _small(plane: PhasePlane) -> bool:
    """Whether a motion that turns back is too small to be seen beside its separatrix: the mark of its start
    would hide it."""
    span = window(plane)
    _, Ws = motion_curve(plane, *span)
    return 0 < Ws.max() < SMALL * highest(plane, *span) and bool(Ws[[0, -1]].max() <= CLOSED * Ws.max())


def _enlarged(ax, plane, factors):
    """A window beside the plane, where it hides no curve: this motion alone and its start."""
    ys, Ws = motion_curve(plane, *window(plane))
    columns = ax.figure.add_gridspec(1, 2, width_ratios=(1, BESIDE_IT))
    ax.set_subplotspec(columns[0])
    inset = ax.figure.add_subplot(columns[1], box_aspect=1)
    middle, half = (ys[0] + ys[-1]) / 2, AROUND * (ys[-1] - ys[0]) / 2
    draw(inset, plane, span=(middle - half, middle + half), levels=14, top=AROUND * float(Ws.max()),
         **factors)
    inset.tick_params(labelsize="small")
    inset.set_title("enlarged", fontsize="small")
    ax.indicate_inset_zoom(inset, edgecolor=style.BLACK)


ROWS: list[tuple[str, dict]] = [
    ("this motion", style.MEANING["this motion"]), ("start", style.MARKER["start"]),
    ("separatrix", style.MEANING["separatrix"]),
    ("other energies", style.MEANING["level"]), ("centre (stable)", style.MARKER["centre"]),
    ("saddle (unstable)", style.MARKER["saddle"])]


def rows_of(rests: Mapping[str, Sized]) -> list[tuple[str, dict]]:
    """The rows of a legend, of those equilibria by their kinds that there are."""
    needed = {"centre (stable)": "centre", "saddle (unstable)": "saddle", "separatrix": "saddle"}
    return [row for row in ROWS if row[0] not in needed or len(rests.get(needed[row[0]], ()))]


def draw(ax, plane: PhasePlane, scale=1.0, offset=0.0, rate_scale=1.0, span=None, levels=16,
         separatrices=True, start=True, top=None):
    """Draw level curves, separatrices, equilibria and the motion on `ax`; x axis: offset + scale*y.
    separatrices: False where the caller draws them himself, each in a look of its own. start: mark where the
    motion begins. top: the largest W, None for what is worth drawing."""
    low, high = span or window(plane)
    top = highest(plane, low, high) if top is None else top
    for y, W, look in curves_of(plane, low, high, top, levels):
        if separatrices or look is not style.MEANING["separatrix"]:
            ax.plot(offset + scale * y, rate_scale * plane.rate(W), **look)
    if start:
        ax.plot([offset], [rate_scale * plane.rate(plane.W0)], zorder=5, **style.MARKER["start"])
    for kind, places in equilibria_of(plane, low, high):
        ax.plot(offset + scale * places, rate_scale * plane.rate(0 * places), zorder=5, clip_on=False,
                **style.MARKER[kind])
    ax.set_xlim(*sorted((offset + scale * low, offset + scale * high)))
    ends = rate_scale * plane.rate(np.array([-top, top]))
    ax.set_ylim(min(ends), max(ends))


def curves_of(plane: PhasePlane, low: float, high: float, top: float,
              levels: int = 16) -> Iterator[tuple[np.ndarray, np.ndarray, dict[str, Any]]]:
    """(y (n,), W (n,), look) of so many other energies, of the separatrices and of this motion, between two
    places and, the level curves, up to a W."""
    y, W = np.linspace(low, high, 700), np.linspace(-top, top, 500)
    energy = W[:, None] ** 2 / 2 + plane.height(y)[None, :]
    values = np.linspace(energy.min(), np.quantile(energy, 0.93), levels + 1)[1:]
    for line in level_lines(y, W, energy, values):
        yield *line.T, style.MEANING["level"]
    for saddle in plane.repeated(plane.saddles, low, high):
        ys, Ws = plane.separatrix(saddle, low, high)
        yield from ((ys, sign * Ws, style.MEANING["separatrix"]) for sign in (1.0, -1.0))
    ys, Ws = motion_curve(plane, low, high)
    yield from ((ys, sign * Ws, style.MEANING["this motion"]) for sign in ways(plane, Ws))


def equilibria_of(plane: PhasePlane, low: float, high: float) -> list[tuple[str, np.ndarray]]:
    """(kind, places (n,)) of the centres and saddles between two places, as far as there are any."""
    result = (("centre", plane.repeated(plane.centres, low, high)),
             ("saddle", plane.repeated(plane.saddles, low, high)))
    return [(kind, np.array(places)) for kind, places in result if len(places)]


def highest(plane: PhasePlane, low: float, high: float) -> float:
    """The largest W worth drawing between two places: above this motion and all separatrices; about a motion
    that all but rests in a single well, a third of the way up its walls."""
    tops = [float(plane.height(s)) for s in plane.repeated(plane.saddles, low, high)]
    heights = plane.height(np.linspace(low, high, 700))
    lift, walls = max(plane.W0**2 / 2, *(tops or [0.0])) - float(np.min(heights)), float(np.ptp(heights))
    return float(np.sqrt(2 * (lift if lift > RESTING * walls else walls / 3)) * 1.12 + 1e-12)


def ways(plane: PhasePlane, W: np.ndarray) -> tuple[float, ...]:
    """Signs of the rate that a motion has: one where it goes right round without a torque and never turns."""
    return (float(np.sign(plane.W0)),) if plane.land.may_rotate and W.min() > 0 else (1, -1)


# --- The Poincaré section of a motion: where it passes a plane of the space of rates, again and again
DOT = {"marker": ".", "linestyle": "none", "markersize": 5}
THIS, OTHER = DOT | {"color": style.VIOLET, "markersize": 7}, DOT | {"color": style.SAGE}
STAYS = DOT | {"color": style.BLUE}
LEAVES = DOT | {"color": style.VERMILION, "marker": "x", "markersize": 3.5}
MIDDLE = style.MARKER["centre"]
PASSAGES, MOST = 300, 20_000
FAN, USUAL = 500, 6  # neighbours: at most, and where no number is asked for
NEIGHBOUR_PASSAGES = 150    # passages of each neighbour, if it does not leave
ROUND = 1000    # passages, at most, for the sake of going round
GONE = 3        # times the farthest of this motion's passages: a neighbour that far has left
# of the picture around its points; half its side at least, of the size of the rates
MARGIN, NEAR_SEPARATRIX = 0.08, 0.01


def section(case: Any, states: Any = None, ax: Axes | None = None, units: str | None = None,
            size: tuple[float, float] | None = None,
            legend: bool = True, neighbours: int | None = None, passages: int | None = None) -> Axes:
    """Draw the Poincaré section of a motion, and return the axes.

    case: a Case, or a scene with `states`: three rates, or (n, 3) of several motions, the first of which is
    this one. The plane is that on which one rate has its mean value over the motion, and grows; the axes are
    the two other rates, in deg/s (units="si": rad/s; scaled scenes have x). Each passage is a root of a
    Taylor series. A periodic motion is one point, one on a torus fills closed curves, one that leaves
    scatters. passages: how many of this motion (None: 300, or about an elliptic periodic motion as many as go
    round it); of one that spins up, those before that is certain. neighbours: how many motions beside it
    (None: six), from the middle to twice as far. Where it stays in an island about an elliptic periodic
    motion, that is marked. A motion that repeats, as all beside it do, passes at one place: drawn are so many
    closed orbits (None: ten) from the middle of its island out to the separatrix, as rings, seen along the
    axis about which they go (or over the turn about the axis of the torque, where some would lie on others).
    Raises InputError for a body with a liquid, in a medium or in a field, a motion at rest, and one that
    spins up before it has passed any plane often enough.
    """
    item, rest = _motions(case, states)
    subjects.check("section", item)
    _check("passages", PASSAGES if passages is None else passages, 1, MOST)
    if not len(rest) and repeats(item):
        return _rings(item, ax, units, size, legend, neighbours)
    with canvas.on(ax, size or canvas.SQUARE) as target:
        rows, lines = scattered(item, target, measures(item, units), neighbours, passages, rest)
        return canvas.explained(target, rows if legend else [], ax is None, item.heading, *lines,
                                notes=canvas.notes(item, measures(item, units), answered=False))


def scattered(item: Subject, ax: Axes, scale: Measures, neighbours: int | None = None,
              passages: int | None = None, others: Any = ()) -> tuple[list[Any], list[str]]:
    """Draw the section of a motion that does not repeat, or of several; the rows of its legend, and lines on
    the plane, the passages and what they go round. others: states beside its own; the rest as of `section`.
    """
    fan = next((n for n in (neighbours, item.neighbours) if n is not None), USUAL)
    _check("neighbours", fan, 0, FAN)
    until = subjects.certain_from(item)
    orbit, plane = plane_of(item, until)
    count, followed = passages or _round(PASSAGES, orbit), _round(NEIGHBOUR_PASSAGES, orbit)
    times, places = returns(item.twin, item.state, plane, count, until)
    sets = [(THIS, "this motion", places)]
    sets += [(OTHER, "the other states", result)
             for result in [_together([returns(item.twin, row, plane, count)[1] for row in others])]
             if len(result)]
    stay, leave = _fan(item.twin, orbit, plane, places, min(followed, len(places)), fan)
    sets += [(STAYS, "neighbours", stay)] * bool(len(stay))
    rows = _draw(ax, sets, leave, orbit, plane, scale)
    lines = [_plane_words(plane, scale), *_passed(item, times, places, until, scale, orbit)]
    return rows, [line for line in lines if line]


# of a motion that repeats: closed orbits
RING, RIM = style.MEANING["bounded"] | {"linewidth": 0.9}, style.MEANING["separatrix"]
ONE_DOT = ("the motion is periodic and goes round no equilibrium: it passes any plane at one place, and a "
           "section has nothing to show")


def _rings(item: Subject, ax: Any, units: str | None, size: tuple[float, float] | None, legend: bool,
           neighbours: int | None) -> Axes:
    """Of a motion that repeats, which passes a plane at one place, closed orbits from the middle of its
    island out to the separatrix."""
    asked = next((n for n in (neighbours, item.neighbours) if n is not None), rings.RINGS)
    _check("neighbours", asked, 0, FAN)
    scale = measures(item, units)
    result = rings.island(item, asked)
    if result is None:
        raise InputError(f"plot section: {ONE_DOT}; plot phase, sphere or time show it")
    per, labels = _coordinates(item, result, scale)
    with canvas.on(ax, size or canvas.SQUARE) as target:
        lines = [(line, RING, 2) for line in result.rings] + [(line, RIM, 3) for line in result.inner]
        lines += [] if result.rim is None else [(result.rim, RIM, 3)]
        for line, look, level in [*lines, (result.own, style.MEANING["this motion"], 4)]:
            target.plot(*(line * per).T, zorder=level, **look)
        for place in result.middles:
            target.plot(*(place[:, None] * per[:, None]), zorder=5, **MIDDLE)
        target.plot(*(result.own[:1] * per).T, zorder=6, **style.MARKER["start"])
        target.set_xlabel(labels[0])
        target.set_ylabel(labels[1])
        rows = [("this motion", style.MEANING["this motion"]), ("start", style.MARKER["start"]),
                *([(f"closed orbits {result.kept}", RING)] if result.rings else []),
                *([("separatrix", RIM)] if result.rim is not None or result.inner else []),
                ("centre (stable)", MIDDLE)]
        return canvas.explained(target, rows if legend else [], ax is None, item.heading,
                                f"periodic, {_time(float(item.motion.period), scale)}, as every bounded "
                                f"motion here", notes=canvas.notes(item, scale, answered=False))


def _coordinates(item: Subject, result: rings.Island,
                 scale: Measures) -> tuple[np.ndarray, tuple[str, str]]:
    """(how many of the units of a picture make one of its coordinates (2,), their labels)."""
    per = scale.rate[1]
    if result.axis is not None:
        first, second = (with_unit(scale.names[n], scale.rate[0]) for n in range(3) if n != result.axis)
        return np.array([per, per]), (first, second)
    n = result.about
    if result.kept == rings.SPHERE:
        angle = f"angle of H from the centre, {{}} {item.axes.short(n + 1)}"
        return np.full(2, scale.angle[1]), (with_unit(angle.format("across"), scale.angle[0]),
                                            with_unit(angle.format("towards"), scale.angle[0]))
    turn = with_unit(rf"turn $\alpha_{n + 1}$ about {item.axes.short(n + 1)} from the start", scale.angle[0])
    return np.array([scale.angle[1], per]), (turn, with_unit(scale.names[n], scale.rate[0]))


def _motions(case: Any, states: Any) -> tuple[Subject, np.ndarray]:
    """The subject of the first motion, and the states (n, 3) of the others."""
    if states is None or isinstance(states, dict):
        return subject(case, states), np.empty((0, 3))
    rows = checked_states(states).reshape(-1, 3)
    if not len(rows):
        raise InputError("states: expected three rates, or an array (n, 3) of at least one state, got none")
    return subject(case, rows[0].tolist()), rows[1:]


def _check(name: str, value: Any, smallest: int, upper: int) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not smallest <= value <= upper:
        raise InputError(f"{name}: expected a whole number from {smallest} to {upper}, got {value!r:.40}")


def repeats(item: Subject) -> bool:
    """Whether a motion is periodic, and every other one beside it."""
    return item.motion.period is not None and _all_repeat(item)


def _all_repeat(item: Subject) -> bool:
    """Whether every bounded motion off a separatrix is periodic: one degree of freedom, or no torque."""
    return reduce(item.twin) is not None or subjects.free(item)


def plane_of(item: Subject, until: float) -> tuple[Periodic | None, Section]:
    """The periodic motion in the middle, where there is one, and the plane that the motion passes."""
    # where an integral of motion is known periodic motions are never isolated
    island = item.motion.fate == Fate.UNDECIDED and not _all_repeat(item)
    orbit = in_the_middle(item.twin, item.state) if island else None
    if orbit is not None and len(returns(item.twin, item.state, orbit.section, LEAST)[0]) == LEAST:
        return orbit, orbit.section
    plane = crossed(item.twin, item.state, until)
    if plane is None:
        raise InputError("plot section: the motion passes no plane often enough")
    return None, plane


def _together(sets: list[np.ndarray]) -> np.ndarray:
    """(n, 3) of several sets of places, none of them included."""
    return np.concatenate([np.empty((0, 3)), *sets])


def _round(count: int, orbit: Periodic | None) -> int:
    """So many passages, and more where they go round an elliptic periodic motion slowly (away from it up to
    twice as slowly), ROUND at most."""
    return count if orbit is None else max(count, min(ROUND, math.ceil(2 * 2 * math.pi / orbit.angle)))


def _fan(scene: Any, orbit: Periodic | None, plane: Section, places: np.ndarray, count: int,
         number_of: int) -> tuple[np.ndarray, np.ndarray]:
    """Passages (n, 3) of the neighbours that stay as long as they are followed, and of those that leave, or
    pass no more within the steps of a search."""
    retained: dict[bool, list[np.ndarray]] = {True: [], False: []}
    if number_of:
        middle = np.array(orbit.state) if orbit is not None else places.mean(axis=0)
        reach = GONE * float(np.linalg.norm(places, axis=1).max())
        for start in neighbours_of(middle, places[0], plane, number_of):
            _, result = returns(scene, start, plane, count, reach=reach)
            retained[len(result) == count].append(np.vstack([start, result]))
    return _together(retained[True]), _together(retained[False])


def _draw(ax: Any, sets: list, leave: np.ndarray, orbit: Periodic | None, plane: Section,
          scale: Measures) -> list:
    """Draw the sets of passages, the nearer ones above; the rows of the legend."""
    j, k = plane.across
    per_rate, rows = scale.rate[1], []
    if len(leave):
        ax.plot(leave[:, j] * per_rate, leave[:, k] * per_rate, zorder=2, **LEAVES)
    for level, (look, name, places) in enumerate(sets):
        if one_place(places):
            look = look | {"markersize": 22}  # a halo, where the periodic motion in the middle is this one
        ax.plot(places[:, j] * per_rate, places[:, k] * per_rate, zorder=5 - level, **look)
        rows.append((name, look | {"markersize": max(9, look["markersize"])}))
    if len(leave):
        rows.append(("neighbours that leave, or pass no more", LEAVES | {"markersize": 6}))
    if orbit is not None:
        ax.plot([orbit.state[j] * per_rate], [orbit.state[k] * per_rate], zorder=6, **MIDDLE)
        rows.append(("periodic motion in the middle (elliptic)", MIDDLE))
    every = np.concatenate([places for _, _, places in sets]
                           + ([np.array([orbit.state])] if orbit is not None else []))
    smallest = NEAR_SEPARATRIX * float(np.abs(every).max())
    for axis, setter, labels in ((j, ax.set_xlim, ax.set_xlabel), (k, ax.set_ylim, ax.set_ylabel)):
        low, high = float(every[:, axis].min()), float(every[:, axis].max())
        half = max((high - low) * (0.5 + MARGIN), smallest)
        setter((low + high) / 2 * per_rate - half * per_rate, (low + high) / 2 * per_rate + half * per_rate)
        labels(with_unit(scale.names[axis], scale.rate[0]))
    return rows


def _plane_words(plane: Section, scale: Measures) -> str:
    unit, per_rate = scale.rate
    return (f"where {scale.plain(plane.axis)} = {number(plane.level * per_rate)} {unit}".rstrip()
            + " and grows")


def _passed(item: Subject, times: np.ndarray, places: np.ndarray, until: float, scale: Measures,
            orbit: Periodic | None) -> list[str]:
    """Lines on the passages, and on what they go round."""
    turn = ("" if orbit is None
            else f"neighbours turn about it by {number(math.degrees(orbit.angle))} deg a passage")
    if len(places) > 1 and one_place(places):
        return [
            f"all {len(places)} passages at one place: periodic, {_time(float(times[1] - times[0]), scale)}",
            turn or "a dot for each motion: every bounded one here is periodic" * _all_repeat(item)]
    passed = f"{len(places)} passages in {_time(float(times[-1]), scale)}"
    if math.isfinite(until):
        passed += f", until spin-up about {item.axes.short(item.motion.axis)} is certain"
    return [passed, "" if orbit is None else f"in the middle: period {_time(orbit.period, scale)}, {turn}"]


def _time(value: float, scale: Measures) -> str:
    unit, per = scale.time(value)
    return f"{number(value * per)} {unit if scale.size else 'τ'}"


POINTS = 1200
ROOM = 0.6     # of the canonical angle, beyond a barrier that would stand outside
CLOSE = 1e-6   # relative: by this a barrier is known by its margin
# of the picture: words at a barrier farther right stand left of it; those of a shorter arrow above it
BESIDE, SHORTEST = 0.65, 0.12
ENERGY = style.MEANING["this motion"] | {"linestyle": "--", "linewidth": 1.2}


def potential(case: Scene, state: Sequence[float] | None = None, ax: Axes | None = None,
              units: str | None = None, size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Draw the reduced potential of a motion, and return the axes.

    case: a Case, or a scene with `state`. Across: the turn about the axis of the torque since the start; up:
    the potential less its value at the start, J (scaled: that of the reduced equation). Dashed: the energy
    of the motion; thick, where the motion is. Minima of the potential are centres, maxima saddles; an arrow
    leads from the energy to the barrier ahead, whose height above it is the margin of `fate`. Raises
    InputError where the motion does not reduce.
    """
    item = subject(case, state)
    subjects.check("potential", item)
    scale, plane = measures(item, units), phase_plane(item.twin, item.state)
    across, up = plane.unit * scale.angle[1], float(plane.reduction.energy_unit)
    low, high = window(plane)
    margin, energy = item.motion.margin_energy, plane.W0**2 / 2
    barrier = _barrier(plane, margin, up, (low, high))
    if barrier is not None:  # it may stand a turn ahead
        low, high = min(low, barrier - ROOM), max(high, barrier + ROOM)
    y = np.linspace(low, high, POINTS)
    with canvas.on(ax, size) as target:
        rows: list[tuple[str, dict[str, Any]]] = [("reduced potential", style.MEANING["separatrix"]),
                                                  ("energy of this motion", ENERGY)]
        target.plot(across * y, up * plane.height(y), **style.MEANING["separatrix"])
        target.axhline(up * energy, **ENERGY)
        ys, _ = motion_curve(plane, low, high)
        target.plot(across * ys[[0, -1]], [up * energy] * 2, **style.MEANING["this motion"])
        target.plot([0], [up * energy], zorder=5, **style.MARKER["start"])
        rows += [("where it is", style.MEANING["this motion"]), ("start", style.MARKER["start"])]
        for kind, name, places in (("centre", "well: centre (stable)", plane.centres),
                                   ("saddle", "barrier: saddle (unstable)", plane.saddles)):
            shown = np.array(plane.repeated(places, low, high))
            if len(shown):
                target.plot(across * shown, up * plane.height(shown), zorder=5, **style.MARKER[kind])
                rows.append((name, style.MARKER[kind]))
        if barrier is not None:
            _margin(target, margin, across * barrier, up * energy, " J" * bool(scale.size),
                    (barrier - low) / (high - low) > BESIDE)
        target.set_xlim(*sorted((across * low, across * high)))
        i = plane.reduction.axis + 1
        target.set_xlabel(with_unit(rf"turn $\alpha_{i}$ about {item.axes.short(i)} from the start",
                                    scale.angle[0]))
        target.set_ylabel(with_unit("energy", "J" if scale.size else ""))
        return canvas.explained(target, rows if legend else [], ax is None,
                                item.heading, canvas.answer(item, scale), notes=canvas.notes(item, scale))


def _barrier(plane: PhasePlane, margin: float | None, up: float, span: tuple[float, float]) -> float | None:
    """Where the barrier stands that a margin in energy is of, up to a turn outside of the span; None where
    there is none, or where the margin is of other motions (of a free body: with the same |H|)."""
    turn = plane.land.turn if np.isfinite(plane.land.turn) else 0.0
    above = {y: up * (float(plane.height(y)) - plane.W0**2 / 2)
             for y in plane.repeated(plane.saddles, span[0] - turn, span[1] + turn)} if margin else {}
    return min((y for y in above if abs(above[y] - margin) <= CLOSE * abs(margin)), key=abs, default=None)


def _margin(ax: Axes, margin: float, location: float, energy: float, unit: str, leftward: bool) -> None:
    """An arrow from the energy to the barrier; its words beside it, or above both where it is short."""
    ax.annotate("", (location, energy + margin), (location, energy),
                arrowprops={"arrowstyle": "<->", "color": style.BLACK, "linewidth": 1.4})
    size = number(abs(margin), SHORT) + unit
    low, high = ax.get_ylim()
    short = abs(margin) < SHORTEST * (high - low)
    if short:
        ax.margins(y=SHORTEST)
    ax.annotate(f"margin in energy {size}" if margin > 0 else f"{size} above the barrier",
                (location, energy + max(margin, 0.0) if short else energy + margin / 2),
                (-6 if leftward else 6, 12 * short), textcoords="offset points",
                va="bottom" if short else "center", ha="right" if leftward else "left", color=style.BLACK,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8})
