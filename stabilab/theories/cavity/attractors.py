"""Where a body with a liquid ends: steady states of the averaged equations, who attracts, and how fast.

A' = A alpha(r), r' = rho0(r) + A^2 rho1(r): the means of first and second order, derived in `averaging_form`,
of the body with D1 and D2 both at their mean and M1 = M2 = 0 (the harmonics of either leave such a state in
first order). The second order matters as soon as |Gamma| > J0 |r|: it holds the decay kappa Gamma^2/J0^3 of
the turn in the liquid. A steady state with A = 0 is a spin about axis 3; one with A > 0 is a regular
precession, the angular velocity going round axis 3 in the body.
"""
from __future__ import annotations

from dataclasses import dataclass

from .normal_form import NAMES, constants, normal_form


@dataclass(frozen=True)
class SteadyState:
    """A steady state of the averaged motion: amplitude A and spin r (rad/s), kind "attracting", "repelling",
    "saddle" or "neutral"; rates: the two eigenvalues of the linearised averaged equations, 1/s (negative real
    part: decays); because: in words."""

    amplitude: float
    spin: float
    kind: str
    rates: tuple[complex, complex]
    because: str


@dataclass(frozen=True)
class Attractors:
    """All isolated steady states; families: curves of them, in words with their rates; reason: why these and
    no others."""

    points: tuple[SteadyState, ...]
    families: tuple[str, ...]
    reason: str

    @property
    def attracting(self) -> tuple[SteadyState, ...]:
        """Those that attract."""
        return tuple(p for p in self.points if p.kind == "attracting")


def attractors(scene) -> Attractors:
    """Steady states of the averaged equations of the scene, first and second order together. Raises
    InputError where the scene is not of the kind (`averaging_form.check`)."""
    from sympy import Poly, Rational, Symbol, expand, re
    form, numbers = normal_form(scene), constants(scene)
    put = {s: Rational(numbers[n].numerator, numbers[n].denominator) for s, n in zip(form.symbols, NAMES)}
    put |= {form.symbols[NAMES.index(n)]: 0 for n in ("h", "M1", "M2")}
    S, r = Symbol("S", real=True), form.variables[2]
    alpha = Poly(re(expand(sum(form.turn).subs(put))), r)
    rho0, rho1 = (Poly(c, r) for c in _by_amplitude(expand(sum(form.spin).subs(put)), S))
    points = [_state(alpha, rho0, rho1, root, 0) for root in _roots(rho0)]
    for root in _roots(alpha):
        swept = rho1.eval(root)
        if swept != 0 and -rho0.eval(root) / swept > 0:
            points.append(_state(alpha, rho0, rho1, root, -rho0.eval(root) / swept))
    families = tuple(_families(alpha, rho0, rho1))
    return Attractors(tuple(points), families, _reason(numbers, points, families))


def _by_amplitude(rate, S):
    """(rate at S = 0, its slope in S): r' is of first degree in S = A^2."""
    return rate.subs(S, 0), rate.diff(S)


def _roots(polynomial):
    """Distinct real roots, exact; none of a constant (0 is 0 everywhere: a family)."""
    from sympy import real_roots
    return () if polynomial.degree() < 1 else tuple(dict.fromkeys(real_roots(polynomial)))


def _state(alpha, rho0, rho1, r, S) -> SteadyState:
    from sympy import Integer, sqrt
    down = rho0.diff().eval(r) + S * rho1.diff().eval(r)
    if S == 0:
        first, second = alpha.eval(r), down
        because = "spin about axis 3: amplitude and spin change each at their own rate"
    else:
        det = -2 * S * alpha.diff().eval(r) * rho1.eval(r)
        root = sqrt(down**2 - 4 * det)
        first, second = (down + root) / 2, (down - root) / 2
        because = "regular precession: the liquid feeds the amplitude as fast as the rest takes it"
    rates = (complex(Integer(0) + first), complex(Integer(0) + second))
    return SteadyState(float(sqrt(S)), float(r), _kind(rates), rates, because)


def _kind(rates):
    signs = [(v.real > 0) - (v.real < 0) for v in rates]
    if 0 in signs:
        return "repelling" if 1 in signs else "neutral"
    return {(-1, -1): "attracting", (1, 1): "repelling"}.get(tuple(signs), "saddle")


def _families(alpha, rho0, rho1):
    """Curves of steady states: where a factor vanishes identically or for all A at once."""
    if rho0.is_zero:
        if alpha.is_zero:
            yield "every spin about axis 3 (A = 0, any r): in these equations nothing attracts or repels"
        else:
            yield "every spin about axis 3 (A = 0, any r), the amplitude growing at the rate " + _words(alpha)
    if alpha.is_zero and rho0.is_zero and rho1.is_zero:
        yield "every amplitude and spin: in these equations nothing changes them"
        return
    for r in _roots(alpha) if not alpha.is_zero else ():
        if rho1.eval(r) == 0 and rho0.eval(r) == 0:
            rate = float(rho1.diff().eval(r))
            yield (f"the angular velocities with r = {float(r):.10g} and any A: the turn stands still there; "
                   f"a neighbour comes "
                   f"back at the rate {-rate:.10g} A^2 1/s (A in rad/s)" if rate < 0 else
                   f"the angular velocities with r = {float(r):.10g} and any A: the turn stands still there; "
                   f"a neighbour leaves "
                   f"at the rate {rate:.10g} A^2 1/s (A in rad/s)")


def _words(polynomial):
    terms = [f"{float(c):.10g}" + (" r" if n == 1 else f" r^{n}" if n else "") for (n,),
             c in polynomial.terms()]
    return " + ".join(terms).replace("+ -", "- ") + " 1/s"


def _reason(numbers, points, families):
    parts = [
        "averaged equations A' = A alpha(r), r' = rho0(r) + A^2 rho1(r) of the body with D1 = D2: all their "
        "steady states"]
    if not points and not families:
        parts.append("there is none: the torque M3 has no resistance to balance it" if numbers["M3"]
                     else "there is none")
    if numbers["M1"] or numbers["M2"]:
        parts.append("the torques M1, M2 average out: the true motion keeps a small oscillation of the size "
                     "M/(J0 nu), and is "
                     "not covered near nu = 0")
    if numbers["h"]:
        parts.append("D1 - D2 averages out as long as nu is much larger than |D1 - D2| |omega|/(2 J0)")
    return "; ".join(parts)
