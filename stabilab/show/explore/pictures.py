"""What the explorer draws: the plane of the reduced motion and the rates over time, as bytes for a page.

    4 bytes: length of the header, little-endian | header, JSON | zeros up to a multiple of 4 | numbers

In the header a row of numbers is {"type": "int16" or "float32", "from": byte in the numbers, "count": how
many}. `orbit.phase_plane` has the same plane in arrays, to the last digit; the one here, in plain floats,
serves a slider that moves, and a browser without NumPy.

The motion is drawn in plain floats where these are sure of it, else in as many digits as needed once the
slider rests: on an unstable plane, and on the separatrix itself, whatever a step in floats leaves out grows
until the line is another motion's. A body on which more acts than wheels and a torque has no separatrix and
no phase plane, and the page says why.

A liquid, a medium, weight and a field take away the law from which both come; a charge that only adds to the
wheel has the rates of a gyrostat, and is no such body."""
from __future__ import annotations

import json
import math
import struct
from array import array
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ...answers.equilibria import equilibria
from ...case.read import Case
from ...equilibrium.result import Equilibria
from ...errors import InputError, StabilabError
from ...integrate.quadratic_series import Path, followed, parting
from ...orbit.potential import Circle, potential
from ...orbit.reduction import Reduction, reduce
from ...orbit.result import Motion
from ...packages import demand, present
from ...physics.coefficients import content
from ...physics.effects.base import effect_words
from ...physics.scene import AnyScene, QuadraticForm
from ...reasons import broad
from ...verify.numbers import shown
from ..assumed import Assumed
from ..data import plain
from ..space.drawing import packed
from ..space.span import limit_time
from ..turns.band import Long
from ..units import Units, with_unit

TYPES = {"int16": "h", "float32": "f"}


class Bag:
    """Rows of numbers, one behind the other."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._length = 0

    def add(self, kind: str, values: Iterable[float] | bytes) -> dict[str, Any]:
        """Keep a row; what the header says of it. values: numbers, or bytes of them, little-endian."""
        raw = values if isinstance(values, bytes) else packed(TYPES[kind], values)
        row = {"type": kind, "from": self._length, "count": len(raw) // array(TYPES[kind]).itemsize}
        padded = raw + b"\0" * (-len(raw) % 4)
        self._parts.append(padded)
        self._length += len(padded)
        return row

    def framed(self, header: dict[str, Any]) -> bytes:
        """Header and numbers as the page reads them. Numbers that are not finite become null."""
        text = json.dumps(plain(header), ensure_ascii=False, separators=(",", ":"), allow_nan=False).encode()
        return b"".join([struct.pack("<I", len(text)), text, b"\0" * (-(4 + len(text)) % 4), *self._parts])


def unframed(message: bytes) -> tuple[dict[str, Any], bytes]:
    """(header, numbers) of `Bag.framed`."""
    (length,) = struct.unpack_from("<I", message)
    return json.loads(message[4:4 + length]), message[4 + length + (-(4 + length) % 4):]


POTENTIAL_POINTS = 361  # of the potential across the picture
CIRCLE = 1.35 * math.pi  # half of what is shown of a circle
# of walls: heights above and below the motion's that are worth drawing, and how far to look for them
LIFT, CELLAR, FARTHEST = 2.5, 6.0, 12.0
HALVINGS = 48
NEAREST, GROWTH = 1e-4, 1.1  # of the steps outward


@dataclass(frozen=True)
class Plane:
    """turn: of the body about the axis of the torque since the start (rad, or scaled), at `low` to `high` of
    the canonical angle in even steps; heights: V there, 0 at the start; W0: the canonical rate at the start.
    unit: turn per canonical angle."""

    reduction: Reduction
    potential: Any
    place: tuple[float, float]
    W0: float
    unit: float
    y: list[float]
    heights: list[float]
    rests: list[tuple[float, float, bool]]  # canonical angle, V, whether it is a saddle

    def rate(self, W: float) -> float:
        """omega_i of canonical W."""
        if not self.reduction.geometry.centred:
            return W - float(self.reduction.s)
        return float(self.reduction.component_i(W))

    def state(self, turn: float, rate: float) -> tuple[float, ...]:
        """The three rates of a point of the plane."""
        r, out = self.reduction, [0.0] * 3
        location = self.potential.move(self.place, turn / self.unit)
        if r.geometry.centred:
            x, z = self.potential.xz(location)
            location = r.component_j(x), r.component_k(z)
        out[r.j], out[r.k] = location
        out[r.axis] = rate
        return tuple(map(float, out))


def plane_of(scene: AnyScene, state: tuple[float, ...]) -> Plane | None:
    """The plane of the motion from a state; None where the scene does not reduce."""
    r = reduce(scene)
    if r is None:
        return None
    pot, index, W0, unit = potential(r), *_start(r, state)
    force = pot.force(index)
    height = lambda y: pot.rise(float(y), index, force)
    if r.geometry.walled:
        low, high = _walls(pot, index, height, W0)
    else:  # of a circle: about the middle of the equilibria within half a turn
        angles = [-math.pi + 2 * math.pi * n / POTENTIAL_POINTS for n in range(POTENTIAL_POINTS + 1)]
        near = list(_rests(pot, index, angles))
        middle = sum(near) / len(near) if near else 0.0
        low, high = middle - CIRCLE, middle + CIRCLE
    y = [low + (high - low) * n / (POTENTIAL_POINTS - 1) for n in range(POTENTIAL_POINTS)]
    rests = [(at, height(at), pot.slope(pot.move(index, at)) > 0) for at in _rests(pot, index, y)]
    return Plane(r, pot, index, W0, unit, y, [height(v) for v in y], rests)


def _start(r: Reduction, state: tuple[float, ...]) -> tuple[tuple[float, float], float, float]:
    """(place, W, turn per canonical angle)."""
    if not r.geometry.centred:
        return (float(state[r.j]), float(state[r.k])), float(state[r.axis]) + float(r.s), 1.0
    x, z, w = r.canonical_exact(state)
    first, second = r.geometry.place(x, z)
    return (float(first), float(second)), float(w), r.constants["flip"] / r.constants["n"]


def _rests(pot: Circle, location: Sequence[float], y: Sequence[float]):
    """Where the force vanishes, between places of opposite signs; nothing where it does everywhere."""
    force = lambda v: pot.force(pot.move(location, v))
    values = [force(v) for v in y]
    for n in range(len(y) - 1 if any(values) else 0):
        if values[n] * values[n + 1] < 0 or values[n] == 0:
            low, high, below = y[n], y[n + 1], values[n] < 0
            for _ in range(HALVINGS if values[n] else 0):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if (force(middle) < 0) == below else (low, middle)
            yield low


def _walls(pot, location, height, W0):
    """How far on each side the potential of a hyperbola or parabola is worth drawing."""
    out = [NEAREST * GROWTH**n for n in range(math.ceil(math.log(FARTHEST / NEAREST, GROWTH)) + 1)]
    marks = [0.0, *_rests(pot, location, [*(-y for y in reversed(out)), 0.0, *out])]
    heights = [height(y) for y in marks]
    smallest = min(heights)
    lift = max(W0 * W0 / 2 - smallest, max(heights) - smallest) or 1.0
    return tuple(_side(height, edge, sense, smallest + LIFT * lift, smallest - CELLAR * lift) for edge,
                 sense in ((min(marks), -1), (max(marks), 1)))


def _side(height, edge, sense, ceiling, cellar):
    step = NEAREST
    while step < FARTHEST and cellar < height(edge + sense * step) < ceiling:
        step *= GROWTH
    return edge + sense * step


# --- The two flat pictures of a page: the phase plane, and the rates over time
CLICK_DIGITS = 9  # of a start that was clicked


def drawn_planes(bag: Bag, scene: AnyScene, state: tuple[float, ...], units: Units) -> dict[str, Any] | None:
    """The phase plane, whose level curves W^2/2 + V = E the page draws itself; None where there is none."""
    plane = plane_of(scene, state)
    if plane is None:
        return None
    angle, rate = (("", 1.0), ("", 1.0)) if units.scaled else (units.angles, units.rates)
    across = plane.unit * angle[1]
    zero = plane.rate(0.0) * rate[1]
    axis = plane.reduction.axis + 1
    name = "x" if units.scaled else "ω"
    rests = [{"at": across * y, "height": v, "saddle": saddle} for y, v, saddle in plane.rests]
    return {"turns": bag.add("float32", [across * y for y in plane.y]),
            "heights": bag.add("float32", plane.heights),
            "rate": [zero, plane.rate(1.0) * rate[1] - zero], "start": plane.W0, "energy": plane.W0**2 / 2,
            "rests": rests,
            "rotates": plane.reduction.sense == 0 and not plane.reduction.geometry.walled,
            "x": with_unit(f"turn about {units.axes.short(axis)}", angle[0]),
            "y": with_unit(f"{name}{axis}", rate[0])}


def clicked(scene: AnyScene, state: tuple[float, ...], at: Any, units: Units) -> list[str]:
    """The start, in the sliders' unit, of the motion through a point {turn, rate} of the phase plane."""
    plane = plane_of(scene, state)
    try:
        turn, rate = float(at["turn"]), float(at["rate"])
    except (KeyError, OverflowError, TypeError, ValueError):
        raise InputError(f"click: expected a turn and a rate, got {shown(at)}") from None
    if plane is None or not (math.isfinite(turn) and math.isfinite(rate)):
        raise InputError("click: this motion has no phase plane")
    angle = 1.0 if units.scaled else units.angles[1]
    item = units.rates[1]
    return [f"{v * item + 0.0:.{CLICK_DIGITS}g}" for v in plane.state(turn / angle, rate / item)]


def over_time(bag: Bag, case: Case, motion: Motion | None, times: list[float], path: list[tuple[float, ...]],
              units: Units, supposed: Assumed | None = None) -> dict[str, Any]:
    """Rates and their size over time, with known extremes over all time and the limits of the case; where it
    states none, and the motion comes so far, the one supposed."""
    name, item = units.times(times[-1])
    label, rate = units.rates
    symbol = "x" if units.scaled else "ω"
    extremes = period = reached = None
    if motion is not None:
        if motion.extremes is not None and motion.for_all_time:
            extremes = [[v * rate for v in pair] for pair in motion.extremes]
        period = None if motion.period is None else motion.period * item
        if (at := limit_time(motion)) is not None:
            low: Any = motion.first and float(motion.first[1].low)
            reached = [low * item, at * item] if broad(low, at) else at * item
    passed = supposed is not None and max(math.hypot(*x) for x in path) >= supposed.rate
    if supposed is not None and supposed.time is not None:
        reached = supposed.time * item
    return {"times": bag.add("float32", [t * item for t in times]),
            "rates": [bag.add("float32", [x[n] * rate for x in path]) for n in range(3)],
            "extremes": extremes, "period": period, "reached": reached,
            "x": "time τ" if units.scaled else with_unit("time", name),
            "y": with_unit("x" if units.scaled else "rate", label),
            "names": [*(f"{symbol}{n}" for n in (1, 2, 3)), f"|{symbol}|"],
            "size": bag.add("float32", [math.hypot(*x) * rate for x in path]),
            "assumed": passed, "limits": [float(v) * rate for v in (
                [supposed.rate] if supposed and passed else _limits(case))]}


def _limits(case: Case) -> list[Any]:
    """The limits of a case as lines: of |omega|, or of the components along principal axes."""
    if case.limits is None:
        return []
    if case.limits.rate is not None:
        return [case.limits.rate]
    as_given = case.frame is None or case.frame.as_given
    return sorted({sign * v for v in case.limits.rates for sign in (1, -1)}) if as_given else []


# --- The motion as a page draws it
ORBIT_POINTS, MOST = 1200, 6000  # of a motion that is drawn: at least, at most
FRAMES = 400  # of the body that turns
CLOSE = 0.25  # rad of turn from one to the next, where so many are enough
NOT_YET = {"reason": "Keep still, and the equilibria are looked for.", "rows": []}


def needed(scene: AnyScene) -> bool:
    """Whether no scene of wheels and a torque alone has the same rates."""
    return not scene.plain and ((parts := content(scene)) is None or parts.kind != "gyrostat")


def check(case: Case) -> None:
    """Raise InputError where a page cannot show a case: its sliders count along principal axes, and so must
    the effects of its file, unless they are alike along all axes."""
    if not needed(case.scene):
        return
    demand("numpy", "scipy")
    scene, turned = case.scene, case.frame
    if turned is None or turned.as_given:
        return
    # the same along all axes, as an isotropic damper is
    similar = scene.blocks == ("omega",) and all(effect.turned(turned) is effect for effect in scene.beyond)
    if not similar:
        names = " and ".join(effect_words(effect.name) for effect in scene.beyond)
        raise InputError(f"{case.place}: explore turns wheels and torque into the principal axes, but not "
                         f"{names}: state the case along its principal axes (stabilab show tells them), or "
                         f"ask stabilab classify or report")


def why(scene: AnyScene) -> str:
    """What the page does not show, and why."""
    taking = [effect.agent for effect in scene.effects if effect.takes]
    turning = [effect.agent for effect in scene.effects if "gamma" in effect.needs and not effect.takes]
    motors = ["the motor"] * ("wheel" in scene.blocks)
    parts = ((taking, "take", "energy away"), (turning, "act", "by the attitude"),
             (motors, "change", "the momentum of its wheel"))
    reasons = [f"{' and '.join(some)} {word}{'s' * (len(some) == 1)} {how}"
               for some, word, how in parts if some]
    return (
        f"No separatrix and no phase plane: {' and '.join(reasons)}, so no law keeps the rates on a curve "
        f"that is known; what is drawn is the motion itself")


def _plots() -> Any:
    """The modules of plots that follow a motion, which load NumPy."""
    from ..plot import long, turning
    return long, turning


def path(case: Case, until: float) -> Path:
    """(times, rates) of the motion up to a time, or as far as a run goes."""
    import numpy as np

    long, turning = _plots()
    turn = until * math.hypot(*case.state)
    number = min(MOST, max(ORBIT_POINTS, math.ceil(turn / CLOSE)))
    t, rates = long.along(turning.subject(case), np.linspace(0.0, until, number))
    return t.tolist(), [(x, y, z) for x, y, z in rates.tolist()]


def turns_of(case: Case, motion: Motion, until: float, units: Units) -> tuple[Long, list[Any]] | None:
    """(what is drawn of a motion of many turns up to a time, the places from which that is made); None of one
    of few."""
    long, turning = _plots()
    resolved: tuple[Long, list[Any]] | None = long.until(replace(turning.subject(case), known=motion), until,
                                                      units.times)
    return resolved


def film(case: Case, motion: Motion | None, until: float, bag: Bag, units: Units,
         limit: Assumed | None = None) -> dict[str, Any]:
    """The body as it turns in that time, as `templates/turning.js` draws it. motion: what is known of it;
    limit: as of `turning.turn`."""
    _, turning = _plots()
    item = replace(turning.subject(case, span=until), known=motion)
    result = turning.turn(item, FRAMES, limit)
    drawn = turning.drawn(item, result, units.times(until), units.rates, units,
                          lambda rows: bag.add("float32", rows.ravel().tolist()))
    return drawn | {"names": [units.axes.label(n) for n in (1, 2, 3)],
                    "words": f"Arrows: {result.words}. {result.part(units)}"}


def at_rest(scene: AnyScene) -> Equilibria | None:
    """The equilibria; None where they are not known."""
    try:
        return equilibria(scene)
    except StabilabError:
        return None


def line(case: Case, form: QuadraticForm | None, until: float, moving: bool) -> Path:
    """(times, rates) of the motion from t = 0 on. form: its rates, where they are quadratic. moving: a slider
    that does not wait is shown the part of which floats are sure; so is a page without NumPy."""
    if form is None:
        return path(case, until)
    times, states = followed(form, case.state, until)
    resolved = parting(form, (times, states))
    if (resolved < len(times) or times[-1] < until) and not moving and present("numpy"):
        return path(case, until)
    return times[:resolved], states[:resolved]
