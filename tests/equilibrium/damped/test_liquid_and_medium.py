"""Liquid and resistance: where the rates vanish, and which of these states attract.

Independent means: SymPy's Groebner bases for completeness, finite differences of the compiled rates with
NumPy's eigenvalues for the spectra, long runs of the Taylor integrator for the verdicts.
"""
import itertools
from fractions import Fraction

import numpy as np
import pytest
import sympy as sp

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.equilibria import equilibria
from stabilab.answers.motion import motion
from stabilab.answers.simulate import trajectory
from stabilab.equilibrium.liquid import trap
from stabilab.numbers.krawczyk import zeros
from stabilab.orbit.result import Fate
from stabilab.physics.coefficients import content, rates
from stabilab.physics.effects.body_force import BodyForce
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from stabilab.physics.effects.newtonian_field import NewtonianField
from stabilab.physics.effects.resistance import Resistance
from stabilab.physics.equations import derive
from stabilab.physics.to_numpy import to_numpy

BODY = Body((9, 8, 5))
LIQUID = LiquidCavity(1250, 1000, "0.1")  # kappa = 1/8


def scene(*effects, body=BODY):
    return Scene(body, *effects)


def all_points(found):
    return [*found.points, *(p for curve in found.curves for p in curve.samples)]


def measured(system, x):
    """Eigenvalues of the Jacobian by central differences of the rates."""
    x = np.asarray(x, float)
    h = 1e-5 * max(1.0, np.abs(x).max())
    J = np.stack([(system(x + h * e) - system(x - h * e)) / (2 * h) for e in np.eye(len(x))], axis=1)
    return np.linalg.eigvals(J)


@pytest.mark.parametrize("moments", [(9, 8, 5), (5, 9, 8), (8, 5, 9)])
def test_liquid_leaves_rotation_about_the_largest_moment_alone_stable(moments):
    found = equilibria(scene(LIQUID, body=Body(moments)))
    assert len(found.curves) == 3
    for curve in found.curves:
        moving = [p for p in curve.samples if any(p.at)]
        axis = int(np.argmax(np.abs(moving[0].at)))
        assert {p.verdict for p in moving} == {"stable" if moments[axis] == 9 else "unstable"}
        assert all("asymptotically stable" in p.because for p in moving) == (moments[axis] == 9)


@pytest.mark.parametrize("moments, attracting", [((8, 8, 5), True), ((5, 5, 8), False)])
def test_plane_of_rotations_of_a_symmetric_body_attracts_iff_its_moment_is_larger(moments, attracting):
    found = equilibria(scene(LIQUID, body=Body(moments)))
    plane = next(c for c in found.curves if c.name.startswith("plane"))
    assert {s.verdict for s in plane.segments} == {"stable" if attracting else "unstable"}


WHEELS = [(Gyrostat((0, 0, "0.5")), Body(("8.7", "8.6", "11.1"))), (Gyrostat((1, 2, "0.5")), BODY),
          (Gyrostat((1, 0, 2)), BODY)]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("wheel, body", WHEELS)
def test_rotations_with_wheel_and_liquid_are_equilibria_with_the_stated_spectrum(wheel, body):
    where = scene(wheel, LIQUID, body=body)
    system = to_numpy(derive(where))
    for p in all_points(equilibria(where)):
        x = np.array(p.at)
        size = 1 + np.abs(x).max()
        assert np.abs(system(x)).max() <= 1e-14 * size**2
        if p.linear == "degenerate" or size > 50:  # far out differences of the cubic rates lose the digits
            continue
        found = measured(system, x)
        assert np.allclose(np.poly(found), np.poly(p.eigenvalues), atol=1e-7 * max(1, np.abs(found).max())**3)
        rest = np.delete(found, np.abs(found).argmin())  # one eigenvalue belongs to the curve
        if np.abs(rest.real).min() > 1e-6:
            assert (p.verdict == "unstable") == (rest.real.max() > 0)


@pytest.mark.slow
def test_motion_next_to_an_attracting_rotation_with_wheel_tends_to_a_rotation_of_its_curve():
    where = scene(Gyrostat((1, 2, "0.5")), LIQUID)
    chosen = [p for p in all_points(equilibria(where)) if p.linear == "stable"
              and 0.5 < np.abs(p.at).max() < 20][:2]
    assert chosen
    for p in chosen:
        run = trajectory(where, np.array(p.at) * 1.01 + 0.01, [3000.0])
        assert np.abs(to_numpy(derive(where))(run.states[-1])).max() < 1e-9
        assert np.abs(run.states[-1] - p.at).max() < 0.1 * np.abs(p.at).max()


def test_liquid_carries_a_motion_of_low_energy_to_the_predicted_rotation():
    state = (-1.0, 0.3, 0.2)
    told = motion(scene(LIQUID), state, (0, 10))
    assert told.fate == Fate.BOUNDED and "tends to rotation about axis 1" in told.because
    end = trajectory(scene(LIQUID), state, [20000.0]).states[-1]
    size = np.linalg.norm(np.array(BODY.inertia) * state)
    assert np.allclose(end, (-size / 9, 0, 0), atol=1e-6)
    assert f"{-size / 9:.6g}"[:6] in told.because


def test_liquid_turns_a_body_over_from_its_smallest_moment():
    state = (1e-3, 1e-3, 1.0)
    told = motion(scene(LIQUID), state)
    assert told.fate == Fate.BOUNDED and "the direction is undecided" in told.because
    end = trajectory(scene(LIQUID), state, [40000.0]).states[-1]
    assert np.abs(end[1:]).max() < 1e-3 * abs(end[0])


RESISTED = [
    (ConstantTorque((1, 3, -2)), Resistance("0.2")),
    (ConstantTorque((1, 3, -2)), Resistance("0.02")),
    (Gyrostat((1, 2, 3)), ConstantTorque((1, 3, -2)), Resistance("0.02")),
    (Gyrostat((0, 0, 3)), ConstantTorque((0, 0, -2)), Resistance("0.02")),
    (ConstantTorque((0, 3, 0)), Resistance("0.02")),
    (Gyrostat((1, "-0.5", 2)), Charge("0.3", 2, 1, 0), ConstantTorque((2, 0, 1)), Resistance("0.1")),
]


def real_solutions(equations):
    """All real zeros of the rates by a Groebner basis in the order of elimination (SymPy), to 30 digits."""
    w = equations.state
    polynomials = [sp.numer(sp.together(equations.numeric(rate))) for rate in equations.rhs]
    for order in itertools.permutations(w):
        basis = (sp.groebner(polynomials, *w, order="grevlex").fglm("lex") if order == w
                 else sp.groebner(polynomials, *order, order="lex"))
        last = order[-1]
        leading = [sp.Poly(g, *order) for g in basis.exprs]
        if all(any(sp.Poly(g, v).degree() == 1 and not sp.Poly(g, v).LC().free_symbols for g in basis.exprs)
               for v in order[:2]):
            break
    out = []
    assert leading
    for root in sp.Poly(basis.exprs[-1], last).nroots(n=40, maxsteps=500):
        if abs(sp.im(root)) > 1e-25:
            continue
        values = {last: sp.re(root)}
        for v in order[:2][::-1]:
            g = next(g for g in basis.exprs if sp.Poly(g, v).degree() == 1
                     and not sp.Poly(g, v).LC().free_symbols)
            values[v] = sp.solve(g.subs(values), v)[0]
        out.append(tuple(float(values[v]) for v in w))
    return sorted(set(out))


@pytest.mark.one_in(2)
@pytest.mark.parametrize("effects", RESISTED)
def test_resistance_has_exactly_the_equilibria_of_a_groebner_basis(effects):
    where = scene(*effects)
    found, wanted = sorted(p.at for p in equilibria(where).points), real_solutions(derive(where))
    assert len(found) == len(wanted)
    assert np.allclose(found, wanted, rtol=1e-12, atol=1e-14)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("effects", RESISTED)
def test_resisted_equilibria_attract_or_repel_as_told(effects):
    where = scene(*effects)
    system = to_numpy(derive(where))
    for p in equilibria(where).points:
        x = np.array(p.at)
        found = measured(system, x)
        assert np.allclose(np.poly(found), np.poly(p.eigenvalues), atol=1e-6 * max(1, np.abs(found).max())**3)
        assert p.verdict == ("asymptotically stable" if found.real.max() < 0 else "unstable")
        size = np.abs(x).max()
        start = x + 1e-4 * size * np.array([0.6, -0.5, 0.62])
        end = trajectory(where, start, [12 / max(np.abs(found.real).min(), abs(found.real.max()))]).states[-1]
        apart = np.abs(end - x).max()
        assert apart < 2e-5 * size if p.verdict == "asymptotically stable" else apart > 1e-3 * size


def test_all_motions_tend_to_the_equilibrium_that_is_said_to_draw_all():
    where = scene(ConstantTorque((1, "0.5", -1)), Resistance("0.5"))
    state = (30.0, -40.0, 25.0)
    told = motion(where, state, (0, 5))
    (only,) = equilibria(where).points
    assert "as every motion does" in told.because
    run = trajectory(where, state, [5.0, 80.0])
    assert np.allclose(run.states[-1], only.at, atol=1e-12)
    largest = np.linalg.norm(run.states, axis=1).max()
    assert largest <= told.invariants["rate_bound"]


def test_a_triple_equilibrium_at_the_pitchfork_attracts():
    # D = (9, 5, 4), torque on the middle axis: with c = 1/2 rotation at 3 c has a zero eigenvalue; a torque
    # above the one
    # here (15/4) has three equilibria, one below has one, so this is a supercritical pitchfork.
    where = scene(ConstantTorque((0, "15/4", 0)), Resistance("1/2"), body=Body((9, 5, 4)))
    (fold,) = equilibria(where).points
    assert fold.at == (0.0, 1.5,
                       0.0) and fold.linear == "degenerate" and fold.verdict == "asymptotically stable"
    far, later = trajectory(where, (0.3, 1.5, 0.3), [200.0, 20000.0]).states
    assert np.abs(later - fold.at).max() < 0.2 * np.abs(far - fold.at).max()
    more = scene(ConstantTorque((0, 4, 0)), Resistance("1/2"), body=Body((9, 5, 4)))
    assert [p.verdict for p in equilibria(more).points] == ["asymptotically stable", "unstable",
                                                            "asymptotically stable"]


def test_rest_draws_every_motion_where_no_torque_acts():
    for effects in ((Resistance("0.1"),), (Resistance("0.1"), LIQUID),
                    (Resistance("0.1"), Gyrostat((1, 2, 3)))):
        (rest,) = equilibria(scene(*effects)).points
        assert rest.at == (0.0, 0.0, 0.0) and rest.verdict == "asymptotically stable"
        assert motion(scene(*effects), (1, 2, 3)).fate == Fate.BOUNDED


@pytest.mark.parametrize("effects", [(ConstantTorque((0, 0, 1)), Resistance("0.05"), LIQUID),
                                     (ConstantTorque((0, "0.5", "0.1")), Resistance("0.02"),
                                      Gyrostat((0, 0, "0.1")), LIQUID)])
def test_newton_from_many_starts_finds_no_equilibrium_beyond_those_proved_with_liquid_and_torque(effects):
    where = scene(*effects)
    found = equilibria(where)
    x1, x2 = trap(content(where))
    system, points = to_numpy(derive(where)), np.array([p.at for p in found.points])
    x = np.random.default_rng(7).uniform(-1, 1, (3000, 3)) * 1.5 * x1 / np.sqrt(5)
    with np.errstate(all="ignore"):
        for _ in range(60):
            x = x - np.linalg.solve(system.jacobian(x) + 1e-300 * np.eye(3), system(x)[..., None])[..., 0]
        x = x[np.isfinite(x).all(axis=1)]
    x = x[(np.abs(system(x)).max(axis=1) < 1e-13) & (np.sqrt((x * x * BODY.inertia).sum(axis=1)) < x2)]
    assert len(x) > 100
    nearest = np.abs(x[:, None] - points[None]).max(axis=2)
    assert nearest.min(axis=1).max() < 1e-7
    assert set(nearest.argmin(axis=1)) == set(range(len(points)))  # and each proved one is found
    for p in found.points:
        assert np.allclose(np.poly(measured(system, p.at)), np.poly(p.eigenvalues), atol=1e-6)
        assert p.verdict == ("asymptotically stable" if max(z.real for z in p.eigenvalues) < 0
                             else "unstable")


@pytest.mark.slow
def test_energy_bound_with_wheel_liquid_and_torque_holds_along_a_run():
    where = scene(ConstantTorque((0, "0.5", "0.1")), Resistance("0.02"), Gyrostat((0, 0, "0.1")), LIQUID)
    state = (2.0, -1.0, 1.5)
    told = motion(where, state, (0, 50))
    assert told.fate == Fate.BOUNDED
    run = trajectory(where, state, np.linspace(1, 2000, 400))
    sizes = np.linalg.norm(run.states, axis=1)
    assert sizes.max() <= told.invariants["rate_bound"]
    assert sizes[-1] <= told.invariants["late_rate_bound"]


def test_boxes_hold_all_zeros_of_a_product():
    # (x^2 - 1, y^2 - 4, z^3 - z): twelve zeros, known by eye.
    found = zeros([{(2, 0, 0): 1, (0, 0, 0): -1}, {(0, 2, 0): 1, (0, 0, 0): -4},
                   {(0, 0, 3): 1, (0, 0, 1): -1}], (3, 3, 3))
    wanted = sorted(itertools.product((-1.0, 1.0), (-2.0, 2.0), (-1.0, 0.0, 1.0)))
    assert found.complete and np.allclose(sorted(map(tuple, found.points)), wanted, atol=1e-14)


@pytest.mark.slow
def test_boxes_say_so_where_a_double_zero_cannot_be_told_apart():
    found = zeros([{(2, 0, 0): 1}, {(0, 1, 0): 1}, {(0, 0, 1): 1}], (1, 1, 1))
    assert not found.complete


@pytest.mark.parametrize("field", [(), (Gravity(20, ("0.7", "0.3", "0.1")), NewtonianField("0.5"))],
                         ids=["alone", "in a field"])
def test_exact_rates_are_those_of_the_derived_equations(field):
    others = (Charge("0.3", 10, 1, "attitude"), *field) if field else (Charge("0.3", 2, 1, "0.4"), LIQUID)
    where = scene(Gyrostat((1, 2, 3)), ConstantTorque((1, 0, 2)), Resistance("0.1"), *others)
    omega, gamma = (0.3, -0.7, 1.1), (0.6, 0.0, 0.8) if field else ()
    exact = [v for block in rates(content(where), omega, gamma or None) for v in block or ()]
    assert np.allclose([float(v) for v in exact], to_numpy(derive(where))(np.array(omega + gamma)),
                       rtol=1e-13, atol=1e-16)
    assert field or all(isinstance(v, Fraction) for v in exact)


def test_printed_liquid_torque_takes_energy_and_its_equilibria_are_not_claimed():
    where = scene(Gyrostat((0, 0, 1)), LiquidCavity(1250, 1000, "0.1", "printed"))
    assert equilibria(where).kind == "undecided"
    told = motion(where, (1.0, 0.5, 0.2))
    assert told.fate == Fate.BOUNDED
    run = trajectory(where, (1.0, 0.5, 0.2), np.linspace(1, 200, 50))
    assert (np.diff((run.states**2 * BODY.inertia).sum(axis=1)) < 1e-12).all()


def test_torque_against_liquid_alone_is_left_undecided_with_the_reason():
    told = motion(scene(ConstantTorque((1, 0, 0)), LIQUID), (1, 0, 0), (0, 1))
    assert told.fate == Fate.UNDECIDED and "no bound is proved" in told.because
    assert told.extremes is not None and told.extremes_over == "s in [0, 1]"


def test_force_at_the_centre_of_mass_leaves_the_verdicts_as_they_are():
    body = Body((9, 8, 5), mass=10)
    pushed = motion(scene(BodyForce((0, 0, 3)), ConstantTorque((0, 3, 0)), body=body), (1, 2, 3))
    alone = motion(scene(ConstantTorque((0, 3, 0)), body=body), (1, 2, 3))
    assert pushed.fate == alone.fate and pushed.margin_energy == alone.margin_energy
    assert "as if it were absent" in pushed.because


def test_rest_is_told_where_the_list_of_equilibria_is_undecided():
    """By hand: at omega = 0 no torque acts. Its spectrum beside NumPy's of finite differences of the rates.
    """
    scene = Scene(Body((3, 2, "1.5")), Gyrostat((0, 10, 10)), LiquidCavity(1, "0.1", 10), Resistance("0.001"))
    found = equilibria(scene)
    assert found.kind == "undecided" and "nothing bounds the equilibria; rest is one" in found.because
    (rest,) = found.points
    h = 1e-6
    parts = content(scene)
    slopes = np.array([(np.array(rates(parts, tuple(h * e), None)[0], float)
                        - np.array(rates(parts, tuple(-h * e), None)[0], float)) / (2 * h)
                       for e in np.eye(3)]).T
    assert rest.at == (0, 0, 0) and rest.verdict == "asymptotically stable"
    assert np.sort(np.linalg.eigvals(slopes).real) == pytest.approx(
        np.sort([z.real for z in rest.eigenvalues]), rel=1e-4)
    from stabilab.show.text.classification import resting
    from stabilab.show.units import SI
    assert resting(found, SI) == "UNDECIDED, 1 known (1 asymptotically stable)"
