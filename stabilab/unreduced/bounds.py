"""The motion of a body with more than a gyrostat and a constant torque: bounded or not, and where it tends.

What proves a bound here: the energy falls (liquid, resistance), or resistance outgrows any torque of bounded
size, or energy and |gamma| = 1 are kept (field). Each proof comes with its numbers. Extremes are roots of the
rates over the span.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from math import frexp, hypot, inf, isinf, sqrt
from typing import Any

from ..equilibrium.dissipative import (
    DIES_OUT,
    GLOBAL,
    decay,
    energy_bound,
    free_axis,
    goes_on,
    resisted_equilibria,
)
from ..equilibrium.liquid import trap
from ..numbers.exact import sqrt_fraction
from ..numbers.vectors import Float3, dot
from ..orbit.fate import REASONS, Basis
from ..orbit.result import Fate, Motion, Needs
from ..physics.coefficients import Content, added_inside, at_rest, content, moved, relative, split, taken_up
from ..physics.scene import Scene, judge_start
from ..reasons import (
    Axis,
    Energy,
    Momentum,
    PerSecond,
    Quantity,
    Rate,
    Reason,
    Sentence,
    Time,
    Torque,
)

NO_BOUND = Sentence("no-bound", "no bound is proved")()
NO_BOUND_HERE = Sentence("no-bound-here", "no bound is proved for this state")()
NO_BOUND_NO_RELEASE = Sentence("no-bound-no-release", "no bound and no release is proved")()
MOTOR_BESIDE = Sentence(
    "motor-beside", "undecided: of a wheel motor nothing is proved beside a damper inside, a liquid, a "
    "field, a medium that leaves some axis free, or an outer torque {which}")
MOTOR_OUTGROWN = Sentence(
    "motor-outgrown", "T' ≤ (M - u) . ω - 2 c T, c = {c}: resistance outgrows outer torque and motor, so |ω| "
    "≤ {always} always and ≤ {late} in the end")
MOTOR_STOPS_MOMENTUM = Sentence(
    "motor-stops-momentum", "|D ω + Λ + h| stays, and the motor stops after {time}, when T stays: so |ω| ≤ "
    "{always} always")
MOTOR_STOPS_WORK = Sentence(
    "motor-stops-work", "T' = -u . ω, and the motor stops after {time}, when T stays: so |ω| ≤ {always} "
    "always")
MOTOR_FOR_EVER = Sentence(
    "motor-for-ever", "|D ω + Λ + h| stays, and h grows by |u| = {motor} each second: so |ω| grows without "
    "bound while the motor runs, in the end by at least {gain} each second")
MOTOR_BEATS_TORQUE = Sentence(
    "motor-beats-torque", "|D ω + Λ + h| grows by at most |M| = {torque} each second, and h grows by |u| = "
    "{motor} each second: so |ω| grows without bound while the motor runs, in the end by at least {gain} "
    "each second")
WHERE_OPEN = Sentence("end-undecided", "where it tends is undecided")()
TENDS_TO_REST = Sentence("tends-to-rest", "it tends to rest")()
REST_LASALLE = Sentence("tends-to-rest-lasalle", "it tends to rest (LaSalle)")()
MOTION_TO_REST = Sentence("motion-tends-to-rest", "the motion tends to rest")()
OPEN_DIRECTION = Sentence("direction-undecided", "the direction is undecided, since its energy is not below "
                          "that of rotation about the next axis")
WORK_OF_TORQUE_AND_LIQUID = Sentence(
    "torque-and-liquid", "undecided: the torque does work at the rate M . ω, and what the liquid takes, of "
    "fourth order in the rates, vanishes about the principal axes: no bound is proved")()
DAMPER_BESIDE = Sentence(
    "damper-beside", "undecided: no bound is proved for a damper inside beside a torque, a medium, another "
    "damper, a liquid or a field")()
DAMPERS_TOO_LARGE = Sentence(
    "dampers-too-large", "undecided: together the dampers may take more than the moments of the body hold")()
SOME_GO_ON = Sentence(
    "damped-in-part", "the damper keeps |H| and takes energy, so the motion is bounded; where it tends is "
    "undecided, for some rotation that is not permanent leaves its wheel at rest in the body")()
DISPLACED = Sentence(
    "mass-moves", "the damper keeps |H| and takes energy wherever its mass moves, so the motion is bounded")()
OPEN_ROTATION = Sentence(
    "mass-end-open", "where it tends is undecided, for at most rotations the mass stays away from where its "
    "spring is relaxed")
TAKES_ENERGY = Sentence(
    "takes-energy", "{part} keeps |H| and takes energy at every rotation that is not permanent (LaSalle), so "
    "the motion is bounded and tends to permanent rotations of its |H|")
TAKES_ALL = Sentence(
    "takes-all-energy", "{part} keeps |H| = 0 and takes energy wherever the body turns (LaSalle), so the "
    "motion is bounded and all comes to rest")
ON_ITS_SIDE = Sentence(
    "energy-below-next-axis", "{part} keeps |H| and takes energy at every rotation that is not permanent "
    "(LaSalle), so the motion is bounded; its energy is below that of rotation about {next} at this |H|, so "
    "it stays on its side and tends to rotation about {axis}, the axis of the largest moment: {rates}")
TENDS_TO_MAJOR = Sentence(
    "tends-to-largest-moment", "{part} keeps |H| and takes energy at every rotation that is not permanent "
    "(LaSalle), so the motion is bounded and tends to a permanent rotation of its |H|: about {axis} (largest "
    "moment) but for a set of measure zero")
ENERGY_FALLS = Sentence(
    "energy-falls", "{law}: the energy falls at least as T(0) exp(-2 c t), so the motion tends to rest")
RESISTANCE_OUTGROWS = Sentence(
    "resistance-outgrows", "{law}: resistance outgrows the torque, so |ω| ≤ {always} always and ≤ {late} in "
    "the end")
# The laws behind these two by whether a liquid takes energy, too
LAWS = {False: Sentence("law-medium", "T' = -2 c T")(),
        True: Sentence("law-medium-and-liquid", "T' ≤ -2 c T")()}
LAW_DAMPED = Sentence("law-damped", "T' ≤ -2 c T, c = {c}")
LAWS_TORQUE = {
    False: Sentence("law-medium-torque",
                             "T' = M . ω - 2 c T ≤ √(2 T) (√(M . D^-1 M) - c √(2 T))")(),
    True: Sentence("law-medium-liquid-torque",
                            "T' ≤ M . ω - 2 c T ≤ √(2 T) (√(M . D^-1 M) - c √(2 T))")()}
LAW_DAMPED_TORQUE = Sentence("law-damped-torque",
                             "T' ≤ M . ω - 2 c T ≤ √(2 T) (√(M . D^-1 M) - c √(2 T)), c = {c}")
TENDS_TO_EQUILIBRIUM = Sentence("tends-to-equilibrium",
                                "it tends to the equilibrium {rates}, as every motion does")
SOME_ATTRACT = Sentence(
    "some-equilibria-attract", "where it tends is undecided: {attracting} of {equilibria} equilibria attract "
    "their neighbourhood, and no proof covers all motions")
WORK_OF_TORQUE = Sentence(
    "torque-and-partial-damper", "undecided: the torque does work at the rate M . ω, and the damper resists "
    "rotation about some axes alone: no bound is proved")()
PARTLY_DAMPED = Sentence(
    "partial-damper", "T' = -ω . C ω ≤ 0: the energy does not grow; where the motion tends is undecided, for "
    "the damper resists rotation about some axes alone")()
ONE_AXIS_FREE = Sentence(
    "one-axis-free", "T' = -ω . C ω vanishes about one axis alone, about which a rotation at {rates} goes "
    "on: the motion tends to one about it, or to rest (LaSalle)")
PRINTED_LIQUID = Sentence(
    "printed-liquid", "the printed torque of the liquid takes energy, T' ≤ 0; where the motion tends is "
    "undecided, since this torque changes the angular momentum")()
WHEEL_AND_LIQUID = Sentence(
    "wheel-and-liquid-open", "undecided: with a wheel or a charge the liquid keeps |H| to first order in κ "
    "only, and its work has parts of either sign")().then(
    NO_BOUND_HERE)
OUTWEIGHED_ABOVE = Sentence(
    "liquid-outweighed-above", "resistance outweighs torque and liquid: the kinetic energy falls wherever it "
    "is above {least}, so |ω| ≤ {always} always")
OUTWEIGHED_BETWEEN = Sentence(
    "liquid-outweighed-between", "resistance outweighs torque and liquid: the kinetic energy falls wherever "
    "it is between {least} and {most}, so |ω| ≤ {always} always")
IN_THE_END = Sentence("bound-in-the-end", "≤ {late} in the end")
LIQUID_IN_FIELD = Sentence(
    "liquid-in-field", "undecided: the torque of the field enters the liquid's own, whose work may have "
    "either sign")().then(
    NO_BOUND)
FIELD_BOUNDS = Sentence(
    "field-bounds-energy", "|γ| = 1 bounds the potential energy from below and the sum of kinetic and "
    "potential energy {course}: T {energy}, so |ω| ≤ {always}")
COURSES = {"medium": Sentence("falls-medium", "falls (the medium takes 2 c T)")(),
           "damper": Sentence("falls-damper", "falls (the damper takes ω . C ω)")(),
           "eddy": Sentence("falls-eddy-currents", "falls (eddy currents take k B² |ω x γ|²)")(),
           "": Sentence("energy-constant", "is constant")()}
ENERGY_AT_MOST = Sentence("energy-at-most", "≤ {most}")
ENERGY_TOO_LARGE = Sentence("energy-beyond-doubles", "is more than a double holds")()
TORQUE_AT_MOST = Sentence(
    "torque-at-most", "the torque is at most {torque}, and T' ≤ |torque| |ω| - 2 c T: resistance outgrows "
    "it, so |ω| ≤ {always}")
TORQUE_IN_FIELD = Sentence(
    "torque-in-field", "undecided: the constant torque does work in a body that also turns in a "
    "field")().then(
    NO_BOUND_NO_RELEASE)
FIELD_REST = Sentence("no-momentum-along-field",
                      "H . γ = 0 stays, and the motion tends to rest (LaSalle)")()
ABOUT_FIELD = Sentence(
    "about-the-field", "H . γ = {momentum} stays, and the motion tends to rotation about the field, at "
    "{rate} along `vertical`")
ANY_AXIS = Sentence("about-any-axis",
                    "(LaSalle); with all moments equal, about whichever axis then points along it")()
IN_PLANE_OF_LARGEST = Sentence(
    "plane-of-largest-moments", "about an axis in the plane of {axes}, the two largest moments, but for a "
    "set of measure zero (LaSalle)")
ABOUT_LARGEST = Sentence(
    "about-largest-moment", "at {rate} about {axis}, the axis of the largest moment: its energy is below "
    "that of rotation about {next} at this H . γ, so it stays on its side (LaSalle)")
WHICH_SIDE_OPEN = Sentence(
    "along-or-against-open", "about {axis}, the axis of the largest moment, but for a set of measure zero "
    "(LaSalle); whether that axis then points along the field or against it is not proved, since its energy "
    "is not below that of rotation about the next axis")
BY_A_RUN = Sentence("side-by-run", "by a run over the span it ends at {rate} about {axis}")
GOES_ON_AFTER = ("that goes on after it; ask of the motion from the state when it stops, the wheel's "
                 "momentum then as [effects.gyrostat]")
ENDLESS = "as large as its own"
SMALL = 1e-290  # below it a square of doubles has lost digits


def motion(scene: Scene, state: Sequence[float] | Mapping[str, Float3], span: Sequence[float] | None = None,
           exact: Sequence[Fraction] | None = None, needs: Needs = Needs.ALL) -> Motion:
    """See `answers.motion`. state: three numbers; six, omega and gamma, or a dict of blocks, where gamma is
    part of the state.

    Raises InputError for a scene with an effect that is not known here."""
    parts = content(scene)
    if parts is None:
        scene.quadratic()  # says which effect it is
    omega, gamma = split(parts, state)
    sigma, wheel = relative(parts, state), taken_up(parts, state)
    judge_start(scene, {"wheel": wheel})
    own = moved(parts, state) if parts.movers else {}
    at = omega + (gamma or ()) + (sigma if parts.inside else ()) + (wheel if any(parts.u) else ())
    at += tuple(v for row in own.values() for v in row)
    visited = {}
    if span is not None and needs:
        from .evidence import seen_of_blocks
        visited = seen_of_blocks(scene, {"omega": omega} | ({"gamma": gamma} if gamma else {})
                         | ({"damper": sigma} if parts.inside else {})
                         | ({"wheel": wheel} if any(parts.u) else {}) | own, span)
    fields: dict[str, Any]
    if any(parts.u):
        fields = {**visited, **_motor(parts, omega, gamma, wheel)}
    elif at_rest(parts, exact or omega, gamma) and not any(sigma) and _rest_too(parts, omega, own):
        fields = {"fate": Fate.EQUILIBRIUM, "reason": REASONS[Basis.AT_REST],
                  "extremes": tuple((w, w) for w in omega)}
    else:
        fate, reason, bounds = judged(parts, omega, gamma, sigma, _end(visited), own)
        fields = {**visited, "fate": fate, "reason": reason, "invariants": bounds}
    reason = fields["reason"].then(parts.note)
    level = "undecided" if fields["fate"] == Fate.UNDECIDED else "exact"
    return Motion(at=at, **{**fields, "reason": reason, "level": level})


def _end(visited: dict[str, Any]) -> tuple[float, ...]:
    """omega and gamma at the end of a run over the span; empty where there was none."""
    shown = visited.get("evidence", {})
    return (*shown["rate_end"], *shown["vertical_end"]) if "vertical_end" in shown else ()


def judged(parts: Content, omega: Sequence[float], gamma: Sequence[float] | None,
           sigma: Sequence[float] = (0.0,) * 3, end: tuple[float, ...] = (),
           own: Mapping[str, Sequence[float]] | None = None) -> tuple[Fate, Reason, dict]:
    """(fate, its proof, the numbers in it); sigma: rates of a damper relative to the body; end: omega
    and gamma at the end of a run; own: blocks of dampers with other states."""
    if parts.damper_inside:
        return _damped(parts, omega, {"damper": sigma, **(own or {})})
    if parts.unproved_loss is not None:
        return Fate.UNDECIDED, parts.unproved_loss, {}
    if gamma:
        return _directed(parts, omega, gamma, end)
    T0, x0 = _energy(parts, omega)
    if parts.kappa and any(parts.Lambda) and not parts.printed:
        return _wheel_and_liquid(parts, T0, x0)
    if parts.c or parts.damped:
        return _resisted(parts, T0, x0)
    if any(parts.M):
        return Fate.UNDECIDED, WORK_OF_TORQUE_AND_LIQUID, {}
    return _liquid(parts, omega, T0, x0)


def _energy(parts: Content, omega: Sequence[float]) -> tuple[float, float]:
    """T and sqrt(2 T); the root, unlike the energy, is a double wherever the rates are ordinary ones."""
    unit = 2.0 ** (frexp(max(map(abs, omega)))[1] - 1)
    T0 = sum(float(d) * w * w for d, w in zip(parts.D, [w / unit for w in omega])) / 2
    return T0 * unit * unit, sqrt(2 * T0) * unit


def _sqrt(square: Fraction) -> float:
    """The root of a number that may be below the least double."""
    result = float(square)
    return sqrt(result) if result > SMALL else float(sqrt_fraction(square))


def _motor(parts: Content, omega, gamma, wheel) -> dict[str, Any]:
    """The fields of a motion in which a motor turns a wheel. As h x omega does no work, resistance bounds the
    rates as it does under the torque M - u."""
    others, smallest = parts.without_motor, float(min(parts.D))
    if not parts.damper_inside and not gamma and not parts.kappa and (slowest := decay(others)):
        T0, x0 = _energy(parts, omega)
        largest, late = energy_bound(replace(others, M=tuple(m - u for m, u in zip(parts.M, parts.u))), x0)
        if parts.duration is not None:
            after, late = energy_bound(others, x0)
            largest = max(largest, after)
        rates = {"rate_bound": largest / sqrt(smallest), "late_rate_bound": late / sqrt(smallest)}
        reason = MOTOR_OUTGROWN(c=PerSecond(float(slowest)), always=Rate(rates["rate_bound"]).upper,
                                late=Rate(rates["late_rate_bound"]).upper)
        return {"fate": Fate.BOUNDED, "reason": reason.then(WHERE_OPEN if late else TENDS_TO_REST),
                "invariants": {"energy": T0, **rates}}
    outer, motor = (sqrt(float(dot(v, v))) for v in (parts.M, parts.u))
    if others.kind != "gyrostat" or parts.kappa or (outer if parts.duration is not None else
                                                    dot(parts.M, parts.M) >= dot(parts.u, parts.u)):
        return {"fate": Fate.UNDECIDED,
                "reason": MOTOR_BESIDE(which=ENDLESS if parts.duration is None else GOES_ON_AFTER)}
    start = tuple(float(l) + h for l, h in zip(parts.Lambda, wheel))
    H = hypot(*(float(d) * w + h for d, w, h in zip(parts.D, omega, start)))
    if parts.duration is not None:
        left = float(parts.duration)
        upper = max(hypot(*start), hypot(*(h + float(u) * left for h, u in zip(start, parts.u))))
        by_momentum = (H + upper) / smallest
        pull = sqrt(sum(float(u) ** 2 / float(d) for d, u in zip(parts.D, parts.u)))
        by_work = (_energy(parts, omega)[1] + pull * left) / sqrt(smallest)
        bound = min(by_momentum, by_work)
        resolved = {"time": Time(left), "always": Rate(bound).upper}
        reason = MOTOR_STOPS_MOMENTUM(**resolved) if by_momentum <= by_work else MOTOR_STOPS_WORK(**resolved)
        return {"fate": Fate.BOUNDED, "reason": reason, "invariants": {"momentum": H, "rate_bound": bound}}
    each = (motor - outer) / float(max(parts.D))
    reason = (MOTOR_BEATS_TORQUE(torque=Momentum(outer).upper, motor=Momentum(motor), gain=Rate(each).lower)
              if outer else MOTOR_FOR_EVER(motor=Momentum(motor), gain=Rate(each).lower))
    acting = [i for i in range(3) if parts.u[i]]
    axis = acting[0] + 1 if len(acting) == 1 and not outer else 0
    return {"fate": Fate.SPIN_UP, "reason": reason, "axis": axis,
            "sense": (-1 if parts.u[axis - 1] > 0 else 1) if axis else 0,
            "invariants": {} if outer else {"momentum": H}}


def _rest_too(parts: Content, omega: Sequence[float], own: Mapping[str, Sequence[float]]) -> bool:
    """Whether what has a state of its own inside stays, too, where the rates do."""
    return not any(any(item.change(omega, own[item.needs[0]])) for item in parts.movers)


def _damped(parts: Content, omega: Sequence[float], blocks: Mapping[str, Sequence[float]]
            ) -> tuple[Fate, Reason, dict]:
    """Dampers alone, or with wheels: |H| stays, the energy falls."""
    if any(parts.M) or parts.c or parts.damped or parts.kappa or parts.directed or any(parts.u):
        return Fate.UNDECIDED, DAMPER_BESIDE, {}
    k = parts.inside
    w, s = tuple(map(Fraction, omega)), tuple(map(Fraction, blocks["damper"]))
    rows = {name: tuple(map(Fraction, row)) for name, row in blocks.items()}
    momentum, energy = added_inside(parts.movers, w, rows)
    H = tuple(d * x + l + k * y + h for d, x, l, y, h in zip(parts.D, w, parts.Lambda, s, momentum))
    twice = sum(d * x * x for d, x in zip(parts.D, w)) + k * (2 * dot(w, s) + dot(s, s)) + 2 * energy
    slowest = parts.rest_of_moments
    bounds = {"energy": float(twice / 2), "momentum": _sqrt(dot(H, H))}
    if slowest > 0:
        bounds["rate_bound"] = _sqrt(twice / slowest)
    if any(parts.Lambda) or not parts.all_is_damped or parts.displaced:
        if slowest <= 0:
            return Fate.UNDECIDED, DAMPERS_TOO_LARGE, bounds
        if parts.displaced:
            return Fate.BOUNDED, DISPLACED.then(OPEN_ROTATION()), bounds
        return Fate.BOUNDED, TAKES_ENERGY(part="the damper") if parts.all_is_damped else SOME_GO_ON, bounds
    return _permanent(parts, H, twice, "the damper")


def _resisted(parts: Content, T0: float, x0: float) -> tuple[Fate, Reason, dict]:
    lower = sqrt(float(min(parts.D)))
    slowest = decay(parts)
    if not slowest:
        return _partly(parts, T0, x0, lower)
    if not any(parts.M):
        law = LAW_DAMPED(c=PerSecond(float(slowest))) if parts.damped else LAWS[bool(parts.kappa)]
        return Fate.BOUNDED, ENERGY_FALLS(law=law), {"energy": T0, "rate_bound": x0 / lower,
                                                     "late_rate_bound": 0.0}
    largest, late = energy_bound(parts, x0)
    law = (LAW_DAMPED_TORQUE(c=PerSecond(float(slowest))) if parts.damped
           else LAWS_TORQUE[bool(parts.kappa)])
    reason = RESISTANCE_OUTGROWS(law=law, always=Rate(largest / lower).upper, late=Rate(late / lower).upper)
    bounds = {"energy": T0, "rate_bound": largest / lower, "late_rate_bound": late / lower}
    if parts.kappa:
        return Fate.BOUNDED, reason.then(WHERE_OPEN), bounds
    result = resisted_equilibria(parts)
    drawn = [p for p in result.points if p.reason.says(GLOBAL.sentence)]
    if drawn:
        where = TENDS_TO_EQUILIBRIUM(rates=Rate(drawn[0].at))
    else:
        attracting = sum(p.verdict == "asymptotically stable" for p in result.points)
        where = SOME_ATTRACT(attracting=attracting, equilibria=len(result.points))
    return Fate.BOUNDED, reason.then(where), bounds


def _partly(parts: Content, T0, x0, smallest) -> tuple[Fate, Reason, dict]:
    """A linear damper that leaves some axis free."""
    if any(parts.M):
        return Fate.UNDECIDED, WORK_OF_TORQUE, {"energy": T0}
    bounds = {"energy": T0, "rate_bound": x0 / smallest}
    axis = None if parts.kappa else free_axis(parts)
    if axis is None:
        return Fate.BOUNDED, PARTLY_DAMPED, bounds
    rates = goes_on(parts, axis)
    if rates == ():
        return Fate.BOUNDED, DIES_OUT, bounds | {"late_rate_bound": 0.0}
    location = "any rate" if rates is None else Rate(tuple(float(rates[0] * v) for v in axis))
    return Fate.BOUNDED, ONE_AXIS_FREE(rates=location), bounds


def _liquid(parts: Content, omega: Sequence[float], T0: float, x0: float) -> tuple[Fate, Reason, dict]:
    """Liquid alone: |H| stays where no wheel acts, the energy falls."""
    if any(parts.Lambda):  # the printed torque
        return (Fate.BOUNDED, PRINTED_LIQUID,
                {"energy": T0, "rate_bound": x0 / sqrt(float(min(parts.D)))})
    w = tuple(map(Fraction, omega))
    return _permanent(parts, tuple(d * x for d, x in zip(parts.D, w)),
                      sum(d * x * x for d, x in zip(parts.D, w)), "the liquid")


def _permanent(parts: Content, H: Sequence[Fraction], twice: Fraction | int,
               what: str) -> tuple[Fate, Reason, dict]:
    """A free body of angular momentum H and kinetic energy twice/2 from which something takes energy."""
    square, order = dot(H, H), sorted(range(3), key=lambda i: -parts.D[i])
    size = _sqrt(square)
    # without a damper |omega| <= |H|/(least moment); with it T >= (least moment of the rest) |omega|^2/2
    bound = (_sqrt(twice / parts.rest_of_moments) if parts.damper_inside
             else size / float(min(parts.D)))
    bounds = {"energy": float(twice) / 2, "momentum": size, "rate_bound": bound}
    if not square:
        return Fate.BOUNDED, TAKES_ALL(part=what), bounds | {"late_rate_bound": 0.0}
    first, second = order[:2]
    if parts.D[first] == parts.D[second]:
        return Fate.BOUNDED, TAKES_ENERGY(part=what), bounds
    final = [0.0] * 3
    final[first] = size / float(parts.D[first]) * (1 if H[first] > 0 else -1)
    if twice * parts.D[second] < square:
        return (Fate.BOUNDED, ON_ITS_SIDE(part=what, next=Axis(second + 1), axis=Axis(first + 1),
                                          rates=Rate(tuple(final))), bounds)
    return Fate.BOUNDED, TENDS_TO_MAJOR(part=what, axis=Axis(first + 1)).then(OPEN_DIRECTION()), bounds


def _wheel_and_liquid(parts: Content, T0, x0) -> tuple[Fate, Reason, dict]:
    """With Lambda the liquid's work has parts of either sign, which resistance outweighs below a certain
    energy."""
    result = trap(parts)
    if result is None or x0 >= result[1]:
        return Fate.UNDECIDED, WHEEL_AND_LIQUID, {"energy": T0}
    x1, x2 = result
    smallest = sqrt(float(min(parts.D)))
    above, always = Energy(x1 * x1 / 2).upper, Rate(max(x0, x1) / smallest).upper
    reason = (OUTWEIGHED_ABOVE(least=above, always=always) if x2 == inf else
              OUTWEIGHED_BETWEEN(least=above, most=Energy(x2 * x2 / 2).lower, always=always))
    reason = (reason.then(IN_THE_END(late=Rate(x1 / smallest).upper), " and ").then(WHERE_OPEN) if x1
              else reason.then(MOTION_TO_REST))
    return Fate.BOUNDED, reason, {"energy": T0, "rate_bound": max(x0, x1) / smallest,
                                  "late_rate_bound": x1 / smallest}


def _directed(parts: Content, omega: Sequence[float], gamma: Sequence[float],
              end: Sequence[float]) -> tuple[Fate, Reason, dict]:
    T0, x0 = _energy(parts, omega)
    s, N = tuple(map(float, parts.s)), float(parts.N)
    V0 = -dot(s, gamma) + N / 2 * sum(float(d) * g * g for d, g in zip(parts.D, gamma))
    smallest, largest = float(min(parts.D)), float(max(parts.D))
    floor = -hypot(*s) + N / 2 * (smallest if N > 0 else largest)
    if parts.kappa:
        return Fate.UNDECIDED, LIQUID_IN_FIELD, {"energy": T0 + V0}
    if not any(parts.M):
        above = T0 + V0 - floor
        rate = (sqrt(max(0.0, 2 * above / smallest)) if SMALL < above < inf
                else hypot(x0, sqrt(max(0.0, 2 * (V0 - floor)))) / sqrt(smallest))
        energy = ENERGY_TOO_LARGE if isinf(above) else ENERGY_AT_MOST(most=Energy(above).upper)
        course = COURSES["medium" if parts.c else "damper" if parts.damped else "eddy" if parts.eddy else ""]
        where = REST_LASALLE if decay(parts) else None
        if parts.eddy and floor == 0 and not (where or parts.damped or any(parts.Lambda)):
            where = _about_the_field(parts, omega, gamma, end)
        return (Fate.BOUNDED,
                FIELD_BOUNDS(course=course, energy=energy, always=Rate(rate).upper).then(where),
                {"energy": T0 + V0, "rate_bound": rate} | ({"late_rate_bound": 0.0} if decay(parts) else {}))
    if slowest := float(decay(parts)):
        torque = hypot(*map(float, parts.M)) + hypot(*s) + abs(N) * (largest - smallest) / 2
        late = torque / sqrt(smallest) / slowest
        rate = max(x0, late) / sqrt(smallest)
        reason = TORQUE_AT_MOST(torque=Torque(torque).upper, always=Rate(rate).upper).then(WHERE_OPEN)
        return Fate.BOUNDED, reason, {"energy": T0 + V0, "rate_bound": rate}
    return Fate.UNDECIDED, TORQUE_IN_FIELD, {"energy": T0 + V0}


def _about_the_field(parts: Content, omega, gamma, end=()) -> Reason:
    """Where a body tends that eddy currents alone act on: see `equilibrium.dissipative`. end: omega and gamma
    at the end of a run, if there was one.

    The rate along the field has the sign of p = H . gamma. That about the axis of the largest moment D1 has
    it where that axis comes to point along the field, and the other where against it. As p^2 <= 2 T gamma .
    D gamma, 2 T D2 < p^2 keeps gamma . D gamma above the next moment D2 for ever: gamma1 keeps its sign, and
    rotation about no other axis has so little energy."""
    p = _along(parts, omega, gamma)
    if not p:
        return FIELD_REST
    first, second = sorted(range(3), key=lambda i: -parts.D[i])[:2]
    rate, axis = float(p / parts.D[first]), Axis(first + 1)
    reason = ABOUT_FIELD(momentum=Momentum(float(p)), rate=Rate(rate))
    if parts.D[first] == parts.D[second]:
        return (reason.then(ANY_AXIS, " ") if len(set(parts.D)) == 1
                else reason.then(IN_PLANE_OF_LARGEST(axes=(axis, Axis(second + 1))), ", "))
    if _on_its_side(parts, omega, gamma, second):
        about = ABOUT_LARGEST(rate=_about(rate, gamma[first]), axis=axis, next=Axis(second + 1))
        return reason.then(about, ": ")
    reason = reason.then(WHICH_SIDE_OPEN(axis=axis), ", ")
    if end and _on_its_side(parts, end[:3], end[3:], second):
        reason = reason.then(BY_A_RUN(rate=_about(rate, end[3 + first]), axis=axis))
    return reason


def _along(parts: Content, omega: Sequence[float], gamma: Sequence[float]) -> Fraction:
    """H . gamma, exact."""
    return dot([d * Fraction(w) for d, w in zip(parts.D, omega)], list(map(Fraction, gamma)))


def _on_its_side(parts: Content, omega: Sequence[float], gamma: Sequence[float], second: int) -> bool:
    """Whether eddy currents let the axis of the largest moment point no other way: see `_about_the_field`."""
    twice = sum((d * Fraction(w) ** 2 for d, w in zip(parts.D, omega)), Fraction(0))
    g = tuple(map(Fraction, gamma))
    return twice * parts.D[second] * dot(g, g) < _along(parts, omega, gamma) ** 2


def _about(rate: float, side: float) -> Quantity:
    """A rate along the field as one about an axis that points along it (side > 0) or against it."""
    return Rate(rate if side > 0 else -rate)
