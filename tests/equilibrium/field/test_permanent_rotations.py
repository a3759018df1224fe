"""Permanent rotations of a body in a field: all of them, their spectrum, and what energy and spectrum decide.

Independent means: Groebner bases of the balance in gamma (SymPy), central differences of the compiled rates
with NumPy's eigenvalues, second differences of the amended potential, classical criteria, long runs.
"""
from fractions import Fraction

import numpy as np
import pytest
import sympy as sp

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.equilibria import equilibria
from stabilab.answers.motion import motion
from stabilab.answers.simulate import trajectory
from stabilab.equilibrium.field_balance import Field, rotations_at
from stabilab.errors import InputError
from stabilab.numbers.balls import MANY_BITS, working
from stabilab.orbit.result import Fate
from stabilab.physics.coefficients import content
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from stabilab.physics.effects.newtonian_field import NewtonianField
from stabilab.physics.effects.resistance import Resistance
from stabilab.physics.equations import derive
from stabilab.physics.to_numpy import to_numpy
from stabilab.show.text import classification
from tests.equilibrium.damped.test_liquid_and_medium import measured
from tests.shared import case

WHEEL, WEIGHT, CENTRE = Gyrostat((1, 0, 2)), Gravity(20, ("0.7", "0.3", "0.1")), NewtonianField("0.5")
CHARGE = Charge("0.3", 10, 1, "attitude")
SCENES = {
    "paper": Scene(Body((5, "5.1", 7)), WHEEL, WEIGHT, CENTRE),
    "charged": Scene(Body((5, "5.1", 7)), WHEEL, WEIGHT, CENTRE, CHARGE),
    "weight on an axis": Scene(Body((5, 6, 7)), Gravity(20, (0, 0, "0.1")), Gyrostat((0, 0, 1))),
    "field alone": Scene(Body((5, 6, 7)), NewtonianField(3)),
    "symmetric": Scene(Body((5, 5, 7)), Gyrostat((0, 0, 2)), Gravity(20, (0, 0, "-0.1")), CENTRE),
    "constant charge": Scene(Body((5, 6, 7)), Charge("0.3", 10, 1, "0.4"), Gravity(20, ("0.1", 0, "-0.1"))),
}
TURNING = "torque along an axis"
FOUND = {}


def scene_of(name):
    if name != TURNING:
        return SCENES[name]
    attitude = case("charged-body-attitude").scene
    return Scene(attitude.body, *(e for e in attitude.effects if e.name != "body_force"))


def found(name):
    if name not in FOUND:
        FOUND[name] = equilibria(scene_of(name))
    return FOUND[name]


def samples(name):
    return [p for curve in found(name).curves for p in curve.samples]


def of_gamma(p):
    """(Omega, gamma) of an equilibrium (omega, gamma)."""
    gamma = np.array(p.at[3:])
    return float(np.dot(p.at[:3], gamma)), gamma


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", [*SCENES, TURNING])
def test_permanent_rotations_rest_and_have_the_stated_spectrum(name):
    system = to_numpy(derive(scene_of(name)))
    nearer = [p for p in samples(name) if np.abs(p.at).max() <= 1e3 or name != TURNING]
    assert len(nearer) > 5
    for p in nearer:
        x = np.array(p.at)
        size = 1 + np.abs(x).max()
        assert np.abs(system(x)).max() <= (1e-13 if name == TURNING else 1e-14) * size**2
        assert abs(np.linalg.norm(x[3:]) - 1) < 1e-15 * 4
        if size < 50:  # farther out differences lose the small coefficients
            found = np.poly(measured(system, x))
            scale = (1 + max(map(abs, p.eigenvalues))) ** np.arange(7)
            assert np.abs((found - np.poly(p.eigenvalues)) / scale).max() < 1e-8


@pytest.mark.parametrize("name, words", [("paper", "outside it"), ("weight on an axis", "outside it"),
                                         (TURNING, "at an end")])
def test_a_curve_has_no_point_beyond_its_ends(name, words):
    refused = 0
    for curve in found(name).curves:
        low, high = curve.segments[0].t[0], curve.segments[-1].t[1]
        for end, way in ((low, -1), (high, 1)):
            for beyond in ((end,) if words == "at an end" else ()) + (end + way * (1 + abs(end)),):
                if np.isfinite(end):
                    with pytest.raises(InputError, match="outside|at an end"):
                        curve.point(beyond)
                    refused += 1
    assert refused


def by_groebner(scene, Omega):
    """Number of real gamma with (S gamma + b) x gamma = 0, |gamma| = 1 by a Groebner basis of the derived
    rates."""
    equations = derive(scene)
    g = equations.state[3:]
    omega = dict(zip(equations.state[:3], (sp.Rational(Omega.numerator, Omega.denominator) * x for x in g)))
    parts = [sp.numer(sp.together(equations.numeric(r).subs(omega))) for r in equations.rhs[:3]]
    # a linear form of gamma takes different values at different solutions, so its polynomial counts them
    u = sp.Symbol("u")
    basis = sp.groebner([*parts, sum(x**2 for x in g) - 1, u - 3 * g[0] - 5 * g[1] - 11 * g[2]], *g, u,
                        order="grevlex").fglm("lex")
    last = sp.Poly(next(e for e in basis.exprs if e.free_symbols == {u}), u)
    return sum(1 for _ in set(sp.real_roots(last)))


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name, values", [("paper", ("-12", "1/2", "24")), ("charged", ("-3", "7")),
                                          ("weight on an axis", ("-2", "1/3", "3")),
                                          ("constant charge", ("-2", "1"))])
def test_each_rate_has_exactly_the_rotations_of_a_groebner_basis(name, values):
    field = Field.of(content(SCENES[name]))
    for value in map(Fraction, values):
        with working(MANY_BITS):
            count = len(rotations_at(field, value))
        assert count == by_groebner(SCENES[name], value)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", SCENES)
def test_branches_hold_every_rotation_of_every_rate(name):
    field = Field.of(content(SCENES[name]))
    curves = [c for c in found(name).curves if c.name.startswith("branch")]
    for value in np.random.default_rng(5).normal(0, 4, 25):
        with working(MANY_BITS):
            wanted = sorted(tuple(float(g.mid()) for g in r.gamma)
                            for r in rotations_at(field, Fraction(value)))
        got = sorted(c.point(value)[3:] for c in curves if c.segments[0].t[0] < value < c.segments[-1].t[1])
        assert len(got) == len(wanted) and np.allclose(got, wanted, atol=1e-12)


def amended(scene, A, gamma):
    """Potential energy on |gamma| = 1 at constant area integral A, for gyrostat, weight, Newtonian field and
    charge."""
    parts = content(scene)
    D, lam, s = (np.array([float(v) for v in row]) for row in (parts.D, parts.Lambda, parts.s))
    gamma = gamma / np.linalg.norm(gamma)
    share = lam @ gamma - float(parts.E) * gamma[2]**2 / 2
    return -s @ gamma + float(parts.N) * (D * gamma) @ gamma / 2 + (A - share)**2 / (2 * (D * gamma) @ gamma)


@pytest.mark.parametrize("name", ["paper", "charged", "weight on an axis", "constant charge"])
def test_energy_decides_as_second_differences_of_the_amended_potential_do(name):
    parts, seen = content(SCENES[name]), set()
    D, lam = (np.array([float(v) for v in row]) for row in (parts.D, parts.Lambda))
    for p in samples(name):
        Omega, gamma = of_gamma(p)
        if abs(Omega) > 30 or p.linear == "degenerate":
            continue
        A = Omega * (D * gamma) @ gamma + lam @ gamma - float(parts.E) * gamma[2]**2 / 2
        u = np.linalg.svd(gamma[None])[2][1:]  # tangent plane
        h = 1e-4
        value = lambda a, b: amended(SCENES[name], A, gamma + h * (a * u[0] + b * u[1]))
        K = np.array([[value(1, 0) - 2 * value(0, 0) + value(-1, 0),
                       (value(1, 1) - value(1, -1) - value(-1, 1) + value(-1, -1)) / 4],
                      [0, value(0, 1) - 2 * value(0, 0) + value(0, -1)]]) / h**2
        K[1, 0] = K[0, 1]
        low, high = np.linalg.eigvalsh(K)
        if min(abs(low), abs(high)) < 1e-3 * max(1, Omega**2):
            continue
        kind = "minimum" if low > 0 else "saddle" if high > 0 else "maximum"
        seen.add(kind)
        assert (p.verdict == "stable") == (kind == "minimum")
        if kind == "saddle":
            assert p.verdict == "unstable" and max(z.real for z in p.eigenvalues) > 0
    assert seen == {"minimum", "saddle", "maximum"}


def excursion(scene, x, size, end):
    """Largest departure from x of the motion that starts `size` away, in units of `size`."""
    run = trajectory(scene, x + size * np.array([0.3, -0.5, 0.4, 0, 0, 0]),
                     np.linspace(1 / 300, 1, 300) * end)
    return np.abs(run.states - x).max() / size


@pytest.mark.parametrize("name", ["paper", "charged"])
def test_motions_stay_by_stable_rotations_in_proportion_and_leave_unstable_ones(name):
    # Next to a change of verdict the well is shallow, so a stable rotation is judged by ever smaller
    # departures: the
    # excursion shrinks in proportion. An unstable one is left however small the departure.
    stay = leave = 0
    for p in samples(name):
        fastest, x = max(z.real for z in p.eigenvalues), np.array(p.at)
        if np.abs(x).max() > 10:
            continue
        if p.verdict == "stable":
            stay += 1
            coarse, fine = (excursion(SCENES[name], x, size, 300) for size in (1e-8, 1e-10))
            assert fine < 3000 and abs(coarse / fine - 1) < 0.2
        elif p.verdict == "unstable" and fastest > 0.05 and leave < 6:
            leave += 1
            assert excursion(SCENES[name], x, 1e-10, 35 / fastest) > 1e7
    assert stay >= 8 and leave == 6


def test_changes_of_verdict_lie_where_an_eigenvalue_passes_zero_or_two_meet():
    system = to_numpy(derive(SCENES["paper"]))
    changes = [fold for c in found("paper").curves for fold in c.folds]
    assert len(changes) > 5
    for fold in changes:
        c = np.poly(system.jacobian(np.array(fold)).astype(float))
        a, b = c[2], c[4]
        scale = 1 + abs(a)
        assert min(abs(b) / scale**2, abs(a * a - 4 * b) / scale**2) < 1e-9


@pytest.mark.parametrize("spin", [0, 3])
def test_sleeping_top_is_stable_from_the_classical_rate_on(spin):
    # Routh and Lagrange: upright iff (C Omega + lambda)^2 > 4 A M g l; gamma along +e3 hangs, so upright is
    # -e3 here.
    A, C, weight = 5, 7, 2
    top = Scene(Body((A, A, C)), Gyrostat((0, 0, spin)), Gravity(20, (0, 0, "0.1")))
    edges = {edge for c in equilibria(top).curves for s in c.segments if s.because.startswith("sleeping")
             for edge in s.t}
    for sign in (1, -1):
        critical = (sign * np.sqrt(4 * A * weight) - spin) / C
        assert min(abs(edge + critical) for edge in edges) < 1e-12  # omega = Omega gamma = -Omega e3
    upright = [p for c in equilibria(top).curves for p in c.samples if p.at[5] < -0.999]
    for p in upright:
        rate = p.at[2]
        margin = (C * rate + spin)**2 - 4 * A * weight
        if abs(margin) > 1e-6:
            assert p.verdict == ("stable" if margin > 0 else "unstable")


def test_body_in_a_newtonian_field_rests_with_its_least_moment_along_the_line():
    # The potential energy N gamma . D gamma/2 is least there.
    at_rest = [p for p in samples("field alone") if not any(p.at[:3])]
    assert len(at_rest) == 6
    for p in at_rest:
        assert (p.verdict == "stable") == (abs(p.at[3]) == 1)


def test_field_alone_leaves_every_direction_free_at_one_rate():
    spheres = [c for c in found("field alone").curves if c.name.startswith("sphere")]
    assert len(spheres) == 2
    system = to_numpy(derive(SCENES["field alone"]))
    for c in spheres:
        assert np.abs(system(np.array(c.point(0.7)))).max() < 1e-14
        assert abs(abs(of_gamma(c.samples[0])[0]) - np.sqrt(3)) < 1e-14
    tilted = np.sqrt(3) * np.array([0.6, 0.48, 0.64])  # the known fact itself, off the axes
    assert np.abs(system(np.r_[tilted, 0.6, 0.48, 0.64])).max() < 1e-14


def test_rotations_on_the_circle_of_a_symmetric_top_drift_away():
    circles = [c for c in found("symmetric").curves if "circle" in c.name]
    assert circles and all(s.verdict == "unstable" for c in circles for s in c.segments)
    p = circles[0].samples[1]
    start = np.array(p.at) + np.array([0, 0, 1e-4, 0, 0, 0])
    run = trajectory(SCENES["symmetric"], start, np.linspace(10, 40000, 200))
    assert np.abs(run.states - p.at).max() > 0.1


def test_energy_and_unit_length_bound_the_rates_along_a_run():
    state = (1.0, -2.0, 3.0, 0.6, 0.0, 0.8)
    told = motion(SCENES["paper"], state, (0, 20))
    assert told.fate == Fate.BOUNDED and told.at == state
    run = trajectory(SCENES["paper"], state, np.linspace(0.5, 400, 800))
    assert np.linalg.norm(run.states[:, :3], axis=1).max() <= told.invariants["rate_bound"]
    inside = trajectory(SCENES["paper"], state, np.linspace(0.01, 20, 4000)).states[:, :3]
    low, high = np.array(told.extremes).T
    assert (inside.min(axis=0) >= low - 1e-12).all() and (inside.max(axis=0) <= high + 1e-12).all()
    assert np.abs(inside.min(axis=0) - low).max() < 1e-3 and told.extremes_over == "s in [0, 20]"


def test_state_may_be_given_by_blocks_and_an_equilibrium_is_told():
    told = motion(SCENES["weight on an axis"], {"omega": (0, 0, 2.5), "gamma": (0, 0, 1)})
    assert told.fate == Fate.EQUILIBRIUM
    with pytest.raises(stabilab.errors.InputError, match="gamma"):
        motion(SCENES["weight on an axis"], (0, 0, 2.5))


def test_resistance_leaves_rest_positions_and_the_lowest_attracts():
    scene = Scene(Body((5, 6, 7)), WEIGHT, CENTRE, Resistance("0.5"), WHEEL)
    rest = equilibria(scene)
    assert rest.kind == "points" and all(not any(p.at[:3]) for p in rest.points)
    system = to_numpy(derive(scene))
    for p in rest.points:
        assert np.abs(system(np.array(p.at))).max() < 1e-14
        found = measured(system, p.at)
        away = np.delete(found, np.abs(found).argmin())  # |gamma| is kept
        assert (p.verdict == "asymptotically stable") == (away.real.max() < 0)
    lowest = [p for p in rest.points if p.verdict == "asymptotically stable"]
    assert len(lowest) == 1
    state = (2.0, 1.0, -1.0, 0.0, 0.6, 0.8)
    told = motion(scene, state)
    assert told.fate == Fate.BOUNDED and "tends to rest" in told.because
    assert np.allclose(trajectory(scene, state, [400.0]).states[-1], lowest[0].at, atol=1e-8)


def test_upright_pendulum_with_resistance_is_unstable_and_a_circle_of_directions_is_found():
    scene = Scene(Body((5, 5, 7)), NewtonianField(2), Resistance("0.5"))
    rest = equilibria(scene)
    (circle,) = rest.curves
    assert circle.segments[0].verdict == "stable"  # least moment, any direction across axis 3
    assert [p.verdict for p in rest.points] == ["unstable", "unstable"]
    assert np.allclose(np.linalg.norm(circle.point(1.0)[3:]), 1)


def test_steady_states_of_a_torque_are_all_that_newton_finds():
    scene = Scene(Body((5, 6, 7)), Gyrostat((0, 0, 1)), Gravity(2, (0, 0, 1)), CHARGE,
                  ConstantTorque((2, 0, 0)))
    curves = equilibria(scene).curves
    assert curves
    rng, hits = np.random.default_rng(3), 0
    # (Omega, gamma) with gamma1 = 0, from random starts: every zero lies on a curve at its angle
    for _ in range(60):
        t, Omega = rng.uniform(-np.pi, np.pi), rng.normal(0, 5)
        c, s = np.cos(t), np.sin(t)
        system = to_numpy(derive(scene))
        rate = lambda O: system(np.array([0, O * c, O * s, 0, c, s]))[0]
        for _ in range(60):
            h = 1e-6 * (1 + abs(Omega))
            Omega -= rate(Omega) * 2 * h / (rate(Omega + h) - rate(Omega - h))
        if not np.isfinite(Omega) or abs(rate(Omega)) > 1e-10:
            continue
        at = [curve.point(t)[1:3] for curve in curves
                  if curve.segments[0].t[0] < t < curve.segments[-1].t[1]]
        hits += 1
        assert min(np.abs(np.array(p) - (Omega * c, Omega * s)).max() for p in at) < 1e-7
    assert hits > 15


@pytest.mark.parametrize("effects",
                         [(WEIGHT, ConstantTorque((1, 2, 0))), (WEIGHT, LiquidCavity(1250, 1000, "0.1")),
                                     (WEIGHT, ConstantTorque((1, 0, 0)), Resistance("0.1"))])
def test_what_has_no_closed_form_is_undecided_with_a_reason(effects):
    rest = equilibria(Scene(Body((5, 6, 7)), *effects))
    assert rest.kind == "undecided" and rest.because.startswith("undecided: ")
    assert classification.undecided(rest, None)


def test_torque_in_a_field_with_resistance_is_bounded_by_its_own_number():
    scene = Scene(Body((5, 6, 7)), WEIGHT, ConstantTorque((3, 0, 0)), Resistance("0.1"))
    state = (1.0, 2.0, 3.0, 0.0, 0.0, 1.0)
    told = motion(scene, state)
    assert told.fate == Fate.BOUNDED
    run = trajectory(scene, state, np.linspace(1, 500, 500))
    assert np.linalg.norm(run.states[:, :3], axis=1).max() <= told.invariants["rate_bound"]


@pytest.mark.parametrize("wheel", [1, 30])
def test_a_sphere_with_its_weight_along_the_wheel_sleeps_upside_down_but_for_slow_spins(wheel):
    """Lagrange's sleeping top: (Lambda - D Omega)^2 > 4 D M g z with gamma = -e3."""
    curves = equilibria(Scene(Body((3, 3, 3)), Gravity(20, (0, 0, "0.1")), Gyrostat((0, 0, wheel)))).curves
    (upright,) = [c for c in curves if c.point(0.0)[5] == -1]
    (unstable,) = [s.t for s in upright.segments if s.verdict == "unstable"]
    np.testing.assert_allclose(unstable, [(wheel - 24**0.5) / 3, (wheel + 24**0.5) / 3], rtol=1e-14)
    assert {s.verdict for s in upright.segments if s.t != unstable} == {"stable"}


@pytest.mark.parametrize("e2, e3, e4", [(5, 0, 4), (5, 0, 6.25), (2, 0, 3), (1, 0, -1), (-5, 0, 4),
                                        (-2, 0, 1), (3, 0, 0), (5, 1, 4),
                                        (5, -1, 4), (0, 0, 0)])
def test_steady_states_of_a_torque_are_told_by_their_quartic(e2, e3, e4):
    from flint import arb

    from stabilab.equilibrium.steady_states import _verdict
    roots = np.roots([1, 0, e2, -e3, e4])
    simple = min(abs(a - b) for n, a in enumerate(roots) for b in roots[:n]) > 1e-3
    word = "unstable" if roots.real.max() > 1e-3 else "stable" if simple else "degenerate"
    assert _verdict(arb(e2), arb(e3), arb(e4))[0] == word


@pytest.mark.parametrize("name, text, charged", [
    ("paper", "gamma_i = (Omega Lambda_i + s_i)/(mu - (Omega^2 - N) D_i), mu by |gamma| = 1", 0),
    ("charged", "gamma_i = (Omega Lambda_i + s_i)/(mu - (Omega^2 - N) D_i), for i = 3 with + Omega E below the line, "
     "mu by |gamma| = 1", 1)])
def test_the_formula_of_a_branch_gives_its_samples_none_far_beyond_what_happens(name, text, charged):
    """The formula as it is printed, mu from gamma_1; 10 times the largest rate at which a branch begins, ends or
    changes, or the verdict does, as the code says."""
    parts, curves = content(SCENES[name]), [c for c in found(name).curves if c.name.startswith("branch")]
    D, lam, s = (np.array([float(v) for v in row]) for row in (parts.D, parts.Lambda, parts.s))
    ends = [abs(t) for c in curves for piece in c.segments for t in piece.t if np.isfinite(t)]
    for curve in curves:
        assert text in curve.parametrisation
        for p in curve.samples:
            Omega, gamma = of_gamma(p)
            below = -(Omega**2 - float(parts.N)) * D + charged * np.array([0, 0, Omega * float(parts.E)])
            mu = (Omega * lam[0] + s[0]) / gamma[0] - below[0]
            assert (Omega * lam + s) / (mu + below) == pytest.approx(gamma, rel=1e-6, abs=1e-9)
            assert abs(Omega) <= 10 * max(ends) * (1 + 1e-12)
