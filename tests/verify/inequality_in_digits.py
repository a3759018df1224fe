"""The inequality of spin-up about a fixed centre in 60 digits, by substitution and elimination: no code of
`verify`, none of the analysis.

The form is not taken from formulas: the rates are written in zeta, its conjugate and X, and what the theorem
says of them is asserted. A polynomial is {(j, k, n): c} for c zeta^j zeta*^k X^-n.
"""
import mpmath as mp

from .trapped import rates_of
from .true_values import number

DIGITS = 60
NOTHING = mp.mpf(10) ** -50


def total(*tables):
    out = {}
    for table in tables:
        for key, c in table.items():
            out[key] = out.get(key, 0) + c
    return {key: c for key, c in out.items() if abs(c) > NOTHING}


def product(one, other):
    return total(*({(j + m, k + n, a + b): c * d} for (j, k, a), c in one.items() for (m, n, b),
                   d in other.items()))


def times(factor, table):
    return {key: factor * c for key, c in table.items()}


class Form:
    """zeta' = i om X zeta + slow, X' = drive about an axis (1 to 3) in a sense, from a certificate's scene.
    """

    def __init__(self, scene, axis, sense):
        order = [(axis - 1 + n) % 3 for n in range(3)]
        self.order, self.signs = order, (sense, 1, sense)  # half a turn about the second
        own, ahead, later = ([self.signs[(i + n) % 3] for i in range(3)] for n in range(3))
        kappa, rho, sigma, m = ([row[n] for n in order] for row in rates_of(scene, number))
        kappa, rho = [v * a * b * c for v, a, b,
                      c in zip(kappa, own, ahead, later)], [v * a * b for v, a, b in zip(rho, own, later)]
        sigma, m = [v * a * b for v, a, b in zip(sigma, own, ahead)], [v * a for v, a in zip(m, own)]
        assert kappa[1] * kappa[2] < 0
        self.centre = -sigma[2] / kappa[2], -rho[1] / kappa[1]
        self.q = mp.sqrt(-kappa[1] / kappa[2]) * (1 if kappa[1] < 0 else -1)
        self.om = mp.sqrt(-kappa[1] * kappa[2])
        self.shift = (self.q * rho[2] - sigma[1] / self.q) / (2 * self.om)
        zeta, star, one = {(1, 0, 0): mp.mpc(1)}, {(0, 1, 0): mp.mpc(1)}, {(0, 0, 0): mp.mpc(1)}
        x = (total({(0, 0, -1): mp.mpc(1)}, times(-self.shift, one)),
             total(times(mp.mpf(1) / 2, total(zeta, star)), times(self.centre[0], one)),
             total(times(1 / (2j * self.q), total(zeta, times(-1, star))), times(self.centre[1], one)))
        rates = [total(times(kappa[i], product(x[(i + 1) % 3], x[(i + 2) % 3])),
                       times(rho[i], x[(i + 2) % 3]), times(sigma[i], x[(i + 1) % 3]),
                       times(m[i], one)) for i in range(3)]
        self.drive, self.slow = rates[0], total(rates[1], times(1j * self.q, rates[2]))
        assert abs(self.slow.pop((1, 0, -1))
                   - 1j * self.om) < NOTHING and set(self.slow) <= {(0, 1, 0), (0, 0, 0)}
        assert set(self.drive) <= {(0, 0, 0), (2, 0, 0), (0, 2, 0), (1, 0, 0), (0, 1, 0)}
        self.M = self.drive.get((0, 0, 0), mp.mpc(0)).real

    def place(self, state):
        x = [state[n] * s for n, s in zip(self.order, self.signs)]
        return x[0] + self.shift, mp.mpc(x[1] - self.centre[0], self.q * (x[2] - self.centre[1]))

    def price(self, terms):
        """The rate of terms apart from the turning."""
        star = {(k, j, n): c.conjugate() for (j, k, n), c in self.slow.items()}
        by = lambda place: {tuple(v - (i == place) for i, v in enumerate(key)): key[place] * c for key,
                            c in terms.items() if key[place]}
        steeper = {(j, k, n + 1): -n * c for (j, k, n), c in terms.items() if n}
        return total(product(by(0), self.slow), product(by(1), star), product(steeper, self.drive))

    def eliminated(self, rate, order):
        """(added, left) without oscillating terms up to X^-order, lowest degree first."""
        added = {}
        while moving := [key for key in rate if key[0] != key[1] and key[2] <= order]:
            low = min(key[2] for key in moving)
            now = {(j, k, n + 1): -rate[j, k, n] / (1j * self.om * (j - k)) for j, k, n in moving if n == low}
            rate = total({key: c for key, c in rate.items() if key[0] == key[1] or key[2] != low},
                         self.price(now))
            added = total(added, now)
        return added, rate


def corrections(form, orders):
    """(added to X^2/2, left of its rate, m, added to |zeta|^2 (1 + m/(M X)), left of its rate); M X + m is
    left out of the second."""
    spin = {key: c for key, c in form.drive.items() if key != (0, 0, 0)}
    high, rest = form.eliminated(product({(0, 0, -1): mp.mpc(1)}, spin), orders[0])
    m = rest.pop((0, 0, 0), mp.mpc(0)).real
    return high, rest, m, *form.eliminated(form.price({(1, 1, 0): mp.mpc(1), (1, 1, 1): mp.mpc(m / form.M)}),
                                           orders[1])


def holds(claims, state) -> bool:
    """Whether the inequality that a certificate claims about the fixed centre holds at a state (three numbers
    of mpmath)."""
    said = claims["motion"]["spin_up"]
    with mp.workdps(DIGITS):
        form = Form(claims["scene"], said["axis"], said["sense"])
        A, z, gain = (number(said[key]) for key in ("cone", "least", "gain"))
        if not (form.M > 0 and A > 0 and z > 0 and gain > 0):
            return False
        high, rest, m, wide, left = corrections(form, said["orders"])
        if min(n for _, _, n in (*high, *rest, (0, 0, 0))) < 0 or min((n for _, _, n in left), default=2) < 2:
            return False
        X, zeta = form.place(state)
        bound = lambda terms: sum(abs(c) * A ** (j + k) / z**n for (j, k, n), c in terms.items())
        value = lambda terms: sum((c * zeta**j * zeta.conjugate() ** k / X**n for (j, k, n),
                                   c in terms.items()), mp.mpc(0)).real
        eta, weight = form.M - (max(0, -m) + bound(rest)) / z, 1 + min(0, m) / (form.M * z)
        if not (X > z and abs(zeta) < A and eta >= gain and weight > 0
                and X * X / 2 + value(high) > z * z / 2 + bound(high)):
            return False
        after = sum(abs(c) * A ** (j + k) * z ** (1 - n) / (n - 1) for (j, k, n), c in left.items())
        return bool((abs(zeta) ** 2 * (1 + m / (form.M * X)) + value(wide) + bound(wide) + after / eta)
                    / weight < A * A)
