"""Loops whose orbits are centred far away, those of nearly equal moments: told from their saddles in the
components themselves.

Canonical places are told from the centre, and would keep no digit of a loop that is a million times smaller
than the way there. With t = p q alpha^2 and S = sum t^k alpha^(2k+1)/(2k+1)!, C its integral, L that of C
(sin, 1 - cos, alpha - sin of an orbit, or hyperbolic ones), a loop is

    omega_j = u + a S + p b C,   omega_k = v + b S + q a C,   a = p v + p0, b = q u + q0,   (omega_i + s)^2 =
    2 alpha^2 R(alpha),
    R = F' c + (F1 l + kappa a b (S c/alpha - l)) alpha + kappa (q a^2 + p b^2)/2 c^2 alpha^2,   c =
    C/alpha^2, l = L/alpha^3,

F' and F1 = F'' - 2 kappa a b at the saddle (u, v). Nothing here is a difference of large numbers, and R is
nearly a parabola, whose roots begin the search.
"""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..potential import Parabola

FAR = 100.0   # times the size of a loop: from there canonical places lose two digits and more
TURNED = 0.1  # of a radian, in which series of five terms end below rounding
STEPS = 10    # of Newton's method with the slope of the parabola, which is off by a tenth of t at most
TINY = np.finfo(float).tiny


class Orbits:
    """Orbits through saddles, in alpha from them. u, v: (r,) the ways there from the asymptotes of the
    hyperbola of equilibria, omega_j = -rho/kappa and omega_k = -sigma/kappa, whose digits the slopes need;
    side: (r,) the sign of alpha on the loop."""

    def __init__(self, reduction, u, v, side):
        self.r, self.side = r, _ = Parabola(reduction), side
        self.product = u * v
        self.u, self.v = u - r.rho / r.kappa, v - r.sigma / r.kappa
        a, b = self.a, self.b = r.p * self.v + r.p0, r.q * self.u + r.q0
        self.steep, self.bent = r.kappa * (a * v + b * u), r.kappa * (r.p * b * v + r.q * a * u)
        self.both, self.curl = r.kappa * a * b, 0.5 * r.kappa * (r.q * a * a + r.p * b * b)

    def moved(self, alpha):
        """(omega_j, omega_k) at alpha (r, ...)."""
        S, C, _ = (v * alpha**n for n, v in enumerate(self._series(alpha), 1))
        a, b, u, v = (one.reshape(one.shape + (1,) * (alpha.ndim - 1))
                      for one in (self.a, self.b, self.u, self.v))
        return u + (a * S + self.r.p * b * C), v + (b * S + self.r.q * a * C)

    def fall(self, alpha):
        """R(alpha): how far the potential lies below the saddle's height, over alpha^2."""
        s, c, third = self._series(alpha)
        steep, bent, both, curl = (v.reshape(v.shape + (1,) * (alpha.ndim - 1))
                                   for v in (self.steep, self.bent, self.both, self.curl))
        return steep * c + (bent * third + both * (s * c - third)) * alpha + curl * c * c * alpha * alpha

    def ends(self):
        """(r,) alpha of the far ends; nan where none is near."""
        return self._root(self.steep / 2, self.bent / 6 + self.both / 3, self.curl / 4, self.fall)

    def centres(self):
        """(r,) alpha of the wells."""
        def force(alpha):  # over alpha
            s, c, _ = self._series(alpha)
            du, dv = self.a * s + self.r.p * self.b * c * alpha, self.b * s + self.r.q * self.a * c * alpha
            return self.steep * s + self.bent * c * alpha + self.r.kappa * du * dv * alpha
        return self._root(self.steep, self.bent / 2 + self.both, self.curl, force)

    def wells(self, alpha):
        """(omega_j, omega_k) of the wells at alpha (r,), which lie on the hyperbola of equilibria too: it
        tells the component that is nearer to its asymptote, of which the way there from the saddle may keep
        no digit."""
        r, (u, v) = self.r, self.moved(alpha)
        first, second = u + r.rho / r.kappa, v + r.sigma / r.kappa
        long = np.abs(second) > np.abs(first)
        with np.errstate(all="ignore"):
            return np.where(long, self.product / second - r.rho / r.kappa,
                            u), np.where(long, v, self.product / first - r.sigma / r.kappa)

    def sharpness(self, end):
        """(r,) the way to the far end times the bend of the potential over its slope there."""
        far = self.moved(end)
        with np.errstate(all="ignore"):
            return np.abs(end) * self.r.slope(far) / np.abs(self.r.force(far))

    def _series(self, alpha):
        t = self.r.p * self.r.q * alpha * alpha
        return (1 + t / 6 * (1 + t / 20 * (1 + t / 42 * (1 + t / 72))),
                0.5 * (1 + t / 12 * (1 + t / 30 * (1 + t / 56 * (1 + t / 90)))),
                (1 + t / 20 * (1 + t / 42 * (1 + t / 72 * (1 + t / 110)))) / 6)

    def _root(self, first, second, third, function):
        """The root on the loop's side of what is nearly first + second x + third x^2, with first > 0 > third.
        """
        with np.errstate(all="ignore"):
            half = -0.5 * (second + np.copysign(np.sqrt(second * second - 4 * first * third), second))
            one, other = half / third, first / half
            x = np.where(one * self.side > 0, one, other)
            for _ in range(STEPS):
                step = function(x) / (second + 2 * third * x)
                x = x - np.where(np.isfinite(step) & (np.abs(step) < 0.5 * np.abs(x)), step, 0.0)
            return np.where((first > 0) & (third < 0) & (x * self.side > 0), x, np.nan)


@lru_cache(maxsize=64)
def asymptotes(land):
    """(omega_j, omega_k) of the hyperbola of equilibria far out, and the product of the ways from them; None
    without one, or with an asymptote that is far."""
    r, conic, g = land.reduction, land.conic, land.reduction.constants
    if not conic.pieces or r.parabolic_shift_size == 0:
        return None
    return float(-r.rho / r.kappa), float(-r.sigma / r.kappa), g["flip"] * g["rx"] * conic.K / conic.G


def saddles_of(land, branch, s):
    """((u, v) of the saddles of a branch at s (n,) as of `Orbits`, (n,) whether they are much nearer than the
    centre)."""
    found = asymptotes(land)
    if found is None or branch.line is not None:
        return (np.zeros(len(s)), np.zeros(len(s))), np.zeros(len(s), bool)
    (first, second, product), rz = found, land.reduction.constants["rz"]
    h = branch.start + (branch.end - branch.start) * s
    u, v = product / h, rz * h
    size = np.abs(u) + np.abs(v) + 2 * (abs(first) + abs(second))
    return (u, v), FAR * size < land.reduction.parabolic_shift_size


def shrinks_far(land, branch, side) -> bool | None:
    """`grid.shrinks` of a fold whose orbit's centre is far; None of others."""
    (u, v), far = saddles_of(land, branch, np.zeros(1))
    if not far[0]:
        return None
    one = Orbits(land.reduction, u, v, np.ones(1))
    return bool((one.bent / 6 + one.both / 3)[0] * side * land.unit <= 0)


def replaced(land, strips, s, u, made, shares_of):
    """The fields of `Loops` of strips at rows s (k, n) and columns u (k, m), those of rows with a far centre
    in the components; shares_of(sharpness (r,), u (r, m), numbers of strips (r,)): where columns stand."""
    r, g = land.reduction, land.reduction.constants
    told = [saddles_of(land, strip[0], row) for strip, row in zip(strips, s)]
    far = np.array([one[1] for one in told])
    if not far.any():
        return made
    strip, row = np.nonzero(far)
    side = np.array([np.sign(one[1] * land.unit) for one in strips])[strip]
    ways = np.moveaxis(np.array([one[0] for one in told]), 1, -1)[far]
    orbits = Orbits(r, *ways.T, side)
    fold = s[far] == 0
    end, deep = (np.where(fold, 0.0, v) for v in (orbits.ends(), orbits.centres()))
    good = np.isfinite(end) & np.isfinite(deep) & (g["n"] * np.abs(end) < TURNED)
    size = np.abs(orbits.moved(np.nan_to_num(end))).max(axis=0)
    good &= FAR * size < r.parabolic_shift_size
    end, deep = np.where(good, end, 0.0), np.where(good, deep, 0.0)
    alpha = end[:, None] * shares_of(np.where(fold, 0.0, orbits.sharpness(end)), u[strip], strip)
    w = np.abs(alpha) * np.sqrt(2 * np.maximum(orbits.fall(alpha), 0.0))
    w[:, 0] = w[:, -1] = 0.0
    points = _states(r, *orbits.moved(alpha), side[:, None] * w)
    still = np.zeros(len(end))
    new = {"end": end * g["n"] * g["flip"], "offset": alpha * g["n"] * g["flip"], "w": w * g["n"],
           "points": points, "found": good | fold,
           "shared": np.zeros(len(end), bool), "ways": ways,
           "saddle_state": _states(r, orbits.u, orbits.v, still),
           "centre_state": _states(r, *orbits.wells(deep), still)}
    out = dict(vars(made))
    for name, values in new.items():
        out[name] = np.array(out[name])
        out[name][strip[good], row[good]] = values[good]
    return type(made)(**out)


def _states(r, u, v, w):
    out = np.empty(np.shape(w) + (3,))
    out[..., r.j], out[..., r.k], out[..., r.axis] = u, v, w - float(r.s)
    return out


def residual_far(land, loops):
    """(r, m) residuals of the rows of loops that are `far`, from their points: energy above the saddle's over
    the size of its terms at the nearest place of the orbit, or how far that is from the point, relative to
    its size."""
    r, far = land.reduction, loops.far
    points, alpha = loops.points[far], loops.offset[far] * land.unit
    orbits = Orbits(r, *loops.ways[far].T, np.sign(alpha[:, -1]))
    u, v = orbits.moved(alpha)
    speed = np.array([orbits.r.p * v + orbits.r.p0, orbits.r.q * u + orbits.r.q0])
    off = np.array([points[..., r.j] - u, points[..., r.k] - v])
    square = np.maximum((speed * speed).sum(axis=0), TINY)
    along = (off * speed).sum(axis=0) / square
    w, size = points[..., r.axis] + float(r.s), np.abs(points[..., r.j]) + np.abs(points[..., r.k])
    beside = np.abs(off[0] * speed[1] - off[1] * speed[0]) / np.sqrt(square) / np.maximum(size, TINY)
    alpha = alpha + along
    departure = np.abs(0.5 * w * w - alpha * alpha * orbits.fall(alpha))
    terms = 0.5 * w * w + orbits.r.terms((points[..., r.j], points[..., r.k])) * np.abs(alpha)
    return np.fmax(np.where(departure > 0, departure / np.maximum(terms, TINY), 0.0), beside)
