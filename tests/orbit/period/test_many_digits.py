"""Periods to many digits: free bodies as elliptic curves, reductions under a torque as sums whose remainder is
proved."""
import math
from fractions import Fraction
from itertools import product

import mpmath as mp
import numpy as np
import pytest
from flint import arb, ctx

from stabilab import load
from stabilab.numbers.balls import working
from stabilab.orbit.extremes import extreme_balls, turning_points
from stabilab.orbit.fate import fate_of
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import free_quartic, period_ball, real_period, time_from_turn
from stabilab.orbit.period_sum import plan, summed
from stabilab.orbit.reduction import reduce
from stabilab.orbit.result import Fate
from stabilab.physics.body import Body
from stabilab.physics.effects.constant_torque import ConstantTorque
from stabilab.physics.effects.gyrostat import Gyrostat
from stabilab.physics.scene import Scene
from tests.oracles import energy
from tests.oracles.model import physical, scaled
from tests.oracles.taylor import integrate_checked
from tests.shared import CASES

FREE, TORQUED = load(CASES / "torque-free-body.toml"), load(CASES / "minor-axis-100.toml")
SPARE = 40  # digits of an oracle beyond those compared


def of_case(one, digits):
    return period_ball(Orbit(reduce(one.scene), one.exact_state), digits)


def euler(D, omega, digits):
    """Period of a free body, times 10^digits, by integers alone: 4 K(m)/lambda of Landau & Lifshitz, Mechanics,
    section 37, K by Gauss's mean of integer square roots."""
    one = 10 ** (digits + SPARE)
    T2, H2 = (sum(d**n * w * w for d, w in zip(D, omega)) for n in (1, 2))
    low, middle, high = sorted(D)
    a, c = (low, high) if H2 < T2 * middle else (high, low)
    speed = abs((H2 - T2 * c) * (a - middle) / (D[0] * D[1] * D[2]))
    m = abs((H2 - T2 * a) * (middle - c)) / abs((H2 - T2 * c) * (a - middle))
    root = lambda f: math.isqrt(f.numerator * one * one // f.denominator)
    x, y = one, root(1 - m)
    while abs(x - y) > 1:
        x, y = (x + y) // 2, math.isqrt(x * y)
    with mp.workdps(digits + SPARE):
        pi = int(mp.floor(mp.pi * one))
    return 2 * pi * one // x * one // root(speed) // 10**SPARE


def as_integer(ball, digits):
    """floor(10^digits times it); its radius must be far below."""
    with ctx.workprec(int(3.33 * (digits + SPARE)) + 64):
        assert ball.rad() < arb(10) ** -(digits + 1) * abs(ball)
        return int((ball.mid() * arb(10) ** digits).floor().unique_fmpz())


@pytest.mark.parametrize("digits", [50, 1000, 10_000])
def test_the_period_of_a_free_body_has_ten_thousand_digits(digits):
    # by hand in integers, see `euler`
    expected = euler(FREE.scene.body.exact, FREE.exact_state, digits)
    assert abs(as_integer(of_case(FREE, digits), digits) - expected) <= 50  # 33 s: the ball is relative
    assert of_case(FREE, digits).rel_accuracy_bits() >= digits * math.log2(10)


def test_extremes_of_a_free_body_have_ten_thousand_digits():
    # omega_a^2 is greatest where omega_c = 0, and least where omega_b = 0: squares of rationals in integers
    D, omega, digits = FREE.scene.body.exact, FREE.exact_state, 10_000
    T2, H2 = (sum(d**n * w * w for d, w in zip(D, omega)) for n in (1, 2))
    balls = extreme_balls(Orbit(reduce(FREE.scene), FREE.exact_state), Fate.BOUNDED, int(3.33 * digits))
    one = 10**digits
    for i, pair in enumerate(balls):
        others = [D[k] for k in range(3) if k != i]
        squares = [(H2 - T2 * d) / (D[i] * (D[i] - d)) for d in others]
        roots = sorted(math.isqrt(int(s * one * one)) for s in squares if s >= 0)
        low, high = (as_integer(v, digits) for v in pair)
        assert min(abs(high - root) for root in roots) <= 2, i
        assert low < 0 or min(abs(low - root) for root in roots) <= 2, i


@pytest.mark.parametrize("distance", [Fraction(1, 10**n) for n in (3, 30, 300)])
def test_beside_the_separatrix_the_period_of_a_free_body_keeps_its_digits(distance):
    # on Euler's polhode through the middle axis D1 (D1 - D2) w1^2 = D3 (D2 - D3) w3^2; 4 K(m)/lambda in mpmath
    D, digits = (Fraction(4), Fraction(3), Fraction(3, 2)), 200
    omega = (3 * (1 - distance), Fraction(1), Fraction(4))
    ball = real_period(free_quartic(D, (0, 0, 0), omega), digits)
    with mp.workdps(digits + 700):
        T2, H2 = (sum(d**n * w * w for d, w in zip(D, omega)) for n in (1, 2))
        low, middle, high = sorted(D)
        a, c = (low, high) if H2 < T2 * middle else (high, low)
        number = lambda f: mp.mpf(f.numerator) / f.denominator
        speed = number(abs((H2 - T2 * c) * (a - middle)) / (D[0] * D[1] * D[2]))
        m = number(abs((H2 - T2 * a) * (middle - c)) / abs((H2 - T2 * c) * (a - middle)))
        exact = 4 * mp.ellipk(m) / mp.sqrt(speed)
        assert abs(mp.mpf(ball.mid().str(digits + 20, radius=False)) / exact - 1) < mp.mpf(10) ** -digits


@pytest.mark.parametrize("D, wheel", [
    ((2, 3, 4), ("0.5", "0.25", 1)), ((2, 2, 3), (0, "0.5", "0.25")), ((3, 2, 2), (1, "0.5", "0.25")),
    ((2, 3, 4), (1000, -2000, 500)), ((2, 2, 2), (1, 2, 3)), ((2, 3, 4), (0, 0, 1))])
def test_the_period_of_any_free_gyrostat_brings_it_home(D, wheel):
    # the Taylor series of tests/oracles/taylor.py in mpmath; half the period does not
    D, wheel = tuple(map(Fraction, D)), tuple(map(Fraction, wheel))
    start = (Fraction(1), Fraction(1, 2), Fraction(1, 4))
    ball = real_period(free_quartic(D, wheel, start), 25)
    with mp.workdps(40):
        period = mp.mpf(ball.mid().str(35, radius=False))
        (half, back), gap = integrate_checked(physical(D, wheel), tuple(map(float, start)),
                                              [period / 2, period], 25)
        off = lambda row: max(abs(v - mp.mpf(float(s))) for v, s in zip(row, start))
        assert off(back) < 1e-18 + gap and off(half) > 1e-3


def equal_steps(model, state, digits, count):
    """The period by count midpoints of y = middle - half cos(phi), in mpmath: the potential of
    tests/oracles/energy.py."""
    with mp.workdps(digits + SPARE):
        motion = energy.motion_of(model, state, digits + SPARE, None)
        (_, high), (_, low) = motion.end(+1), motion.end(-1)
        half, total = (high - low) / 2, mp.mpf(0)
        for n in range(count):
            phi = mp.pi * (2 * n + 1) / (2 * count)
            total += half * mp.sin(phi) / mp.sqrt(abs(motion.g((high + low) / 2 - half * mp.cos(phi))))
        return 2 * mp.pi / count * total


@pytest.mark.parametrize("digits", [50, pytest.param(200, marks=pytest.mark.slow)])
def test_the_period_under_a_torque_has_the_digits_of_mpmath(digits):
    model = scaled(*TORQUED.scene.exact_ab, TORQUED.scene.exact_mu)
    exact = equal_steps(model, TORQUED.exact_state, digits, 3 * digits)
    with mp.workdps(digits + SPARE):
        near = mp.mpf(of_case(TORQUED, digits).mid().str(digits + 10, radius=False))
        assert abs(near / exact - 1) < mp.mpf(10) ** -digits


def random_scenes(count, seed):
    """(scene, exact state) of bounded motions under a torque on an axis: ordinary bodies, moments that nearly
    meet, large wheels, feeble torques."""
    rng = np.random.default_rng(seed)
    while count:
        D = [Fraction(int(v), 50) for v in rng.integers(50, 100, 3)]
        if rng.integers(3) == 0:
            D[1] = D[0] + Fraction(1, 10 ** int(rng.integers(3, 12)))
        axis = int(rng.integers(3))
        wheel = [Fraction(int(v), 100) * 10 ** int(4 * (rng.integers(4) == 0))
                 for v in rng.integers(-100, 100, 3)]
        torque = [Fraction(0)] * 3
        wheel[axis], torque[axis] = Fraction(0), Fraction(int(rng.integers(1, 100)),
                                                          10 ** int(rng.integers(2, 10)))
        state = [Fraction(int(v), 100) for v in rng.integers(-100, 100, 3)]
        if len(set(D)) < 3 or 2 * max(D) >= sum(D):
            continue
        scene = Scene(Body(D), Gyrostat(wheel), ConstantTorque(torque))
        orbit = Orbit(reduce(scene), state)
        if fate_of(scene, orbit).label == Fate.BOUNDED:
            count -= 1
            yield scene, orbit


def by_integral(orbit):
    left, right = turning_points(orbit)
    middle = ((left + right) / 2).mid()
    return 2 * (time_from_turn(orbit, left, middle) + time_from_turn(orbit, right, middle))


def test_the_sum_and_the_integral_agree_for_random_scenes():
    # two rules: equal steps with a bound on a strip, and arb's Gauss-Legendre on pieces
    for _, orbit in random_scenes(20, 3):
        ball, other = period_ball(orbit, 30), orbit.settled(by_integral, 192)
        assert ball.overlaps(other) and ball.rel_accuracy_bits() > 99 and other.rel_accuracy_bits() > 40


def test_the_remainder_of_few_terms_is_within_its_bound():
    for _, orbit in random_scenes(10, 5):
        exact = period_ball(orbit, 40)
        for bits in (192, 384):
            def few(item):
                left, right = turning_points(item)
                by = plan(item, left, right, 64)
                return [(by.remainder(n), summed(item, left, right, by, n)) for n in (4, 8, 12)] if by else []
            for bound, ball in orbit.settled(few, bits):
                with working(bits):
                    assert ball.overlaps(exact) and abs(ball.mid() - exact.mid()) <= bound * 1.01


@pytest.mark.one_in(2)
@pytest.mark.parametrize("decade", [6, 15, 30])
def test_beside_a_barrier_the_period_under_a_torque_is_proved(decade):
    # the start is at rest 10^-decade before the place of the saddle: an unstable place that it leaves slowly
    orbit = Orbit(reduce(TORQUED.scene), TORQUED.exact_state)

    def saddle(item):
        spot = next(s for s in item.barriers())
        return [Fraction(int(v.fmpq().p), int(v.fmpq().q)) for v in
                (u.mid() for u in item.components(spot.y - arb(10) ** -decade))]
    first, second = orbit.settled(saddle, 256)
    r = orbit.reduction
    state = [Fraction(0)] * 3
    state[r.j], state[r.k] = first, second
    close = Orbit(r, state)
    assert fate_of(TORQUED.scene, close).label == Fate.BOUNDED
    ball, other = period_ball(close, 40), close.settled(by_integral, 512)
    assert ball.overlaps(other) and ball.rel_accuracy_bits() > 132
    assert float(ball) > decade  # it grows with the logarithm of the distance


@pytest.mark.slow
@pytest.mark.long
def test_ten_thousand_digits_under_a_torque_by_two_rules():
    # equal steps of an angle, with the potential of the scaled equations written here, against the sum of the
    # package, whose steps are those of a Jacobian elliptic argument; they share arb's sine and cosine alone
    digits = 10_000
    ball, model = of_case(TORQUED, digits), scaled(*TORQUED.scene.exact_ab, TORQUED.scene.exact_mu)
    with mp.workdps(40):
        rough = equal_steps(model, TORQUED.exact_state, 25, 120)
        assert abs(mp.mpf(ball.mid().str(30, radius=False)) / rough - 1) < mp.mpf(10) ** -24
    orbit = Orbit(reduce(TORQUED.scene), TORQUED.exact_state)

    def angles(item):
        left, right = turning_points(item)
        middle, half, total, count = (left + right) / 2, (right - left) / 2, arb(0), 18_000
        for n in range(count):
            s, c = arb.sin_cos_pi_fmpq(arb(2 * n + 1).fmpq() / (2 * count))
            total += half * s / (2 * (item.energy - item.height(middle - half * c))).sqrt()
        return 2 * arb.pi() / count * total
    other = orbit.settled(angles, int(3.33 * digits) + 128)
    with working(int(3.33 * digits) + 128):
        assert abs(other - ball) < arb(10) ** -(digits - 2)


def test_a_sum_says_beforehand_how_long_it_takes():
    said = []
    period_ball(Orbit(reduce(TORQUED.scene), TORQUED.exact_state), 60, said.append)
    assert len(said) >= 1 and all(0 < seconds < 60 for seconds in said)


def test_the_third_integral_is_that_of_mpmath():
    for n, m in product(("-3", "-0.5", "0", "0.3", "0.999"), ("0", "0.1", "0.999999")):
        with working(800) as numbers:
            full, third = numbers.elliptic(arb(n), arb(m))
        with mp.workdps(220):
            for ball, exact in ((full, mp.ellipk(mp.mpf(m))), (third, mp.ellippi(mp.mpf(n), mp.mpf(m)))):
                assert abs(mp.mpf(ball.mid().str(230, radius=False)) / exact - 1) < mp.mpf(10) ** -195
