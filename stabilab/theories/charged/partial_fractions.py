"""The charged axisymmetric body long after its start: the divided differences as partial fractions, formed
once per body.

Where all frequencies 0, r0, w, r0 + w, r0 - w are far apart (times t), no partial fraction is larger than
what it adds up to, and every output is a fixed combination of cos and sin of wt, r0 t, (r0 + w) t, (r0 - w) t
and of 1, t, t^2: one product of matrices. `axisymmetric_terms` has the formulas, and what holds nearer to the
start.
"""
from __future__ import annotations

from functools import lru_cache
from math import factorial

import numpy as np

from ...numbers.error_free import exact_product
from .modes import ChargedBody, modes
from .terms import Terms

# |difference of two frequencies| t from which on the fractions are used: from 3 on they lose no more than the
# rounding of
# the data and of t does, at 1 eight times that (measured against balls; tests)
WIDE = 4.0
RANGE = 1e40  # rates beyond, or below its inverse, overflow in the products of six
NODES, POWERS = "+-fbhl", 3  # of `axisymmetric_terms`, and of t: what a divided difference is made of
AGAINST = {"-": "+", "b": "f"}  # the node that turns the other way
TURNING = "+fhl"


class Coefficients(Terms):
    """`Terms` whose divided differences are arrays of coefficients of e^(node t) for NODES, then of 1, t,
    t^2."""

    def __init__(self, body: ChargedBody):
        super().__init__(body, np.zeros(()), modes(body))
        self.nodes, self.low = ({n: complex(v) for n, v in d.items()} for d in (self.nodes, self.low))

    def gap(self, i, j) -> complex:
        """Node i minus node j."""
        return (self.nodes[i] - self.nodes[j]) + (self.low[i] - self.low[j])

    def _tables(self, names, counts):
        return {c: self._fractions(names, c) for c in counts}

    def _fractions(self, names, counts):
        """Residues of e^(st) / product of (s - node): the node 0, which comes first, may be there up to four
        times."""
        zeros, single = (counts[0],
                         [n for n, c in zip(names[1:], counts[1:]) if c]) if names[0] == "0" else (0, names)
        out = np.zeros(len(NODES) + POWERS, complex)
        for n in single:
            rest = self.gap(n, "0") ** zeros
            for other in single:
                rest *= self.gap(n, other) if other != n else 1.0
            out[NODES.index(n)] = 1 / rest
        series = [1.0 + 0j] + [0j] * POWERS  # of 1/product of (s - node) about s = 0
        for n in single:
            for k in range(len(series)):
                series[k] = ((series[k - 1] if k else 0) - series[k]) / self.gap(n, "0")
        for k in range(min(zeros, POWERS)):
            out[len(NODES) + k] = series[zeros - 1 - k] / factorial(k)
        return out

    def power(self, n, factor=1.0):
        """factor t^n."""
        out = np.zeros(len(NODES) + POWERS, complex)
        out[len(NODES) + n] = factor
        return out

    def outputs(self) -> list:
        """Complex combinations: p + iq, Gamma, G1 + i G2, and with a mass v1 + i v2, v3, x1 + i x2, x3."""
        body, J = self.body, self.J(0, 1, 2)
        D = self._tables("0+-", [(0, 1, 0), (0, 0, 1), (0, 1, 1), (1, 1, 1)])
        C, S, S2 = (D[0, 1, 0] + D[0, 0, 1]) / 2, D[0, 1, 1], D[1, 1, 1]
        Pi = ((self.p0 + 1j * self.q0) * C
              + (self.m1 - self.a * self.q0 + 1j * (self.m2 + self.b * self.p0)) * S
              + (1j * self.b * self.m1 - self.a * self.m2) * S2)
        wheel, Z, away = self._tables("0f", [(1, 1), (2, 1)]), self.Z(1, 2), self.Z(0, start=0.0)[0]
        found = [Pi, J[0],
                 self.turn * (self.power(0, self.still_momentum()) + self.M * wheel[1, 1]
                              - 1j * body.charge_moment * away)]
        if body.mass is None:
            return found
        f, f3 = body.force[..., 0] + 1j * body.force[..., 1], body.force[..., 2]
        for n, start in ((1, [body.velocity]), (2, [body.position, body.velocity])):
            free = [sum(self.power(k, v[..., 0] + 1j * v[..., 1]) for k, v in enumerate(start)),
                    sum(self.power(k, v[..., 2]) for k, v in enumerate(start))]
            across = self.turn * (f * wheel[n, 1] - 1j * f3 * Z[n])
            along = self.power(n, f3 / n) + 1j * np.conj(f) * J[n]  # of which the real part counts
            found += [free[0] + across / body.mass, free[1] + along / body.mass]
        return found


class Fractions:
    """Rates, angles, momentum and, with a mass, velocity and position, (5 or 3, len(t), 3), at times |t| >=
    wide, s; start: the same at t = 0, (5 or 3, 3)."""

    def __init__(self, body: ChargedBody):
        terms = Coefficients(body)
        rates = [abs(terms.nodes[n]) for n in TURNING]
        self.wide = WIDE / min(rates) if min(rates) * RANGE > 1 and max(rates) < RANGE else np.inf
        if not np.isfinite(self.wide):
            return
        self.angles = [(terms.nodes[n].imag, terms.low[n].imag) for n in "+f"]
        self.columns = np.stack([column for part in self._columns(terms, body) for column in part], axis=1)
        G = terms.turn * terms.still_momentum()
        start = [(*body.rates, body.spin), body.attitude, (G.real, G.imag, terms.axial_momentum()),
                 body.velocity, body.position]
        self.start = np.array([np.array(row, float) for row in start[:self.columns.shape[1] // 3]])

    def _columns(self, terms, body):
        """Combinations of the basis for each component of each part."""
        Pi, Gamma, G, *places = terms.outputs()
        for across, along in ((Pi, terms.power(0, body.spin)),
                              (Gamma, terms.power(0, body.attitude[2]) + terms.power(1, body.spin)),
                              (G, terms.power(0, terms.axial_momentum())), *zip(places[::2], places[1::2])):
            yield _real(across), _imaginary(across), _real(along)

    def __call__(self, t):
        (cw, sw), (cr, sr) = (_turned(*angle, t) for angle in self.angles)
        basis = (cw, sw, cr, sr, cr * cw - sr * sw, sr * cw + cr * sw, cr * cw + sr * sw, sr * cw - cr * sw,
                 np.ones_like(t), t, t * t)
        return np.moveaxis((np.stack(basis, axis=1) @ self.columns).reshape(len(t), -1, 3), 1, 0)


@lru_cache(maxsize=64)
def fractions(body: ChargedBody) -> Fractions | None:
    """The fractions of one body, kept while it lives; None for a batch of bodies and in the unstable band."""
    single = not any(body.shapes)
    return Fractions(body) if single and not modes(body).unstable else None


def _real(z):
    """Coefficients of cos and sin of TURNING, then of 1, t, t^2, in the real part of a combination."""
    out = np.zeros(2 * len(TURNING) + POWERS)
    for n, c in zip(NODES, z):
        place = 2 * TURNING.index(AGAINST.get(n, n))
        out[place] += c.real
        out[place + 1] += c.imag if n in AGAINST else -c.imag
    out[2 * len(TURNING):] = z[len(NODES):].real
    return out


def _imaginary(z):
    return _real(-1j * z)


def _turned(rate, rest, t):
    """cos and sin of (rate + rest) t, the rounding of the product made good."""
    angle, low = exact_product(rate, t)
    low = low + rest * t
    c, s, dc, ds = np.cos(angle), np.sin(angle), np.cos(low), np.sin(low)
    return c * dc - s * ds, s * dc + c * ds
