"""When a motion reaches a limit: results, and roots along a run in machine precision.

How long a small torque across the axis leaves a bounded motion below a rate is here as well.

The error of a run's roots is shown by a second run from a start moved in its last place (`by_run`).

The drift of a motion that is bounded by a torque on an axis (`stays_below`):

Axis i carries the torque, j, k follow it cyclically, and the wheel has no momentum along i. Let a_j = D_j -
D_i, a_k = D_k - D_i be of one sign (the major or the minor axis), c_j = -l_j/a_j, c_k = -l_k/a_k, and

    p = (D_j |a_j|)^(1/2) (omega_j - c_j),  q = (D_k |a_k|)^(1/2) (omega_k - c_k),  p + i q = rho exp(-i
    theta),
    n = sgn(a) (a_j a_k / (D_j D_k))^(1/2).

With the torque (M_i, s_j, s_k) Euler's equations give (p + i q)' = -i n omega_i (p + i q) + mu, mu =
(|a_j|/D_j)^(1/2) s_j + i (|a_k|/D_k)^(1/2) s_k. So

    |rho'| <= |mu|,    |theta' - n omega_i| <= |mu|/rho,    T' = M_i omega_i + s_j omega_j + s_k omega_k

for the kinetic energy T, and E = T - (M_i/n)(theta - theta(0)) drifts by no more than |s||omega_perp| +
|M_i/n||mu|/rho. On the axis (s = 0) rho and E are the integrals of the motion. As D_i omega_i^2/2 = E - V, V
= T_perp(rho, theta) - (M_i/n)(theta - theta(0)), the phase cannot pass a place theta_b while E < V there.
Given a time t: rho lies within |mu| t of its start, E within its drift; if at some theta_a behind and theta_b
ahead the least V over these rho exceeds the most E, the phase stays between them until t, and |omega| stays
below its most there."""
from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import Caveat
from ..integrate.events import zeros_passed
from ..integrate.to_heyoka import TAYLOR_TOLERANCE
from ..numbers.exact import precise
from ..numbers.vectors import CYCLE, Exact3, Float3
from ..physics.coefficients import limits_of
from ..physics.effects import effect_class
from ..physics.equations import Equations, derive, rotation
from ..physics.own_unit import in_unit, mass_unit, own_unit, rows_in_unit
from ..physics.scene import AnyScene, Rows, Scene, euler_coefficients, rates_of, slices
from ..physics.states import equations_and_start, moved_row, to_space
from ..physics.to_numpy import Form, form, to_numpy
from ..reasons import Quantity, Reasoned, Sentence
from ..representation import Answer, Compared
from .limit import Limit, Momentum

if TYPE_CHECKING:
    from ..physics.law_limits import Validity

# --- What is known of the first time at which a limit is reached
@dataclass(frozen=True, repr=False, eq=False)
class TimeTo(Answer, Compared):
    """The first times (...,) at which states (..., 3) reach a limit, in the scene's time: each is between low
    and high.

    Both inf: never. high NaN: not known; then the limit is not reached before low. level (...,), texts:
    "exact" (a law, or all extremes), "proved" (the motion enclosed by a proof), "certified" (the theorem of
    spin-up, applied to a run of machine precision), "run" (roots along a run of machine precision, wider by
    what a second run shows), "undecided". reason (...,): how it is known; words (...,): the same behind the
    quantity, in SI units. quantity: what was asked, in words. caveats: what limits the answers
    (`answers.caveats`); ending: how the motion of a case ends that loses energy
    (`answers.dissipation.ending`), where it does; tilt: what other directions and sizes of the torque of a
    case do, None where that was not looked at; decimals: of one motion, the time written out, where digits
    were asked for and a formula gives them.
    """

    low: np.ndarray
    high: np.ndarray
    level: np.ndarray
    reason: np.ndarray
    quantity: str = ""
    scene: Any = field(default=None, repr=False, compare=False)
    states: np.ndarray | None = field(default=None, repr=False, compare=False)
    ending: Any = field(default=None, compare=False)
    tilt: Any = field(default=None, repr=False, compare=False)
    decimals: str | None = None

    @cached_property
    def words(self) -> np.ndarray:
        """(...,) texts: the quantity and how the answer is known."""
        reasons = np.array(self.reason, object)
        printed = [f"{self.quantity}: {item}" if str(item) else self.quantity for item in reasons.ravel()]
        return np.array(printed, object).reshape(reasons.shape)[()]

    @cached_property
    def validity(self) -> Validity | None:
        """Of an approximate law (`stabilab.physics.law_limits`) at the start; None where all laws are exact.
        """
        limits = limits_of(self.scene)
        return limits.validity(self.scene, self.states) if limits else None

    def __iter__(self) -> Iterator[np.ndarray]:
        return iter((self.low, self.high))


BY_ROOTS = Sentence("roots-along-run", "roots along a run in machine precision")()
BY_TWO_RUNS = Sentence(
    "roots-along-two-runs", "roots along a run in machine precision, the error from a second one")()
STEPS_END = Sentence("not-reached-in-steps", "not reached within {time} ({steps} steps)")
TIME_ENDS = Sentence("not-reached-in-time", "not reached within {time} (t_max)")
SECOND_DOES_NOT = Sentence(
    "second-run-does-not", "roots along a run in machine precision find it after {time}, a second run from a "
    "start moved in its last place does not: rounding errors decide it")
ONLY_NEAR = Sentence(
    "comes-near-only", "roots along a run in machine precision find it after {time}, but not a limit farther "
    "by {share} of it: the motion may come near it and no farther")


@dataclass(frozen=True)
class Found(Reasoned):
    """The answer of one motion; fields as of `TimeTo`, plain numbers; steps: that its run took."""

    low: float
    high: float
    level: str
    steps: int = 0

    @property
    def time(self) -> tuple[float, float] | None:
        """(low, high); None where it is never within what is known."""
        return (self.low, self.high) if math.isfinite(self.high) else None

    @property
    def never(self) -> bool:
        """Whether it is known never to be reached."""
        return math.isinf(self.low)


def times_of(result: Sequence[Found], shape: tuple[int, ...], quantity: str, scene: AnyScene,
             states: np.ndarray, caveats: tuple[Caveat, ...]) -> TimeTo:
    """The answers of motions, one after another, in this shape."""
    column = lambda name, kind: np.array([getattr(item, name) for item in result], kind).reshape(shape)[()]
    return TimeTo(column("low", float), column("high", float), column("level", object),
                  column("reason", object), quantity, scene, states, caveats=caveats)


DRIFT_ROUNDING = 1e-9  # of the limit's square: far beyond the rounding of these lines
PHASES = 720  # to a turn of the phase; between them a bound of the slope counts
BEHIND = 4  # turns that are looked at against the torque
HALVINGS = 50


def stays_below(scene: Scene, state: Float3, rate: float, sideways: float,
                along: tuple[float, float]) -> float:
    """A time before which |omega| < `rate`, for every torque whose component along its axis is within `along`
    (N m) and whose part across it is at most `sideways`; constant, but otherwise any. scene: with the torque
    on an axis; state: three floats, rad/s. 0 where nothing is proved."""
    D, l = (np.array([float(v) for v in row]) for row in (scene.body.exact, scene.vector("gyrostat")))
    # T = W^2/2: |W'| <= |D^(-1/2) M| bounds |omega| <= W/min(D)^(1/2)
    smallest, torque = math.sqrt(D.min()), math.hypot(sideways, max(along, key=abs))
    room = rate * smallest - math.sqrt(D @ np.square(state))
    crude = max(0.0, room) * smallest / torque * (1 - DRIFT_ROUNDING)
    i = next(n for n, m in enumerate(scene.vector("constant_torque")) if m)
    j, k = CYCLE[i]
    a = np.array([D[j] - D[i], D[k] - D[i]])
    if not a[0] * a[1] > 0 or l[i]:
        return crude
    well = _Well(D[[i, j, k]], l[[j, k]], a, np.array(state, float)[[i, j, k]], rate, sideways, along)
    if not well.rho > 0 or not sideways > 0:
        return crude
    low, high = 0.0, well.rho / well.pull
    if not well.holds(low):
        return crude
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if well.holds(middle) else (low, middle)
    return float(max(crude, low))


class _Well:
    def __init__(self, D: np.ndarray, l: np.ndarray, a: np.ndarray, omega: np.ndarray, rate: float,
                 sideways: float, along: tuple[float, float]) -> None:
        self.D, self.rate, self.sideways, self.along = D, rate, sideways, along
        self.centre, self.scale = -l / a, np.sqrt(D[1:] * np.abs(a))
        self.n = math.copysign(math.sqrt(a[0] * a[1] / (D[1] * D[2])), a[0])
        p, q = self.scale * (omega[1:] - self.centre)
        self.rho, self.theta = math.hypot(p, q), -math.atan2(q, p)
        self.energy = 0.5 * float(D @ omega**2)
        self.pull = sideways * math.sqrt(max(abs(a) / D[1:]))  # of |mu|
        ahead = math.copysign(1.0, along[0] * self.n)
        self.step = 2 * math.pi / PHASES
        self.behind, self.ahead = (sense * np.arange(turns * PHASES + 1) * self.step
                                   for sense, turns in ((-ahead, BEHIND), (ahead, 1)))

    def holds(self, t: float) -> bool:
        """Whether |omega| is surely below the rate up to t."""
        rhos = self.rho - self.pull * t, self.rho + self.pull * t
        if not rhos[0] > 0:
            return False
        tilt = max(map(abs, self.along)) / abs(self.n)
        across = math.hypot(*self.centre) + rhos[1] / min(self.scale)
        energy = self.energy + t * (self.sideways * across + tilt * self.pull / rhos[0])
        inside = []
        for route in (self.behind, self.ahead):  # up to the first place that the phase cannot pass
            smallest = -self._greatest(route, rhos, -0.5 * self.D[1:], 1.0)
            closed = np.nonzero(smallest > energy * (1 + DRIFT_ROUNDING))[0]
            if not closed.size:
                return False
            inside.append(route[:closed[0] + 1])
        # the most of |omega|^2 at these places and half a step around them
        weights = 1 - self.D[1:] / self.D[0]
        value = 2 * energy / self.D[0] + self._greatest(np.concatenate(inside), rhos, weights, 2 / self.D[0])
        fastest = np.abs(self.centre) + rhos[1] / self.scale
        slope = (2 * np.abs(weights) * fastest * rhos[1] / self.scale).sum() + 2 / self.D[0] * tilt
        return bool(value.max() + slope * self.step / 2 < self.rate**2 * (1 - DRIFT_ROUNDING))

    def _greatest(self, route: np.ndarray, rhos: tuple[float, float], weights: np.ndarray,
                  factor: float) -> np.ndarray:
        """Greatest of weights . omega_perp^2 + factor (M_i/n)(theta - theta(0)) over the radii and the torque
        along the axis, at each place."""
        theta = self.theta + route
        across = np.stack([np.cos(theta), -np.sin(theta)], axis=-1) / self.scale
        square, linear = across**2 @ weights, 2 * across @ (weights * self.centre)
        constant = float(self.centre**2 @ weights)
        ends = np.maximum(*(square * r * r + linear * r for r in rhos))
        with np.errstate(all="ignore"):
            top = -linear / (2 * square)
            ends = np.where((square < 0) & (rhos[0] < top) & (top < rhos[1]),
                            np.maximum(ends, -linear**2 / (4 * square)), ends)
        return ends + constant + factor * np.maximum(*(m / self.n * route for m in self.along))


RUN_STEPS = 300_000  # of each of the two runs
MOVED = 2.0  # places by which the second run's start is moved
WIDER = 4.0  # times what the two runs differ by
ROUNDING = 2.0**-50  # relative, of a time that both find alike
LOOK = 32  # steps after which a run that is one of many looks for its first zero: it may be short
VAGUE = 1e-6  # of a time: two runs that differ by more may have met the limit by rounding alone
HIGHER = Fraction(1, 2**44)  # of a limit: far beyond the rounding of a motion that settles there
FARTHEST = 10**300  # squares of rates that no run in doubles reaches
PRODUCTS = tuple(combinations_with_replacement(range(3), 2))  # of two rates


def by_run(scene: AnyScene, start: Any, limit: Limit, t_max: float = math.inf, steps: int = RUN_STEPS,
           beside: np.ndarray | None = None) -> Found:
    """The first crossing of the motion of any scene. start: numbers or blocks, as `trajectory` takes them;
    t_max: the scene's time; beside: the state from which the second run starts (None: moved in the start's
    last place)."""
    forms, state, rates, unit = _search(scene, start, limit)
    end = t_max * unit if math.isfinite(t_max) else 1e300
    item = zeros_passed(forms, state, rates, end, steps, first=True)
    if item.first is None:
        low = item.t * (1 - ROUNDING) / unit
        until = Quantity(low, scene.time_unit).lower
        ended = STEPS_END(time=until, steps=steps) if item.reason else TIME_ENDS(time=until)
        return Found(low, math.nan, "run", item.steps, reason=BY_ROOTS.then(ended, ": "))
    second = (moved_row(state, MOVED) if beside is None
              else np.concatenate([beside[:3] / unit, beside[3:]]))
    two = zeros_passed(forms, second, rates, end, 2 * steps, 4 * TAYLOR_TOLERANCE, first=True)
    at = Quantity(item.first / unit, scene.time_unit)
    if two.first is None:
        return Found(0.0, math.nan, "undecided", item.steps, reason=SECOND_DOES_NOT(time=at))
    blur = WIDER * abs(item.first - two.first) + ROUNDING * item.first
    if blur > VAGUE * item.first:
        further = 1 - HIGHER if limit.falls else 1 + HIGHER
        raised = tuple((terms, largest * further) for terms, largest in limit.parts)
        higher = _search(scene, start, replace(limit, parts=raised))[0]
        end = min(end, item.first + 2 * blur)
        if zeros_passed(higher, state, rates, end, 2 * steps, first=True).first is None:
            return Found(max(0.0, item.first - blur) / unit, math.nan, "undecided",
                         item.steps, reason=ONLY_NEAR(time=at, share=Quantity(float(HIGHER), digits=1)))
    return Found(max(0.0, item.first - blur) / unit, (item.first + blur) / unit, "run",
                 item.steps, reason=BY_TWO_RUNS)


def run_once(scene: AnyScene, state: Sequence[float], limit: Limit, t_max: float = math.inf,
             steps: int = RUN_STEPS, torque: Float3 | None = None, wheel: Float3 | None = None
             ) -> tuple[float, float]:
    """(time of the first crossing by one run, inf where none was found; the time until which none was): no
    word on their error.

    scene: wheel and torque; state: three floats; t_max: the scene's time. torque (N m), wheel (N m s): in
    place of the scene's, where many are compared: no scene is made of them.
    """
    forms, start, rates, unit = _search(scene, state, limit, torque, wheel)
    end = t_max * unit if math.isfinite(t_max) else 1e300
    result = zeros_passed(forms, start, rates, end, steps, first=True, look=LOOK)
    if result.first is not None:
        return result.first / unit, math.inf
    return math.inf, t_max if not result.reason and math.isfinite(t_max) else result.t / unit


def _search(scene: AnyScene, start: Sequence[float], limit: Limit, torque: Float3 | None = None,
            wheel: Float3 | None = None) -> tuple[Form, np.ndarray, Any, float]:
    """(rates followed by what vanishes at the limit, in the motion's own unit of rates; the start and its
    rates in it; that unit)."""
    if torque is not None and (limit.angular or not scene.plain):
        scene, torque = _with(scene, torque, wheel), None
    if limit.angular or not scene.plain:
        equations, state, unit, expressions = _asked(scene, start, limit)
        with np.errstate(all="ignore"):
            rates = to_numpy(equations)(state)
        return form(equations, (*equations.rhs, *expressions)), state, rates, unit
    rows, unit, state = _in_own_unit(scene, start, torque, wheel)
    return _quadratic(rows, limit.parts, Fraction(unit) ** 2), state, rates_of(rows, state.tolist()), unit


def _with(scene: Any, torque: Float3, wheel: Float3 | None) -> Scene:
    """The scene under a torque in place of its own, and with a momentum where one is given, in doubles."""
    replaced = {"constant_torque": torque} | ({} if wheel is None else {"gyrostat": wheel})
    return Scene(scene.body, *(effect for effect in scene.effects if effect.name not in replaced),
                 *(effect_class(name)(tuple(map(Fraction, vector))) for name, vector in replaced.items()))


def largest_rate(scene: AnyScene, state: Sequence[float], until: float, budget: int) -> tuple[float, float]:
    """(largest |omega| from 0 to `until`, rad/s; the time that the run reached, s): at its ends and where it
    is stationary."""
    rows, unit, start = _in_own_unit(scene, state)
    run = zeros_passed(_quadratic(rows), start, rates_of(rows, start.tolist()), until * unit, budget)
    sizes = [float(np.linalg.norm(item)) for item in (start, run.state, *run.states)]
    return max(sizes) * unit, run.t / unit


def _in_own_unit(scene: Any, state: Sequence[float], torque: Float3 | None = None,
                 wheel: Float3 | None = None) -> tuple[Rows, float, np.ndarray]:
    """(coefficients of the rates in the motion's own unit of rates, that unit, the start in it).

    In the unit of a feeble torque alone the events of the numbers would not be found."""
    rows = scene.quadratic().coefficients
    if torque is not None:
        kappa, rho, sigma, _ = rows
        rows = euler_coefficients(scene.body.exact, kappa, wheel or (0.0,) * 3, torque)
        rows = rows if wheel else (kappa, rho, sigma, rows[3])
    unit = own_unit(scene, state, rates_of(rows, list(state)))
    scaled = rows_in_unit(rows, unit)
    if scaled is None:  # says which number leaves the range of doubles
        scene = scene if torque is None else _with(scene, torque, wheel)
        scaled = in_unit(scene, unit, mass_unit(scene)).quadratic().coefficients
    return scaled, unit, np.array(state, float) / unit


def _quadratic(rows: Rows, parts: Sequence[Any] = (), square: Fraction = Fraction(1)) -> Form:
    """The rates of a scene of wheel and torque with these coefficients, and the limit's parts over the square
    of the unit."""
    state, symbols, expressions = _structure(len(parts))
    numbers = [*sum(zip(*rows), ())]
    for terms, largest in parts:
        numbers += [*_products(terms), float(min(largest / square, FARTHEST))]
    return Form(state, expressions, symbols, tuple(numbers))


@lru_cache(maxsize=16)
def _products(terms: tuple[tuple[Fraction, Exact3], ...]) -> list[float]:
    """The coefficients of `PRODUCTS` in sum c (a . omega)^2: many runs are compared at one limit."""
    return [float(sum(c * a[i] * a[j] * (1 + (i != j)) for c, a in terms)) for i, j in PRODUCTS]


@lru_cache(maxsize=4)
def _structure(parts: int) -> Any:
    """(state, coefficients, rates followed by events): where so many quadratic forms are at their limits;
    without any, where |omega| is stationary. All scenes have the same coefficients, so that it is compiled
    once."""
    from sympy import symbols
    extra: Any = symbols(f"e0:{7 * parts}", real=True) if parts else ()
    x, c = symbols("x1:4", real=True), symbols("c0:12", real=True)
    rates = [c[4 * i] * x[j] * x[k] + c[4 * i + 1] * x[k] + c[4 * i + 2] * x[j] + c[4 * i + 3]
             for i, (j, k) in enumerate(CYCLE)]
    events = [sum(e * x[i] * x[j] for e, (i, j) in zip(extra[7 * n:], PRODUCTS)) - extra[7 * n + 6]
              for n in range(parts)]
    return x, (*c, *extra), (*rates, *(events or [sum(v * rate for v, rate in zip(x, rates))]))


def _asked(scene: AnyScene, start: Any, limit: Limit) -> tuple[Equations, np.ndarray, float, list[Any]]:
    """(equations, state, unit, expressions that vanish at the limit), in units near the motion's own where
    these are known."""
    tilted = limit.kind == "tilt"  # it alone needs the attitude
    if limit.momentum is not None and scene.plain and not isinstance(start, dict):
        start = {"omega": tuple(start)[:3]}
    if tilted and not isinstance(start, dict):
        start = {name: tuple(start)[part] for name, part in slices(scene.blocks).items()}
    if tilted:
        start = {"attitude": (1.0, 0.0, 0.0, 0.0), **start}
    equations, state = equations_and_start(scene, start)
    unit = 1.0
    if set(equations.blocks) <= {"omega", "attitude"}:
        with np.errstate(all="ignore"):
            unit = own_unit(scene, state[:3].tolist(), np.asarray(to_numpy(equations)(state))[:3].tolist())
        mass = mass_unit(scene)
        if unit != 1 or mass != 1:
            scene = in_unit(scene, unit, mass)
            equations = derive(scene, equations.blocks)
            state = np.concatenate([state[:3] / unit, state[3:]])
    if limit.momentum is not None:
        return equations, state, unit, [_nutation(limit, scene, equations)]
    return equations, state, unit, _expressions(limit, equations, state, unit)


def _nutation(limit: Limit, scene: AnyScene, equations: Equations) -> Any:
    """a . H - |H| cos angle, of a scene in the unit of its equations."""
    from sympy import Rational, sqrt
    rational = lambda v: Rational(v.numerator, v.denominator)
    law, at = Momentum.made(scene), slices(equations.blocks)
    H = law.components(equations.state[:3], {name: equations.state[part] for name, part in at.items()
                                             if name != "omega"}, rational)
    ((_, direction),), angle = limit.parts[0]
    along = sum(rational(a) * v for a, v in zip(direction, H) if a)
    return along - rational(precise("cos", angle)) * sqrt(sum(v * v for v in H))


def _expressions(limit: Limit, equations: Equations, state: Sequence[float] | np.ndarray,
                 unit: float) -> list[Any]:
    """What vanishes at the limit, one expression a part, in the unit of rates."""
    from sympy import Float, Rational, cos
    rational = lambda v: Rational(v.numerator, v.denominator)
    if limit.kind != "tilt":
        omega = equations.state[:3]
        power = rational(Fraction(unit)) ** 2
        return [sum(rational(c) * sum(rational(a) * w for a, w in zip(vector, omega) if a) ** 2
                    for c, vector in terms) - rational(largest) / power
                for terms, largest in limit.parts]
    at = 3 + (3 if "gamma" in equations.blocks else 0)
    q = equations.state[at:at + 4]
    direction = limit.direction or ()
    first = limit.origin or to_space(state[at:at + 4], [float(v) for v in direction])
    rows = rotation(q)
    turned = sum(Rational(float(f)) * rational(a) * entry for f, row in zip(first, rows)
                 for a, entry in zip(direction, row) if a)
    return [turned - Rational(float(cos(Float(rational(limit.parts[0][1]), 30))))]
