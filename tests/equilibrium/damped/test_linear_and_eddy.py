"""A linear damper and eddy currents: where the rates vanish, which of these states attract, and where motions end.

Independent means: Newton's method from many starts, NumPy's eigenvalues of central differences of the rates
written here, SciPy's runs of these.
"""
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import (
    Body,
    ConstantTorque,
    EddyCurrents,
    Gravity,
    Gyrostat,
    InputError,
    LiquidCavity,
    RateDamper,
    Scene,
    ViscousDamper,
    equilibria,
    flat_spin,
    load,
    motion,
)
from stabilab.orbit.result import Fate
from tests.equilibrium.damped.test_liquid_and_medium import measured

D = np.array([3.0, 2.0, 1.0])


def linear(C, M=(0, 0, 0), wheel=(0, 0, 0), D=D):
    """omega' of three rates, one row."""
    C, M, wheel = (np.array(v, float) for v in (C, M, wheel))
    return lambda w: (np.cross(D * w + wheel, w) - C @ w + M) / D


def eddy(k, D=D):
    """(omega', gamma') in a field of this k B^2, by B^2 and the part of omega along the field."""
    def rates(x):
        w, g = x[:3], x[3:]
        return np.concatenate([(np.cross(D * w, w) - k * (g @ g * w - (w @ g) * g)) / D, np.cross(g, w)])
    return rates


def end(rates, start, until):
    return solve_ivp(lambda t, x: rates(x), (0, until), start, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]


FULL = (("0.2", "0.05", 0), ("0.05", "0.3", "-0.1"), (0, "-0.1", "0.15"))
SCENES = [(("0.2", "0.3", "0.15"), (1, 0, 1), (0, 1, 0)), (FULL, (1, 0, 1), (0, 1, 0)), (FULL, (2, -1, "0.5"), (0, 0, 0)),
          ("0.4", ("0.3", 2, "-0.7"), (1, "0.5", 0))]


def rows(C):
    """As a matrix of numbers."""
    if isinstance(C, str):
        return float(C) * np.eye(3)
    return np.array(C, float) if isinstance(C[0], tuple) else np.diag(np.array(C, float))


@pytest.mark.parametrize("C, M, wheel", SCENES)
def test_every_equilibrium_with_a_linear_damper_is_found_and_its_stability_is_that_of_its_spectrum(C, M, wheel):
    found = equilibria(Scene(Body((3, 2, 1)), RateDamper(C), ConstantTorque(M), Gyrostat(wheel)))
    rates = linear(rows(C), M, wheel)
    starts = np.random.default_rng(1).normal(size=(80, 3)) * 8
    places = []
    for w in starts:  # Newton's method from many places
        for _ in range(25):
            J = np.stack([(rates(w + 1e-6 * e) - rates(w - 1e-6 * e)) / 2e-6 for e in np.eye(3)], axis=1)
            w = w - np.linalg.solve(J, rates(w))
        if np.abs(rates(w)).max() < 1e-9 and all(np.abs(w - other).max() > 1e-5 for other in places):
            places.append(w)
    assert found.kind == "points" and len(found.points) == len(places)
    for point in found.points:
        assert min(np.abs(np.array(point.at) - w).max() for w in places) < 1e-8
        values = measured(rates, point.at)
        assert sorted(point.eigenvalues, key=lambda z: (z.real, z.imag)) == pytest.approx(
            sorted(values, key=lambda z: (z.real, z.imag)), abs=1e-7)
        assert (point.verdict == "asymptotically stable") == (values.real.max() < 0)


def test_a_damper_in_proportion_to_the_moments_is_a_resisting_medium():
    """C = c D: the same numbers by the medium's own formulas, which are tested elsewhere."""
    from stabilab import Resistance
    one, two = (equilibria(Scene(Body((3, 2, 1)), loss, ConstantTorque((1, 0, 1)), Gyrostat((0, 1, 0))))
                for loss in (Resistance("0.1"), RateDamper(("0.3", "0.2", "0.1"))))
    assert [p.at for p in one.points] == [p.at for p in two.points]
    assert [p.eigenvalues for p in one.points] == [p.eigenvalues for p in two.points]


def test_the_first_line_says_what_is_left_in_the_end(stabilab, tmp_path):
    """Rest without a torque (LaSalle); with one the late bound is recorded."""
    (tmp_path / "a.toml").write_text("body.inertia = [3, 2, 1]\neffects.rate_damper.coefficient = 0.1\n"
                                     "motion.angular_velocity = [1, 0, 0]\n")
    assert stabilab("fate", tmp_path / "a.toml")[1].splitlines()[0].endswith(", tends to rest")


@pytest.mark.parametrize("C, M, wheel", SCENES)
def test_rates_stay_below_their_bounds(C, M, wheel):
    start = np.array([2.0, -3.0, 5.0])
    found = motion(Scene(Body((3, 2, 1)), RateDamper(C), ConstantTorque(M), Gyrostat(wheel)), start)
    assert found.fate == Fate.BOUNDED
    run = solve_ivp(lambda t, w: linear(rows(C), M, wheel)(w), (0, 200), start, rtol=1e-9)
    size = np.linalg.norm(run.y, axis=0)
    assert size.max() <= found.invariants["rate_bound"]
    assert size[-1] <= found.invariants["late_rate_bound"] * (1 + 1e-6)


def test_without_a_torque_every_rate_falls_at_least_as_it_says():
    found = motion(Scene(Body((3, 2, 1)), RateDamper(FULL), Gyrostat((0, 1, 0))), (2, -3, 5))
    slowest = float(found.because.split("c = ")[1].split()[0])
    scaled = rows(FULL) / np.sqrt(np.outer(D, D))  # T' = -y . D^-1/2 C D^-1/2 y, y^2/2 = T
    assert slowest == pytest.approx(np.linalg.eigvalsh(scaled)[0], rel=1e-5)
    end_rates = end(linear(rows(FULL), wheel=(0, 1, 0)), (2, -3, 5), 50)
    assert end_rates @ (D * end_rates) / 2 <= found.invariants["energy"] * np.exp(-2 * slowest * 50)


def test_a_damper_about_some_axes_is_bounded_and_its_end_stays_open():
    scene = Scene(Body((3, 2, 1)), RateDamper((0, "0.1", 0)))
    found = motion(scene, (1, 2, 3))
    assert found.fate == Fate.BOUNDED and "undecided" in found.because and equilibria(scene).kind == "undecided"
    assert motion(Scene(scene.body, *scene.effects, ConstantTorque((1, 0, 0))), (1, 2, 3)).fate == Fate.UNDECIDED


def test_a_damper_in_an_oblique_body_acts_along_the_axes_of_the_file():
    """The matrix turned by NumPy's eigenvectors."""
    inertia, C = np.array([[2, 0.3, 0], [0.3, 3, 0.1], [0, 0.1, 1.5]]), np.diag([0.1, 0.0, 0.2])
    body = Body([[str(v) for v in row] for row in inertia])
    scene = Scene(body, RateDamper(("0.1", 0, "0.2")))
    axes = np.array(body.axes.axes, float)
    assert np.array(scene.effect("rate_damper").coefficient) == pytest.approx(axes @ C @ axes.T, abs=1e-15)
    # free about y, which is no principal axis, so that no rotation about it goes on
    assert motion(scene, (1, 2, 3)).invariants["late_rate_bound"] == 0 and equilibria(scene).kind == "points"
    assert load(scene, (1, 2, 3)).motion().because == motion(scene, (1, 2, 3)).because


@pytest.mark.parametrize("moments, stable", [((3, 2, 1), {0}), ((1, 3, 2), {1}), ((2, 2, 1), {0, 1}), ((2, 2, 2), {0, 1, 2})])
def test_eddy_currents_leave_rotation_about_the_largest_moment_along_the_field(moments, stable):
    found = equilibria(Scene(Body(moments), EddyCurrents("0.1", 2)))
    rates = eddy(0.4, np.array(moments, float))
    assert found.kind == "curves" and len(found.curves) == 7
    for axis, curve in zip((0, 0, 1, 1, 2, 2), found.curves):
        for sample in curve.samples:
            assert np.abs(rates(np.array(sample.at))).max() == 0
            values = measured(rates, sample.at)
            ours, theirs = (sorted(v, key=lambda z: (round(z.real, 6), z.imag)) for v in (sample.eigenvalues, values))
            assert ours == pytest.approx(theirs, abs=1e-6)
            assert (sample.verdict == "stable") == (axis in stable) == (values.real.max() < 1e-6)


def test_a_body_in_a_field_ends_about_the_field_as_it_says():
    start = np.array([1.0, 2.0, -3.0, 0.6, 0.0, 0.8])
    found = motion(Scene(Body((3, 2, 1)), EddyCurrents("0.1", 2)), start)
    last, p = end(eddy(0.4), start, 300), float(D @ (start[:3] * start[3:]))
    assert found.fate == Fate.BOUNDED and f"{p:.6g} N m s" in found.because and f"{p / 3:.6g} rad/s" in found.because
    assert np.abs(np.cross(last[:3], last[3:])).max() < 1e-6
    assert (abs(last[3]), last[0] * last[3]) == pytest.approx((1, p / 3), abs=1e-6)
    assert np.linalg.norm(start[:3]) <= found.invariants["rate_bound"]


def turning_in_a_field(seed):
    """(moments, start) of one that soon is on the side where it ends, or that tumbles first."""
    rng = np.random.default_rng(seed)
    a = rng.uniform(0.1, 1, 3)
    moments = np.round([a[1] + a[2], a[0] + a[2], a[0] + a[1]], 3)
    omega, gamma = rng.normal(size=3), rng.normal(size=3)
    if seed % 2:
        gamma *= 0.3
        gamma[moments.argmax()] += rng.choice((-2.0, 2.0))
        omega = 0.2 * omega + rng.choice((-2.0, 2.0)) * gamma / np.linalg.norm(gamma)
    return moments, np.concatenate([omega, gamma / np.linalg.norm(gamma)])


def signs_as_in_a_run(seed):
    """Whether the rates along the field and about the axis have the signs of SciPy's run; which of them are
    said; None where that run has not settled. A side that is proved is so without a run."""
    moments, start = turning_in_a_field(seed)
    rates, until, i = eddy(2.0, moments), 120.0, int(moments.argmax())
    last = end(rates, start, until)
    if np.linalg.norm(np.cross(last[:3], last[3:])) > 1e-3 * abs(last[:3] @ last[3:]) or abs(last[3 + i]) < 0.99:
        return None
    scene = Scene(Body(tuple(moments)), EddyCurrents(2, 1))
    said = set()
    for words in (motion(scene, start).because, motion(scene, start, (0, until)).because):
        along = re.search(r"at (\S+) rad/s along `vertical`", words)
        assert float(along[1]) == pytest.approx(last[:3] @ last[3:], rel=2e-3)
        about = re.search(r"(?:: at|it ends at) ([-+]\S+) rad/s about axis (\d)", words)
        if about:
            assert (int(about[2]), float(about[1])) == (i + 1, pytest.approx(last[i], rel=2e-3))
        said.add("open" if not about else "run" if "by a run" in words else "proved")
    return said


@pytest.mark.parametrize("wheel", [(0, 0, 0), (0.4, -1, 0.3)])
def test_eddy_currents_beside_a_damper_leave_rest_in_every_attitude(wheel):
    """Eigenvalues by differences of the rates written here; SciPy's run from beside it ends at rest, near by."""
    C = np.array([[0.2, 0.05, 0], [0.05, 0.3, -0.1], [0, -0.1, 0.15]])
    still, turning = linear(C, wheel=wheel), eddy(0.4)
    rates = lambda x: turning(x) + np.concatenate([still(x[:3]) - np.cross(D * x[:3], x[:3]) / D, np.zeros(3)])
    result = equilibria(Scene(Body(tuple(D)), EddyCurrents(0.4, 1.0), RateDamper(C.tolist()),
                              *([Gyrostat(wheel)] if any(wheel) else [])))
    curve, = result.curves
    sample, = curve.samples
    assert [segment.verdict for segment in curve.segments] == ["stable"] and not any(sample.at[:3])
    x, h = np.array(sample.at), 1e-6
    J = np.array([(rates(x + h * e) - rates(x - h * e)) / (2 * h) for e in np.eye(6)]).T
    key = lambda v: (round(v.real, 6), round(v.imag, 6))
    assert np.abs(np.array(sorted(np.linalg.eigvals(J), key=key)) - sorted(sample.eigenvalues, key=key)).max() < 1e-8
    last = end(rates, [0.01, -0.02, 0.01, *x[3:]], 300)
    assert np.abs(last[:3]).max() < 1e-9 and np.abs(last[3:] - x[3:]).max() < 0.3


def test_eddy_currents_name_the_rate_along_the_field_and_the_one_about_the_axis():
    assert {word for seed in range(6) for word in signs_as_in_a_run(seed) or ()} == {"open", "run", "proved"}


@pytest.mark.slow
@pytest.mark.parametrize("end, settled, proved", [(46, 28, 7), pytest.param(290, 200, 50, marks=pytest.mark.long)])
def test_eddy_currents_name_both_rates_of_settled_scenes(end, settled, proved):
    found = [said for seed in range(6, end) if (said := signs_as_in_a_run(seed))]
    assert len(found) >= settled and sum(said == {"proved"} for said in found) > proved


def test_eddy_currents_without_momentum_along_the_field_bring_to_rest():
    # H . gamma = -2 * 0.25 + 1 * 1.0 * 0.5 = 0, by hand
    found = motion(Scene(Body((3, 2, 1)), EddyCurrents(1, 1)), (0.5, 0.25, 1.0, 0.0, -1.0, 0.5))
    assert found.because.endswith("H . gamma = 0 stays, and the motion tends to rest (LaSalle)")


@pytest.mark.parametrize("moments, words", [((2, 2, 1), "in the plane of axis 1 and axis 2"),
                                            ((2, 2, 2), "whichever axis then points along it")])
def test_eddy_currents_name_no_axis_of_the_largest_moment_where_there_are_several(moments, words):
    start = np.array([0.3, -0.2, 1.0, 0.6, 0.0, 0.8])
    found = motion(Scene(Body(moments), EddyCurrents(1, 1)), start)
    last = end(eddy(1.0, np.array(moments, float)), start, 300)
    along = float(re.search(r"at (\S+) rad/s along `vertical`", found.because)[1])
    assert words in found.because and along == pytest.approx(last[:3] @ last[3:], rel=1e-5)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("others", [(ConstantTorque((1, 0, 0)),), (Gravity(1, (0, 0, 1)),), (Gyrostat((1, 0, 0)),),
                                    (LiquidCavity(1, 1, 1),), (RateDamper("0.1"),),
                                    (ViscousDamper("0.1", 1),)])
def test_eddy_currents_beside_others_are_bounded_or_open_but_never_wrong(others):
    scene, start = Scene(Body((3, 2, 1)), EddyCurrents("0.1", 1), *others), (1, 2, 3, 0, 0, 1)
    assert equilibria(scene).kind == ("curves" if isinstance(others[0], RateDamper) else "undecided")
    found = motion(scene, start)
    open_ = others[0].name in ("constant_torque", "liquid_cavity", "viscous_damper")
    assert (found.fate == Fate.UNDECIDED) == open_ and ("rate_bound" in found.invariants) != open_


def test_turns_too_many_for_a_search_are_not_searched():
    found = motion(Scene(Body((3, 2, 1)), EddyCurrents(1, 1)), (1e12, 1e12, 0, 0, 0, 1), (0, 10))  # 1e13 rad
    assert found.fate == Fate.BOUNDED and "too fast" in found.extremes_over
    assert found.invariants["rate_bound"] == pytest.approx(5**0.5 * 1e12)  # T <= T(0) and D3 = 1


@pytest.mark.parametrize("loss", [RateDamper("0.1"), EddyCurrents(1, 1)])
def test_there_is_no_flat_spin_where_the_angular_momentum_falls(loss):
    case = load(Scene(Body((3, 2, 1)), loss), {"omega": (0, 0, 1)} | ({"gamma": (1, 0, 0)} if loss.needs else {}))
    with pytest.raises(InputError, match="which changes the angular momentum"):
        flat_spin(case)


CASE = "[body]\ninertia = [3, 2, 1]\n[effects.{}]\n{}\n[motion]\nangular_velocity = [1, 2, 3]\n"


@pytest.mark.parametrize("effect, keys, line, words", [
    ("rate_damper", "coefficient = -1", 4, "expected no negative number"),
    ("rate_damper", "coefficient = [1, -2, 0]", 4, "expected no negative number"),
    ("rate_damper", "coefficient = [[1, 2, 0], [2, 1, 0], [0, 0, 1]]", 4, "not positive semidefinite"),
    ("rate_damper", "coefficient = [[1, 2, 0], [3, 9, 0], [0, 0, 1]]", 4, "not symmetric"),
    ("rate_damper", "coefficient = [1, 2]", 4, "expected three numbers"),
    ("rate_damper", 'coefficient = "1 N"', 4, "angular momentum"),
    ("rate_damper", "", 3, "coefficient is missing"),
    ("eddy_currents", "coefficient = -1\nfield = 1", 4, "not negative"),
    ("eddy_currents", 'coefficient = 1\nfield = "-1 uT"', 5, "not negative"),
    ("eddy_currents", "coefficient = 1", 3, "field is missing")])
def test_a_damper_that_gives_energy_is_one_fault_of_its_line(effect, keys, line, words):
    with pytest.raises(InputError, match=words) as error:
        load(CASE.format(effect, keys))
    assert [one.line for one in error.value.problems] == [line]


@pytest.mark.parametrize("made, words", [(lambda: RateDamper(-1), "coefficient: expected no negative"),
                                         (lambda: EddyCurrents(1, -1), "field: expected"),
                                         (lambda: EddyCurrents(-1, 1), "coefficient: expected")])
def test_python_refuses_them_too(made, words):
    with pytest.raises(InputError, match=words):
        made()


def test_a_damper_of_each_form_is_written_as_it_was_given():
    for C in ("0.1", ("0.1", "0.2", 0), FULL):
        scene = Scene(Body((3, 2, 1)), RateDamper(C))
        assert load(scene, (1, 2, 3)).scene.effect("rate_damper").exact == scene.effect("rate_damper").exact
    assert Scene(Body((3, 2, 1)), RateDamper(0)).effects == ()  # without strength it is absent
