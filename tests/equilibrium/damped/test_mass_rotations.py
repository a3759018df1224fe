"""All rotations of body and mass at one angular momentum: against a search by SciPy, Newton's equations of the two
bodies, and work by hand."""
from __future__ import annotations

import json
import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

import stabilab
from stabilab import Body, DamperMass, Gyrostat, InputError, Scene, load
from stabilab.equilibrium.mass_rotations import BodyWithMass
from tests.answers.dissipation.test_damper_mass import newtons_rates
from tests.shared import CASES

WHOLE, MASS = 10.0, 0.5


def _drawn(seed):
    """(moments, place, line, stiffness, |H|): in general, and as nutation dampers are built."""
    rng = np.random.default_rng([9, seed])
    D, line, place = rng.uniform(1, 2, 3), rng.normal(size=3), rng.normal(size=3) * 0.4
    if seed % 4:
        line, place = (([0, 0, 1], [0.5, 0, 0]), ([1, 0, 0], [0.3, 0, 0]), ([1, 1, 0], [0.2, -0.1, 0.3]))[seed % 4 - 1]
    k, h = 10 ** rng.uniform(-1, 1), 10 ** rng.uniform(-0.5, 0.7)
    return [[round(float(v), 3) for v in vector] for vector in (D, place, line)] + [round(float(k), 3), round(float(h), 3)]


def _scene(D, place, line, k, c=1, *others):
    return Scene(Body(D, WHOLE), DamperMass(MASS, place, line, k, c, WHOLE), *others)


def _tensors(D, place, line):
    """J(x) = D + x J1 + x^2 J2 from the parallel axis theorem: mu (rho^2 1 - rho rho^T), rho = r + x n."""
    mu = MASS * (1 - MASS / WHOLE)
    r, n = np.array(place, float) / (1 - MASS / WHOLE), np.array(line, float) / np.linalg.norm(line)
    point = lambda rho: mu * (rho @ rho * np.eye(3) - np.outer(rho, rho))
    second = (point(r + n) + point(r - n)) / 2 - point(r)
    return np.diag(D), (point(r + n) - point(r - n)) / 2, second


def _searched(D, place, line, k, h, seed, tries):
    """(H, x) of critical points from random starts, by least squares of the balance written here."""
    D, J1, J2 = _tensors(D, place, line)
    rng, found = np.random.default_rng(seed), []

    def balance(y):
        H, x = y[:3], y[3]
        w = np.linalg.solve(D + x * J1 + x * x * J2, H)
        return [*(w - y[4] * H), k * x - w @ (J1 + 2 * x * J2) @ w / 2, (H @ H - h * h) / h]
    for _ in range(tries):
        u = rng.normal(size=3)
        run = least_squares(balance, [*(u * h / np.linalg.norm(u)), rng.normal() * rng.choice([0.1, 0.5, 1, 3]), 1],
                            xtol=1e-15, ftol=1e-15, gtol=1e-15)
        if np.abs(run.fun).max() < 1e-9 and not any(np.linalg.norm(run.x[:4] - y) < 1e-5 * (1 + h) for y in found):
            found.append(run.x[:4])
    return found


@pytest.mark.first(1, 12)
@pytest.mark.parametrize("seed", [6, 9, *(n for n in range(120) if n not in (6, 9))])
def test_no_rotation_of_body_and_mass_is_missed(seed):
    """Oracle: the search; and Morse: minima less saddles of one direction ... are 2, the Euler number of the sphere."""
    D, place, line, k, h = _drawn(seed)
    found = stabilab.flat_spin(_scene(D, place, line, k), momentum=str(h)).rotations
    rows = np.array([[*item.momentum, item.displacement] for item in found])
    for at in _searched(D, place, line, k, h, seed, 25):
        assert np.linalg.norm(rows - at, axis=1).min() < 1e-4 * (1 + h)
    body = BodyWithMass.of(*(lambda s: (s.body.exact, s.effect("damper_mass")))(_scene(D, place, line, k)),
                           Fraction(str(h)) ** 2)
    assert sum((-1) ** item.downward for item in body.rotations) == 2 and len(rows) == len(body.rotations)


@pytest.mark.first(1, 12)
@pytest.mark.parametrize("seed", [9, 8, 7, 6, *range(10, 50)])
def test_they_rest_and_are_stable_by_newtons_equations(seed):
    """Oracle: Newton's equations of the two bodies, which vanish there, and eigenvalues of their differences."""
    D, place, line, k, h = _drawn(seed)
    n = np.array(line) / np.linalg.norm(line)
    rate, *_ = newtons_rates(D, MASS, place, n, k, 1, whole=WHOLE)
    for item in stabilab.flat_spin(_scene(D, place, line, k), momentum=str(h)).rotations:
        at = np.array([*item.rates, item.displacement, 0])
        step = 1e-6 * max(1.0, float(np.abs(at).max()))
        assert np.abs(rate(0, at)).max() < 1e-8 * (1 + np.abs(at).max() ** 2)
        J = np.array([(np.array(rate(0, at + v)) - rate(0, at - v)) / (2 * step) for v in step * np.eye(5)]).T
        values = sorted(np.linalg.eigvals(J), key=abs)[1:]  # |H| may be another
        growth = max(z.real for z in values)
        if abs(growth) < 1e-7 * np.abs(values).max():  # a nutation that moves the mass less than differences show
            assert item.growth is None and 1 / (item.decay or math.inf) < 2e-7 * np.abs(values).max()
            assert item.with_losses == ("stable" if item.nature == "minimum" else "undecided")
            continue
        assert (item.with_losses == "stable") == (growth < 0) == (item.nature == "minimum")
        assert (item.decay or -item.growth) == pytest.approx(-1 / growth, rel=1e-3)


def test_a_mass_on_a_line_across_the_spin_flies_out_where_its_spring_is_too_weak():
    """By hand, p = 0 and n along axis 1: k x = Omega^2 mu x, so that Omega^2 = k/mu off the middle, and x^2 = (h/Omega -
    D3)/mu."""
    mu, k, h = 0.5 * 0.95, 2.0, 5.0
    found = stabilab.flat_spin(_scene((1, 1.5, 2), (0, 0, 0), (3, 0, 0), 2), momentum=5)
    rate = math.sqrt(k / mu)
    least = found.rotations[0]
    assert least.nature == "minimum" and abs(least.rates[2]) == pytest.approx(rate, rel=1e-12)
    assert abs(least.displacement) == pytest.approx(math.sqrt((h / rate - 2) / mu), rel=1e-12)
    assert least.energy == pytest.approx(h * rate / 2 + k * least.displacement**2 / 2, rel=1e-12)
    still = [item for item in found.rotations if item.rates[2] and not item.displacement]
    assert {item.with_losses for item in still} == {"unstable"}
    weak = stabilab.flat_spin(_scene((1, 1.5, 2), (0, 0, 0), (3, 0, 0), 2), momentum=2 * rate * 0.99)
    assert weak.rotations[0].displacement == 0 and weak.rotations[0].with_losses == "stable"


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1, 8])
def test_a_motion_ends_at_the_rotation_that_its_run_comes_to(seed):
    """Oracle: Newton's equations followed for 25 time constants."""
    rng = np.random.default_rng([10, seed])
    D, place, line, k, _ = _drawn(seed)
    omega = [round(float(v), 3) for v in rng.normal(size=3)]
    found = stabilab.flat_spin(load(_scene(D, place, line, k), {"omega": omega}))
    if found.end is None or (decay := found.rotations[found.end].decay) is None or decay > 80:
        return
    rate, *_ = newtons_rates(D, MASS, place, np.array(line) / np.linalg.norm(line), k, 1, whole=WHOLE)
    until = (found.crosses.at if found.crosses else 0) + 25 * decay
    end = solve_ivp(rate, (0, until), [*omega, 0, 0], "DOP853", rtol=1e-9, atol=1e-11).y[:, -1]
    item = found.rotations[found.end]
    assert end[:4] == pytest.approx([*item.rates, item.displacement], abs=1e-3 * (1 + np.abs(omega).max()))
    assert found.level == "run" and found.tenth.at < until
    ending = stabilab.motion(load(_scene(D, place, line, k), {"omega": omega})).ending  # the same list
    assert (ending.rates, ending.displacement) == (item.rates, item.displacement)


def test_fate_has_the_end_of_the_list_in_all_digits(stabilab):
    """By hand: |H|/D3 of the public example; on a soft spring along its line, turning across it, k x = W^2 J'(x)/2."""
    code, out, _ = stabilab("fate", CASES / "dampers" / "mass.toml", "--json")
    end = json.loads(out)[0]["ending"]
    assert code == 0 and (end["level"], end["displacement"]) == ("run", 0)
    assert end["rates"] == pytest.approx([0, 0, math.hypot(137.57, 1454.6217821782178) / 1454.6217821782178], rel=1e-14)
    assert end["settles"][0] < end["tenth"][0] and end["time_constants"][0]["time"] == pytest.approx(311.5, rel=1e-3)  # of flat-spin: 5.191 min


@pytest.mark.slow
def test_within_the_angle_the_momentum_stays():
    """Newton's equations: from then on H is within the angle of its end, and a turn of the nutation before it was not."""
    D, arguments = np.array([1.5, 1.8, 2.2]), (1.5, (0.5, 0.1, 0.1), (0.2, 0.3, 1), 3, 2)
    w = [0.3, 0.1, 1.0]
    found = stabilab.flat_spin(load(Scene(Body(D.tolist(), WHOLE), DamperMass(*arguments, WHOLE)), {"omega": w}), "14 deg")
    end, settles = np.array(found.rotations[found.end].momentum), found.settles.at
    rate, n, r, B, mu = newtons_rates(D, *arguments, whole=WHOLE)
    times = np.linspace(0, settles + 20, 800)
    y = solve_ivp(rate, (0, times[-1]), [*w, 0, 0], "DOP853", times, rtol=1e-8, atol=1e-10).y.T
    rho = r + y[:, 3:4] * n
    H = y[:, :3] @ B + mu * np.cross(rho, y[:, 4:] * n + np.cross(y[:, :3], rho))
    angle = np.degrees(np.arccos(H @ end / np.linalg.norm(H, axis=1) / np.linalg.norm(end)))
    assert angle[times > settles].max() < 14 < angle[times < settles].max()


def test_a_body_of_revolution_ends_on_a_circle_whose_point_the_phase_decides():
    """By hand: mass on the axis z, line along it, turning at W about x: k x = mu W^2 (r + x), |H| = (D1 + mu (2 r x +
    x^2)) W."""
    scene = _scene((2, 2, 1), (0, 0, 0.3), (0, 0, 1), 20, 4)
    ending = stabilab.motion(load(scene, {"omega": (0.5, 0, 0)})).ending
    mu, r, x = MASS * (WHOLE - MASS) / WHOLE, 0.3, ending.displacement
    place = r * WHOLE / (WHOLE - MASS)  # from the mass centre of the rest
    W = 1 / (2 + mu * (2 * place * x + x * x))  # |H| = 2 0.5
    assert 20 * x == pytest.approx(mu * W * W * (place + x), rel=1e-9) and ending.rate == pytest.approx(W, rel=1e-9)
    assert ending.rates is None and ending.axis == 3


@pytest.mark.slow
def test_a_nutation_that_leaves_the_mass_where_it_is_has_no_end():
    """A symmetric body with the mass on its axis: by hand the pull on it is constant along a nutation."""
    scene = _scene((2, 2, 1), (0, 0, 0.3), (0, 0, 1), 20, 4)
    ending = stabilab.motion(load(scene, {"omega": (0.5, 0.1, 0.4)})).ending
    assert ending.kind == "undecided" and "does not come near" in ending.because


@pytest.mark.slow
def test_with_a_wheel_beside_the_mass_a_run_shows_the_end():
    scene = _scene((1, 1.5, 2), (0.4, 0, 0), (0, 0, 1), 2, 1, Gyrostat((0, 0, 1)))
    ending = stabilab.motion(load(scene, {"omega": [0, 0.1, 1]})).ending
    H = math.hypot(1.5 * 0.1, 2 + 1)
    assert ending.kind == "steady rotation" and ending.rates[2] == pytest.approx((H - 1) / 2, rel=1e-6)  # by hand


def test_the_spacecraft_with_a_particle_turns_about_its_largest_moment_in_the_end(stabilab):
    code, out, _ = stabilab("flat-spin", CASES / "dampers" / "mass.toml", "--json")
    row = json.loads(out)
    end = row["rotations"][row["end"]]
    assert code == 0 and row["stable_with_losses"] == 2 and end["displacement"] == 0 and end["nature"] == "minimum"
    # by hand: |H|/D3, H = (1375.7 0.1, 0, 1454.62.. 1)
    assert row["final_rates"][2] == pytest.approx(math.hypot(137.57, 1454.6217821782178) / 1454.6217821782178, rel=1e-12)
    # by hand, the mass on its line at x, turning about y: k = mu Omega^2, (D2 + mu x^2) Omega = |H|
    mu, k = 52.744 * 5274.4 / 5327.144, 52.744
    x = math.sqrt((row["momentum"] / math.sqrt(k / mu) - 1344.7217821782178) / mu)
    assert abs(row["rotations"][4]["displacement"]) == pytest.approx(x, rel=1e-9)


@pytest.mark.parametrize(("scene", "words"), [
    (_scene((1, 1.5, 2), (0.4, 0, 0), (0, 0, 1), 2, 1, Gyrostat((0, 0, 1))), "with wheels not all"),
    (_scene((1, 1.5, 2), (0.4, 0, 0), (0, 0, 1), 0), "no spring")])
def test_what_is_not_known_is_refused_with_what_follows_the_motion(scene, words):
    for ask in (lambda: stabilab.flat_spin(load(scene, {"omega": [0, 0.1, 1]})),
                lambda: stabilab.flat_spin(scene, momentum=1)):
        with pytest.raises(InputError, match=words):
            ask()
