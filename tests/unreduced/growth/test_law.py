"""Capture and spin-up under a torque along an axis that carries a gyrostatic component."""
import math
from fractions import Fraction
from fractions import Fraction as F

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.simulate import trajectory
from stabilab.errors import InputError
from stabilab.unreduced.growth import captured_fate
from stabilab.unreduced.growth_certificate import certificate, growth_law, standard_form

heyoka = pytest.importorskip("heyoka")
BODY = Body((2000, 1500, 1000))


def paper(c, mu1=1, a=0):
    return ScaledGyrostat(a, Fraction(a) + Fraction(c), (mu1, 0, 0))


@pytest.fixture(scope="module")
def brute():
    """Standard form written out by hand, with roots of phi' R^2 (event 0) and of y3 (event 1): no code of the
    package."""
    u, y, z = heyoka.make_vars("u", "y", "z")
    c, hits = heyoka.par[0], []
    du, dy, dz = y * z + 1.0, -z * (u - 0.5 * c), y * (u + 0.5 * c)

    def note(index):
        return lambda ta, t, sign: hits.append((t, index))
    events = [heyoka.nt_event(y * dz - z * dy, note(0)), heyoka.nt_event(z, note(1))]
    ta = heyoka.taylor_adaptive([(u, du), (y, dy), (z, dz)], [0.0] * 3, pars=[0.0], nt_events=events)

    def run(c, start, t):
        hits.clear()
        ta.time, ta.pars[0], ta.state[:] = 0.0, c, start
        ta.propagate_until(t, max_steps=200_000)
        return list(hits), ta.state.copy()
    return run


def random_states(seed, count):
    """c < 0 mostly, over three decades; states over two, half of them pushed to just inside a certificate's
    boundary."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        c = float(rng.choice([-1, -1, -1, 1]) * 10**rng.uniform(-2, 1))
        y = rng.normal(size=3) * 10**rng.uniform(-1, 1.2)
        yield c, (onto_boundary(c, y, rng) if n % 2 else y)


def onto_boundary(c, y, rng):
    """A state in which a certificate holds by a hair: bisection on a segment from a certified state to
    another."""
    inside = certificate(c, y)
    other = rng.normal(size=3) * np.abs(y).max()
    if inside is None or certificate(c, other) == inside:
        return y
    low, high = y, other
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if certificate(c, middle) == inside else (low, middle)
    return low


@pytest.mark.one_in(2)
@pytest.mark.parametrize("count", [500, pytest.param(1500, marks=pytest.mark.slow), pytest.param(
    3000, marks=[pytest.mark.slow, pytest.mark.long])])
def test_no_certificate_misfires_against_brute_force(brute, count):
    fired = {"spin-up": 0, "well": 0}
    for c, y in random_states(20240, count):
        name = certificate(c, y)
        if name is None:
            continue
        fired[name] += 1
        J = y[1]**2 + y[2]**2 - 2 * c * y[0]
        hits, _ = brute(c, y, min(40.0 + abs(J / c), 300.0) / (1 + np.abs(y).max() / 10))
        turned_back = [t for t, index in hits if index == 0 and t > 0]
        crossed = [t for t, index in hits if index == 1 and t > 0]
        assert not (turned_back if name == "spin-up" else crossed), (c, y, name)
    assert min(fired.values()) > count / 10


@pytest.mark.parametrize("mu1, c", [(1, "0.3"), (-1, "0.3"), (2.5, "-0.7"), ("-1e-3", "-5")])
def test_J_follows_its_law_exactly(mu1, c):
    scene = paper(c, mu1, a="0.4")
    axis, J, rate = growth_law(scene)
    times = np.linspace(0.5, 40, 30)
    run = trajectory(scene, (0.3, -1.0, 2.0), times)
    assert axis == 0 and rate == pytest.approx(-2 * float(Fraction(c)) * float(Fraction(mu1)), rel=1e-15)
    J0 = J((0.3, -1.0, 2.0))
    size = (run.states**2).sum(axis=1).max() + abs(J0) + abs(rate) * times
    assert (np.abs([J(x) - J0 - rate * t for x, t in zip(run.states, times)]) < 1e-12 * size).all()


@pytest.mark.parametrize("c", ["1e-3", "0.03", "0.5", "4", "1e4"])
def test_every_motion_spins_up_about_the_torque_axis_for_positive_c(c):
    """x1 >= (-J0 + 2 c tau)/(2c): no other fate exists."""
    rng = np.random.default_rng(11)
    for x in rng.normal(size=(3, 3)) * 3:
        answer = captured_fate(paper(c), x, t_max=300)
        assert (answer.fate, answer.axis, answer.sense) == (Fate.SPIN_UP, 1, 1)


def test_capture_over_ten_thousand_units_ends_in_release(brute):
    answer = captured_fate(paper("1e-3"), (0, -1, 5))
    assert answer.fate is Fate.SPIN_UP and answer.axis == 1
    assert 1e4 < answer.release_time < answer.release_estimate == pytest.approx(12000, rel=1e-3)
    hits, end = brute(1e-3, (0.0005, -1, 5), 13500.0)  # u = x1 + c/2
    last = max(t for t, index in hits if index == 0)
    assert answer.release_time == pytest.approx(last, rel=1e-6)
    assert end[0] > 100


@pytest.mark.parametrize("c", ["-0.4", "0.4", "-3"])
def test_opposite_torque_and_c_give_the_mirror_image(c):
    """(-x1, x2, -x3), (a, b) -> (-a, -b), mu1 -> -mu1 maps motions onto motions."""
    rng = np.random.default_rng(3)
    for x in rng.normal(size=(8, 3)) * 4:
        one = captured_fate(paper(c), x)
        other = captured_fate(ScaledGyrostat(0, -Fraction(c), (-1, 0, 0)), x * [-1, 1, -1])
        assert one.axis == other.axis and one.sense == -other.sense
        assert one.t_certificate == other.t_certificate


@pytest.mark.parametrize("inertia, axis",
                         [((2000, 1500, 1000), 0), ((2000, 1500, 1000), 2), ((1000, 2000, 1500), 1),
                                           ((1000, 2000, 1500), 0), ((3, 4, 5), 2), ((5, 3, 4), 1)])
@pytest.mark.parametrize("sense", [1, -1])
def test_standard_form_maps_bodies_exactly(inertia, axis, sense):
    """Rates carried to standard form equal its right side, for the major and the minor axis in any place."""
    unit = [0, 0, 0]
    unit[axis] = 1
    scene = Scene(Body(inertia), Gyrostat([3 * v for v in unit]),
                  ConstantTorque([7 * sense * v for v in unit]))
    change = standard_form(scene)
    for x in np.random.default_rng(1).normal(size=(5, 3)):
        rate = scene.quadratic().rate(x.tolist())
        u, y2, y3 = change.to_standard(x)
        got = [rate[n] * change.time / r for n, r in zip(change.axes, change.rates)]
        assert got == pytest.approx([y2 * y3 + 1, -y3 * (u - change.c / 2), y2 * (u + change.c / 2)],
                                    rel=1e-12, abs=1e-12)


@pytest.mark.one_in(5)
@pytest.mark.parametrize("torque, momentum",
                         [((0, 0, -10), (0, 0, 30)), ((0, 0, 10), (0, 0, 30)), ((200, 0, 0), (-40, 0, 0)),
                                              ((0, 30, 0), (0, 100, 0)), ((0, 0, -40), (0, 100, 30))])
def test_bodies_spin_up_about_the_answered_axis(torque, momentum):
    """Brute force: far beyond the answer, the answered axis holds the growing spin."""
    scene = Scene(BODY, Gyrostat(momentum), ConstantTorque(torque))
    answer = captured_fate(scene, (0.5, 2.6, 0.06))
    assert answer.fate is Fate.SPIN_UP
    late = 4 * (answer.t_certificate or 3000.0) + 500
    early, end = (trajectory(scene, (0.5, 2.6, 0.06),
                             np.linspace(f * late / 2, f * late / 2 * 1.1, 200)).states for f in (1, 2))
    held = answer.sense * end[:, answer.axis - 1]
    assert held.min() > 1.15 * np.abs(early[:, answer.axis - 1]).min() > 0


@pytest.mark.parametrize("scene", [ScaledGyrostat(0, 0, (1, 0, 0)), ScaledGyrostat(0, 1, (1, 1, 0)),
                                   ScaledGyrostat(0, 1, (0, 0, 1)),
                                   Scene(BODY, Gyrostat((1, 0, 0)), ConstantTorque((0, 0, 1))), Scene(BODY)])
def test_other_scenes_are_turned_away(scene):
    with pytest.raises(InputError, match="torque along one principal axis"):
        captured_fate(scene, (1, 2, 3))


@pytest.mark.parametrize("size", [1e-12, 1e12])
def test_tiny_and_huge_torques_are_answered_in_their_own_time(size):
    answer = captured_fate(ScaledGyrostat(0, -0.3 * math.sqrt(size), (size, 0, 0)),
                           np.array([-6.0, 2, -1]) * math.sqrt(size))
    assert (answer.axis,
            answer.sense) == (lambda one: (one.axis, one.sense))(captured_fate(paper("-0.3"), (-6.0, 2, -1)))


def test_rates_whose_squares_overflow_are_refused():
    with pytest.raises(InputError, match="units"):
        captured_fate(ScaledGyrostat(0.2, 0.4, (1, 0, 0)), (1e160, 1e160, -1e160))


# -- beside the boundary between spin-up and capture


def boundary(c, seed):
    """(scene, states on a line by their distance from the boundary between spin-up and capture), located by
    halving as far as the answers are decided."""
    scene, rng = ScaledGyrostat(-c / 2, c / 2, (1, 0, 0)), np.random.default_rng(seed)
    ends = {}
    while len(ends) < 2:
        state = rng.normal(size=3) * 2
        found = captured_fate(scene, state)
        if found.t_certificate:
            ends[found.certificate] = state
    up, well = ends["spin-up"], ends["well"]
    low, high = 0.0, 1.0
    while (name := captured_fate(scene, up + (low + high) / 2 * (well - up)).certificate) != "none":
        low, high = ((low + high) / 2, high) if name == "spin-up" else (low, (low + high) / 2)
    return scene, lambda share: up + ((low + high) / 2 + share) * (well - up)


def by_many_digits(c, state):
    """Which certificate fires first on a Taylor series of 30 digits; the certificates' inequalities as in
    theory.md, section 1."""
    import mpmath as mp

    from tests.oracles import taylor
    from tests.oracles.model import scaled
    model, y = scaled(-c / 2, c / 2, (1, 0, 0)), [mp.mpf(float(v)) for v in state]
    with mp.workdps(40):
        for _ in range(400):
            u, y2, y3 = y
            phi = mp.atan2(y3, y2)
            P, J, p = u + mp.mpf(c) / 2 * mp.cos(2 * phi), y2**2 + y3**2 - 2 * c * u, phi % mp.pi
            bump = mp.mpf(c) ** 2 / 8
            # J < 0 is left to a later time: the printed inequality needs J >= 0 there
            if P > 0 and J > 0 and P**2 / 2 - J / 2 * mp.sin(phi) ** 2 - bump * mp.cos(2 * phi) ** 2 > mp.mpf(
                c) ** 2 / 2:
                return "spin-up"
            if P**2 / 2 + bump * mp.sin(2 * phi) ** 2 + mp.pi - p < J / 2 * mp.sin(phi) ** 2:
                return "well"
            y = taylor.integrate(model, y, [mp.mpf(1) / 4], digits=30)[0]
    raise AssertionError("neither fired")


@pytest.mark.slow
@pytest.mark.parametrize("c, seed, decades",
                         [(-0.5, 1, (3, 9, 16)), (-3.0, 2, range(3, 17)),
                          *(pytest.param(c, n, range(3, 17), marks=pytest.mark.long)
                            for n, c in ((1, -0.5), (3, -1.0), (4, -0.2)))])
def test_no_state_beside_the_boundary_between_spin_up_and_capture_gets_the_wrong_axis(c, seed, decades):
    """Fails in code that trusts the end of one run: rounding carries a motion over the boundary."""
    scene, at = boundary(c, seed)
    words, told = set(), []
    for decade in decades:
        for side in (-1, 1):
            state = at(side * 10.0**-decade)
            found = captured_fate(scene, state)
            if found.fate is Fate.UNDECIDED:
                assert "rounding" in found.because
                words.add("undecided")
            else:
                assert found.certificate == by_many_digits(c, state), (decade, side)
                words.add(found.certificate)
                told.append(decade)
    # nine digits of a state are enough to be told
    assert words == {"undecided", "spin-up", "well"} and max(told) >= 9


@pytest.mark.parametrize("torque", [(1e160, 0, 0), (1e160, 0, 1e160)])  # without a torque: test_free_gyrostat
def test_moments_whose_squares_are_beyond_the_doubles_are_refused(torque):
    scene = Scene(Body((3e160, 2e160, 1.5e160)), Gyrostat((1e160, 2e160, -3e160)), ConstantTorque(torque))
    with pytest.raises(InputError, match="choose other units"):
        stabilab.motion(scene, (0.1, 0.2, 0.3), (0, 5))


def test_a_temporary_capture_whose_swing_dies_out_is_no_spin_up():
    """Oracle: without the 1e-14 across the torque the spin-up about axis 1 is proved, after a release at t =
    14,619 s."""
    scene = Scene(Body((2, 1, 1.5)), Gyrostat((F(4862117930819083, 2**58), 1e-14, 0)),
                  ConstantTorque((F(6340252040850999, 2**50), 0, 0)))
    found = captured_fate(scene, (-0.029033100610280364, 52.89864997290313, -0.0026971012632171962),
                          t_max=7000)
    assert found.axis in (0, 1) and found.fate in (Fate.UNDECIDED, Fate.SPIN_UP)
