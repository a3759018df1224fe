"""What internal dissipation makes of a spin: when a body tumbles from its minor axis, and about which
direction of the major axis it ends.

The body is free but for what takes energy from it. It is exact at its start, and followed from one level of
its energy to the next.

A damper or a liquid keeps the angular momentum H and takes kinetic energy T. With D1 > D2 > D3 the principal
moments of the whole,

    |H|^2/(2 D1) <= H . D^-1 H/2 <= T,

since T is least, at given H, where nothing turns relative to the body. So once 2 T D2 < |H|^2 (past the
separatrix) H . D^-1 H < |H|^2/D2 for ever: H stays in the cone about +axis 1 or in that about -axis 1, and as
T falls at every motion but the permanent rotations it tends to that axis (LaSalle). T crosses any level once:
each of the times below is the one root of a monotone function. The polhode of the same T and |H| goes from
an axis at most by the angle theta,

    sin^2 theta = (2T/|H|^2 - 1/D1)/(1/D2 - 1/D1)  from the major axis,
                  (1/D3 - 2T/|H|^2)/(1/D3 - 1/D2)  from the minor axis: the nutation angle of an energy sink.

Which cone it is depends on the phase: while H circles the minor axis its component along axis 1 changes sign
every half turn, and the separatrix is crossed within one of them. Turned by pi about the minor axis a motion
ends in the other direction (the equations are symmetric), so that the two directions share the phases in
equal parts; in the nutation angle, or in the strength of the damper, the bands shrink with the damping."""
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from operator import getitem
from typing import Any

import numpy as np

from ...case.given import Amount, Given, Start, as_case, with_start
from ...case.given import Span as Times
from ...case.read import Case, with_data
from ...case.source import parsed
from ...errors import Caveat, InputError, Kind, without
from ...numbers.units import ANGLE, MOMENTUM, in_si
from ...numbers.vectors import Float3, cross, dot
from ...physics.coefficients import content
from ...physics.states import moved_row
from ...reasons import Angle, Axis, Quantity, Reason, Reasoned, Sentence
from ...representation import Answer, Compared
from ..caveats import caveats_of
from ..passage import MOVED, WIDER
from . import gyrostat, mass
from .changes import Span, spans_of
from .gyrostat import GyrostatSpin
from .rotations import Rotations, free_only, rotations_at
from .spinner import ENDED, Run, Spinner, after_the_separatrix
from .times import Time

# --- Why
NOT_KNOWN = Sentence("end-not-known", "how it ends is not known")()
PAST = Sentence("past-the-separatrix",
                "2 T D2 < |H|² at the start: the separatrix is crossed already, with the angular momentum on "
                "the {side} side of {axis}, where it stays and tends to that axis")
LEAST_ENERGY = Sentence("rotation-of-least-energy",
                        "the start is a permanent rotation about the greatest moment, the one with the least "
                        "energy")()
UNSTABLE_ROTATION = Sentence(
    "unstable-rotation", "the start is exactly the rotation about the {which} axis, an equilibrium that is "
    "unstable: either direction of the major axis follows from a disturbance, however small; give a start "
    "with a nutation angle")
BY_PHASE = Sentence(
    "ends-by-phase", "two greatest moments are equal: the energy falls to that of rotation about an axis in "
    "their plane, and which one hangs on the phase alone: the start turned about the minor axis by an angle "
    "ends at an axis turned by that angle")()
BY_START = Sentence(
    "ends-by-start", "two greatest moments are equal: the energy falls to that of rotation about an axis in "
    "their plane, and which one hangs on the start")()
PLANE_NOT_REACHED = Sentence("plane-not-reached",
                             "two greatest moments are equal, and the angular momentum is not within "
                             "{within} of their plane by the end of the run: {why}")
NOT_CROSSED = Sentence("separatrix-not-crossed",
                       "the separatrix is not crossed by the end of the run: {why}")
BETWEEN_DIRECTIONS = Sentence(
    "between-directions", "the start is within rounding of the boundary between the two directions: a run "
    "and a second one, from a start moved by {moved} in its last place with tolerance {tolerance}, end at "
    "opposite directions of the major axis")
CROSSES = Sentence(
    "crosses-the-separatrix", "2 T D2 falls below |H|² with the angular momentum on the {side} side of "
    "{axis}; from then on it cannot cross, and tends to that axis; a second run, from a start moved by "
    "{moved} in its last place with tolerance {tolerance}, agrees")
ENDS_DRAWN = Sentence("ends-drawn", "of {drawn} motions drawn from their box {positive} end about the "
                      "positive and {negative} about the negative side of {axis}")
OPEN_OVER_BOX = Sentence("end-open-over-box", "the uncertain numbers leave it open: {found}")
SAME_OVER_BOX = Sentence("end-over-box-by-samples", "uncertain numbers: {found}; samples, no proof")

# --- The answer
POSITIVE, NEGATIVE = "positive major axis", "negative major axis"
ACROSS, UNDECIDED = "across the minor axis", "undecided"


@dataclass(frozen=True, eq=False, repr=False)
class FlatSpin(Answer, Compared, Reasoned):
    """What internal dissipation makes of a spin.

    outcome: "positive major axis", "negative major axis", "across the minor axis" (two greatest moments are
    equal: about some axis in their plane) or "undecided"; reason: how it is known, or why it is not;
    level: "exact", "run" (a run and a second one agree) or "undecided". axis: of the greatest moment, 1 to 3,
    and minor: of the least; momentum: |H|, N m s; final_rate: |H|/(greatest moment), rad/s; rates: rad/s,
    along the principal axes, at the end, None where it is undecided or across. energy, final_energy: J, now
    and at the end.

    The nutation angle is that of the polhode: the largest angle between the angular momentum and an axis in
    the free motion of the same T and |H|. leaves: when it exceeds `within`, rad, from the minor axis;
    crosses: when the separatrix is crossed, 2 T D2 = |H|^2, D2 the intermediate moment; settles: when it is
    at most `within` from the major axis, which it then stays. Each None where it is past at the start, or not
    reached. Where the start turns about the major axis (two greatest moments equal: across the minor one)
    and its nutation dies out: nutation, rad, then, and tenth: when it is a tenth of that, which it then
    stays; else None. growth, decay: s, time constants of the nutation near the minor and the major axis, by
    eigenvalues, None where there are none. spans: by how much the start may change. steps: of the first run.
    """

    outcome: str
    level: str
    axis: int
    minor: int
    momentum: float
    final_rate: float
    rates: Float3 | None
    energy: float
    final_energy: float
    within: float
    leaves: Time | None = None
    crosses: Time | None = None
    settles: Time | None = None
    nutation: float | None = None
    tenth: Time | None = None
    growth: float | None = None
    decay: float | None = None
    spans: tuple[Span, ...] = ()
    steps: int = 0

    @property
    def lost(self) -> float:
        """The energy that is lost in all, J."""
        return self.energy - self.final_energy

    @property
    def passage(self) -> float | None:
        """From leaving the minor axis to settling at the major one, s."""
        return None if self.leaves is None or self.settles is None else self.settles.at - self.leaves.at


# --- The question
LEAST = math.radians(0.01)  # of `within`: below, the energy in doubles does not tell the angle any more
DRAWN = 32  # motions from the box of uncertain numbers
SECOND_RTOL = 1e-13  # tolerance of the second run
RUN_STEPS = 5_000_000  # of a run: some ten seconds
SPAN_STEPS = 6_000_000  # of all runs that look for changes of the outcome by one number


def flat_spin(case: Given, within: Amount = "5 deg", *, momentum: Amount | None = None,
              state: Start | None = None, span: Times | None = None) -> FlatSpin | GyrostatSpin | Rotations:
    """What becomes of a free body with a damper or a liquid: the direction of the major axis about which it
    ends, when it tumbles, and by how much its start decides that; with wheels, the rotation in which it ends,
    among all rotations at its angular momentum.

    case: in any form, or a scene with `state`, with a viscous damper or a liquid cavity, wheels or none, and
    nothing else that acts, and a start. within: the nutation angle, rad or text with a unit, from which the
    tumble is counted and to which it settles; with wheels the angle of H to where it ends. momentum: |H|, N m
    s or text with a unit: all rotations at that, of a body with or without losses and wheels, whatever its
    start. Raises InputError for other scenes, a body without wheels at rest or with equal moments, and an
    angle that is none.
    """
    angle = float(in_si(within, ANGLE, "within"))
    if not LEAST <= angle < math.pi / 2:
        raise InputError('within: expected an angle from 0.01 deg to below 90 deg, such as "5 deg", got '
                         f"{math.degrees(angle):.6g} deg")
    if momentum is not None:
        return at_momentum(as_case(case, state, span), in_si(momentum, MOMENTUM, "momentum"))
    return any_of_case(with_start(as_case(case, state, span), "flat_spin"), angle)


def at_momentum(case: Case, size: Fraction) -> Rotations:
    """All rotations of a case at |H| = size, N m s, those that displace a damper's mass among them."""
    if size > 0:
        free_only(case)
        if (result := mass.rotations_with_mass(case, size)) is not None:
            return result
    return rotations_at(case, size)


def any_of_case(case: Case, angle: float) -> FlatSpin | GyrostatSpin:
    """The same of a case and an angle in rad, with wheels or without."""
    scene: Any = case.scene
    if (result := mass.of_case(case, angle)) is not None:
        return result
    wheels = case.variables == "physical" and any(scene.vector("gyrostat"))
    return gyrostat.of_case(case, angle) if wheels else of_case(case, angle)


def of_case(case: Case, angle: float, spans: bool = True) -> FlatSpin:
    """The same of a case without wheels; spans: also look for changes of the outcome."""
    out = _answered(Spinner.of(case), angle, spans)
    own = without(case.caveats, Kind.UNCERTAIN)
    out = replace(out, caveats=(*own, *out.caveats))
    return _over_the_box(case, out) if case.uncertain and out.outcome in (POSITIVE, NEGATIVE) else out


def _over_the_box(case: Case, result: FlatSpin) -> FlatSpin:
    """With what uncertain numbers do: undecided where motions drawn from their box end in both directions."""
    draws, ends = np.random.default_rng(1), {POSITIVE: 0, NEGATIVE: 0}
    drawn = max(4, min(DRAWN, SPAN_STEPS // max(1, result.steps)))
    for _ in range(drawn):
        data = parsed(case.path, case.text)[0]
        for item in case.uncertain:
            *tables, last = item.path
            fraction = Fraction(draws.uniform(-1, 1))
            reduce(getitem, tables, data)[last] = str(item.middle + item.half * fraction)
        spinner = Spinner.of(with_data(case.path, case.text, data))
        side = (spinner.momentum[result.axis - 1] if result.crosses is None
                else after_the_separatrix(spinner, spinner.start, result.crosses.at)[0])
        ends[POSITIVE if side > 0 else NEGATIVE] += 1
    noted = ENDS_DRAWN(drawn=drawn, positive=ends[POSITIVE], negative=ends[NEGATIVE], axis=Axis(result.axis))
    if all(ends.values()):
        return replace(result, outcome=UNDECIDED, level="undecided", rates=None,
                       reason=OPEN_OVER_BOX(found=noted))
    return replace(result, caveats=(*result.caveats, Caveat(Kind.UNCERTAIN, SAME_OVER_BOX(found=noted))))


def _answered(spinner: Spinner, angle: float, spans: bool) -> FlatSpin:
    """The answer of one start: exactly where it rests or is past the separatrix, else by runs."""
    D1, D2, _ = spinner.moments
    size, axis = spinner.size, spinner.order[0]
    growth, decay = spinner.constants
    result = FlatSpin(
        UNDECIDED, "undecided", axis + 1, spinner.order[2] + 1, size, size / float(D1), None,
        float(spinner.energy), float(dot(spinner.momentum, spinner.momentum) / (2 * D1)), angle,
        growth=growth, decay=decay, reason=NOT_KNOWN)
    if not spinner.moves_inside and not any(cross(spinner.momentum, spinner.omega)):  # nothing changes
        return _at_rest(spinner, result)
    if spinner.ratio * D2 < 1 and D1 > D2:
        direction = spinner.momentum[axis]
        result = _ended(result, direction, "exact", PAST(side=_side(direction), axis=Axis(axis + 1)))
    return _timed(spinner, result, angle, spans)


def _side(direction: Fraction | int) -> str:
    return "positive" if direction > 0 else "negative"


def _ended(result: FlatSpin, direction: Fraction | int, level: str, reason: Reason) -> FlatSpin:
    """With the rates at the end; reason: why."""
    sign = 1 if direction > 0 else -1
    rates = tuple(sign * result.final_rate if i == result.axis - 1 else 0.0 for i in range(3))
    return replace(result, outcome=POSITIVE if sign > 0 else NEGATIVE, rates=rates, level=level,
                   reason=reason)


def _at_rest(spinner: Spinner, result: FlatSpin) -> FlatSpin:
    """A permanent rotation: of the greatest moment it stays for ever; any other is unstable."""
    D1, D2, _ = spinner.moments
    if spinner.ratio * D1 == 1:
        if D1 == D2:
            return replace(result, outcome=ACROSS, level="exact", reason=LEAST_ENERGY,
                           rates=tuple(map(float, spinner.omega)))
        return _ended(result, spinner.momentum[spinner.order[0]], "exact", LEAST_ENERGY)
    name = "minor" if spinner.ratio * spinner.moments[2] == 1 else "intermediate"
    return replace(result, reason=UNSTABLE_ROTATION(which=name))


def _dying(spinner: Spinner, settled: float) -> float | None:
    """The nutation angle of a start from which it only dies out; None where the body turns over first.
    settled: the level of 2 T/|H|^2 below which it is small."""
    D1, D2, _ = spinner.moments
    if not (spinner.ratio * D2 < 1 and D1 > D2) and float(spinner.ratio) >= settled:
        return None
    item, two, three = spinner.inverses
    fraction = float(spinner.ratio - 1 / D1) / ((two if two > item else three) - item)
    return math.asin(math.sqrt(min(1.0, max(0.0, fraction))))


def _timed(spinner: Spinner, result: FlatSpin, angle: float, spans: bool) -> FlatSpin:
    """The times of a motion that goes on, by two runs."""
    D1, D2, _ = spinner.moments
    levels = spinner.levels(angle)
    nutation = _dying(spinner, levels["settles"])
    if nutation is not None and nutation / 10 >= LEAST:
        levels["tenth"] = spinner.levels(nutation / 10)["settles"]
    ahead = {name: level for name, level in levels.items() if float(spinner.ratio) >= level}
    runs = [Run(spinner, spinner.start, None, RUN_STEPS),
            Run(spinner, moved_row(spinner.start, MOVED), SECOND_RTOL, RUN_STEPS)]
    visited: list[dict[str, float]] = [{}, {}]
    directions = [0, 0]
    for n, run in enumerate(runs):
        for name in sorted(ahead, key=lambda name: -ahead[name]):
            if (t := run.falls(ahead[name])) is None:
                break
            visited[n][name] = t
            if name == "crosses":
                directions[n] = spinner.direction(run.state)
    first = runs[0]
    times: dict[str, Any] = {name: Time(t, WIDER * abs(t - visited[1][name]) + 1e-15 * t)
                             for name, t in visited[0].items() if name in visited[1]}
    result = replace(result, steps=first.steps, nutation=nutation,
                    caveats=caveats_of(spinner.scene, validity=first.validity), **times)
    if result.outcome != UNDECIDED:
        return result
    why = first.why or runs[1].why or ENDED
    if D1 == D2:
        parts = content(spinner.scene)
        # a wheel or a mass has a phase of its own
        across = BY_START if parts is not None and parts.movers else BY_PHASE
        if "settles" not in ahead:  # near their plane already, from which the falling energy keeps it
            return replace(result, outcome=ACROSS, level="exact", reason=across)
        return (replace(result, reason=PLANE_NOT_REACHED(within=Angle(angle), why=why))
                if "settles" not in visited[0]
                else replace(result, outcome=ACROSS, level="run", reason=across))
    if "crosses" not in visited[0] or "crosses" not in visited[1]:
        return replace(result, reason=NOT_CROSSED(why=why))
    second: dict[str, Any] = {"moved": int(MOVED), "tolerance": Quantity(SECOND_RTOL, digits=1)}
    if directions[0] != directions[1]:
        return replace(result, reason=BETWEEN_DIRECTIONS(**second))
    result = _ended(result, directions[0], "run",
                   CROSSES(side=_side(directions[0]), axis=Axis(result.axis), **second))
    if result.crosses is None or not spans:
        return result
    return replace(result, spans=spans_of(spinner, result.crosses.at, result.steps, SPAN_STEPS))
