"""The motion of a body with more than a gyrostat and a constant torque: bounded or not, and where it tends.

What proves a bound here: the energy falls (liquid, resistance), or resistance outgrows any torque of bounded
size, or energy and |gamma| = 1 are kept (field). Each proof comes with its numbers. Extremes are roots of the
rates over the span.
"""
from __future__ import annotations

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
from ..numbers.vectors import dot
from ..orbit.fate import REASONS, Basis
from ..orbit.result import Fate, Motion
from ..physics.coefficients import Content, at_rest, content, relative, split, taken_up
from ..physics.scene import judge_start
from ..reasons import number

BESIDE = ("undecided: of a wheel motor nothing is proved beside a damper inside, a liquid, a field, a medium "
          "that leaves some axis free, or an outer torque ")
AFTER = ("that goes on after it; ask of the motion from the state when it stops, the wheel's momentum then "
         "as [effects.gyrostat]")
ENDLESS = "as large as its own"
OPEN_DIRECTION = ("; the direction is undecided, since its energy is not below that of rotation about the "
                  "next axis")
SMALL = 1e-290  # below it a square of doubles has lost digits


def motion(scene, state, span=None, exact=None, brief: bool | str = False) -> Motion:
    """See `answers.motion`. state: three numbers; six, omega and gamma, or a dict of blocks, where gamma is
    part of the state.

    Raises InputError for a scene with an effect that is not known here."""
    parts = content(scene)
    if parts is None:
        scene.quadratic()  # says which effect it is
    omega, gamma = split(parts, state)
    sigma, wheel = relative(parts, state), taken_up(parts, state)
    judge_start(scene, {"wheel": wheel})
    at = omega + (gamma or ()) + (sigma if parts.inside else ()) + (wheel if any(parts.u) else ())
    seen = {}
    if span is not None and brief != "fate":
        from .evidence import seen_of_blocks
        seen = seen_of_blocks(scene, {"omega": omega} | ({"gamma": gamma} if gamma else {})
                         | ({"damper": sigma} if parts.inside else {})
                         | ({"wheel": wheel} if any(parts.u) else {}), span)
    fields: dict[str, Any]
    if any(parts.u):
        fields = {**seen, **_motor(parts, omega, gamma, wheel)}
    elif at_rest(parts, exact or omega, gamma) and not any(sigma):
        fields = {"fate": Fate.EQUILIBRIUM, "because": REASONS[Basis.AT_REST],
                  "extremes": tuple((w, w) for w in omega)}
    else:
        fate, because, bounds = judged(parts, omega, gamma, sigma, _end(seen))
        fields = {**seen, "fate": fate, "because": because, "invariants": bounds}
    because = f"{fields['because']}; {parts.note}" if parts.note else fields["because"]
    level = "undecided" if fields["fate"] == Fate.UNDECIDED else "exact"
    return Motion(at=at, **{**fields, "because": because, "level": level})


def _end(seen: dict[str, Any]) -> tuple[float, ...]:
    """omega and gamma at the end of a run over the span; empty where there was none."""
    shown = seen.get("evidence", {})
    return (*shown["rate_end"], *shown["vertical_end"]) if "vertical_end" in shown else ()


def judged(parts: Content, omega, gamma, sigma=(0.0,) * 3,
           end: tuple[float, ...] = ()) -> tuple[Fate, str, dict]:
    """(fate, proof in words, the numbers in it); sigma: rates of a damper relative to the body; end: omega
    and gamma at the end of a run."""
    if parts.inside:
        return _damped(parts, omega, sigma)
    if parts.unproved_loss:
        return Fate.UNDECIDED, parts.unproved_loss, {}
    if gamma:
        return _directed(parts, omega, gamma, end)
    T0, x0 = _energy(parts, omega)
    if parts.kappa and any(parts.Lambda) and not parts.printed:
        return _wheel_and_liquid(parts, T0, x0)
    if parts.c or parts.damped:
        return _resisted(parts, T0, x0)
    if any(parts.M):
        return (Fate.UNDECIDED,
                "undecided: the torque does work at the rate M . omega, and what the liquid takes, of fourth "
                "order in the rates, "
                "vanishes about the principal axes: no bound is proved", {})
    return _liquid(parts, omega, T0, x0)


def _energy(parts: Content, omega) -> tuple[float, float]:
    """T and sqrt(2 T); the root, unlike the energy, is a double wherever the rates are ordinary ones."""
    unit = 2.0 ** (frexp(max(map(abs, omega)))[1] - 1)
    T0 = sum(float(d) * w * w for d, w in zip(parts.D, [w / unit for w in omega])) / 2
    return T0 * unit * unit, sqrt(2 * T0) * unit


def _most(value: float) -> str:
    """An upper bound in a sentence."""
    return number(value, side=1)


def _sqrt(square: Fraction) -> float:
    """The root of a number that may be below the least double."""
    found = float(square)
    return sqrt(found) if found > SMALL else float(sqrt_fraction(square))


def _motor(parts: Content, omega, gamma, wheel) -> dict[str, Any]:
    """The fields of a motion in which a motor turns a wheel. As h x omega does no work, resistance bounds the
    rates as it does under the torque M - u."""
    others, least = parts.without_motor, float(min(parts.D))
    if not parts.inside and not gamma and not parts.kappa and (slowest := decay(others)):
        T0, x0 = _energy(parts, omega)
        largest, late = energy_bound(replace(others, M=tuple(m - u for m, u in zip(parts.M, parts.u))), x0)
        if parts.duration is not None:
            after, late = energy_bound(others, x0)
            largest = max(largest, after)
        rates = {"rate_bound": largest / sqrt(least), "late_rate_bound": late / sqrt(least)}
        end = "where it tends is undecided" if late else "it tends to rest"
        words = (f"T' <= (M - u) . omega - 2 c T, c = {float(slowest):.6g} 1/s: resistance outgrows outer "
                 f"torque and motor, so |omega| <= {_most(rates['rate_bound'])} rad/s always and <= "
                 f"{_most(rates['late_rate_bound'])} rad/s in the end; {end}")
        return {"fate": Fate.BOUNDED, "because": words, "invariants": {"energy": T0, **rates}}
    outer, motor = (sqrt(float(dot(v, v))) for v in (parts.M, parts.u))
    if others.kind != "gyrostat" or parts.kappa or (outer if parts.duration is not None else
                                                    dot(parts.M, parts.M) >= dot(parts.u, parts.u)):
        return {"fate": Fate.UNDECIDED, "because": BESIDE + (ENDLESS if parts.duration is None else AFTER)}
    start = tuple(float(l) + h for l, h in zip(parts.Lambda, wheel))
    H = hypot(*(float(d) * w + h for d, w, h in zip(parts.D, omega, start)))
    if parts.duration is not None:
        left = float(parts.duration)
        most = max(hypot(*start), hypot(*(h + float(u) * left for h, u in zip(start, parts.u))))
        known = "|D omega + Lambda + h| stays", (H + most) / least
        pull = sqrt(sum(float(u) ** 2 / float(d) for d, u in zip(parts.D, parts.u)))
        by_work = "T' = -u . omega", (_energy(parts, omega)[1] + pull * left) / sqrt(least)
        because, bound = min(known, by_work, key=lambda one: one[1])
        words = (f"{because}, and the motor stops after {left:.6g} s, when T stays: so |omega| <= "
                 f"{_most(bound)} rad/s always")
        return {"fate": Fate.BOUNDED, "because": words, "invariants": {"momentum": H, "rate_bound": bound}}
    each = (motor - outer) / float(max(parts.D))
    grows = f"grows by at most |M| = {_most(outer)} N m s each second" if outer else "stays"
    words = (f"|D omega + Lambda + h| {grows}, and h grows by |u| = {motor:.6g} N m s each second: so "
             f"|omega| grows without bound while the motor runs, in the end by at least "
             f"{number(each, side=-1)} rad/s "
             "each second")
    acting = [i for i in range(3) if parts.u[i]]
    axis = acting[0] + 1 if len(acting) == 1 and not outer else 0
    return {"fate": Fate.SPIN_UP, "because": words, "axis": axis,
            "sense": (-1 if parts.u[axis - 1] > 0 else 1) if axis else 0,
            "invariants": {} if outer else {"momentum": H}}


def _damped(parts: Content, omega, sigma) -> tuple[Fate, str, dict]:
    """A damper alone, or with wheels: |H| stays, the energy falls."""
    if any(parts.M) or parts.c or parts.damped or parts.kappa or parts.directed:
        return (Fate.UNDECIDED,
                "undecided: no bound is proved for a damper inside beside a torque, a medium, another "
                "damper, a liquid or a field", {})
    k = parts.inside
    w, s = tuple(map(Fraction, omega)), tuple(map(Fraction, sigma))
    H = tuple(d * x + l + k * y for d, x, l, y in zip(parts.D, w, parts.Lambda, s))
    twice = sum(d * x * x for d, x in zip(parts.D, w)) + k * (2 * dot(w, s) + dot(s, s))
    if not any(parts.Lambda):
        return _permanent(parts, H, twice, "the damper")
    words = ("the damper keeps |H| and takes energy at every rotation that is not permanent (LaSalle), so "
             "the motion is bounded and tends to permanent rotations of its |H|")
    return Fate.BOUNDED, words, {"energy": float(twice / 2), "momentum": _sqrt(dot(H, H)),
                                 "rate_bound": _sqrt(twice / (min(parts.D) - k))}


def _resisted(parts: Content, T0, x0) -> tuple[Fate, str, dict]:
    least = sqrt(float(min(parts.D)))
    slowest, takes = decay(parts), "T' <= " if parts.kappa or parts.damped else "T' = "
    rate = f", c = {float(slowest):.6g} 1/s" if parts.damped else ""
    if not slowest:
        return _partly(parts, T0, x0, least)
    if not any(parts.M):
        return (Fate.BOUNDED,
                f"{takes}-2 c T{rate}: the energy falls at least as T(0) exp(-2 c t), so the motion tends to "
                "rest", {"energy": T0, "rate_bound": x0 / least, "late_rate_bound": 0.0})
    largest, late = energy_bound(parts, x0)
    words = (f"{takes}M . omega - 2 c T <= sqrt(2 T) (sqrt(M . D^-1 M) - c sqrt(2 T)){rate}: resistance "
             f"outgrows the torque, so |omega| <= "
             f"{_most(largest / least)} rad/s always and <= {_most(late / least)} rad/s in the end")
    bounds = {"energy": T0, "rate_bound": largest / least, "late_rate_bound": late / least}
    if parts.kappa:
        return Fate.BOUNDED, words + "; where it tends is undecided", bounds
    found = resisted_equilibria(parts)
    drawn = [p for p in found.points if GLOBAL in p.because]
    if drawn:
        where = ("it tends to the equilibrium (" + ", ".join(f"{v:.12g}" for v in drawn[0].at)
                 + ") rad/s, as every motion does")
    else:
        attracting = sum(p.verdict == "asymptotically stable" for p in found.points)
        where = (
            f"where it tends is undecided: {attracting} of {len(found.points)} equilibria attract their "
            f"neighbourhood, and no proof covers all motions")
    return Fate.BOUNDED, f"{words}; {where}", bounds


def _partly(parts: Content, T0, x0, least) -> tuple[Fate, str, dict]:
    """A linear damper that leaves some axis free."""
    if any(parts.M):
        return (Fate.UNDECIDED, "undecided: the torque does work at the rate M . omega, and the damper "
                                "resists rotation about some axes alone: no bound is proved", {"energy": T0})
    bounds = {"energy": T0, "rate_bound": x0 / least}
    axis = None if parts.kappa else free_axis(parts)
    if axis is None:
        return (Fate.BOUNDED, "T' = -omega . C omega <= 0: the energy does not grow; where the motion tends "
                              "is undecided, for the damper resists rotation about some axes alone", bounds)
    rates = goes_on(parts, axis)
    if rates == ():
        return Fate.BOUNDED, DIES_OUT, bounds | {"late_rate_bound": 0.0}
    place = ("any rate" if rates is None else
             f"({', '.join(f'{float(rates[0] * v):.12g}' for v in axis)}) rad/s")
    return (Fate.BOUNDED,
            f"T' = -omega . C omega vanishes about one axis alone, about which a rotation at {place} goes "
            f"on: the motion tends to one about it, or to rest (LaSalle)", bounds)


def _liquid(parts: Content, omega, T0, x0) -> tuple[Fate, str, dict]:
    """Liquid alone: |H| stays where no wheel acts, the energy falls."""
    if any(parts.Lambda):  # the printed torque
        return (Fate.BOUNDED,
                "the printed torque of the liquid takes energy, T' <= 0; where the motion tends is "
                "undecided, since "
                "this torque changes the angular momentum",
                {"energy": T0, "rate_bound": x0 / sqrt(float(min(parts.D)))})
    w = tuple(map(Fraction, omega))
    return _permanent(parts, tuple(d * x for d, x in zip(parts.D, w)),
                      sum(d * x * x for d, x in zip(parts.D, w)), "the liquid")


def _permanent(parts: Content, H, twice, what: str) -> tuple[Fate, str, dict]:
    """A free body of angular momentum H and kinetic energy twice/2 from which something takes energy."""
    square, order = dot(H, H), sorted(range(3), key=lambda i: -parts.D[i])
    size = _sqrt(square)
    # without a damper |omega| <= |H|/(least moment); with it T >= (least moment - k) |omega|^2/2
    bound = (_sqrt(twice / (min(parts.D) - parts.inside)) if parts.inside
             else size / float(min(parts.D)))
    bounds = {"energy": float(twice) / 2, "momentum": size, "rate_bound": bound}
    words = (
        f"{what} keeps |H| and takes energy at every rotation that is not permanent (LaSalle), so the "
        "motion is bounded")
    first, second = order[:2]
    if parts.D[first] == parts.D[second]:
        return Fate.BOUNDED, words + " and tends to permanent rotations of its |H|", bounds
    final = [0.0] * 3
    final[first] = size / float(parts.D[first]) * (1 if H[first] > 0 else -1)
    if twice * parts.D[second] < square:
        place = ", ".join(f"{v:.12g}" for v in final)
        return (Fate.BOUNDED,
                f"{words}; its energy is below that of rotation about axis {second + 1} at this |H|, so it "
                f"stays on its side and tends to "
                f"rotation about axis {first + 1}, the axis of the largest moment: ({place}) rad/s", bounds)
    return (Fate.BOUNDED,
            f"{words} and tends to a permanent rotation of its |H|: about axis {first + 1} (largest moment) "
            f"but for a set of measure zero{OPEN_DIRECTION}",
            bounds)


def _wheel_and_liquid(parts: Content, T0, x0) -> tuple[Fate, str, dict]:
    """With Lambda the liquid's work has parts of either sign, which resistance outweighs below a certain
    energy."""
    found = trap(parts)
    if found is None or x0 >= found[1]:
        return (Fate.UNDECIDED,
                "undecided: with a wheel or a charge the liquid keeps |H| to first order in kappa only, and "
                "its work has parts "
                "of either sign; no bound is proved for this state", {"energy": T0})
    x1, x2 = found
    least = sqrt(float(min(parts.D)))
    where = (f"above {x1 * x1 / 2:.6g} J" if x2 == inf
             else f"between {x1 * x1 / 2:.6g} and {x2 * x2 / 2:.6g} J")
    words = (f"resistance outweighs torque and liquid: the kinetic energy falls wherever it is {where}, so "
             f"|omega| <= "
             f"{_most(max(x0, x1) / least)} rad/s always")
    end = (f" and <= {_most(x1 / least)} rad/s in the end; where it tends is undecided" if x1
           else "; the motion tends to rest")
    return Fate.BOUNDED, words + end, {"energy": T0, "rate_bound": max(x0, x1) / least,
                                       "late_rate_bound": x1 / least}


def _directed(parts: Content, omega, gamma, end) -> tuple[Fate, str, dict]:
    T0, x0 = _energy(parts, omega)
    s, N = tuple(map(float, parts.s)), float(parts.N)
    V0 = -dot(s, gamma) + N / 2 * sum(float(d) * g * g for d, g in zip(parts.D, gamma))
    least, most = float(min(parts.D)), float(max(parts.D))
    floor = -hypot(*s) + N / 2 * (least if N > 0 else most)
    if parts.kappa:
        return (Fate.UNDECIDED,
                "undecided: the torque of the field enters the liquid's own, whose work may have either "
                "sign; no bound is proved",
                {"energy": T0 + V0})
    if not any(parts.M):
        above = T0 + V0 - floor
        rate = (sqrt(max(0.0, 2 * above / least)) if SMALL < above < inf
                else hypot(x0, sqrt(max(0.0, 2 * (V0 - floor)))) / sqrt(least))
        at_most = "is more than a double holds" if isinf(above) else f"<= {_most(above)} J"
        kept = ("falls (the medium takes 2 c T)" if parts.c else
                "falls (the damper takes omega . C omega)" if parts.damped else
                "falls (eddy currents take k B^2 |omega x gamma|^2)" if parts.eddy else "is constant")
        where = "; it tends to rest (LaSalle)" if decay(parts) else ""
        if parts.eddy and floor == 0 and not (where or parts.damped or any(parts.Lambda)):
            where = _about_the_field(parts, omega, gamma, end)
        return (Fate.BOUNDED,
                f"|gamma| = 1 bounds the potential energy from below and the sum of kinetic and potential "
                f"energy {kept}: T {at_most}, so |omega| <= {_most(rate)} rad/s{where}",
                {"energy": T0 + V0, "rate_bound": rate} | ({"late_rate_bound": 0.0} if decay(parts) else {}))
    if slowest := float(decay(parts)):
        torque = hypot(*map(float, parts.M)) + hypot(*s) + abs(N) * (most - least) / 2
        late = torque / sqrt(least) / slowest
        rate = max(x0, late) / sqrt(least)
        return (Fate.BOUNDED,
                f"the torque is at most {_most(torque)} N m, and T' <= |torque| |omega| - 2 c T: resistance "
                f"outgrows it, so |omega| <= {_most(rate)} "
                "rad/s; where it tends is undecided", {"energy": T0 + V0, "rate_bound": rate})
    return (Fate.UNDECIDED,
            "undecided: the constant torque does work in a body that also turns in a field; no bound and no "
            "release is proved",
            {"energy": T0 + V0})


def _about_the_field(parts: Content, omega, gamma, end=()) -> str:
    """Where a body tends that eddy currents alone act on: see `equilibrium.dissipative`. end: omega and gamma
    at the end of a run, if there was one.

    The rate along the field has the sign of p = H . gamma. That about the axis of the largest moment D1 has
    it where that axis comes to point along the field, and the other where against it. As p^2 <= 2 T gamma .
    D gamma, 2 T D2 < p^2 keeps gamma . D gamma above the next moment D2 for ever: gamma1 keeps its sign, and
    rotation about no other axis has so little energy."""
    p = _along(parts, omega, gamma)
    if not p:
        return "; H . gamma = 0 stays, and the motion tends to rest (LaSalle)"
    first, second = sorted(range(3), key=lambda i: -parts.D[i])[:2]
    rate, name = float(p / parts.D[first]), f"axis {first + 1}, the axis of the largest moment"
    words = (f"; H . gamma = {float(p):.6g} N m s stays, and the motion tends to rotation about the field, "
             f"at {rate:.6g} rad/s along `vertical`")
    if parts.D[first] == parts.D[second]:
        return words + (
            " (LaSalle); with all moments equal, about whichever axis then points along it"
            if len(set(parts.D)) == 1 else f", about an axis in the plane of axes {first + 1} and "
            f"{second + 1}, the two largest moments, but for a set of measure zero (LaSalle)")
    if _on_its_side(parts, omega, gamma, second):
        return words + (f": at {_about(rate, gamma[first])} rad/s about {name}: its energy is below "
                        f"that of rotation about axis {second + 1} at this H . gamma, so it stays on its "
                        "side (LaSalle)")
    words += (f", about {name}, but for a set of measure zero (LaSalle); whether that axis then points along "
              "the field or against it is not proved, since its energy is not below that of rotation about "
              "the next axis")
    if end and _on_its_side(parts, end[:3], end[3:], second):
        words += (f"; by a run over the span it ends at {_about(rate, end[3 + first])} rad/s about axis "
                  f"{first + 1}")
    return words


def _along(parts: Content, omega, gamma) -> Fraction:
    """H . gamma, exact."""
    return dot([d * Fraction(w) for d, w in zip(parts.D, omega)], list(map(Fraction, gamma)))


def _on_its_side(parts: Content, omega, gamma, second: int) -> bool:
    """Whether eddy currents let the axis of the largest moment point no other way: see `_about_the_field`."""
    twice = sum((d * Fraction(w) ** 2 for d, w in zip(parts.D, omega)), Fraction(0))
    g = tuple(map(Fraction, gamma))
    return twice * parts.D[second] * dot(g, g) < _along(parts, omega, gamma) ** 2


def _about(rate: float, side: float) -> str:
    """A rate along the field as one about an axis that points along it (side > 0) or against it."""
    return f"{rate if side > 0 else -rate:+.6g}"
