"""The averaged equations of a nearly spherical body with a liquid, derived from the scene's equations as a
normal form of the slow turn; and where they end: their steady states, which attract, and how fast.

With D1 = J0 + e d + e^2 h, D2 = J0 + e d - e^2 h, D3 = J0, Gamma = e g, kappa = e kappa, resistance e^2 zeta,
torque e^2 M (e only counts orders: every answer is written in the physical numbers, e = 1) and Z = p - i q =
A exp(i phi)

    omega' = e X0 + e^2 X1 + e^3 X2 + ...,   X0: Z' = i nu Z, r' = 0,   nu = (d r - Gamma)/J0.

Coordinates y with omega = y + e U(y) are chosen so that y' = e X0 + e^2 Y1 + e^3 Y2 + O(e^4) turns with no
other dependence on the phase than near nu = 0, where no phase can be averaged away: a term of frequency n nu
is split into K(nu) and 1 - K(nu), K = exp(-(nu/width)^4); the first part stays in Y, the second is removed by
U through the factor m(nu) = (1 - K)/nu, which is regular everywhere. Far from nu = 0 this is classical
averaging, at nu = 0 the plain equations.

Steady states are those of A' = A alpha(r), r' = rho0(r) + A^2 rho1(r): the means of first and second order of
the body with D1 and D2 both at their mean and M1 = M2 = 0 (the harmonics of either leave such a state in
first order). The second order matters as soon as |Gamma| > J0 |r|: it holds the decay kappa Gamma^2/J0^3 of
the turn in the liquid. A steady state with A = 0 is a spin about axis 3; one with A > 0 is a regular
precession, the angular velocity going round axis 3 in the body.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from ..errors import InputError, Refused
from ..numbers.vectors import Number
from ..physics.effects.base import effect_words
from ..physics.equations import derive
from ..reasons import Axis, Momentum, Quantity, Rate, Reason, Reasoned, Sentence

if TYPE_CHECKING:
    from sympy import Expr

    from ..physics.scene import Scene


ORDERS = 3  # X0, X1, X2
ALLOWED = {"gyrostat", "constant_torque", "charge", "resistance", "liquid_cavity"}
NAMES = ("J0", "d", "h", "Gamma", "kappa", "zeta", "M1", "M2", "M3")


@dataclass(frozen=True)
class NormalForm:
    """Averaged equations as SymPy expressions of Z, its conjugate Zc, the spin r, m, its derivative m1 in nu,
    and K.

    symbols: of NAMES, in their order (physical numbers of a scene: `constants`); frequency: nu. turn: (h1,
    h2), the mean of Z'/Z beyond i nu at each order, in S = |Z|^2; spin: (g1, g2), the mean of r'; kept: ((Z
    part, r part), ...) what stays of the other harmonics, each times K already; near: (U_Z, U_r), the
    near-identity change of the variables.
    """

    variables: tuple
    symbols: tuple
    frequency: Number
    turn: tuple
    spin: tuple
    kept: tuple
    near: tuple


def constants(scene: Scene) -> dict:
    """Name of NAMES -> exact number of this scene (J0, D1 - J0 halved into mean d and split h, Gamma =
    lambda3 - k ...)."""
    D1, D2, D3 = scene.body.exact
    charge, liquid, resistance = (scene.effect(n) for n in ("charge", "liquid_cavity", "resistance"))
    gamma = scene.vector("gyrostat")[2] - (charge.exact if charge else 0)
    return dict(zip(NAMES, (D3, (D1 + D2) / 2 - D3, (D1 - D2) / 2, gamma, liquid.exact if liquid else 0,
                            resistance.exact if resistance else 0, *scene.vector("constant_torque"))))


def check(scene: Scene):
    """Raises InputError where the scene is not of the kind that the averaging is about."""
    if scene.variables == "scaled":
        raise InputError("averaging needs a physical scene (a body with a liquid, resistance, small "
                         "torques), got a scaled one")
    other = [e.with_article for e in scene.effects if e.name not in ALLOWED]
    if other:
        raise InputError(f"averaging covers {', '.join(map(effect_words, sorted(ALLOWED)))}; the scene also "
                         f"has {', '.join(other)}")
    if len(scene.blocks) > 1:
        raise InputError('averaging needs a constant angle of the charge (the angular velocity alone as '
                         'state), got angle = '
                         '"attitude": give the angle in rad')
    lam = scene.vector("gyrostat")
    if lam[0] or lam[1]:
        raise Refused(NEEDS_AXIS_3(momentum=Momentum(tuple(map(float, lam)))))


def normal_form(scene: Scene) -> NormalForm:
    """The averaged equations of the scene's effects, first and second order, in symbols. Raises InputError
    (`check`)."""
    check(scene)
    equations = derive(scene)
    return _normal_form(equations.state, equations.rhs, tuple(equations.symbols.items()))


@lru_cache(maxsize=32)
def _normal_form(state: Sequence[Expr], rhs: Sequence[Expr], items: Sequence[tuple[str, Expr]]) -> NormalForm:
    from sympy import I, Symbol, expand, symbols
    supplied = dict(items)
    p, q, r = state
    Z, Zc = symbols("Z Zc")
    m, m1, K = symbols("m m1 K", real=True)
    names = {n: Symbol(n, real=True, positive=n == "J0" or None) for n in NAMES}
    fields = _orders(rhs, supplied, names)
    into = {p: (Z + Zc) / 2, q: I * (Z - Zc) / 2}
    fields = [tuple(expand(f.subs(into)) for f in (x - I * y, z)) for x, y, z in fields]
    nu = expand(fields[0][0] / (I * Z))  # (d r - Gamma)/J0
    if nu.has(Z, Zc) or fields[0][1] != 0 or nu.diff(r, 2) != 0:
        raise InputError("averaging needs equations whose first order is a turn about axis 3; the effects of "
                         "this scene give another")
    slope = nu.diff(r)

    def by_r(f: Expr):  # m depends on r through nu
        return f.diff(r) + slope * m1 * f.diff(m)

    def along(f: Expr, v: Sequence[Expr]):
        """Derivative of f along the field v = (v_Z, v_r)."""
        return f.diff(Z) * v[0] + f.diff(Zc) * _conjugate(v[0], Z, Zc) + by_r(f) * v[1]

    first = _split(fields[1], Z, Zc, slope, m, K)
    U, Y1 = first.near, first.field(Z)
    rest = [fields[2][i] + along(fields[1][i], U) - along(U[i], Y1) for i in (0, 1)]
    rest[0] += I * slope * U[0] * U[1]  # half the second derivative of X0
    second = _split([expand(f) for f in rest], Z, Zc, slope, m, K)
    return NormalForm((Z, Zc, r, m, m1, K), tuple(names.values()), nu, (first.turn, second.turn),
                      (first.spin, second.spin),
                      (first.kept, second.kept), U)


def _orders(rhs: Sequence[Expr], supplied: Mapping[str, Expr], names: Mapping[str, Expr]):
    """The rates sorted by orders of e: [X0, X1, X2], each a triple in (p, q, r)."""
    from sympy import Integer
    J, d, h, g = (names[n] for n in ("J0", "d", "h", "Gamma"))
    swap = {supplied["D1"]: [J, d, h], supplied["D2"]: [J, d, -h], supplied["D3"]: [J]}
    if "lambda3" in supplied:  # Gamma = lambda3 - k: k must drop out
        swap[supplied["lambda3"]] = [supplied.get("k", Integer(0)), g]
    elif "k" in supplied:
        swap[supplied["k"]] = [Integer(0), -g]
    swap |= {supplied[n]: [0, names[n]] for n in ("kappa",) if n in supplied}
    swap |= {supplied[n]: [0, 0, names[n]] for n in ("zeta", "M1", "M2", "M3") if n in supplied}
    rows = [_series(rate, swap) for rate in rhs]
    if any(row[0] != 0 or any(c.has(*[supplied["k"]]) for c in row if "k" in supplied) for row in rows):
        raise InputError(
            "averaging needs a gyrostatic moment and a charge that act through their difference alone")
    return [tuple(row[n] for row in rows) for n in range(1, ORDERS + 1)]


def _series(expression: Expr, swap: Mapping[Expr, list[Expr]]):
    """Coefficients of e^0 ... e^3 of a Laurent polynomial whose symbols are themselves series in e."""
    from sympy import Add, Integer, Mul, expand
    total = [[] for _ in range(ORDERS + 1)]
    for term in Add.make_args(expand(expression)):
        series, plain = [Integer(1)] + [Integer(0)] * ORDERS, []
        for base, power in term.as_powers_dict().items():
            if base in swap:
                series = _times(series, _power(swap[base], int(power)))
            else:
                plain.append(base ** power)
        for n, c in enumerate(series):
            total[n].append(Mul(*plain) * c)
    return [expand(Add(*parts)) for parts in total]


def _times(u: Sequence[Expr], v: Sequence[Expr]):
    return [sum(u[i] * v[n - i] for i in range(n + 1)) for n in range(ORDERS + 1)]


def _power(series: Sequence[Number], n: int):
    from sympy import Integer
    a = [Integer(0) + c for c in series] + [Integer(0)] * (ORDERS + 1 - len(series))
    item = [Integer(1)] + [Integer(0)] * ORDERS
    if n < 0:  # 1/a, a0 != 0
        inverse = [1 / a[0]]
        for k in range(1, ORDERS + 1):
            inverse.append(-sum(a[i] * inverse[k - i] for i in range(1, k + 1)) / a[0])
        a, n = inverse, -n
    for _ in range(n):
        item = _times(item, a)
    return item


def _conjugate(f: Expr, Z: Expr, Zc: Expr):
    from sympy import I
    return f.subs({Z: Zc, Zc: Z, I: -I}, simultaneous=True)


@dataclass(frozen=True)
class _Split:
    """One order: mean turn and spin, kept harmonics, and the change of variables that removes the others."""

    turn: Number
    spin: Number
    kept: tuple
    near: tuple

    def field(self, Z: Expr):
        from sympy import Symbol
        S = Symbol("S", real=True)
        back = {S: Z * Symbol("Zc")}
        return (Z * self.turn.subs(back) + self.kept[0], self.spin.subs(back) + self.kept[1])


def _split(field: Sequence[Expr], Z: Expr, Zc: Expr, slope: Expr, m: Expr, K: Expr):
    """Mean, kept part and remover of one order; Z^a Zc^b has frequency (a - b) nu in r', (a - b - 1) nu in
    Z'."""
    from sympy import I, Symbol, expand
    S = Symbol("S", real=True)
    spin, kept_r, near_r = _harmonics(field[1], Z, Zc, 0, m, K, S)
    # the turn of the removed part of r': nu depends on r
    turn, kept_Z, near_Z = _harmonics(expand(field[0] + I * slope * Z * near_r), Z, Zc, 1, m, K, S)
    return _Split(turn, spin, (kept_Z, kept_r), (near_Z, near_r))


def _harmonics(f: Expr, Z: Expr, Zc: Expr, shift: int, m: Expr, K: Expr, S: Expr):
    from sympy import I, Integer, Poly
    mean = retained = nearby = Integer(0)
    for (a, b), c in Poly(f, Z, Zc).terms() if f != 0 else ():
        n = a - b - shift
        if n == 0:
            mean += c * S ** b
        else:
            retained += K * c * Z**a * Zc**b
            nearby += m * c / (I * n) * Z**a * Zc**b
    return mean, retained, nearby


NEEDS_AXIS_3 = Sentence(
    "averaging-needs-axis-3", "averaging needs a gyrostatic moment along axis 3, got {momentum}")
SPIN_ALONE = Sentence(
    "averaged-spin-alone", "spin about {axis}: amplitude and spin change each at their own rate")
PRECESSION = Sentence(
    "averaged-precession", "regular precession: the liquid feeds the amplitude as fast as the rest takes "
    "it")()
EVERY_SPIN = Sentence(
    "averaged-every-spin", "every spin about {axis} (A = 0, any r): in these equations nothing attracts or "
    "repels")
EVERY_SPIN_GROWS = Sentence(
    "averaged-every-spin-grows", "every spin about {axis} (A = 0, any r), the amplitude growing at the rate "
    "{rate}")
EVERY_STATE = Sentence(
    "averaged-every-state", "every amplitude and spin: in these equations nothing changes them")()
COMES_BACK = Sentence(
    "averaged-comes-back", "the angular velocities with r = {spin} and any A: the turn stands still there; a "
    "neighbour comes back at the rate {rate} A² 1/s (A in rad/s)")
LEAVES = Sentence(
    "averaged-leaves", "the angular velocities with r = {spin} and any A: the turn stands still there; a "
    "neighbour leaves at the rate {rate} A² 1/s (A in rad/s)")
ALL_STEADY = Sentence(
    "averaged-all-steady", "averaged equations A' = A α(r), r' = ρ0(r) + A² ρ1(r) of the body with D1 = D2: "
    "all their steady states")()
NO_RESISTANCE = Sentence(
    "averaged-no-resistance", "there is none: the torque M3 has no resistance to balance it")()
THERE_IS_NONE = Sentence("averaged-none", "there is none")()
AVERAGE_OUT = Sentence(
    "averaged-torques-out", "the torques M1, M2 average out: the true motion keeps a small oscillation of "
    "the size M/(J0 ν), and is not covered near ν = 0")()
DIFFERENCE_OUT = Sentence(
    "averaged-difference-out", "D1 - D2 averages out as long as ν is much larger than |D1 - D2| |ω|/(2 J0)")()


@dataclass(frozen=True)
class SteadyState(Reasoned):
    """A steady state of the averaged motion: amplitude A and spin r (rad/s), kind "attracting", "repelling",
    "saddle" or "neutral"; rates: the two eigenvalues of the linearised averaged equations, 1/s (negative real
    part: decays); reason: what it is."""

    amplitude: float
    spin: float
    kind: str
    rates: tuple[complex, complex]


@dataclass(frozen=True)
class Attractors(Reasoned):
    """All isolated steady states; families: curves of them, with their rates; reason: why these and
    no others."""

    points: tuple[SteadyState, ...]
    families: tuple[Reason, ...]

    @property
    def attracting(self) -> tuple[SteadyState, ...]:
        """Those that attract."""
        return tuple(p for p in self.points if p.kind == "attracting")


def attractors(scene: Scene) -> Attractors:
    """Steady states of the averaged equations of the scene, first and second order together. Raises
    InputError where the scene is not of the kind (`check`)."""
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
    return Attractors(tuple(points), families, reason=_reason(numbers, points, families))


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
        reason = SPIN_ALONE(axis=Axis(3))
    else:
        det = -2 * S * alpha.diff().eval(r) * rho1.eval(r)
        root = sqrt(down**2 - 4 * det)
        first, second = (down + root) / 2, (down - root) / 2
        reason = PRECESSION
    rates = (complex(Integer(0) + first), complex(Integer(0) + second))
    return SteadyState(float(sqrt(S)), float(r), _kind(rates), rates, reason=reason)


def _kind(rates):
    signs = [(v.real > 0) - (v.real < 0) for v in rates]
    if 0 in signs:
        return "repelling" if 1 in signs else "neutral"
    return {(-1, -1): "attracting", (1, 1): "repelling"}.get(tuple(signs), "saddle")


def _families(alpha, rho0, rho1):
    """Curves of steady states: where a factor vanishes identically or for all A at once."""
    if rho0.is_zero:
        if alpha.is_zero:
            yield EVERY_SPIN(axis=Axis(3))
        else:
            yield EVERY_SPIN_GROWS(axis=Axis(3), rate=_words(alpha))
    if alpha.is_zero and rho0.is_zero and rho1.is_zero:
        yield EVERY_STATE
        return
    for r in _roots(alpha) if not alpha.is_zero else ():
        if rho1.eval(r) == 0 and rho0.eval(r) == 0:
            rate = float(rho1.diff().eval(r))
            neighbour = COMES_BACK if rate < 0 else LEAVES
            yield neighbour(spin=Rate(float(r)), rate=Quantity(abs(rate), digits=10))


def _words(polynomial):
    terms = [f"{float(c):.10g}" + (" r" if n == 1 else f" r^{n}" if n else "")
             for (n,), c in polynomial.terms()]
    return " + ".join(terms).replace("+ -", "- ") + " 1/s"


def _reason(numbers, points, families):
    result = ALL_STEADY
    if not points and not families:
        result = result.then(NO_RESISTANCE if numbers["M3"] else THERE_IS_NONE)
    if numbers["M1"] or numbers["M2"]:
        result = result.then(AVERAGE_OUT)
    return result.then(DIFFERENCE_OUT if numbers["h"] else None)
