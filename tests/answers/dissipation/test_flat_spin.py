"""The end of a spin that loses energy: against an integration of the same bodies written another way, limits
known by hand, and starts that leave it open."""
import math

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, InputError, LiquidCavity, Scene, ViscousDamper, flat_spin, load
from stabilab.answers.dissipation import flat_spin as dissipation
from tests.oracles.two_bodies import crossing

RAHN_BARBA = """[body]
inertia = [2000, 1500, 1000]
[effects.viscous_damper]
inertia = 18
coefficient = 30
[motion]
angular_velocity = [{rates}]
"""


def case(rates="0.1224, 0, 2.99"):
    return load(RAHN_BARBA.format(rates=rates))


@pytest.fixture
def no_search(monkeypatch):
    monkeypatch.setattr(dissipation, "SPAN_STEPS", 0)


@pytest.fixture(scope="module")
def tumbled():
    """The spacecraft with its changes of the outcome."""
    return flat_spin(case())


def drawn(seed):
    """A body, a damper and a start near its minor axis."""
    rng = np.random.default_rng(seed)
    while True:
        D = rng.uniform(0.5, 3, 3)
        two = np.sort(D)
        if two[2] < two[0] + two[1] and two[2] > 1.08 * two[1] and two[1] > 1.08 * two[0]:
            break
    k = float(rng.uniform(0.03, 0.12) * two[0])
    spin = rng.choice([-1, 1]) * rng.uniform(0.5, 2)
    c = float(k * abs(spin) * 10 ** rng.uniform(-0.7, 0.3))
    turn, tilt = rng.uniform(0, 2 * math.pi), rng.uniform(0.1, 0.5)
    i, j, m = np.argsort(D)
    omega = np.zeros(3)
    omega[[i, j, m]] = spin, abs(spin) * tilt * math.cos(turn), abs(spin) * tilt * math.sin(turn)
    return D, k, c, omega


def agrees(seed):
    D, k, c, omega = drawn(seed)
    D, omega = D.tolist(), omega.tolist()
    found = flat_spin(load(Scene(Body(D), ViscousDamper(k, c)), omega))
    if found.outcome == "undecided":
        return False
    if found.crosses is None:
        # proved at the start: 2 T D2 < |H|^2 in fractions
        assert found.level == "exact"
        return True
    t, sign = crossing(tuple(D), k, c, tuple(omega), 2 * found.crosses.at)
    assert found.crosses.at == pytest.approx(t, rel=1e-6)  # two integrations, the other at 1e-11
    assert (found.outcome == "positive major axis") == (sign > 0)
    assert found.final_rate == pytest.approx(math.hypot(*np.multiply(D, omega)) / max(D), rel=1e-14)
    return True


def test_damped_spinners_end_as_two_bodies_in_space_do(no_search):
    assert sum(agrees(seed) for seed in range(1, 7)) == 6


@pytest.mark.slow
@pytest.mark.parametrize("first", [7, *(pytest.param(n, marks=pytest.mark.long) for n in range(57, 507, 50))])
def test_five_hundred_damped_spinners_end_as_two_bodies_in_space_do(no_search, first):
    assert sum(agrees(seed) for seed in range(first, first + 50)) >= 49  # a start beside a boundary stays open


def test_the_spacecraft_of_rahn_and_barba_tumbles_as_two_bodies_in_space_do(tumbled):
    """Its data (J. Guidance 14(4), 1991): I = (2000, 1500, 1000) with a slug of 18 kg m^2, mu = 30 N m s."""
    found = tumbled
    t, sign = crossing((2000, 1500, 1000), 18, 30, (0.1224, 0, 2.99), 1000)
    assert found.outcome == ("positive major axis" if sign > 0 else "negative major axis")
    assert found.crosses.at == pytest.approx(t, rel=1e-8)
    assert found.rates == (sign * found.final_rate, 0, 0)
    assert found.final_rate == pytest.approx(math.hypot(2000 * 0.1224, 1000 * 2.99) / 2000, rel=1e-15)
    spans = {one.name: one for one in found.spans}
    assert list(spans) == ["phase", "nutation", "coefficient", "inertia", "damping"]
    # the equations are symmetric, each end known to 1/2000 of itself
    assert spans["phase"].down + spans["phase"].up == pytest.approx(math.pi, rel=1e-3)
    assert all(0 < end < 0.02 for name in ("nutation", "inertia", "damping")
               for end in (spans[name].down, spans[name].up))


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", ["phase", "nutation", "damping"])
def test_the_outcome_changes_where_it_is_said_to(name, tumbled):
    """One side and the other of the upper end, by brute force."""
    D, k, c, w = (2000, 1500, 1000), 18, 30, (0.1224, 0, 2.99)
    span = next(span for span in tumbled.spans if span.name == name)
    one, two = 1 / 1000 - 1 / 2000, 1 / 1000 - 1 / 1500

    def there(s):
        L = [d * v for d, v in zip(D, w)]
        size = math.hypot(*L)
        if not s:
            return crossing(D, k, c, w, 1000)[1]
        if name == "damping":
            return crossing(D, k * (1 + s), c * (1 + s), w, 1000)[1]
        if name == "nutation":
            x, y = L[0] * (1 + s), 0.0
        else:  # u = (L1 sqrt(one), 0) turned along the circle that the polhode is in these coordinates
            x, y = L[0] * math.cos(s), L[0] * math.sin(s) * math.sqrt(one / two)
        moved = (x, y, math.sqrt(size**2 - x * x - y * y))
        return crossing(D, k, c, tuple(v / d for v, d in zip(moved, D)), 1000)[1]
    assert there(0.97 * span.up) == there(0) != there(1.03 * span.up)


def test_a_start_on_the_boundary_is_undecided_and_names_both_directions(no_search):
    """The boundary by bisection of the answer itself, to the last place."""
    sign = {"positive major axis": 1, "negative major axis": -1}
    ends = [0.1224, 0.124]
    first = [flat_spin(case(f"{x!r}, 0, 2.99")).outcome for x in ends]
    assert set(first) == set(sign)
    for _ in range(60):
        middle = 0.5 * sum(ends)
        found = flat_spin(case(f"{middle!r}, 0, 2.99"))
        if found.outcome == "undecided":
            break
        ends[first.index(found.outcome)] = middle
    assert found.outcome == "undecided" and "opposite directions" in found.because
    assert found.crosses is not None and found.rates is None


def test_a_start_past_the_separatrix_is_decided_without_a_run(no_search):
    found = flat_spin(case("-1.5, 0.3, 0.2"))
    assert (found.outcome, found.level) == ("negative major axis", "exact") and found.crosses is None
    assert found.settles.at > 0


@pytest.mark.parametrize("rates, outcome, level", [
    ("0, 0, 2", "undecided", "undecided"), ("0, 2, 0", "undecided", "undecided"),
    ("2, 0, 0", "positive major axis", "exact"), ("-2, 0, 0", "negative major axis", "exact")])
def test_permanent_rotations_stay_or_are_open(rates, outcome, level):
    found = flat_spin(case(rates))
    assert (found.outcome, found.level, found.steps) == (outcome, level, 0)


def test_next_to_the_intermediate_axis_the_side_decides(no_search):
    for sign, word in ((1, "positive"), (-1, "negative")):
        assert flat_spin(case(f"{sign * 1e-9}, 2, 0")).outcome == f"{word} major axis"


def test_a_disc_is_decided_at_once_and_a_rod_has_no_major_axis(no_search):
    disc = flat_spin(load(Scene(Body((1, 1, "1.8")), ViscousDamper("0.05", "0.1")), (1, 0, "-1e-3")))
    assert (disc.outcome, disc.level) == ("negative major axis", "exact")
    rod = flat_spin(load(Scene(Body((2, 2, 1)), ViscousDamper("0.05", "0.1")), (0.01, 0, 1)))
    assert rod.outcome == "across the minor axis" and rod.crosses is None and rod.settles.at > rod.leaves.at > 0
    assert rod.final_rate == pytest.approx(math.hypot(0.02, 1) / 2)


def test_the_nutation_of_a_rod_grows_as_kanes_linear_damper_says(no_search):
    """Two transverse moments equal: z = omega1 + i omega2 and s = sigma1 + i sigma2 obey a linear equation of
    second order at constant spin; its root with the positive real part, written out here."""
    D, d, k, c, spin = 2.0, 1.0, 0.05, 0.1, math.hypot(2e-3, 1)  # all of |H| in the rotation about the minor axis
    # (D - k) z' = -i (D - d) spin z + c s;  s' = -c s/k - i spin s - z'
    M = np.array([[-1j * (D - d) * spin, c], [1j * (D - d) * spin, -c]]) / (D - k)
    M[1, 1] += -c / k - 1j * spin
    found = flat_spin(load(Scene(Body((D, D, d)), ViscousDamper("0.05", "0.1")), (1e-3, 0, 1)))
    assert 1 / found.growth == pytest.approx(max(np.linalg.eigvals(M).real), rel=1e-12)


def test_the_time_to_settle_is_where_the_energy_says(no_search):
    """2 T/|H|^2 of the run at the time found, by its own formula."""
    found = flat_spin(case(), "20 deg")
    scene = case().scene
    from stabilab import trajectory
    x = trajectory(scene, [0.1224, 0, 2.99, 0, 0, 0], [0, found.settles.at]).states[-1]
    w, s, D = x[:3], x[3:], np.array([2000, 1500, 1000])
    H, T = D * w + 18 * s, w @ (D * w) / 2 + 18 * (w @ s + s @ s / 2)
    sine = (2 * T / (H @ H) - 1 / 2000) / (1 / 1500 - 1 / 2000)
    assert math.degrees(math.asin(math.sqrt(sine))) == pytest.approx(20, rel=1e-9)
    assert found.passage is None or found.passage > 0


def test_an_attitude_in_the_file_is_none_of_a_flat_spin(no_search):
    """Nothing that acts depends on it."""
    body = {"body": {"inertia": [3, 2, 1]}, "effects": {"viscous_damper": {"inertia": "0.1", "coefficient": 1}}}
    bare, turned = ({**body, "motion": {"angular_velocity": [0, "0.1", 1], **more}}
                    for more in ({}, {"vertical": [0, 0, 1], "attitude": [0, 0, 0]}))
    one, other = flat_spin(bare), flat_spin(turned)
    assert (one.outcome, one.crosses.at) == (other.outcome, other.crosses.at)


@pytest.mark.slow
def test_a_liquid_tumbles_a_body_as_well(no_search):
    scene = Scene(Body((12, 9, 5)), LiquidCavity.of_sphere(10_000, "0.01", "0.12"))  # a heavy one is quick
    found = flat_spin(load(scene, (0.02, 0.01, 0.1)))
    assert found.level == "run" and found.crosses.at < found.settles.at and not found.caveats


@pytest.mark.parametrize("scene, rates, words", [
    (Scene(Body((3, 2, 1))), (0, 0, 1), "nothing takes energy"),
    (Scene(Body((3, 2, 1)), ViscousDamper("0.1", 1), ConstantTorque((0, 0, 1))), (0, 0, 1), "constant torque"),
    (Scene(Body((2, 2, 2)), ViscousDamper("0.1", 1)), (0, 0, 1), "all moments are equal"),
    (Scene(Body((3, 2, 1)), ViscousDamper("0.1", 1)), (0, 0, 0), "angular momentum is zero")])
def test_what_the_question_is_not_known_of_is_refused(scene, rates, words):
    with pytest.raises(InputError, match=words):
        flat_spin(load(scene, rates))


@pytest.mark.parametrize("within", ["0 deg", "90 deg", "5 m", "wide", -1])
def test_an_angle_that_is_none_is_refused(within):
    with pytest.raises(InputError, match="within"):
        flat_spin(case(), within)


@pytest.mark.parametrize("inertia, coefficient, line, words", [
    ("0", "1", 4, "inertia: expected a positive number, got 0.0"),
    ("0.1", "-1", 5, "coefficient: expected a positive number, got -1.0"),
    ("1000", "1", 4, "must be smaller than every principal moment"),
    ('"3 N"', "1", 4, "moment of inertia")])
def test_a_damper_that_cannot_be_is_one_fault_of_its_line(inertia, coefficient, line, words):
    with pytest.raises(InputError) as error:
        load(RAHN_BARBA.format(rates="0, 0, 1").replace("= 18", f"= {inertia}").replace("= 30", f"= {coefficient}"))
    assert len(error.value.problems) == 1 and error.value.problems[0].line == line
    assert words in str(error.value)


def test_a_damper_needs_both_of_its_keys():
    with pytest.raises(InputError, match="coefficient is missing"):
        load(RAHN_BARBA.format(rates="0, 0, 1").replace("coefficient = 30\n", ""))


def test_a_damper_that_turns_at_the_start_counts_in_energy_and_momentum(no_search):
    found = flat_spin(load(RAHN_BARBA.format(rates="0.1224, 0, 2.99") + "damper = [1, 0, 0]\n"))
    assert found.momentum == pytest.approx(math.hypot(2000 * 0.1224 + 18, 2990), rel=1e-15)
    assert found.energy == pytest.approx((2000 * 0.1224**2 + 1000 * 2.99**2) / 2 + 18 * (0.1224 + 0.5), rel=1e-15)


def test_a_slow_tumble_says_what_it_cost(no_search):
    found = flat_spin(load(RAHN_BARBA.format(rates="0.1224, 0, 2.99").replace("= 30", "= 600")))
    assert found.level == "run" and found.steps > 10_000


def test_a_run_that_does_not_reach_the_separatrix_is_undecided(no_search, monkeypatch):
    monkeypatch.setattr(dissipation, "RUN_STEPS", 500)
    found = flat_spin(case())
    assert found.outcome == "undecided" and "were not enough" in found.because
