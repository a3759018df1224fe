"""Models of a nearly spherical body with a viscous liquid.

They give its slow amplitude, spin and phase: by the averaged equations, exactly, and by the paper's Taylor
polynomials as printed.

p = A cos phi, q = -A sin phi, r: A and r change slowly while phi turns at about nu = (d r - Gamma)/J0. The
averaged equations come from `cavity_normal_form`; they are integrated in W = A exp(i (phi - psi)), r, psi,
which is regular at A = 0, at r < 0 and through nu = 0. Without a torque across axis 3 no amplitude reaches 0,
and log W is followed, which keeps an amplitude and its phase far below the rounding of r.

p and q of an exact run in doubles are known to a share of the whole angular velocity: once
A has fallen below the rounding of r they are noise, and so is the angle of (p, -q). Where p' and q' vanish
with p and q, A'/A and phi' stay regular however small A is, so log A and phi are followed instead.

The polynomials as printed:

Galal, Amer, Elneklawy, El-Kafly, "Studying the influence of a gyrostatic moment on the motion of a charged
rigid body containing a viscous incompressible liquid", eqs (13), (14), (24)-(29). The formulas are
those of the audit's file on the paper (`theories/printed/papers/liquid-cavity.toml`), which holds each
against the equations of motion. What is wrong in print, and how it is read here:
- (20), (24), (27): the term of (D1' - D2')/4 lacks the factor a^2/2 that averaging (18) gives: kept as
printed (its dimension is wrong).
- (20)-(22), (24)-(28): the liquid torque is that of a body without rotor and charge, the average of a
frequency that
  contains both; terms of the same order are missing: kept as printed.
- (24): "- eps lambda a" for "- eps zeta a" of (20), (27); lambda is nowhere defined: read as zeta.
- (25): B' for D2'; (19): A' for D1'; (7): D3' for D1': read so.
- (24)-(26): braces that do not close: closed so that (24)-(26) are the Taylor polynomials of (20)-(22), which
they are otherwise.
- after (13): sin phi0 lacks the sign of (13): the phase is taken from (13), so the motion starts at the given
state.
- (13), (14): the amplitude is that of p alone, with a square root of (D1' r - g)/(D2' r - g): no real motion
where
  that is negative, and none at D2' r = g, though the true motion is regular there.
The polynomials are of second degree in t and turn back, the phase among them: they hold for short times only.
"""
from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..answers.simulate import Simulation
from ..errors import InputError, Refused
from ..integrate.trajectory import ALL_REACHED, FALLBACK_RTOL
from ..physics.equations import derive
from ..physics.states import numbers_in_a_row, three_numbers
from ..physics.to_numpy import lambdified, to_numpy
from ..reasons import Axis, Moment, Quantity, Rate, Reason, Reasoned, Sentence, Time
from .cavity_normal_form import NAMES, NormalForm, check, constants, normal_form
from .printed.evaluate import printed_formulas

if TYPE_CHECKING:
    from fractions import Fraction

    from ..physics.scene import Scene

# --- Averaged equations
RTOL = 1e-10  # the equations themselves are true to eps^2 at best
# Width of the band of slow turn in which phases are kept, as a share of (|d| |omega| + |Gamma|)/J0: in powers
# of e it is of order one, as the second order needs; at twice the width from nu = 0 the kept part is
# exp(-16), at 2.5 times 1e-17.
SHARE = 0.4
# A removed harmonic leaves about (its rate)/nu of the state: within this many times the rate of nu = 0 it is
# kept.
GUARD = 4.0
SAMPLES = 400  # between asked-for times, to follow the angle of W
INVERSIONS = 100
# log A below which relative rates are those at A = 1e-100, which leaves out a share of A of them
LEAST = -230.0


@dataclass(frozen=True)
class AveragedMotion(Reasoned):
    """What the averaged equations say at the asked-for times.

    t: (n,) s; amplitude A, rad/s, spin r, rad/s, phase phi, rad, unwrapped: (n,), the averaged variables;
    omega: (n, 3) rad/s, body frame, rebuilt from them (second order: with the near-identity change of
    variables, so omega at t = 0 is the given state). At A = 0 the phase is that of the turn alone. order: 1
    or 2; eps: the small parameter. floor: absolute tolerance of the spin, and of p and q where a torque lies
    across axis 3, rad/s; else these are as well known as their size. status: "reached", or "stopped" with t
    up to where the run came; reason: why; horizon: how far to trust it.
    """

    t: np.ndarray
    amplitude: np.ndarray
    spin: np.ndarray
    phase: np.ndarray
    omega: np.ndarray
    order: int
    eps: float
    floor: tuple[float, float, float]
    status: str
    horizon: Reason


def averaged(scene: Scene, state: Sequence[float], times: np.ndarray, order: int = 1) -> AveragedMotion:
    """Averaged motion from `state` (three numbers, rad/s, or {"omega": ...}) at t = 0; times: (n,) s, any
    order and sign.

    D3 is J0; axes 1, 2 have moments near it, the gyrostatic moment lies along axis 3. The small parameter eps
    is the larger of |D1 - D3|, |D2 - D3| over D3. Errors in A and r over t ~ 1/eps^2: eps (first order),
    eps^2 (second); after a passage through nu = 0 with M1, M2 or D1 != D2, whose jump of size sqrt(eps)
    depends on the phase there: eps^(1/2) and eps^(3/2). In the phase one order less. Raises InputError where
    the scene does not fit the assumptions and says which.
    """
    if order not in (1, 2):
        raise InputError(f"order: expected 1 or 2, got {order!r}")
    omega, times = omega_of(state), numbers_in_a_row(times, "times")
    check(scene)
    numbers = constants(scene)
    small = Smallness.of(numbers, omega)
    small.refuse()
    model = _Model(scene, numbers, omega, order)
    start = model.inward(omega)
    w0, failure = complex(start[0], -start[1]), None
    rows: dict[Any, Any] = {}
    for sense in (-1, 1):
        grid = np.unique(times[times * sense > 0] * sense)
        if grid.size:
            result, ended = model.run(w0, start[2], grid, sense)
            rows |= {sense * t: row for t, row in zip(grid, result)}
            failure = ended if failure is None else failure.then(ended)
    rows[0.0] = (w0, start[2], 0.0, math.atan2(w0.imag, w0.real))
    reached = np.array([t for t in times if t in rows])
    W, r, psi, angle = (np.array([rows[t][i] for t in reached]) for i in range(4))
    omega = model.outward(W * np.exp(1j * psi), r.real)
    return AveragedMotion(reached, np.abs(W), r.real, psi.real + angle.real, omega, order, small.eps,
                          model.floor,
                          "stopped" if failure else "reached", small.horizon(order),
                          reason=failure or ALL_REACHED)


def omega_of(state) -> np.ndarray:
    """Three numbers, or the block omega of a state."""
    return three_numbers(state["omega"] if isinstance(state, dict) and "omega" in state else state)


OF_MOMENTS = Sentence("averaging-ratio-of-moments", "(D1 + D2)/2 - D3 against D3")()
OF_SPLITTING = Sentence(
    "averaging-ratio-of-splitting",
    "the splitting D1 - D2 against the turn it disturbs (|D1 + D2 - 2 D3| |ω|/2 + |Γ|)")()
OF_LIQUID = Sentence("averaging-ratio-of-liquid", "the liquid (κ (|ω| + |Γ|/J0)/J0)")()
OF_TORQUE = Sentence(
    "averaging-ratio-of-torque",
    "the torque (|M|/(J0 |ω|²), with |Γ|/J0 or the steady spin M3/(ζ J0) where that is larger)")()
OF_MOMENTUM = Sentence("averaging-ratio-of-momentum", "Γ against J0 |ω|, for first order")()
ACROSS = Sentence(
    "averaging-ratio-of-torque-across",
    "the torque across {axis}, left out in first order, against the turn")(axis=Axis(3))
NOT_SMALL = Sentence(
    "averaging-not-small", "averaging needs small disturbances: {ratio} is {value}, expected it below 1 "
    "(much below 1 for a close answer); use the exact motion (`trajectory`) here")
NO_CONVERGENCE = Sentence(
    "averaging-not-converging", "averaging to second order needs smaller disturbances: the change of the "
    "initial values to averaged variables does not converge (off by {off}); use order 1 or the exact motion")
NOT_OSCILLATING = Sentence(
    "printed-averaging-needs-oscillation", "the printed solution does not exist here: it needs "
    "(D1'r - g)(D2'r - g) > 0 at the start, got {product}")
ERRORS_UP_TO = Sentence(
    "averaging-errors-up-to", "errors of order ε^{order} (ε = {small}) in amplitude and spin up to about t = "
    "{time} (the time of the slow change), in the phase they grow with time")
ERRORS_ALWAYS = Sentence(
    "averaging-errors-always", "errors of order ε^{order} (ε = {small}) in amplitude and spin up to about "
    "all times (the time of the slow change), in the phase they grow with time")
DOUBTFUL = Sentence("averaging-doubtful", "doubtful here, for {ratio} is {value}")
STOPPED_AT = Sentence("averaged-run-stopped", "the run stopped at {time}: {why}")
NO_REAL_VALUE = Sentence(
    "printed-no-real-value", "the printed q has no real value at {time}: (D1'r - g)(D2'r - g) is not "
    "positive there")
AVERAGED = Sentence("averaged-model", "averaged equations of order {order}, ε = {small}")


@dataclass(frozen=True)
class Smallness:
    """The numbers whose smallness the averaging assumes; `ratios`: name -> number that must stay below 1;
    `soft`: those that only make the answer doubtful. eps: small parameter; slow: fastest slow rate, 1/s."""

    eps: float
    ratios: dict
    soft: dict
    slow: float

    @classmethod
    def of(cls, numbers: Mapping[str, Fraction], omega: np.ndarray) -> Smallness:
        J, d, h, g, kappa, zeta, *M = (float(numbers[n]) for n in NAMES)
        moment, size = math.hypot(*M), float(np.linalg.norm(omega))
        turn = (abs(d) * size + abs(g)) / J
        speed = max(size, abs(g) / J)
        ratios = {OF_MOMENTS: 2 * abs(d) / J,
                  OF_SPLITTING:
                      abs(h) * size / (J * turn) if turn else (math.inf if h * size else 0.0),
                  OF_LIQUID: kappa * speed / J,
                  OF_TORQUE:
                      _over(moment / J, max(speed, abs(M[2]) / (zeta * J) if zeta else 0.0) ** 2)}
        slow = max(zeta, kappa * speed * turn / J, _over(moment, J * speed))
        # The liquid torque is of second degree in Gamma and the turn by Gamma is in nu: a large one spoils
        # first order only.
        # First order leaves M1, M2 out: their share comes round with the turn, if there is one.
        soft = {OF_MOMENTUM: _over(abs(g) / J, size) if kappa else 0.0,
                ACROSS: _over(
                    math.hypot(*M[:2]) / J, turn * speed)}
        return cls((abs(d) + abs(h)) / J, ratios, soft, slow)

    def refuse(self):
        """InputError for the first ratio that is not below 1."""
        for key, ratio in self.ratios.items():
            if not ratio < 1:
                raise Refused(NOT_SMALL(ratio=key, value=Quantity(ratio, digits=3)))

    def horizon(self, order) -> Reason:
        """How far the answer may be trusted."""
        ratios = self.ratios | (self.soft if order == 1 else {})
        largest = max(ratios, key=ratios.get)
        worst, small = ratios[largest], Quantity(self.eps, digits=3)
        result = (ERRORS_UP_TO(order=order, small=small, time=Time(1 / self.slow, digits=3)) if self.slow
                 else ERRORS_ALWAYS(order=order, small=small))
        return result.then(DOUBTFUL(ratio=largest, value=Quantity(float(worst), digits=2))
                          if worst > 0.3 else None)


def _over(a: float, b: float):
    return a / b if b else (math.inf if a else 0.0)


class _Model:
    """The averaged equations of one scene as plain numbers."""

    def __init__(self, scene: Scene, numbers: Mapping[str, Fraction], omega: np.ndarray, order: int):
        self.order = order
        self.parameters = [float(numbers[n]) for n in NAMES]
        J, d, h, g = self.parameters[:4]
        self.slope, self.offset = d / J, float(numbers["Gamma"] / numbers["J0"])
        size = float(np.linalg.norm(omega))
        harmonics = abs(h) * size / J + (math.hypot(*self.parameters[6:8]) / (J * size) if size else 0.0)
        self.width = max(SHARE * (abs(d) * size + abs(g)) / J, GUARD * harmonics)
        self.logarithmic = not any(self.parameters[6:8]) and bool(omega[0] or omega[1])
        smallest = RTOL * 1e-2 * max(float(np.abs(omega).max()), self.width, 1e-300)
        self.floor = (0.0, 0.0, smallest) if self.logarithmic else (smallest,) * 3
        self.means, self.kept, self.near = _functions(normal_form(scene), order,
                                                      frozenset(n for n in NAMES if not numbers[n]))

    def removal(self, nu: np.ndarray):
        """m = (1 - K)/nu, its derivative, and K = exp(-(nu/width)^4); without a width everything is kept."""
        if not self.width:
            return nu * 0.0, nu * 0.0, nu * 0.0 + 1.0
        x = np.clip(nu / self.width, -1e60, 1e60)
        retained = np.exp(-x**4)
        safe = np.where(x == 0, 1.0, x)
        fraction = np.where(x == 0, 0.0, -np.expm1(-x**4) / safe)
        return fraction / self.width, (4 * x**2 * retained - fraction / safe) / self.width**2, retained

    def near_identity(self, Z: np.ndarray, r: np.ndarray):
        """(U_Z, U_r) at averaged variables; complex and real."""
        uz, ur = self.near(Z, np.conj(Z), r, *self.removal(self.slope * r - self.offset), *self.parameters)
        return uz, np.real(ur)

    def outward(self, Z: np.ndarray, r: np.ndarray):
        """(n, 3) angular velocity of the averaged variables Z, r, each (n,)."""
        if self.order == 2:
            uz, ur = self.near_identity(Z, r)
            Z, r = Z + uz, r + ur
        return np.stack([np.real(Z), -np.imag(Z), r], axis=-1)

    def inward(self, omega: np.ndarray):
        """Averaged (p, q, r) of an angular velocity: the change of variables undone. Raises InputError if it
        cannot be."""
        y = omega.copy()
        if self.order == 1:
            return y
        scale = float(np.abs(omega).max())
        for _ in range(INVERSIONS):
            miss = omega - self.outward(np.array([complex(y[0], -y[1])]), y[2:])[0]
            y = y + miss
            if not np.abs(miss).max() > 4e-16 * scale:
                return y
        if np.abs(miss).max() < 1e-13 * scale:
            return y
        raise Refused(NO_CONVERGENCE(off=Rate(float(np.abs(miss).max()), digits=2)))

    def rates(self, t: float, y: np.ndarray):
        """Rates of (Re W, Im W, r, psi), or of (log |W|, arg W, r, psi); none where an amplitude leaves the
        range of doubles."""
        try:
            return self._rates(y)
        except OverflowError:
            return [math.nan] * 4

    def _rates(self, y: np.ndarray):
        W = cmath.exp(complex(max(y[0], LEAST), y[1])) if self.logarithmic else complex(y[0], y[1])
        r, psi = y[2], y[3]
        nu = self.slope * r - self.offset
        removal = self.removal(nu) if self.order == 2 else (0.0, 0.0, 0.0)
        turn, spin = self.means(abs(W) ** 2, r, *removal, *self.parameters)
        kept_W = kept_r = 0.0
        if removal[2]:
            unit = complex(math.cos(psi), math.sin(psi))
            Z = W * unit
            kept_W, kept_r = self.kept(Z, Z.conjugate(), r, *removal, *self.parameters)
            kept_W = kept_W * unit.conjugate()
        turn = complex(turn)
        dW = turn.real + kept_W / W if self.logarithmic else W * turn.real + kept_W
        return [dW.real, dW.imag, complex(spin + kept_r).real, nu + turn.imag]

    def run(self, w0: complex, r0: float, grid: np.ndarray, sense: int):
        """([(W, r, psi, unwrapped angle of W)] at the times of grid, failure or None); grid > 0, run backward
        for sense -1."""
        from scipy.integrate import solve_ivp
        fine = np.union1d(grid, np.linspace(0.0, grid[-1], SAMPLES))
        W = cmath.log(w0) if self.logarithmic else w0
        with np.errstate(all="ignore"):
            run = solve_ivp(lambda t, y: [sense * v for v in self.rates(t, y)], (0.0, grid[-1]),
                            [W.real, W.imag, r0, 0.0], "DOP853",
                            t_eval=fine, rtol=RTOL, atol=[RTOL, RTOL, self.floor[2], self.floor[2]]
                            if self.logarithmic else self.floor[2])
        W = run.y[0] + 1j * run.y[1]
        W, angle = (np.exp(W), W.imag) if self.logarithmic else (W, np.unwrap(np.angle(W)))
        wanted = np.isin(run.t, grid)
        rows = list(zip(W[wanted], run.y[2][wanted], run.y[3][wanted], angle[wanted]))
        return rows, None if run.success else STOPPED_AT(
            time=Moment(float(sense * run.t[-1])), why=run.message)


@lru_cache(maxsize=32)
def _functions(form: NormalForm, order: int, absent: frozenset[str]):
    """(means(S, r, m, m1, K, ...), kept(Z, Zc, r, m, m1, K, ...), near(...)) up to an order; absent: names
    that are 0."""
    from sympy import Symbol, expand
    Z, Zc, r, m, m1, K = form.variables
    gone = {s: 0 for s, n in zip(form.symbols, NAMES) if n in absent}
    means = [sum(part[:order]) for part in (form.turn, form.spin)]
    retained = [sum(parts) for parts in zip(*form.kept)]
    inner = [r, m, m1, K, *form.symbols]
    return tuple(lambdified([*first, *inner], [expand(e.subs(gone)) for e in expressions], cse=True)
                 for first, expressions
                 in (([Symbol("S", real=True)], means), ([Z, Zc], retained), ([Z, Zc], form.near)))


# log A below which A'/A and phi' are those at A = 1e-100: what is left out is of the order of A, and A^3 is
# still a double


def polar(scene: Scene, state: Sequence[float], times: np.ndarray) -> dict[str, np.ndarray]:
    """{"amplitude": (n,) rad/s, "spin": (n,) rad/s, "phase": (n,) rad, unwrapped} of the exact motion from
    `state` (as of `averaged`).

    times: (n,) s, increasing from 0 or later. Relative tolerance 1e-13. Raises InputError for a scene that
    averaging does not cover, for a torque across axis 3, which keeps the amplitude from dying out, and for a
    start on that axis, which has no phase.
    """
    check(scene)
    (p, q, r), times = omega_of(state), numbers_in_a_row(times, "times")
    rate = to_numpy(derive(scene)).rate
    if any(rate([0.0, 0.0, 1.0])[:2]) or not math.hypot(p, q):
        raise InputError("amplitude and phase: expected no torque across axis 3 and a start off that axis")

    def slow(_: float, y: np.ndarray):
        A, c, s = math.exp(max(y[0], LEAST)), math.cos(y[1]), math.sin(y[1])
        dp, dq, dr = rate([A * c, -A * s, y[2]])
        return (dp * c - dq * s) / A, -(dp * s + dq * c) / A, dr

    from scipy.integrate import solve_ivp
    run = solve_ivp(slow, (0.0, times[-1]), (math.log(math.hypot(p, q)), math.atan2(-q, p), r), "DOP853",
                    t_eval=times, rtol=FALLBACK_RTOL,
                    atol=FALLBACK_RTOL)
    if not run.success:
        raise InputError(f"amplitude and phase: the run stopped at t = {run.t[-1] if len(run.t) else 0:.6g} "
                         f"s: {run.message}")
    return {"amplitude": np.exp(run.y[0]), "spin": run.y[2], "phase": run.y[1]}


# --- The polynomials as printed
@dataclass(frozen=True)
class PrintedMotion(Reasoned):
    """The printed solution at the asked-for times.

    t: (n,) s, up to where it exists; amplitude a of p, rad/s, spin r, rad/s, phase phi, rad: (n,); omega: (n,
    3) rad/s, body frame, by (14). status: "reached" or "stopped"; reason: why.
    """

    t: np.ndarray
    amplitude: np.ndarray
    spin: np.ndarray
    phase: np.ndarray
    omega: np.ndarray
    status: str = "reached"
    reason: Reason = field(default=ALL_REACHED, kw_only=True)


@dataclass(frozen=True)
class Polynomials:
    """(24)-(26) of one scene and start: Taylor coefficients of a, r, phi in t, in s (tau = eps t, so eps
    drops out)."""

    a: tuple
    r: tuple
    phi: tuple
    d: tuple
    gamma: float
    J0: float

    @classmethod
    def of(cls, scene: Scene, omega: np.ndarray) -> Polynomials:
        check(scene)
        n = {k: float(v) for k, v in constants(scene).items()}
        exact, (p, q, r) = scene.body.exact, omega
        d1, d2 = float(exact[0] - exact[2]), float(exact[1] - exact[2])
        x1, x2 = d1 * r - n["Gamma"], d2 * r - n["Gamma"]
        if not x1 * x2 > 0:
            raise Refused(NOT_OSCILLATING(product=Quantity(x1 * x2, "(N m s)^2", 3)))
        formula, om = formulas(), math.sqrt(x1 * x2) / n["J0"]
        # eps = 1, so that d1, d2 are the differences themselves; lambda of (24) and B' of (25) read as zeta
        # and D2'
        values = {"ep": 1.0, "J0": n["J0"], "g": n["Gamma"], "zt": n["zeta"], "lam": n["zeta"], "M3": n["M3"],
                  "d1": d1, "d2": d2, "d3": d2, "r": r,
                  "Lam": n["kappa"] / n["J0"] ** 3}  # (23)
        # (13)
        a, phi = formula("a_13", values, p0=p, q0=x2 / n["J0"] * q,
                         om=om), math.atan2(-q * math.copysign(math.sqrt(x2 / x1), x2), p)
        f1, f2 = formula("f1_27", values, a=a), formula("f2_28", values, a=a)
        second = [formula(name, values, a=a, f1=f1, f2=f2) for name in ("a2_24", "r2_26", "phi2_25")]
        return cls((a, formula("a1_24", values, a=a), second[0] / 2), (r, f2, second[1] / 2),
                   (phi, formula("f3_29", values), second[2] / 2), (d1, d2),
                   n["Gamma"], n["J0"])

    def at(self, t: np.ndarray):
        """(a, r, phi, omega) at the times t (n,); rows of omega are NaN where (14) has no real value."""
        a, r, phi = (np.polyval(c[::-1], t) for c in (self.a, self.r, self.phi))
        x1, x2 = (d * r - self.gamma for d in self.d)
        with np.errstate(all="ignore"):
            om = np.sqrt(np.where(x1 * x2 > 0, x1 * x2, np.nan)) / self.J0
            # (14)
            q = formulas()("q_13", {"J0": self.J0, "a": a, "om": om, "ph": phi, "d2": self.d[1], "r0": r,
                                    "g": self.gamma})
        return a, r, phi, np.stack([a * np.cos(phi), q, r], axis=-1)


def formulas():
    """The paper's formulas; SymPy is imported with the first of them."""
    return printed_formulas("liquid-cavity")


def printed(scene: Scene, state: Sequence[float], times: np.ndarray) -> PrintedMotion:
    """The paper's solution from `state` (three numbers, rad/s, or {"omega": ...}) at times (n,) >= 0,
    increasing, s.

    Raises InputError where the scene is not the paper's (as `averaged`) and where the printed formulas have
    no real value at the start.
    """
    omega, times = omega_of(state), numbers_in_a_row(times, "times")
    if (times < 0).any() or (np.diff(times) <= 0).any():
        raise InputError("times: expected increasing times, 0 or later")
    poly = Polynomials.of(scene, omega)
    a, r, phi, w = poly.at(times)
    good = np.isfinite(w).all(axis=1)
    count = len(times) if good.all() else int(np.argmin(good))
    reason = ALL_REACHED if count == len(times) else NO_REAL_VALUE(time=Moment(float(times[count])))
    return PrintedMotion(times[:count], a[:count], r[:count], phi[:count], w[:count],
                         "reached" if count == len(times) else "stopped", reason=reason)


# --- The averaged models of a body with a liquid or a resistance, as models of a case
MODELS = ("averaged1", "averaged2", "printed")


def applies(scene: Scene) -> bool:
    """Whether averaging covers the scene."""
    if not {e.name for e in scene.effects} & {"liquid_cavity", "resistance"}:
        return False
    try:
        check(scene)
    except InputError:
        return False
    return True


def follow(model, case, times, order=None) -> Simulation:
    """The case's motion by an averaged model, or by the paper's polynomials."""
    run: PrintedMotion | AveragedMotion
    error = {}
    if model == "printed":
        run = printed(case.scene, case.state, times)
        how, reason = "Galal et al. (24)-(26)", run.reason
    else:
        result = run = averaged(case.scene, case.state, times, order=int(model[-1]))
        error = {"omega": np.array(result.floor), "amplitude": np.array(result.floor[0]),
                 "spin": np.array(result.floor[2])}
        how, reason = (AVERAGED(order=result.order, small=Quantity(result.eps)).text(),
                       result.reason.then(result.horizon))
    state = {"omega": run.omega, "amplitude": run.amplitude, "spin": run.spin, "phase": run.phase}
    return Simulation(np.asarray(run.t), state, model, how, None, status=run.status, reason=reason,
                      error=error)
