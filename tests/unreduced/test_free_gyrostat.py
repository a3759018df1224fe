"""Fates without a reduction: free gyrostats on their momentum sphere, and torques turned onto an axis of a
symmetric body."""
from fractions import Fraction
from fractions import Fraction as F

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene
from stabilab.answers.digits import ask
from stabilab.answers.kinds import kind_of
from stabilab.answers.motion import Needs
from stabilab.answers.motion import motion as motion_of
from stabilab.errors import InputError
from stabilab.orbit.fate import free_margin
from stabilab.unreduced.free_gyrostat import extremes_over_period
from tests.oracles import sphere


def free_scenes(seed, count, decades=0.0):
    """Bodies without a torque, moments distinct, nearly equal or equal, wheels along no, one, two or three
    axes, and states: floats."""
    rng = np.random.default_rng(seed)
    while count:
        D = (rng.uniform(1, 2, 3) if count % 4
             else np.array([1.5, 1.5 * (1 + rng.choice([0, 1e-15, 1e-8])), rng.uniform(1, 2.5)]))
        lam = rng.normal(size=3) * 10.0 ** rng.uniform(-decades, decades) * (np.arange(3) < count % 5)
        state = rng.normal(size=3) * 10.0 ** rng.uniform(-decades, decades) * (rng.random(3) < 0.9)
        order = rng.permutation(3)
        if state.any():
            count -= 1
            yield D[order].tolist(), lam[order].tolist(), state.tolist()


def energies(D, lam, state, margin):
    """Kinetic energies of the motion and of the saddle: what a margin is judged by."""
    own = float(sum(d * v * v for d, v in zip(D, state))) / 2
    return own + abs(own + margin)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("decades", [0.0, 3.0])
def test_margins_of_free_bodies_and_gyrostats_are_those_of_the_nearest_saddle_in_many_digits(decades):
    # oracle: mpmath's roots of |H|^2 = h^2 and the second derivative as a matrix (tests/oracles/sphere.py)
    for D, lam, state in free_scenes(5, 25, decades):
        scene, exact = Scene(Body(D), Gyrostat(lam)), sphere.margin(D, lam, state)
        found = stabilab.fate(scene,
                              np.array([state])).margins[0], motion_of(scene, state,
                                                                             needs=Needs.QUICK).margin_energy
        if exact is None:
            assert found == (np.inf, None), (scene, state)
        else:
            assert max(abs(v - float(exact))
                       for v in found) <= 1e-12 * energies(D, lam, state, float(exact)), (scene, state)


def test_large_arrays_of_free_motions_keep_their_digits_and_rarely_need_many():
    rng = np.random.default_rng(8)
    for D, lam, _ in free_scenes(9, 10, 2.0):
        scene, states = Scene(Body(D), Gyrostat(lam)), rng.normal(size=(6000, 3))
        many = stabilab.fate(scene, states)
        assert many.precise <= 12, scene
        for state, margin in zip(states[::2000].tolist(), many.margins[::2000]):
            exact = float(free_margin(scene, state))
            assert margin == exact or abs(margin
                                          - exact) <= 1e-12 * energies(D, lam, state, exact), (scene, state)


def saddle_and_another():
    """(D, lambda, a saddle, another state of its energy and momentum), all rational. H + t v has the saddle's
    momentum for t = -2 v.H/|v|^2, and its energy as well where sum v_i^2/D_i = |v|^2/s (H = s omega at the
    saddle)."""
    D, v = [Fraction(d) for d in (4, 3, 2)], [Fraction(a) for a in (1, 2, 1)]
    s = sum(a * a for a in v) / sum(a * a / d for a, d in zip(v, D))
    omega = [Fraction(1), Fraction(1, 10), Fraction(1, 5)]
    H, lam = [s * w for w in omega], [(s - d) * w for d, w in zip(D, omega)]
    t = -2 * sum(a * h for a, h in zip(v, H)) / sum(a * a for a in v)
    return D, lam, omega, [(h + t * a - l) / d for h, a, l, d in zip(H, v, lam, D)]


def test_a_rational_state_on_the_separatrix_of_a_free_gyrostat_is_recognised_and_its_neighbours_are_not():
    D, lam, saddle, state = saddle_and_another()
    scene = Scene(Body(D), Gyrostat(lam))
    assert kind_of(scene) == "free"
    energy = lambda w: sum(d * v * v for d, v in zip(D, w)) / 2
    momentum = lambda w: sum((d * v + l) ** 2 for d, v, l in zip(D, w, lam))
    assert energy(state) == energy(saddle) and momentum(state) == momentum(saddle)
    found = free_margin(scene, state)
    assert found.tie and float(found) == 0
    for nudge in (Fraction(1, 10**70), -Fraction(1, 10**70)):  # sixty digits would call this a tie
        near = free_margin(scene, [state[0] + nudge, *state[1:]])
        assert not near.tie and 0 < abs(float(near)) < 1e-68
    motion = motion_of(scene, tuple(map(float, state)), exact=tuple(state))
    assert motion.fate is Fate.SEPARATRIX and motion.margin_energy == 0


def test_the_digits_of_a_free_margin_are_those_asked_for():
    from stabilab.answers.digits import ask
    lam, D, state = (0.125, 0.25, -0.125), (4, 3, 2), (1.0, 0.5, -0.25)
    told = ask("fate", Scene(Body(D), Gyrostat(lam)), state, 40)
    assert told.digits >= 40
    nearest = sphere.margin(D, lam, state)
    with mp.workdps(60):
        assert abs(mp.mpf(told.decimals) - nearest) < mp.mpf(10) ** -40 * abs(nearest)


def turned_by(cosine, sine):
    """A scene (D = (4, 4, 2), lambda = (0, 1, 0), torque (-50, 0, 0)) and a state exactly on its separatrix
    (tests/hard/test_numbers.py, TIES), turned about axis 3 by an angle with these rational cosine and sine."""
    turn = lambda x, y: (cosine * x - sine * y, sine * x + cosine * y)
    momentum, torque = (*turn(0, 1), 0), (*turn(-50, 0), 0)
    state = (*turn(Fraction(1), Fraction(-15, 2)), Fraction(-7, 2))
    return Scene(Body((4, 4, 2)), Gyrostat(momentum), ConstantTorque(torque)), state


@pytest.mark.parametrize("cosine, sine",
                         [(Fraction(3, 5), Fraction(4, 5)), (Fraction(-5, 13), Fraction(12, 13)),
                          (Fraction(7, 25), Fraction(-24, 25))])
def test_a_state_on_the_separatrix_stays_there_when_the_scene_is_turned(cosine, sine):
    scene, state = turned_by(cosine, sine)
    assert kind_of(scene) == "aligned"
    given = tuple(map(float, state))
    assert motion_of(scene, given, exact=state, needs=Needs.QUICK).fate is Fate.SEPARATRIX
    near = (state[0], state[1] * (1 + Fraction(1, 10**25)), state[2])
    found = motion_of(scene, given, exact=near, needs=Needs.QUICK)
    assert found.fate is Fate.BOUNDED and 1e-30 < abs(found.margin_energy) < 1e-20


def test_a_state_too_near_a_separatrix_for_an_irrational_turn_is_undecided_and_says_why():
    # the torque (-50, -50/3, 0) has an irrational length; the saddle's energy is met by a speed of many
    # digits
    third = Fraction(1, 3)
    root = mp.mp.clone()
    root.dps = 90
    scale = root.sqrt(1 + root.mpf(1) / 9)
    cosine, sine = 1 / scale, 1 / (3 * scale)
    as_fraction = lambda v: Fraction(int(root.floor(v * root.mpf(10) ** 80)), 10**80)
    # across the torque to 80 digits, made so exactly below
    momentum = tuple(as_fraction(v) for v in (-sine, cosine))
    momentum = (-momentum[1] * third, momentum[1], Fraction(0))
    length = as_fraction(50 * cosine)
    scene = Scene(Body((4, 4, 2)), Gyrostat(momentum), ConstantTorque((-length, -length * third, 0)))
    x, y = root.mpf(1), root.mpf("-7.5")
    state = (as_fraction(cosine * x - sine * y), as_fraction(sine * x + cosine * y), Fraction(-7, 2))
    found = motion_of(scene, tuple(map(float, state)), exact=state, needs=Needs.QUICK)
    # its sign is open
    assert found.fate is Fate.UNDECIDED and "irrational" in found.because and found.margin_energy is None
    off = (state[0], state[1] * (1 + Fraction(1, 10**20)), state[2])
    assert motion_of(scene, tuple(map(float, state)), exact=off, needs=Needs.QUICK).fate is Fate.BOUNDED


@pytest.mark.parametrize("torque, along", [((1, 2, 0), (0.1, 0.2, 0.0)), ((3, -1, 0), (-0.3, 0.1, 0.0)),
                                           ((0.1, 0.7, 0), (0.1, 0.7, 0.0))])
def test_spin_along_a_torque_between_equal_axes_is_pure_spin_for_arrays_and_single_states(torque, along):
    """Nothing but the torque acts on a spin along it; turned in doubles, a component of 1e-17 across it would
    seem to bound it."""
    scene = Scene(Body((4, 4, 2)), Gyrostat((0, 0, 0)), ConstantTorque(torque))
    assert kind_of(scene) == "aligned"
    many = stabilab.fate(scene, np.array([along, np.multiply(along, 2)]))
    np.testing.assert_array_equal(many.labels, Fate.SPIN_UP)
    assert many.precise == 2 and motion_of(scene, along, needs=Needs.QUICK).fate is Fate.SPIN_UP


def test_arrays_beside_a_turned_separatrix_get_the_labels_of_exact_arithmetic():
    scene, state = turned_by(Fraction(3, 5), Fraction(4, 5))
    given = np.array([float(v) for v in state])
    states = given * (1 + np.array([0, 1e-15, -1e-15, 1e-13, -1e-12, 1e-9, 1e-6, -1e-4])[:, None])
    found = stabilab.fate(scene, states)
    singles = [motion_of(scene, tuple(s), needs=Needs.QUICK) for s in states.tolist()]
    np.testing.assert_array_equal(found.labels, [m.fate for m in singles])
    # of the energy, 140 J
    np.testing.assert_allclose(found.margins, [m.margin_energy for m in singles], rtol=1e-9, atol=1e-12 * 140)
    assert 0 < found.precise < len(states)


@pytest.mark.slow
def test_a_gyrostatic_component_along_a_torque_between_equal_axes_leaves_no_motion_bounded():
    """Found by the search: decimals of a moment across the torque leave a hair along it, and the turned scene
    has no reduction. Law: |H|^2/2 - D T grows at the rate lambda.M, D the equal moments (from D omega.M = (D
    omega).M)."""
    scene = Scene(Body((4, 4, 2)), Gyrostat((-4.1, 3.0750000000000006, 0)), ConstantTorque((3, 4, 0)))
    assert kind_of(scene) == "aligned" and -4.1 * 3 + 3.0750000000000006 * 4 != 0
    states = np.array([(1.0, 0.5, -0.25), (0.1, -2.0, 0.5)])
    many = stabilab.fate(scene, states)
    assert set(many.labels.tolist()) <= {Fate.SPIN_UP, Fate.UNDECIDED} and (many.margins == -np.inf).all()
    assert not many.axis.any()
    one = motion_of(scene, tuple(states[0]), needs=Needs.QUICK)
    assert one.fate == many.labels[0] and "no motion is bounded" in one.because


def test_a_free_gyrostat_at_rest_has_no_period_and_its_doubles_swing_by_rounding():
    """Momentum and rotation parallel in the decimals of the case, not in its doubles: equal moments turn
    these about the wheel's moment at the rate |lambda|/D (omega' = lambda x omega/D)."""
    scene, tenths = Scene(Body((3, 3, 3)), Gyrostat((1, 2, 3))), [Fraction(n, 10) for n in (1, 2, 3)]
    found = motion_of(scene, tuple(map(float, tenths)), exact=tenths)
    assert found.fate is Fate.EQUILIBRIUM and found.period is None and found.extremes == (
        (0.1, 0.1), (0.2, 0.2), (0.3, 0.3))
    doubles = np.array([0.1, 0.2, 0.3])
    assert stabilab.fate(scene, doubles).labels == Fate.BOUNDED
    np.testing.assert_allclose(stabilab.extremes(scene, doubles), np.stack([doubles, doubles], axis=1),
                               rtol=0, atol=1e-16)
    assert stabilab.period(scene, doubles) == pytest.approx(2 * np.pi * 3 / np.sqrt(14), rel=1e-15)


SPIN = Scene(Body((12, 9, 5)), Gyrostat(("0.8", "0.5", "0.3")))


def permanent(s, ulps=0):
    """The doubles of the permanent rotation (D + lambda/omega = s), its first rate some units in the last
    place away."""
    w = [float(h / (s - d)) for h, d in zip((mp.mpf(4) / 5, mp.mpf(1) / 2, mp.mpf(3) / 10), (12, 9, 5))]
    return [w[0] + ulps * np.spacing(w[0]), *w[1:]]


@pytest.mark.parametrize("s", [20, -3, 6, 11])
def test_a_swing_by_rounding_about_a_stable_rotation_has_the_period_of_the_linear_motion(s):
    """2 pi over the frequency of the Jacobian, by NumPy's eigenvalues; the swing is of the size of the
    start's rounding."""
    state = permanent(s, 5)
    frequency = max(abs(np.linalg.eigvals(np.array(SPIN.quadratic().jacobian(state))).imag))
    assert stabilab.period(SPIN, state) == pytest.approx(2 * np.pi / frequency, rel=1e-11)
    box = stabilab.extremes(SPIN, state)
    assert (box[:, 0] <= state).all() and (state <= box[:, 1]).all() and np.ptp(box, axis=1).max() < 1e-14


@pytest.mark.parametrize("s, passages",
                         # outside the figure eight of a saddle, which it rounds, or in a loop of it
                         [(7, 2), (10, 1)])
def test_the_period_next_to_an_unstable_rotation_grows_by_the_logarithm_of_the_margin(s, passages):
    """Each passage of a saddle costs ln(1/margin)/rate, so periods differ by ln of the ratio of the margins
    over the growth rate."""
    near, far = permanent(s, 100), permanent(s, 10**6)
    rate = max(np.linalg.eigvals(np.array(SPIN.quadratic().jacobian(near))).real)
    ratio = stabilab.fate(SPIN, far).margins / stabilab.fate(SPIN, near).margins
    assert stabilab.period(SPIN,
                           near) - stabilab.period(SPIN,
                                                   far) == pytest.approx(passages * np.log(ratio) / rate,
                                                                         rel=1e-8)


def test_thirty_digits_of_a_swing_by_rounding_are_those_of_the_linear_motion():
    """Equal moments turn the rates about the wheel's moment at the rate |lambda|/D, whatever the start."""
    scene = Scene(Body((3, 3, 3)), Gyrostat((1, 2, 3)))
    with mp.workdps(40):
        wanted = mp.nstr(2 * mp.pi * 3 / mp.sqrt(14), 30)
    told = ask("period", scene, (0.1, 0.2, 0.3), 30)
    assert told.enough and told.decimals[:30] == wanted[:30]


def test_a_momentum_sphere_that_touches_its_fold_has_a_margin():
    """At the fold, where the state rests, two rotations merge: it is no saddle."""
    D, wheel, state = (3, 5, 6), (F(8, 3), -1, F(1, 3)), (F(5, 3), F(-3, 2), F(1, 3))
    own = sum(d * v * v for d, v in zip(D, state)) / 2
    with mp.workdps(100):
        apart = [e - sphere.num(own) for e, saddle in sphere.rotations(D, wheel, state) if saddle]
        nearest = min((v for v in apart if abs(v) > 1e-30), key=abs)
    found = free_margin(Scene(Body(D), Gyrostat(wheel)), state)
    assert float(found) == pytest.approx(float(nearest), rel=1e-9)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("u", [Fraction(2) ** k for k in (-900, -300, 300, 900)]
                         + [Fraction(10) ** p for p in (155, 160, 200, 300)])
def test_a_free_gyrostat_at_any_rate_is_the_same_motion(u):
    """Law: with moment and rates times u the motion is the same in a time 1/u as long, and its energies go
    with u^2."""
    def made(u):
        return Scene(Body((12, 9, 5)),
                     Gyrostat([v * u for v in (1, 2, 3)])), [Fraction(v) * u
                                                             for v in (1, Fraction(1, 2), Fraction(-3, 4))]
    (scene, state), (plain, start) = made(u), made(1)
    rows, size = np.array([[float(v) for v in state]]), float(u)
    one, wanted = motion_of(scene, tuple(rows[0]),
                                  exact=state), stabilab.motion(plain, tuple(map(float, start)))
    assert one.fate == wanted.fate and one.period * size == pytest.approx(wanted.period, rel=1e-11)
    np.testing.assert_allclose(np.array(one.extremes) / size, wanted.extremes, rtol=1e-11)
    np.testing.assert_allclose(stabilab.period(scene, rows) * size, wanted.period, rtol=1e-11)
    np.testing.assert_allclose(stabilab.extremes(scene, rows)[0] / size, wanted.extremes, rtol=1e-11)
    margin = stabilab.fate(scene, rows)
    if abs(np.log2(size)) < 500:
        assert margin.margins[0] / size**2 == pytest.approx(wanted.margin_energy,
                                                            rel=1e-11) == one.margin_energy / size**2
    else:
        assert np.isnan(margin.margins[0]) and one.margin_energy is None
        assert "the margin in energy" in one.because and "beyond the range of doubles" in margin.because[0]


def test_rates_next_to_the_largest_doubles_lose_what_is_no_double_and_say_so():
    """Law: rates and wheel times u are the same motion, whose extremes beyond 1.797 u are no doubles for u =
    1e308."""
    def made(u):
        return Scene(Body((12, 9, 5)), Gyrostat((0.1 * u, 0.2 * u, 0.3 * u))), np.array([1.0, 1.7, -1.7]) * u
    (scene, state), (plain, start) = made(1e308), made(1.0)
    ordinary, found = stabilab.extremes(plain, start), stabilab.extremes(scene, states=[state])[0]
    held = np.abs(ordinary) < 1.797
    assert not held.all() and held.any()
    np.testing.assert_allclose(found[held] / 1e308, ordinary[held], rtol=1e-11)
    assert np.isnan(found[~held]).all()
    one = stabilab.motion(scene, tuple(state))
    assert one.extremes is None and "an extreme" in one.because
    assert one.extremes_over == "none: beyond the range of doubles"
    assert one.period * 1e308 == pytest.approx(stabilab.period(plain, start), rel=1e-11)


@pytest.mark.parametrize("mass", [1e160, 1e-160])
def test_the_unit_of_mass_leaves_a_free_motion_as_it_is(mass):
    """Law: moments and wheel times a number give the same rates; the margin in energy goes with it."""
    def asked(u):
        return stabilab.motion(Scene(Body((12 * u, 9 * u, 5 * u)), Gyrostat((u, 2 * u, 3 * u))),
                               (1.0, 0.5, -0.75))
    found, wanted = asked(mass), asked(1.0)
    np.testing.assert_allclose(found.extremes, wanted.extremes, rtol=1e-11)
    assert (found.period,
            found.margin_energy / mass) == pytest.approx((wanted.period, wanted.margin_energy), rel=1e-11)


def test_the_distance_of_a_free_gyrostat_from_its_separatrix_is_told_as_not_known():
    scene, state = Scene(Body((12, 9, 5)), Gyrostat((1, 2, 3))), (1.0, 0.5, -0.75)
    found = stabilab.motion(scene, state)
    assert np.isnan(stabilab.fate(scene, np.array([state])).velocity_margins).all()
    assert found.margin_velocity is None and found.velocity_because.startswith("not known")
    # T = |H - lambda|^2/(2 D) is linear on the sphere |H| = h: it has no saddle
    ball = Scene(Body((2, 2, 2)), Gyrostat((1, 2, 3)))
    assert stabilab.fate(ball,
                         state).velocity_margins == np.inf and "no separatrix" in stabilab.motion(
                             ball, state).velocity_because


def test_a_free_gyrostat_on_its_separatrix_has_no_distance_from_it():
    D, lam, saddle, state = saddle_and_another()
    found = motion_of(Scene(Body(D), Gyrostat(lam)), tuple(map(float, state)), exact=state)
    assert found.fate is Fate.SEPARATRIX and found.margin_velocity == 0 and found.velocity_witness == found.at


@pytest.mark.parametrize("state", [(1.0, 2.0), (1.0, 2.0, 3.0, 4.0)])
def test_a_free_motion_needs_three_numbers(state):
    with pytest.raises(InputError, match="three numbers"):
        extremes_over_period(Scene(Body((3, 2, 1)), Gyrostat((1, 2, 3))), state)
