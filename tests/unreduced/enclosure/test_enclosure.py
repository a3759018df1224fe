"""Enclosures hold the motions: judged by runs in 50 digits of another code, over bodies, sizes and kinds of
numbers."""
import math
import random
import subprocess
import sys
from fractions import Fraction

import mpmath
import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.errors import InputError
from stabilab.numbers.numba_door import IMPORT, Kernel, installed
from stabilab.unreduced import enclosure_kernel
from stabilab.unreduced.enclosure import ADVANCE, STEP, Course
from tests.oracles import taylor
from tests.oracles.pairs import model_of
from tests.oracles.taylor import integrate

from ..spin_up.scenes import EXAMPLE, random_scene, sphere


def shares(middle, rest, radius, true):
    """|true - (middle + rest)|/radius of three rates: at most 1 where the enclosure holds."""
    with mpmath.workdps(50):
        return [float(abs(mpmath.mpf(float(m)) + mpmath.mpf(float(r)) - x) / mpmath.mpf(float(e)))
                for m, r, e, x in zip(middle, rest, radius, true)]


def drawn(rng, n):
    """(scene, start, time): generic, nearly equal moments, scaled, fast; starts are doubles or decimals that
    are none."""
    scene, kind = random_scene(rng), n % 4
    if kind == 1:
        wheel = Gyrostat(sphere(rng, rng.choice((0, 1))))
        scene = Scene(Body((1, 1 + rng.choice((1e-3, 1e-6, 1e-9)), rng.uniform(.3, 1.5))), wheel,
                      ConstantTorque(sphere(rng)))
    if kind == 2:
        scene = ScaledGyrostat(Fraction(rng.uniform(-1, 1)), Fraction(rng.uniform(-1, 1)),
                               tuple(map(Fraction, sphere(rng))))
    size = rng.choice((.1, 1, 10)) if kind < 3 else rng.choice((1e3, 1e5))
    start = [Fraction(v) for v in sphere(rng, size)]
    if n % 3 == 0:
        start = [Fraction(round(v * 1000), 1000) for v in start]
    return scene, start, rng.choice((.25, 1., 2.5)) / max(size, 1)


def enclose(scene, state, t, steps=None):
    course = Course(scene, state, t)
    course.advance(t, steps)
    return course.now


def holds(scene, start, end, rng):
    """The greatest share of a radius that the true motion takes, at the end and at times between; the
    enclosure at the end."""
    course, bands = Course(scene, start, end), []
    while course.status == enclosure_kernel.GOING:
        bands.append(course.advance(end, band=True))
    found = course.now
    assert found.status == "enclosed" and found.t == end
    times = sorted(rng.uniform(0, end) for _ in range(2))
    *between, last = integrate(model_of(scene), start, [*times, end])
    worst = shares(found.middle, found.rest, found.radius, last)
    for t, true in zip(times, between):
        band = next(b for b in bands if b.times[0] <= t <= b.times[-1])
        i = max(int(np.searchsorted(band.times, t)) - 1, 0)
        begin, end_ = map(Fraction, band.times[i:i + 2].tolist())
        x = (Fraction(t) - begin) / (end_ - begin)
        middle = [sum(Fraction(c) * x**n for n, c in enumerate(row)) for row in band.polynomials[i].tolist()]
        rest = [float(v - Fraction(float(v))) for v in middle]
        worst += shares(np.array(middle, float), np.array(rest), band.radii[i], true)
    return max(worst), found


@pytest.mark.one_in(3)
@pytest.mark.parametrize("seed, times", [
    *((40 + n, 1) for n in range(12)), *(pytest.param(1000 + n, 4, marks=pytest.mark.slow) for n in range(60))])
def test_random_motions_lie_within_their_radii(seed, times):
    rng = random.Random(seed)
    scene, start, end = drawn(rng, seed % 20)
    worst, found = holds(scene, start, times * end, rng)
    assert worst <= 1  # a run in 50 digits
    assert times > 1 or found.radius.max() < 1e-22 * np.abs(found.middle).max()


def test_a_long_motion_is_held():
    worst, found = holds(EXAMPLE, (.1, 1, 2), 12.0, random.Random(1))
    assert worst <= 1 and found.steps > 50  # a run in 50 digits


@pytest.mark.skipif(not installed(), reason="thousands of steps take the compiled kernel")
def test_a_thousand_turns_keep_ten_digits_beyond_those_of_a_double():
    found = enclose(EXAMPLE, (.1, 1, 2), 200.0)
    assert found.status == "enclosed" and found.radius.max() < 1e-16 and found.steps > 5000


@pytest.mark.skipif(not installed(), reason="hundreds of steps take the compiled kernel")
def test_a_fast_wheel_widens_the_set_by_no_more_than_its_turns():
    """Beside a strong wheel the rates go round on an ellipse: directions made orthogonal at each step would
    widen the set at each by a third."""
    scene = Scene(Body((3.46, 3.46 + 1e-10, .51)), Gyrostat((2e4, -8.7e4, 0)),
                  ConstantTorque((0, -2.4, -178)))
    found = enclose(scene, (38, 0, -.2), .01)
    assert found.steps > 400 and found.radius.max() < 1e-20


def test_a_fraction_and_a_decimal_in_a_string_are_taken_exactly():
    end = 0.5
    one, two = enclose(EXAMPLE, ("0.1", "1/3", "2"),
                       end), enclose(EXAMPLE, (Fraction(1, 10), Fraction(1, 3), 2), end)
    assert one.middle.tolist() == two.middle.tolist() and one.rest.tolist() == two.rest.tolist()
    # a run in 50 digits
    assert max(shares(one.middle, one.rest, one.radius,
                      integrate(model_of(EXAMPLE), ("0.1", "1/3", "2"), [end])[0])) <= 1
    double = enclose(EXAMPLE, (.1, 1 / 3, 2.), end)  # another motion, 1e-17 beside it
    beside = integrate(model_of(EXAMPLE), (.1, 1 / 3, 2), [end])[0]
    assert max(shares(one.middle, one.rest, one.radius, beside)) > 1e3
    assert max(shares(double.middle, double.rest, double.radius,
                      beside)) <= 1


def test_energy_and_squares_of_a_band_are_those_of_the_motion():
    course = Course(EXAMPLE, (.1, 1, 2), 1.0)
    band = course.advance(1.0, band=True)
    D = EXAMPLE.body.exact
    for weights in ((1, 1, 1), tuple(d / 2 for d in D)):
        polynomials, radii = band.form(list(zip(weights, np.eye(3))))
        for i in range(len(radii)):
            begin, end = map(Fraction, band.times[i:i + 2].tolist())
            x = Fraction(3, 8)
            state = integrate(model_of(EXAMPLE), (.1, 1, 2), [begin + x * (end - begin)])[0]
            with mpmath.workdps(50):
                true = sum(mpmath.mpf(Fraction(w).numerator) / Fraction(w).denominator * v * v for w,
                           v in zip(weights, state))
                value = sum(mpmath.mpf(c) * (mpmath.mpf(3) / 8) ** k for k,
                            c in enumerate(polynomials[i].tolist()))
                assert abs(value - true) <= radii[i] and radii[i] < 1e-10  # a run in 50 digits


def in_fifty_digits(scene, state, direction, times):
    """(rates, direction n) at increasing times: n' = n x omega by its power series, those of the rates of
    `tests.oracles.taylor`; steps of 1/16."""
    model, exactly = model_of(scene), lambda row: [mpmath.mpf(Fraction(v).numerator) / Fraction(v).denominator
                                                   for v in row]
    table = [*map(exactly, (model.kappa, model.rho, model.sigma, model.m))]
    x, n, found, now = exactly(state), exactly(direction), [], mpmath.mpf(0)
    for end in map(mpmath.mpf, times):
        while now < end:
            h = min(mpmath.mpf(1) / 16, end - now)
            w, rows = taylor.coefficients(table, x, 60), [[v] for v in n]
            for m in range(60):
                cross = [mpmath.fdot(rows[j], w[k][m::-1]) - mpmath.fdot(rows[k], w[j][m::-1])
                         for j, k in ((1, 2), (2, 0), (0, 1))]
                for row, value in zip(rows, cross):
                    row.append(value / (m + 1))
            x, n = ([mpmath.polyval(row[::-1], h) for row in series] for series in (w, rows))
            now += h
        found.append([*x, *n])
    return found


@pytest.mark.one_in(4)
@pytest.mark.parametrize("seed", range(4))
def test_a_direction_at_rest_in_space_is_within_its_radius_at_all_times(seed):
    rng = random.Random(seed)
    scene, state = random_scene(rng, rng.choice((0, 1))), sphere(rng, rng.choice((.3, 2)))
    end, direction = 3.0, [(0, 0, 1), (Fraction(3, 5), 0, Fraction(-4, 5))][seed % 2]
    course = Course(scene, state, end, direction=direction)
    band = course.advance(end, band=True)
    assert course.status == enclosure_kernel.DONE
    places = range(0, len(band.radii), max(1, len(band.radii) // 4))
    begins, ends = band.times[:-1], band.times[1:]
    with mpmath.workdps(50):
        at = [mpmath.mpf(begins[i]) + (mpmath.mpf(ends[i]) - begins[i]) * 5 / 8 for i in places]
        for i, true in zip(places, in_fifty_digits(scene, state, direction, at)):  # no code shared
            for row, radius, value in zip(band.polynomials[i].tolist(), band.radii[i].tolist(), true):
                off = abs(mpmath.polyval([mpmath.mpf(c) for c in row[::-1]], mpmath.mpf(5) / 8) - value)
                assert off <= radius < 1e-11
        # the true direction itself, not rounded to the doubles of a band, is as near as the rates
        last = in_fifty_digits(scene, state, direction, [end])[0][3:]
        high, low, off = course._set[4:]
        gap = mpmath.sqrt(sum((mpmath.mpf(a) + mpmath.mpf(b) - v) ** 2 for a, b, v in zip(high, low, last)))
        assert gap <= off[0] < 1e-22


def test_a_step_in_integers_holds_the_same_motion():
    """The polynomials and radii of a band, evaluated in exact fractions."""
    course = Course(EXAMPLE, (.1, 1, 2), 1.0, direction=(0, 0, 1))
    band, unit = course.advance(1.0, band=True), Fraction(1, 4)
    piece = band.piece(1, unit)
    assert piece.start == Fraction(band.times[1]) and piece.start + piece.length == Fraction(band.times[2])
    for n, row in enumerate(piece.rows):
        of = unit if n < 3 else 1
        rest = sum(abs(Fraction(c, 2**piece.bits) * of - Fraction(d))
                   for c, d in zip(row, band.polynomials[1, n].tolist()))
        assert Fraction(band.radii[1, n]) + rest <= Fraction(piece.radii[n], 2**piece.bits) * of
        assert piece.radii[n] < 2**70 and piece.sizes[n] == sum(map(abs, row))


def test_a_band_is_one_piece_and_ends_at_the_time_asked_for():
    course, bands = Course(EXAMPLE, (.1, 1, 2), 1.7), []
    while course.status == enclosure_kernel.GOING:
        bands.append(course.advance(1.7, band=True))
    times = np.concatenate([band.times for band in bands])
    assert times[0] == 0 and times[-1] == 1.7 and (np.diff(times) >= 0).all()
    assert sum(len(band.radii) for band in bands) == course.steps
    for band in bands:
        ends, starts = band.polynomials[:-1].sum(axis=2), band.polynomials[1:, :, 0]
        assert (np.abs(ends - starts) <= band.radii[:-1] + band.radii[1:]).all()


def test_steps_that_run_out_are_told():
    found = enclose(EXAMPLE, (.1, 1, 2), 50.0, steps=3)
    assert found.status == "stopped" and found.steps == 3 and 0 < found.t < 50 and "used up" in found.because


def test_what_is_no_start_or_time_is_refused():
    for state, t in (((1, 2), 1.), ((1, 2, "x"), 1.), ((1, 2, 3), 0.), ((1, 2, 3), float("inf")),
                     ((1, 2, 3), float("nan"))):
        with pytest.raises(InputError):
            enclose(EXAMPLE, state, t)


@pytest.mark.one_in(2)
@pytest.mark.skipif(not installed(), reason="nothing is compiled without numba")
@pytest.mark.parametrize("plain", [1, 5, 32])
def test_steps_without_the_compiler_give_the_same_bits(plain, monkeypatch):
    """The same set and the same bands, whether all steps are compiled, the first few are not, or none is."""
    rng = random.Random(plain)
    for _ in range(2):
        scene, state = random_scene(rng, rng.choice((0, 1, 5))), sphere(rng, rng.choice((.1, 3, 30)))
        told, direction = [], rng.choice((None, (0, 1, 0)))
        for spent in (math.inf, IMPORT - (plain + 0.5) * STEP, -math.inf):
            kernel = Kernel(ADVANCE.module, ADVANCE.entry, ADVANCE.seconds, variant=ADVANCE.variant,
                            options=ADVANCE.options, spent=spent)  # the same on disk
            kernel.left = lambda kernel=kernel: 0.0 if kernel.ready else max(0.0, IMPORT - kernel.spent)
            monkeypatch.setattr("stabilab.unreduced.enclosure.ADVANCE", kernel)
            course = Course(scene, state, 40.0, direction=direction)
            bands = [course.advance(40.0, 12, band=True), course.advance(40.0, 3, band=True)]
            told.append([course.t, course.steps, course.status,
                         *(v.tobytes() for v in (course.now.middle, course.now.rest, course.now.radius)),
                         *(v.tobytes() for band in bands if band
                           for v in (band.times, band.polynomials, band.radii))])
        assert told[0] == told[1] == told[2] and told[0][1] > 5


@pytest.mark.skipif(not installed(), reason="nothing is compiled without numba")
def test_a_short_way_is_proved_without_the_compiler():
    program = """
import sys
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.enclosure import proved
from stabilab.unreduced.spin_up.follow import spin_up
scene = Scene(Body((1.4, 1, .6)), Gyrostat((.2, .1, -.3)), ConstantTorque((.5, .6, .62)))
print(proved(scene, (.1, 1, 2), spin_up(scene, (.1, 1, 2)), fast=False).level, "numba" in sys.modules)
"""
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                          check=True).stdout.split() == ["proved", "False"]
