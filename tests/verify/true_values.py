"""The value that a bracket of a certificate should hold, from the equations alone, in 50 digits: nothing of
the package, nothing of `verify`.

A motion is a Taylor series in mpmath (`oracles.taylor`), step by step. Its extremes are zeros of a rate, its
period is the return to the start. An isolated equilibrium is a zero of the rates by Newton's method. A fold is a
zero of m in the characteristic polynomial z^3 + m z + n of the Jacobian matrix, along the curve that the
certificate names.
"""
from __future__ import annotations

from fractions import Fraction as F

import mpmath as mp

from tests.oracles import taylor
from tests.verify.trapped import model_of, rates_of

# the latter beside a plane that is left as exp(angle): what is lost there grows by exp(DECAYED) = 1e48
DIGITS, MORE = 55, 115
# relative errors of a run, and of a zero by Newton's method: in 20 more digits both differ by 2e-5 of these
# at most
LOST, ROUNDED = F(1, 10**46), F(1, 10**51)
SAMPLES = 12  # of each rate in a step, between which one sign change is looked for
# angles of a spin-up: more than a turn, and one at which a transverse part that decays as exp(-angle) is
# 1e-48
ROUND, DECAYED = 7, 110


def number(value):
    fraction = F(value)
    return mp.mpf(fraction.numerator) / fraction.denominator


class TrueValues:
    """The values of one certificate's brackets; each is worked out once, when it is asked for."""

    def __init__(self, claims):
        self.claims, self._run, self._known = claims, None, {}

    def holds(self, path, low, high):
        """Whether [low, high] holds the value at a path: True, False, or None where it is not known from
        here, or as near to an end as its error."""
        if path not in self._known:
            with mp.workdps(DIGITS):
                self._known[path] = self._value(path)
        found = self._known[path]
        if found is None:
            return None
        value, error = found
        low, high = F(low), F(high)
        if low <= value - error and value + error <= high:
            return True
        return False if value + error < low or high < value - error else None

    def _value(self, path):
        """(value, error) as fractions, or None."""
        if path[0] == "motion" and path[1] in ("extremes", "period"):
            self._run = self._run or Run(self.claims)
            value = self._run.period if path[1] == "period" else self._run.extremes[path[2]][path[3]]
            size, share = self._run.size, LOST
        elif path[:3] == ("motion", "spin_up", "way"):
            (value, size), share = self._on_the_way(path[3], path[5]), LOST
        elif path[:2] == ("equilibria", "points"):
            x = self._equilibrium(path[2])
            value, size, share = x[path[4]], max(map(abs, x)), ROUNDED
        elif path[-1] == "t" or path[-2] == "t":
            value, size, share = self._fold(path), 0, ROUNDED
        else:
            return None
        if value is None:
            return None
        return fraction(value), F(0) if value == 0 else share * fraction(max(abs(value), size))

    def _on_the_way(self, n, i):
        """Component i of the state at the n-th time of the way, and the size of the state."""
        x = state_at(self.claims, number(self.claims["motion"]["spin_up"]["way"][n]["t"]))
        return x[i], max(map(abs, x))

    def _equilibrium(self, n):
        rates = rates_of(self.claims["scene"], number)
        start = [(number(low) + number(high)) / 2 for low,
                 high in self.claims["equilibria"]["points"][n]["box"]]
        return list(mp.findroot(lambda *x: rate(rates, x), start, tol=mp.mpf(10)**(20 - 2 * mp.mp.dps)))

    def _fold(self, path):
        """The parameter of a zero of m next to the bracket's middle; None for a bracket that is a single
        number (poles, crossings)."""
        curve, ends = self.claims["equilibria"]["curves"][path[2]], self.claims["equilibria"]
        for key in path[1:]:
            ends = ends[key]
        low, high = map(number, ends)
        if low == high:
            return None
        rates = rates_of(self.claims["scene"], number)
        return mp.findroot(lambda t: second_coefficient(rates, on_curve(curve, t)), (low, high),
                           tol=mp.mpf(10)**(20 - 2 * mp.mp.dps))


def fraction(value):
    sign, mantissa, exponent, _ = mp.mpf(value)._mpf_
    return (-1)**sign * F(int(mantissa)) * F(2)**int(exponent)


def on_curve(curve, t):
    at = lambda row: mp.polyval([number(c) for c in row[::-1]], t)
    return [at(row) / at(curve["denominator"]) for row in curve["numerators"]]


def rate(rates, x):
    return [k * x[(i + 1) % 3] * x[(i + 2) % 3] + r * x[(i + 2) % 3] + s * x[(i + 1) % 3] + m for i,
            (k, r, s, m) in enumerate(zip(*rates))]


def second_coefficient(rates, x):
    """m of the Jacobian matrix at x: the sum of its principal minors, whose diagonal entries vanish."""
    kappa, rho, sigma, _ = rates
    by_next = [kappa[i] * x[(i + 2) % 3] + sigma[i] for i in range(3)]  # d x_i' / d x_(i+1)
    by_last = [kappa[i] * x[(i + 1) % 3] + rho[i] for i in range(3)]
    return -sum(by_next[i] * by_last[(i + 1) % 3] for i in range(3))


def series(rates, x):
    """The first coefficients of the Taylor series of three components, and a step within which the rest is
    below a unit of the last digit but two."""
    order = mp.mp.dps + 5
    rows = taylor.coefficients(rates, x, order)
    return rows, min(taylor.step_length(rows, order, mp.mp.dps - 2), mp.mpf(1))


def at(row, s):
    return mp.polyval(row[::-1], s)


def state_at(claims, end):
    """The state at a time."""
    return taylor.integrate(model_of(claims["scene"]), claims["motion"]["state"], [end], digits=mp.mp.dps)[0]


class Run:
    """A motion from its state on: over one period where it returns, else until it has spun so far that
    nothing new comes."""

    def __init__(self, claims):
        motion = claims["motion"]
        self.rates = rates_of(claims["scene"], number)
        self.start = [number(v) for v in motion["state"]]
        self.period, self.size = None, max(map(abs, self.start))
        self.seen = [[v, v] for v in self.start]
        spinning = None if motion["fate"] == "bounded" else motion["axis"] - 1
        with mp.workdps(MORE if spinning is not None and self._saddle(spinning) > 0 else DIGITS):
            self._follow(spinning, motion["sense"])

    @property
    def extremes(self):
        """Least and greatest of each component. One that falls below 10^-45 for ever without a change of sign
        has zero as its limit."""
        return [[mp.mpf(0) if abs(v) < mp.mpf(10)**-45 * self.size else v for v in pair]
                for pair in self.seen]

    def _follow(self, spinning, sense):
        x, t, angle, least = self.start, mp.mpf(0), mp.mpf(0), mp.mpf(0)
        first = rate(self.rates, x)
        while spinning is None or angle - least < self._enough(spinning):
            rows, step = series(self.rates, x)
            self._see(rows, step)
            if spinning is None and t > 0 and (back := self._return(rows, first, step)) is not None:
                self.period = t + back
                return
            if spinning is not None:
                angle += sense * sum(c * step**(n + 1) / (n + 1) for n, c in enumerate(rows[spinning]))
                least = min(least, angle)
            x, t = [at(row, step) for row in rows], t + step
            self.size = max(self.size, max(map(abs, x)))

    def _saddle(self, i):
        """kappa_j kappa_k: positive where the transverse part grows and decays with the spin instead of
        turning."""
        return self.rates[0][(i + 1) % 3] * self.rates[0][(i + 2) % 3]

    def _enough(self, i):
        """The integral of the spin over time after which a transverse part has gone round, or decayed: it
        turns at sqrt(-kappa_j kappa_k) times the spin."""
        product = self._saddle(i)
        return (DECAYED if product > 0 else ROUND) / mp.sqrt(abs(product) or 1)

    def _see(self, rows, step):
        for row, seen in zip(rows, self.seen):
            slope = [n * c for n, c in enumerate(row)][1:]
            for s in [*zeros(slope, step), step]:
                v = at(row, s)
                seen[:] = [min(seen[0], v), max(seen[1], v)]

    def _return(self, rows, first, step):
        """The time within a step at which the state is the first one again, or None."""
        apart = [mp.fdot(first, [row[n] - (v if n == 0 else 0) for row, v in zip(rows, self.start)])
                 for n in range(len(rows[0]))]
        for s in zeros(apart, step):
            if max(abs(at(row, s) - v) for row, v in zip(rows, self.start)) < mp.mpf(10)**-30 * self.size:
                return s
        return None


def zeros(row, step):
    """Places within a step at which a series changes its sign."""
    marks = [step * n / SAMPLES for n in range(SAMPLES + 1)]
    values = [at(row, s) for s in marks]
    out = []
    for a, b, u, v in zip(marks, marks[1:], values, values[1:]):
        if u * v < 0:
            out.append(mp.findroot(lambda s: at(row, s), (a, b), solver="anderson",
                                   tol=mp.mpf(10)**(30 - 2 * mp.mp.dps), verify=False))
        elif v == 0:
            out.append(b)
    return out
