"""Fate, margin, extremes and period from the reduced potential, in 100-digit arithmetic.

Torque along axis i with x_j' = (p x_k + r) w and x_k' = (q x_j + s) w, where w = x_i + h (h = 0 unless the
form has a common factor). With angle alpha, alpha' = w, the pair (u, v) = (x_j, x_k) moves on a fixed conic
as a function of alpha alone and w' = F(u, v), hence w^2 = w0^2 + 2 W(alpha), W = integral of F from the
initial state: motion in the potential
-W. Everything below is roots of F (equilibria) and of w^2 (turning points), found exactly by polynomial root
isolation. Floats are exact numbers; C = 0 and A = 0 are decided in rational arithmetic.
"""
from __future__ import annotations

from fractions import Fraction
from functools import lru_cache, wraps

import mpmath as mp
from flint import arb, ctx

from tests.oracles.model import CYCLE, Model

DIGITS = 100


def num(v):
    return mp.mpf(v.numerator) / v.denominator if isinstance(v, Fraction) else mp.mpf(v)


# ---- real roots of polynomials, by isolation between the roots of the derivative (coefficients from degree 0
# up)

def _value(c, t):
    return mp.polyval(c[::-1], t)


def _noise(c, t):
    return mp.polyval([abs(v) for v in c[::-1]], abs(t)) * mp.mpf(10) ** (25 - mp.mp.dps)


def bracketed_root(f, slope, lo, hi):
    """Root of f in [lo, hi] with a change of sign: Newton steps kept inside the bracket, else halving. A step
    of the last places ends it where the sign changes just beyond: the next step would leave the bracket by
    the function's rounding, and halve it from its far end."""
    flo = f(lo)
    if flo == 0:
        return lo
    t, small = (lo + hi) / 2, mp.mpf(10) ** (4 - mp.mp.dps)
    for n in range(4000):
        ft = f(t)
        if ft == 0:
            return t
        if (ft > 0) == (flo > 0):
            lo = t
        else:
            hi = t
        d = slope(t)
        new = t - ft / d if d else lo
        if abs(new - t) <= small * abs(t):
            beyond = t + (64 * small * abs(t) if (hi if t == lo else lo) > t else -64 * small * abs(t))
            if (f(beyond) > 0) != (ft > 0):
                return new
        # by then Newton's steps are the function's rounding
        if n > 300 or not min(lo, hi) < new < max(lo, hi):
            new = (lo + hi) / 2
        if abs(new - t) <= small * abs(t) or abs(hi - lo) <= small * max(abs(lo), abs(hi)):
            return new
        # Newton creeping along one side: halve every time the bracket did not shrink by much
        t = new if abs(ft) < abs(flo) or n % 3 or n > 300 else (lo + hi) / 2
    raise ArithmeticError("root not found")


def real_roots(c):
    """[(root, simple)] in rising order; a touching root (no change of sign) has simple=False."""
    c = list(c)
    while c and c[-1] == 0:
        c.pop()
    if len(c) <= 1:
        return []
    shift = 0
    while c[0] == 0:
        c, shift = c[1:], shift + 1
    found = []
    if len(c) == 2:
        found = [(-c[0] / c[1], True)]
    elif len(c) > 2:
        slope = [n * v for n, v in enumerate(c)][1:]
        bound = 2 + max(abs(v / c[-1]) for v in c[:-1]) * 2
        marks = [-bound] + [t for t, _ in real_roots(slope)] + [bound]
        touching = [abs(_value(c, t)) <= _noise(c, t) for t in marks]
        for (a, ta), (b, tb) in zip(zip(marks, touching), zip(marks[1:], touching[1:])):
            if tb and b is not marks[-1]:
                found.append((b, False))
            if not ta and not tb and (_value(c, a) > 0) != (_value(c, b) > 0):
                found.append((bracketed_root(lambda t: _value(c, t), lambda t: _value(slope, t), a, b), True))
    if shift:
        found.append((mp.mpf(0), shift % 2 == 1))
    return sorted(found)


def _mul(*factors):
    out = [mp.mpf(1)]
    for f in factors:
        new = [mp.mpf(0)] * (len(out) + len(f) - 1)
        for m, a in enumerate(out):
            for n, b in enumerate(f):
                new[m + n] += a * b
        out = new
    return out


def _add(*polynomials):
    out = [mp.mpf(0)] * max(len(c) for c in polynomials)
    for c in polynomials:
        for n, v in enumerate(c):
            out[n] += v
    return out


# ---- the reduction

def reduction_axis(model: Model):
    """(axis, h) of the torque's axis, or of the first axis that reduces when there is no torque; None if none
    does."""
    axes = [i for i in range(3) if model.m[i]] or [0, 1, 2]
    if len(axes) == 2 or (len(axes) == 3 and any(model.m)):
        return None
    for i in axes:
        j, k = CYCLE[i]
        if model.sigma[j] == 0 and model.rho[k] == 0:
            return i, Fraction(0)
        if model.kappa[j] and model.kappa[k] and model.rho[j] == 0 == model.sigma[k] \
                and model.sigma[j] / model.kappa[j] == model.rho[k] / model.kappa[k]:
            return i, model.sigma[j] / model.kappa[j]
    return None


def kept(method):
    """A method whose answers an object keeps, each at its precision: label, extremes and period ask for the
    same ones."""
    @wraps(method)
    def asked(self, *arguments):
        key = method.__name__, arguments, mp.mp.prec
        if key not in self.known:
            self.known[key] = method(self, *arguments)
        return self.known[key]
    return asked


@lru_cache(maxsize=256)
def motion_of(model: Model, state, digits: int, axis: int | None) -> Reduced:
    """The motion of one state (a tuple), the same object for every question about it."""
    return Reduced(model, state, digits, axis)


class Reduced:
    """The one-degree-of-freedom motion of one state; every method runs at `digits` digits."""

    def __init__(self, model: Model, state, digits: int = DIGITS, axis: int | None = None):
        found = reduction_axis(model) if axis is None else (axis, Fraction(0))
        if found is None:
            raise ValueError("no reduction: torque off the principal axes, or gyrostatic moment along it")
        self.model, self.digits, self.known = model, digits, {}
        self.i, self.h = found
        self.j, self.k = CYCLE[self.i]
        x = [Fraction(v) for v in state]
        i, j, k = self.i, self.j, self.k
        p, r, q, s = model.kappa[j], model.rho[j], model.kappa[k], model.sigma[k]
        ka, ro, si, m = model.kappa[i], model.rho[i], model.sigma[i], model.m[i]
        u0, v0, w0 = x[j], x[k], x[i] + self.h
        with mp.workdps(digits):
            self.weight = num(model.weight[i])
            self.w0, self.u0, self.v0 = num(w0), num(u0), num(v0)
            self.F_exact = ka * u0 * v0 + ro * v0 + si * u0 + m
            self.still = (w0 == 0 and self.F_exact == 0
                          or (self.F_exact == 0 and p * v0 + r == 0 == q * u0 + s))
            if p * q == 0:
                self._polynomial(p, q, r, s, ka, ro, si, m, u0, v0)
                return
            uc, vc = -s / q, -r / p
            U, V = u0 - uc, v0 - vc
            tilt = ka * uc * vc + ro * vc + si * uc + m
            self.kind = "elliptic" if p * q < 0 else "hyperbolic"
            self.C = q * U * U - p * V * V
            self.k0 = mp.sqrt(num(abs(p * q)))
            self.p, self.q, self.uc, self.vc, self.U0, self.V0 = map(num, (p, q, uc, vc, U, V))
            self.cu, self.cv, self.ka, self.tilt = map(num, (ka * vc + si, ka * uc + ro, ka, tilt))
            self.at_centre = U == 0 == V
            if self.kind == "hyperbolic":
                x = self.p * self.V0 / self.k0
                plus, minus = (self.U0 + x) / 2, (self.U0 - x) / 2
                if self.C == 0:  # on an invariant plane: one exponential is exactly absent
                    plus, minus = (plus, mp.mpf(0)) if abs(plus) > abs(minus) else (mp.mpf(0), minus)
                self.plus, self.minus = plus, minus

    def _polynomial(self, p, q, r, s, ka, ro, si, m, u0, v0):
        """One or both of p, q vanish: u, v, W are polynomials in alpha with rational coefficients."""
        self.kind, self.C = "parabolic", None
        if p == 0:
            u = [u0, r]
            v = [v0, q * u0 + s, q * r / 2]
        else:
            v = [v0, s]
            u = [u0, p * v0 + r, p * s / 2]
        F = [Fraction(0)] * 5
        for a, x in enumerate(u):
            F[a] += si * x
            for b, y in enumerate(v):
                F[a + b] += ka * x * y
        for b, y in enumerate(v):
            F[b] += ro * y
        F[0] += m
        self.at_centre = not any(u[1:]) and not any(v[1:])
        self.pu, self.pv, self.pF = ([num(c) for c in row] for row in (u, v, F))
        self.pW = [mp.mpf(0)] + [c / (n + 1) for n, c in enumerate(self.pF)]
        self.tilt = num(m)

    # -- along the angle
    def pair(self, alpha):
        """(u, v) at the angle alpha from the initial state."""
        if self.kind == "parabolic":
            return _value(self.pu, alpha), _value(self.pv, alpha)
        if self.kind == "elliptic":
            c, s = mp.cos(self.k0 * alpha), mp.sin(self.k0 * alpha) / self.k0
            U, V = self.U0 * c + self.p * self.V0 * s, self.V0 * c + self.q * self.U0 * s
        else:
            up, down = self.plus * mp.exp(self.k0 * alpha), self.minus * mp.exp(-self.k0 * alpha)
            U, V = up + down, (up - down) * self.k0 / self.p
        return self.uc + U, self.vc + V

    def F(self, alpha):
        if self.kind == "parabolic":
            return _value(self.pF, alpha)
        u, v = self.pair(alpha)
        U, V = u - self.uc, v - self.vc
        return self.ka * U * V + self.cu * U + self.cv * V + self.tilt

    def W(self, alpha):
        """Work per unit inertia from the initial state: (w^2 - w0^2)/2."""
        if self.kind == "parabolic":
            return _value(self.pW, alpha)
        u, v = self.pair(alpha)
        U, V = u - self.uc, v - self.vc
        return (self.ka * (U * U - self.U0 ** 2) / (2 * self.p) + self.cu * (V - self.V0) / self.q
                + self.cv * (U - self.U0) / self.p + self.tilt * alpha)

    def g(self, alpha):
        return self.w0 ** 2 + 2 * self.W(alpha)

    def terms(self, alpha):
        """Size of the largest term of W: what a rounding error is relative to."""
        if self.kind == "parabolic":
            return mp.polyval([abs(c) for c in self.pW[::-1]], abs(alpha)) + self.w0 ** 2
        u, v = self.pair(alpha)
        U, V = abs(u - self.uc) + abs(self.U0), abs(v - self.vc) + abs(self.V0)
        return (abs(self.ka / self.p) * U * U + abs(self.cu / self.q) * V + abs(self.cv / self.p) * U
                + abs(self.tilt * alpha) + self.w0 ** 2)

    @property
    def turn(self):
        return 2 * mp.pi / self.k0 if self.kind == "elliptic" else mp.inf

    @kept
    def stationary(self):
        """[(alpha, kind)] of the equilibria on this conic in rising order, kind "saddle", "centre" or "fold";
        elliptic: those of one turn, -turn/2 < alpha <= turn/2."""
        if self.at_centre:
            return []
        if self.kind == "parabolic":
            roots = real_roots(self.pF)
        elif self.kind == "elliptic":
            one, k = [mp.mpf(1), mp.mpf(0), mp.mpf(1)], self.k0
            U = [self.U0, 2 * self.p * self.V0 / k, -self.U0]
            V = [self.V0, 2 * self.q * self.U0 / k, -self.V0]
            quartic = _add([self.ka * c for c in _mul(U, V)], [self.cu * c for c in _mul(U, one)],
                           [self.cv * c for c in _mul(V, one)], [self.tilt * c for c in _mul(one, one)])
            roots = [(2 * mp.atan(t) / k, simple) for t, simple in real_roots(quartic)]
            if quartic[-1] == 0:
                roots.append((mp.pi / k, True))
        else:
            U = [self.minus, mp.mpf(0), self.plus]
            V = [-self.minus * self.k0 / self.p, mp.mpf(0), self.plus * self.k0 / self.p]
            y = [mp.mpf(0), mp.mpf(1)]
            quartic = _add([self.ka * c for c in _mul(U, V)], [self.cu * c for c in _mul(U, y)],
                           [self.cv * c for c in _mul(V, y)], [self.tilt * c for c in _mul(y, y)])
            roots = [(mp.log(t) / self.k0, simple) for t, simple in real_roots(quartic) if t > 0]
        out = []
        for alpha, simple in sorted(roots):
            kind = "fold" if not simple else ("saddle" if self.slope(alpha) > 0 else "centre")
            out.append((alpha, kind))
        return out

    def slope(self, alpha):
        """dF/dalpha."""
        if self.kind == "parabolic":
            return _value([n * c for n, c in enumerate(self.pF)][1:], alpha)
        u, v = self.pair(alpha)
        U, V = u - self.uc, v - self.vc
        return self.ka * (self.p * V * V + self.q * U * U) + self.cu * self.p * V + self.cv * self.q * U

    # -- where the motion goes
    @kept
    def _ahead(self, direction):
        """Equilibria met in the direction +1/-1 from alpha = 0 (excluded), for the elliptic case the turns
        that matter."""
        marks = [(a, kind) for a, kind in self.stationary()]
        if self.kind != "elliptic" or not marks:
            return [m for m in (marks if direction > 0 else marks[::-1]) if m[0] * direction > 0], 0
        gain = self.tilt * direction * self.turn  # change of W over a turn in this direction
        first = 0
        if gain < 0:  # uphill: skip the turns that are certainly passed
            lowest = min(self.W(a) for a, _ in marks) - abs(gain)
            first = max(0, int(mp.floor((self.w0 ** 2 / 2 + lowest) / -gain)) - 1)
        ahead = sorted(((a * direction + n * self.turn, kind) for a,
                        kind in marks for n in range(first, first + 5)),
                       key=lambda m: m[0])
        ahead = [(direction * a, kind) for a, kind in ahead if a > 0]
        if gain >= 0:  # a barrier downhill stands within one turn or nowhere
            ahead = [m for m in ahead if abs(m[0]) <= self.turn]
        return ahead, first

    @kept
    def end(self, direction):
        """("turn", alpha) turning point, ("limit", alpha) saddle approached for ever, ("open", inf) none;
        from alpha = 0 in the given direction."""
        if self.w0 == 0 and self.F_exact * direction < 0:
            return "turn", mp.mpf(0)
        if self.at_centre:
            if self.tilt * direction < 0:
                return "turn", -self.w0 ** 2 / (2 * self.tilt)
            return "open", direction * mp.inf
        ahead, _ = self._ahead(direction)
        last = mp.mpf(0)
        for alpha, kind in ahead:
            value, noise = self.g(alpha), self.terms(alpha) * mp.mpf(10) ** (30 - self.digits)
            if abs(value) <= noise and kind != "centre":
                return "limit", alpha
            if value < 0:
                return "turn", self._turning(last, alpha)
            last = alpha
        if self._falls(direction):
            return "open", direction * mp.inf
        step = mp.mpf(1) if self.kind != "elliptic" else self.turn / 7
        if self.kind == "hyperbolic":
            step = 1 / self.k0
        far = last + direction * step
        while self.g(far) >= 0:
            step *= 2 if self.kind != "hyperbolic" else mp.mpf("1.25")
            last, far = far, far + direction * step
        return "turn", self._turning(last, far)

    def _falls(self, direction):
        """True where -W has no wall at infinity in this direction."""
        if self.kind == "elliptic":
            return self.tilt * direction >= 0
        if self.kind == "hyperbolic":
            wall = self.plus if direction > 0 else self.minus
            return wall == 0 and self.tilt * direction >= 0
        for c in range(len(self.pW) - 1, 0, -1):
            if self.pW[c]:
                return self.pW[c] * direction ** c > 0
        return True

    def _turning(self, inner, outer):
        if inner == 0 and self.w0 == 0:  # leaves from rest: the start is a root of g too, step off it
            inner = outer
            while self.g(inner) <= 0:
                inner /= 2
        return bracketed_root(self.g, lambda a: 2 * self.F(a), inner, outer)


def _at(digits):
    def wrap(function):
        def inside(model, state, digits=digits, **named):
            with mp.workdps(digits):
                return function(model, state, digits=digits, **named)
        inside.__doc__ = function.__doc__
        return inside
    return wrap


@_at(DIGITS)
def label(model, state, digits=DIGITS, axis=None):
    """"bounded", "spin-up", "separatrix" (exact tie) or "equilibrium" (exact)."""
    motion = motion_of(model, tuple(state), digits, axis)
    if motion.still:
        return "equilibrium"
    (right, _), (left, _) = motion.end(+1), motion.end(-1)
    if "limit" in (right, left):
        return "separatrix"
    if motion.tilt == 0:
        return "bounded" if motion.kind != "hyperbolic" or "open" not in (right, left) else "separatrix"
    return "spin-up" if "open" in (right, left) else "bounded"


@_at(DIGITS)
def margin(model, state, digits=DIGITS, axis=None):
    """Barrier minus energy, in the energy unit of the model; None without any saddle on the state's conic.
    Elliptic: the highest barrier within one turn in the torque's direction; else the saddle (unique wherever
    it is asked for)."""
    motion = motion_of(model, tuple(state), digits, axis)
    if motion.at_centre:
        return None
    if motion.kind == "elliptic" and motion.tilt != 0:
        heights = [-motion.W(a) for a,
                   kind in motion._ahead(1 if motion.tilt > 0 else -1)[0] if kind == "saddle"]
    else:
        heights = [-motion.W(a) for a, kind in motion.stationary() if kind == "saddle"]
    return motion.weight * (max(heights) - motion.w0 ** 2 / 2) if heights else None


@_at(DIGITS)
def from_a_saddle(model, state, digits=DIGITS, axis=None):
    """The least distance in energy, in the unit of the model, of a motion from a saddle of its own orbit
    (elliptic: of three turns of it); None without any."""
    motion = motion_of(model, tuple(state), digits, axis)
    turns = (-1, 0, 1) if motion.kind == "elliptic" else (0,)
    heights = [-motion.W(a + n * motion.turn if n else a) for a,
               kind in motion.stationary() if kind == "saddle" for n in turns]
    return min((abs(motion.weight * (h - motion.w0 ** 2 / 2)) for h in heights), default=None)


@_at(DIGITS)
def extremes(model, state, digits=DIGITS, axis=None):
    """3 x 2 list of [min, max] over t >= 0, mpf; infinite where the component grows without bound."""
    motion = motion_of(model, tuple(state), digits, axis)
    out = [None] * 3
    if motion.still:
        for n, value in zip((motion.i, motion.j, motion.k),
                            (motion.w0 - num(motion.h), motion.u0, motion.v0)):
            out[n] = [value, value]
        return out
    (right, hi), (left, lo) = motion.end(+1), motion.end(-1)
    if "limit" in (right, left):
        raise ValueError("on a separatrix")
    if right == left == "turn":
        visited, both = (lo, hi), True
    else:  # spin-up, after at most one turning point
        forward = 1 if right == "open" else -1
        back = lo if forward > 0 else hi
        start = back if motion.w0 * forward < 0 else mp.mpf(0)
        visited, both = ((start, hi) if forward > 0 else (lo, start)), False
    if both:
        top = mp.sqrt(max(motion.g(a) for a in _inner(motion, lo, hi)))
        wide = [-top, top]
    else:
        ahead = [motion.g(a) for a, _ in motion._ahead(forward)[0]] + [motion.w0 ** 2]
        if motion.w0 * forward < 0:
            reach = [motion.w0 ** 2] + [motion.g(a) for a, _ in motion.stationary() for a in _turns(motion, a)
                                        if 0 < -a * forward <= abs(back)]
            wide = [-mp.sqrt(max(reach)) * forward, mp.inf * forward]
        else:
            wide = [mp.sqrt(min(ahead)) * forward, mp.inf * forward]
    out[motion.i] = [x - num(motion.h) for x in sorted(wide)]
    for n, which in ((motion.j, 0), (motion.k, 1)):
        values = [motion.pair(a)[which] for a in _levels(motion, which, *visited)]
        out[n] = [min(values), max(values)]
    return out


def _turns(motion, alpha):
    """A stationary angle and its copies one turn either side (W falls uphill, so no further ones matter)."""
    return [alpha + n * motion.turn for n in (-1, 0, 1)] if motion.kind == "elliptic" else [alpha]


def _inner(motion, lo, hi):
    marks = [b for a, _ in motion.stationary() for b in _turns(motion, a) if lo <= b <= hi]
    if motion.at_centre:
        return [mp.mpf(0)]
    return marks + [mp.mpf(0)]


def _levels(motion, which, lo, hi):
    """Angles in [lo, hi] where u (which=0) or v (1) can be largest or smallest."""
    ends = [a for a in (lo, hi) if mp.isfinite(a)]
    if motion.at_centre:
        return [mp.mpf(0)]
    if motion.kind == "parabolic":
        row = (motion.pu, motion.pv)[which]
        if len([a for a in (lo, hi) if mp.isfinite(a)]) < 2 and any(row[1:]):
            raise ValueError("a perpendicular component grows without bound")
        return (ends + [mp.mpf(0)] + [a for a, _ in real_roots([n * c for n, c in enumerate(row)][1:])
                                      if lo <= a <= hi])
    if motion.kind == "elliptic":
        k = motion.k0
        first = (mp.atan2(motion.p * motion.V0 / k, motion.U0) if which == 0
                 else mp.atan2(motion.q * motion.U0 / k, motion.V0)) / k
        if hi - lo >= motion.turn:
            return [first, first + mp.pi / k]
        base = mp.ceil((lo - first) * k / mp.pi)
        peaks = [first + (base + n) * mp.pi / k for n in range(3)]
        return ends + [a for a in peaks if lo <= a <= hi]
    ratio = (motion.minus / motion.plus if which == 0 else -motion.minus / motion.plus) if motion.plus else 0
    inside = [mp.log(ratio) / (2 * motion.k0)] if ratio > 0 else []
    # decayed to the centre
    limit = [mp.sign(a) * 200 * mp.log(10) / motion.k0 for a in (lo, hi) if not mp.isfinite(a)]
    return ends + limit + [a for a in inside if lo <= a <= hi]


@lru_cache
def _gauss(n, digits):
    """Gauss-Legendre nodes and weights on [-1, 1], of python-flint."""
    with ctx.workdps(digits + 10):
        pairs = [arb.legendre_p_root(n, k, weight=True) for k in range(n)]
        return [tuple(mp.mpf(v.str(digits + 5, radius=False)) for v in pair) for pair in pairs]


@_at(60)
def period(model, state, digits=60, nodes=None):
    """Period of a bounded motion, mpf; 0 at an equilibrium, inf otherwise.

    2 integral dalpha/w with alpha = middle - half cos(phi), which removes the square roots at both turning
    points. What is left is even and has the period 2 pi in phi: where three times as many equal steps change
    no more than 1e-16 of it, their sum is taken. Elsewhere, and where `nodes` are given, Gauss-Legendre on
    panels that shrink geometrically towards both ends and every saddle inside, where the integrand may be
    steep. `nodes` per panel, 20 without a number; a second call with more nodes bounds the error.
    """
    motion = motion_of(model, tuple(state), digits, None)
    if motion.still:
        return mp.mpf(0)
    (right, hi), (left, lo) = motion.end(+1), motion.end(-1)
    if not right == left == "turn":
        return mp.inf
    half = (hi - lo) / 2

    def rate(phi):
        near = 2 * half * (mp.sin(phi / 2) if 2 * phi < mp.pi else mp.cos(phi / 2)) ** 2
        alpha = lo + near if 2 * phi < mp.pi else hi - near
        return half * mp.sin(phi) / mp.sqrt(abs(motion.g(alpha)))

    found = _by_equal_steps(rate) if nodes is None else None
    return found or _by_panels(motion, rate, lo, hi, nodes or 20, digits)


def _by_equal_steps(rate):
    """Twice the integral of an even function of period 2 pi over [0, pi] by 16, 48 and 144 midpoints, each of
    the latter holding the former; None where the last two differ."""
    sums, total = [], mp.mpf(0)
    for n in (16, 48, 144):
        total += mp.fsum(rate(mp.pi * (2 * m + 1) / (2 * n)) for m in range(n) if n == 16 or m % 3 != 1)
        sums.append(2 * mp.pi / n * total)
        if len(sums) > 1 and abs(sums[-1] - sums[-2]) <= mp.mpf("1e-16") * sums[-1]:
            return sums[-1]
    return None


def _by_panels(motion, rate, lo, hi, nodes, digits):
    """The same by Gauss-Legendre on panels."""
    middle, half = (hi + lo) / 2, (hi - lo) / 2
    saddles = [b for a, kind in motion.stationary() if kind != "centre" for b in _turns(motion, a)
               if lo < b < hi]
    fixed = [mp.mpf(0), mp.pi] + [mp.acos((middle - a) / half) for a in saddles]
    cuts = sorted(set(fixed + [c + s * mp.mpf(4) ** -n for c in fixed for s in (1, -1) for n in range(18)]))
    cuts = [c for c in cuts if 0 <= c <= mp.pi]
    total = mp.mpf(0)
    for a, b in zip(cuts, cuts[1:]):
        if b - a < mp.mpf(10) ** (20 - digits):
            continue
        rule = _gauss(nodes, mp.mp.dps)
        total += (b - a) / 2 * mp.fsum(w * rate((a + b) / 2 + x * (b - a) / 2) for x, w in rule)
    return 2 * total
