"""Homoclinic loops of a gyrostat under a constant torque about one principal axis, from Euler's equations
alone.

D w' = (D w + lambda) x w + M with M = (.., M_i, ..) and lambda_i = 0, i j k cyclic. With d alpha = w_i dt the
rates across the axis obey the linear D_j dw_j = ((D_k - D_i) w_k + lambda_k) d alpha, D_k dw_k = ((D_i - D_j)
w_j - lambda_j) d alpha: w_j and w_k are a sum of exp(+-kappa alpha), kappa^2 = (D_k - D_i)(D_i - D_j)/(D_j
D_k), plus constants; the exponent is imaginary where they run round a closed curve. The work-energy law makes
T - M_i alpha a constant, and D_i w_i' = F = (D_j - D_k) w_j w_k + lambda_j w_k - lambda_k w_j + M_i, so an
equilibrium of the motion along the curve is F = 0, y^2 F a quartic in y = exp(kappa alpha), and it is a
saddle where F grows with alpha.

The separatrix is made of the loops that leave a saddle and come back to it: on closed curves against the
torque, where the potential rises from turn to turn; on open ones on either side. `Curves` holds the curves of
many states in doubles, `lobes` give places of the surface, `in_digits` tells in 50 digits how far a place
lies from it to first order.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import mpmath as mp
import numpy as np

from tests.oracles import energy, model

DIGITS = 50


@dataclass(frozen=True)
class Gyrostat:
    """D, lambda, M with the torque along `axis` only; the numbers are the doubles they look like."""

    inertia: tuple
    wheel: tuple
    torque: tuple

    @property
    def axis(self) -> int:
        return next(i for i in range(3) if self.torque[i])

    def numbers(self):
        """(D_i, D_j, D_k, lambda_j, lambda_k, M)."""
        i = self.axis
        j, k = (i + 1) % 3, (i + 2) % 3
        D, wheel = self.inertia, self.wheel
        return D[i], D[j], D[k], wheel[j], wheel[k], self.torque[i]

    def split(self, states):
        """(w_i, w_j, w_k) of states (..., 3)."""
        i = self.axis
        return tuple(np.asarray(states)[..., n] for n in (i, (i + 1) % 3, (i + 2) % 3))

    def joined(self, w_i, w_j, w_k):
        """States (..., 3)."""
        i = self.axis
        out = np.empty((*np.broadcast(w_i, w_j, w_k).shape, 3))
        out[..., i], out[..., (i + 1) % 3], out[..., (i + 2) % 3] = w_i, w_j, w_k
        return out

    @property
    def closed(self) -> bool:
        """Whether the curves of the rates across the axis are closed."""
        Di, Dj, Dk, *_ = self.numbers()
        return (Dk - Di) * (Di - Dj) < 0

    def coefficients(self):
        """(kappa, p, centre of w_j, centre of w_k)."""
        Di, Dj, Dk, lj, lk, _ = self.numbers()
        p, q = (Dk - Di) / Dj, (Di - Dj) / Dk
        return np.emath.sqrt(p * q), p, lj / (Di - Dj), lk / (Di - Dk)

    def invariant(self, states):
        """q U^2 - p V^2 of states: constant along every motion, U and V measured from the centre."""
        Di, Dj, Dk, *_ = self.numbers()
        _, p, cu, cv = self.coefficients()
        _, u, v = self.split(states)
        return (Di - Dj) / Dk * (u - cu) ** 2 - p * (v - cv) ** 2


class Curves:
    """The curves through many states, (n,) each, parametrised by alpha from the state."""

    def __init__(self, body: Gyrostat, states):
        self.body = body
        self.w, self.u, self.v = (np.atleast_1d(v) for v in body.split(states))
        self.kappa, self.p, self.cu, self.cv = body.coefficients()
        U, V = self.u - self.cu, self.v - self.cv
        x = V * self.p / self.kappa
        self.up, self.down = 0.5 * (U + x), 0.5 * (U - x)
        self.turn = 2 * np.pi / abs(self.kappa) if body.closed else np.inf

    def _of(self, values, alpha):
        return values.reshape(values.shape + (1,) * (np.ndim(alpha) - 1))

    def pair(self, alpha):
        """(w_j, w_k) at alpha (n, ...)."""
        up, down = self._of(self.up,
                            alpha) * np.exp(self.kappa
                                            * alpha), self._of(self.down, alpha) * np.exp(-self.kappa * alpha)
        return self.cu + np.real(up + down), self.cv + np.real((up - down) * self.kappa / self.p)

    def force(self, alpha):
        _, Dj, Dk, lj, lk, M = self.body.numbers()
        u, v = self.pair(alpha)
        return (Dj - Dk) * u * v + lj * v - lk * u + M

    def slope(self, alpha):
        """dF/d alpha."""
        Di, Dj, Dk, lj, lk, _ = self.body.numbers()
        u, v = self.pair(alpha)
        return ((Dj - Dk) * v - lk) * ((Dk - Di) * v
                                       + lk) / Dj + ((Dj - Dk) * u + lj) * ((Di - Dj) * u - lj) / Dk

    def rise(self, alpha):
        """Potential at alpha over that at the state, the differences of squares formed as products."""
        _, Dj, Dk, _, _, M = self.body.numbers()
        grow, decay = np.expm1(self.kappa * alpha), np.expm1(-self.kappa * alpha)
        up, down = self._of(self.up, alpha) * grow, self._of(self.down, alpha) * decay
        du, dv = np.real(up + down), np.real((up - down) * self.kappa / self.p)
        u, v = self._of(self.u, alpha), self._of(self.v, alpha)
        return 0.5 * (Dj * du * (2 * u + du) + Dk * dv * (2 * v + dv)) - M * alpha

    def equilibria(self):
        """alpha (n, 4) of the equilibria, nan where there are fewer; on closed curves within half a turn
        either way."""
        _, Dj, Dk, lj, lk, M = self.body.numbers()
        r, a, b = self.kappa / self.p, self.up, self.down
        of_u, of_v = (Dj - Dk) * self.cv - lk, (Dj - Dk) * self.cu + lj
        rest = (Dj - Dk) * self.cu * self.cv + lj * self.cv - lk * self.cu + M
        quartic = [(Dj - Dk) * r * a * a, of_u * a + of_v * r * a, rest + 0 * a, of_u * b - of_v * r * b,
                   -(Dj - Dk) * r * b * b]
        with np.errstate(all="ignore"):
            alpha = np.log(_roots(np.stack(quartic, axis=-1))) / self.kappa
            out = np.where(np.abs(alpha.imag) < 0.3 / abs(self.kappa), alpha.real, np.nan)
            for _ in range(12):
                step = -self.force(out) / self.slope(out)
                out = np.where(np.abs(step) < 0.1 / abs(self.kappa), out + step, out)
            u, v = self.pair(out)
            size = abs(Dj - Dk) * np.abs(u * v) + abs(lj * v) + abs(lk * u) + abs(M)
            return np.where(np.abs(self.force(out)) < 1e-9 * size, out, np.nan)


def _roots(c):
    """(n, 4) complex roots of quartics c (n, 5), highest power first; of those that lack powers at either end
    fewer, then nan."""
    out = np.full((len(c), 4), np.nan, complex)
    size = np.abs(c).max(axis=1)
    whole = (np.abs(c[:, 0]) > 1e-14 * size) & (np.abs(c[:, 4]) > 0)
    companion = np.zeros((whole.sum(), 4, 4), complex)
    companion[:, 1:, :-1] = np.eye(3)
    companion[:, 0] = -c[whole, 1:] / c[whole, :1]
    out[whole] = np.linalg.eigvals(companion)
    for n in np.flatnonzero(~whole):
        found = np.roots(c[n][np.argmax(np.abs(c[n]) > 1e-14 * size[n]):])
        out[n, :len(found)] = np.where(found == 0, np.nan, found)
    return out


# ---- the surface itself

@dataclass(frozen=True)
class Stretch:
    """A stretch of the curve F = 0, w_i = 0, all of saddles: with gap = D_j - D_k, w_j = sign exp(t) -
    lambda_j/gap and w_k = K/(sign exp(t)) + lambda_k/gap for t between low and high. at_fold: whether F's
    slope vanishes at low and at high; else the invariant reaches its limit there."""

    body: Gyrostat
    sign: int
    low: float
    high: float
    at_fold: tuple

    def saddle(self, t):
        """(n, 3) of t (n,)."""
        return _still(self.body, self.sign, t)


def _still(body, sign, t):
    _, Dj, Dk, lj, lk, M = body.numbers()
    gap, x = Dj - Dk, sign * np.exp(t)
    return body.joined(0.0, x - lj / gap, -(lj * lk / gap + M) / gap / x + lk / gap)


def stretches(body: Gyrostat, limit=np.inf, number=20_001):
    """Every stretch of saddles, as far out as the invariant is of the size `limit`."""
    _, Dj, Dk, lj, lk, M = body.numbers()
    gap = Dj - Dk
    K = abs(lj * lk / gap + M) / abs(gap)
    size = np.sqrt(K) + abs(lj / gap) + abs(lk / gap) + sum(abs(v) for v in body.coefficients()[2:])
    if limit < np.inf:
        Di, Dj, Dk, *_ = body.numbers()
        size += 2 * np.sqrt(limit / min(abs(Dk - Di) / Dj, abs(Di - Dj) / Dk))
    t, found = np.linspace(np.log(K / size) - 9, np.log(size) + 9, number), []

    def value(sign, t):  # positive where there is a saddle within the limit
        places = _still(body, sign, t)
        slope = Curves(body, places).slope(np.zeros((len(t), 1)))[:, 0]
        return slope, limit - np.abs(body.invariant(places))
    for sign in (-1, 1):
        slope, room = value(sign, t)
        good = (slope > 0) & (room >= 0)
        for a, b in zip(np.flatnonzero(good & ~np.r_[False, good[:-1]]),
                        np.flatnonzero(good & ~np.r_[good[1:], False])):
            ends, folds = [], []
            for inside, outside in ((a, a - 1), (b, b + 1)):
                if not 0 <= outside < number:
                    ends.append(t[inside])
                    folds.append(False)
                    continue
                low, high = t[inside], t[outside]
                for _ in range(60):
                    middle = 0.5 * (low + high)
                    slope_there, room_there = (float(v[0]) for v in value(sign, np.array([middle])))
                    low, high = (middle, high) if slope_there > 0 and room_there >= 0 else (low, middle)
                ends.append(low)
                folds.append(not slope[outside] > 0)
            found.append(Stretch(body, sign, *ends, tuple(folds)))
    return found


def largest_fold(body: Gyrostat) -> float:
    """The largest size of the invariant at folds, nan where there is none."""
    ends = [(one, t) for one in stretches(body) for t, fold in zip((one.low, one.high), one.at_fold) if fold]
    return max((abs(float(body.invariant(one.saddle(np.array([t])))[0])) for one, t in ends), default=np.nan)


def far_ends(body: Gyrostat, places, side):
    """alpha (n,) from saddles (n, 3), on the side -1 or +1, at which the potential is back at the saddle's
    height behind a well; nan where no loop closes."""
    curves = Curves(body, places)
    alpha = curves.equilibria()
    small = 1e-6 / abs(curves.kappa)
    if body.closed:
        alpha = np.where(alpha * side < small, alpha + side * curves.turn, alpha)
        alpha = np.where(np.abs(alpha) > curves.turn - small, np.nan, alpha)
    alpha = np.where(alpha * side > small, np.abs(alpha), np.nan)
    alpha = np.sort(alpha, axis=1)  # distances, nan last
    with np.errstate(all="ignore"):
        barrier, rise = curves.slope(side * alpha) > 0, curves.rise(side * alpha)
    low, high = np.full(len(places), np.nan), np.full(len(places), np.nan)
    for t, is_barrier, height in zip(alpha.T, barrier.T, rise.T):
        going = np.isnan(high) & np.isfinite(t)
        high = np.where(going & is_barrier & (height >= 0), t, high)
        low = np.where(going & ~is_barrier, t, low)
    if body.closed:
        high = np.where(np.isnan(high), curves.turn, high)
    else:
        step = 0.5 / abs(curves.kappa)
        last = np.where(np.isnan(high), np.fmax(low, 0.0), high)
        for _ in range(60):
            with np.errstate(all="ignore"):
                last = np.where(np.isnan(high) & ~(curves.rise(side * last[:, None])[:, 0] > 0), last + step,
                                last)
        high = np.where(np.isnan(high), last, high)
    with np.errstate(all="ignore"):
        good = (curves.rise(side * high[:, None])[:, 0] >= 0) & (curves.rise(side * low[:, None])[:, 0] < 0)
        for _ in range(80):
            middle = 0.5 * (low + high)
            above = curves.rise(side * middle[:, None])[:, 0] > 0
            low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.where(good, side * low, np.nan)


def loop_places(body: Gyrostat, places, ends, shares, sign):
    """(n, 3) places of the loops of saddles, at shares (n,) of the way to the far end, with w_i of that sign.
    """
    curves = Curves(body, places)
    alpha = (ends * shares)[:, None]
    u, v = curves.pair(alpha)
    w = np.sqrt(np.maximum(-2 * curves.rise(alpha) / body.numbers()[0], 0.0))
    return body.joined(sign * w[:, 0], u[:, 0], v[:, 0])


@dataclass(frozen=True)
class Lobe:
    """The loops of a stretch of saddles on one side of them, with w_i of the sign `way`: a branch's half, or a
    quarter of it."""

    stretch: Stretch
    side: int
    way: int

    def places(self, t, turned):
        """(n, 3) places of the surface by the saddle's t (n,) and `turned` (n,), from 0 at the saddle to 1 at
        the far end; nan where no loop closes."""
        saddle = self.stretch.saddle(t)
        return loop_places(self.stretch.body, saddle, far_ends(self.stretch.body, saddle, self.side),
                           np.sin(0.5 * np.pi * turned) ** 2, self.way)


def lobes(body: Gyrostat, limit):
    """Every lobe of the separatrix out to the limit of the invariant."""
    sides = (-int(np.sign(body.torque[body.axis])),) if body.closed else (-1, 1)
    return [Lobe(one, side, way) for one in stretches(body, limit) for side in sides for way in (-1, 1)]


# ---- how far places are from it

def in_digits(body: Gyrostat, state, digits=DIGITS):
    """The first-order distance of one state from the stable manifolds of the saddles of its curve, as mpf:
    the least of those that no higher barrier hides and that lie towards the torque on closed curves, or half
    a turn beyond at most; inf without a saddle."""
    problem, exact = model.physical(body.inertia, body.wheel, body.torque), [Fraction(v) for v in state]
    with mp.workdps(digits):
        here, best = energy.motion_of(problem, tuple(exact), digits, None), mp.inf
        for start in _visible(here):
            step, slope = Fraction(1, 10 ** (digits // 3)) * max(map(abs, exact)), mp.mpf(0)
            for n in range(3):
                ends = [_gap(energy.Reduced(problem, [v + sign * step * (m == n) for m, v in enumerate(exact)],
                                            digits), start) for sign in (1, -1)]
                slope += ((ends[0] - ends[1]) / (2 * energy.num(step))) ** 2
            if slope:
                best = min(best, abs(_gap(here, start)) / mp.sqrt(slope))
        return best


def _visible(motion):
    """alpha of the saddles that no higher barrier hides; on closed curves of those within one turn and a half."""
    closed = motion.kind == "elliptic"
    found = sorted(t + n * motion.turn if n else t for t, kind in motion.stationary() if kind == "saddle"
                   for n in ((-1, 0, 1) if closed else (0,)))
    heights = [(t, -motion.W(t)) for t in found]
    return [t for t, height in heights
            if not any(0 < other * mp.sign(t) < abs(t) and above > height for other, above in heights)
            and (not closed or t * mp.sign(motion.tilt) * motion.k0 > -mp.pi)]


def _gap(motion, alpha):
    """Energy of the saddle near alpha over the state's, per unit inertia."""
    for _ in range(200):
        step = motion.F(alpha) / motion.slope(alpha)
        alpha -= step
        if abs(step) < mp.mpf(10) ** (6 - mp.mp.dps) * (1 + abs(alpha)):
            break
    return -motion.W(alpha) - motion.w0**2 / 2
