"""Tables 2 to 4 hold the doubles next to the true numbers."""
import mpmath as mp
import pytest

from stabilab.case.read import load
from stabilab.papers import table


def oracle(case):
    """(period, extremes of x1, x2, x3) by mpmath in 40 digits: the motion in one coordinate s, its potential
    U by hand, roots between signs and Gauss's rule. Minor axis: s = theta, x1 + a = A sin s, x2 = A cos s, s'
    = x3, U = -s - X^2/2 - (b - a) X with X = x1 + a. Middle axis: x1 + b and x3 = (start) cosh s + (start)
    sinh s, s' = x2, U = -s + (x1 + a)^2/2."""
    exact = lambda v: mp.mpf(v.numerator) / v.denominator
    (a, b), (x1, x2, x3) = (tuple(map(exact, row)) for row in (case.scene.exact_ab, case.exact_state))
    if case.name.startswith("minor"):
        A, here, rate, pair = mp.hypot(x1 + a, x2), mp.atan2(x1 + a, x2), x3, (0, 1, 2)
        first, second = lambda s: A * mp.sin(s) - a, lambda s: A * mp.cos(s)
        U = lambda s: -s - (first(s) + a) ** 2 / 2 - (b - a) * (first(s) + a)
    else:
        here, rate, pair = mp.mpf(0), x2, (0, 2, 1)
        first, second = lambda s: (x1
                                   + b) * mp.cosh(s) + x3 * mp.sinh(s) - b, lambda s: (x1 + b) * mp.sinh(
                                       s) + x3 * mp.cosh(s)
        U = lambda s: -s + (first(s) + a) ** 2 / 2
    E = rate**2 / 2 + U(here)
    ends = []
    for way in (-1, 1):
        step = next(n for n in range(1, 10_000) if U(here + way * mp.mpf(n) / 200) > E)
        ends.append(mp.findroot(lambda s: U(s) - E,
                                (here + way * mp.mpf(step - 1) / 200, here + way * mp.mpf(step) / 200),
                                solver="anderson"))
    (low, high), grid = ends, 80

    def most(f):
        """Least and greatest of f over [low, high]: its ends, and where its slope changes sign on a grid."""
        points = [low + (high - low) * n / grid for n in range(grid + 1)]
        inner = [mp.findroot(lambda s: mp.diff(f, s), (p, q), solver="anderson") for p,
                 q in zip(points, points[1:])
                 if mp.diff(f, p) * mp.diff(f, q) < 0]
        values = [f(s) for s in (low, high, *inner)]
        return min(values), max(values)
    middle, half = (low + high) / 2, (high - low) / 2
    speed = mp.sqrt(2 * (E - most(U)[0]))
    inverse = lambda u: half * mp.cos(u) / mp.sqrt(2 * (E - U(middle + half * mp.sin(u))))
    period = 2 * mp.quad(inverse, mp.linspace(-mp.pi / 2, mp.pi / 2, 5), method="gauss-legendre")
    found = dict(zip(pair, (most(first), most(second), (-speed, speed))))
    return [period, *(v for n in range(3) for v in found[n])]


@pytest.mark.parametrize("number, stem",
                         [(2, "minor-axis-100"), (2, "minor-axis-500"), (3, "middle-axis-500"),
                                          (4, "middle-axis-plane-500")])
def test_every_number_is_the_double_next_to_the_true_one(number, stem):
    row = table._extremes_row(table.cases_folder() / f"{stem}.toml", 0, ())
    with mp.workdps(40):
        assert list(row[8:]) == [float(v) for v in oracle(load(table.cases_folder() / f"{stem}.toml"))]
