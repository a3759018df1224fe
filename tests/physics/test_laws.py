"""Laws that hold for every scene, over the whole registry of effects, by SymPy and along motions."""
from itertools import combinations

import numpy as np
import pytest
import sympy as sp

from stabilab import Body, ScaledGyrostat, Scene
from stabilab.physics.effects import REGISTRY, effect_class
from stabilab.physics.equations import derive, invariants
from stabilab.physics.to_numpy import to_numpy

ARGUMENTS = {  # what each effect is made from; an effect of one vector needs no line
    "charge": ("0.003", 100, "1.02", "0.37"), "resistance": ("0.02",), "liquid_cavity": (1250, 1000, "1.9"),
    "viscous_damper": (17, "2.5"), "damper_wheel": (17, "2.5", (2, 0, "-1.5")),
    "damper_mass": (2, (3, 0, 0), (0, 0, 1), 40, 5, 10), "rate_damper": (((3, "0.5", 0), ("0.5", 2, "-0.1"), (0, "-0.1", 1)),),
    "eddy_currents": ("0.3", 2), "newtonian_field": ("0.5",), "gravity": (2943, ("0.7", "0.3", "-0.1"))}


def vanishes(expression):
    """Whether it is zero identically; the moments less that of a sphere inside stand in denominators. With a mass that
    moves these are polynomials of its place: exact values at random rational points, which are zero by chance at none of
    three but for one in 10^9."""
    if any(str(symbol) == "xm" for symbol in expression.free_symbols):
        return not any(expression.xreplace(point(expression, n)) for n in range(3))
    expanded = sp.expand(expression)
    return expanded == 0 or sp.expand(sp.fraction(sp.together(expanded))[0]) == 0


def point(expression, seed):
    """Random rational values of all symbols."""
    draws = np.random.default_rng(seed)
    names = sorted(expression.free_symbols, key=str)
    return {s: sp.Rational(int(draws.integers(1, 1000)), int(draws.integers(1, 1000))) for s in names}


def example(name, numbers=(3, "-1/7", "2.5")):
    """An effect of the registry with some numbers in it."""
    return effect_class(name)(*ARGUMENTS.get(name, (numbers,)))


HALF, TENTH = sp.Rational(1, 2), sp.Rational(1, 10)
BODY = Body((2000, 1500, "1000.25"), 10)
RATIONAL = "damper_mass"  # its equations are long: with few others alone
POLYNOMIAL = [name for name in REGISTRY if name != RATIONAL]
SUBSETS = [names for n in range(3) for names in combinations(POLYNOMIAL, n)] + [tuple(POLYNOMIAL)]
SPRUNG = effect_class("damper_wheel")(17, "2.5", (2, 0, "-1.5"), 3)
VARIANTS = [Scene(BODY, SPRUNG), Scene(BODY, SPRUNG, example("gyrostat"))] + [Scene(BODY, effect_class("charge")("0.01", 100, "0.01", "attitude"), *map(example, others))
            for others in ((), ("gyrostat",), ("gyrostat", "liquid_cavity"))] + [
    Scene(BODY, effect_class("liquid_cavity").of_sphere(1250, 1, "0.3", "printed"), example("gyrostat"))]
SCENES = [Scene(BODY, *map(example, names)) for names in SUBSETS] + VARIANTS + [ScaledGyrostat("0.3", "-2/7", (1, -2, "0.7"))]
PAIRS = range(1 + len(POLYNOMIAL), len(SUBSETS) - 1)  # of two effects
SUBSETS += [(RATIONAL,), ("gyrostat", RATIONAL), ("gravity", RATIONAL), ("damper_wheel", RATIONAL)]
SCENES[len(SUBSETS) - 4:len(SUBSETS) - 4] = [Scene(BODY, *map(example, names)) for names in SUBSETS[-4:]]
IDS = ["+".join(names) or "free" for names in SUBSETS] + [f"variant {i}" for i in range(len(VARIANTS))] + ["scaled"]
QUADRATIC = ("gyrostat", "constant_torque")
SPECIAL = [Scene(BODY, *(effect_class(name)(v) for name in QUADRATIC)) for v in ((0, 0, 3), (2, 0, 0), (0, 1, 0), (1, 0, 2))] + [
    Scene(Body(D), *(effect_class(name)(v) for name in QUADRATIC)) for D in ((2, 2, 1), (2, 2, 2), (1, 2, 2))
    for v in ((0, 0, 3), (1, 1, 0), (1, 2, 3))] + [
    ScaledGyrostat(a, b, mu) for a, b in ((1, 2), (1, 1), (0, 0)) for mu in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, 1), (1, 0, -1))]


@pytest.mark.one_in(5)
@pytest.mark.parametrize("scene", SCENES, ids=IDS)
def test_balance_laws_hold_identically(scene):
    """Work and energy, momentum (circle, hyperbola when scaled): in all states and parameters."""
    equations = derive(scene)
    assert len(equations.balances) >= 2
    for law in equations.balances:
        assert vanishes(equations.derivative(law.quantity) - law.rate), law.name


@pytest.mark.one_in(5)
@pytest.mark.parametrize("scene", SCENES, ids=IDS)
def test_flow_preserves_volume_but_for_effects_that_say_otherwise(scene):
    trace = derive(scene).jacobian.trace()
    assert vanishes(trace) == all(effect.keeps_volume for effect in scene.effects)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("scene", SCENES, ids=IDS)
def test_parts_of_the_torque_add_up(scene):
    equations = derive(scene)
    for i in range(3):
        assert vanishes(equations.inertia[i] * equations.rhs[i] - sum(t[i] for t in equations.torques.values()))


@pytest.mark.parametrize("name", REGISTRY)
def test_effects_that_promise_no_work_do_none(name):
    equations = derive(Scene(BODY, example(name)))
    power = sp.expand(sum(w * t for w, t in zip(equations.state[:3], equations.torques[name])))
    assert (power == 0) or effect_class(name).works
    assert power != 0 or not effect_class(name).works  # the promise is given where it can be


@pytest.mark.one_in(5)
@pytest.mark.parametrize("scene", SPECIAL + SCENES)
def test_every_stated_invariant_is_one(scene):
    """Identically in the state, this scene's numbers put in; turn angles differentiate to the rates they integrate."""
    equations = derive(scene)
    for law in invariants(scene):
        assert vanishes(equations.numeric(equations.derivative(law.quantity)) - equations.numeric(law.rate)), law.because


def test_scaled_work_and_energy_is_the_combination_of_its_two_laws():
    equations = derive(SCENES[-1])
    circle, hyperbola, energy = equations.balances
    a, b = equations.symbols["a"], equations.symbols["b"]
    assert sp.expand((b * circle.rate - a * hyperbola.rate) / 2 - energy.rate) == 0
    assert not sp.expand((b * circle.quantity - a * hyperbola.quantity) / 2 - energy.quantity).free_symbols & set(equations.state)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("scene", [pytest.param(scene, marks=pytest.mark.slow if n in PAIRS else ()) for n, scene in enumerate(SCENES)], ids=IDS)
def test_compiled_law_rates_are_gradients_along_the_motion(scene):
    """Complex step of the compiled quantity along the compiled rates."""
    system = to_numpy(derive(scene))
    x = np.random.default_rng(8).normal(size=(6, len(system.equations.state)))
    moved = system.invariants(x + 1e-200j * system(x))
    for (name, rate), sizes in zip(system.law_rates(x).items(), system.laws(x)[1]):
        rounding = 1e-14 * sizes.max() * np.abs(system(x)).max()
        assert moved[name].imag / 1e-200 == pytest.approx(rate, abs=rounding)


def rates_of(*effects, name):
    laws = {law.name: law for law in derive(Scene(BODY, *effects)).balances}
    return sp.expand(laws[name].rate)


@pytest.mark.parametrize("name", ["energy", "area", "gamma"])
def test_newtonian_field_and_gravity_keep_energy_area_and_gamma(name):
    assert rates_of(example("newtonian_field"), example("gravity"), example("gyrostat"), name=name) == 0


@pytest.mark.parametrize("effects", [("charge",), ("gyrostat",), ("charge", "gyrostat")])
def test_charge_and_gyrostat_keep_the_energy(effects):
    assert rates_of(*map(example, effects), name="energy") == 0


def test_liquid_alone_keeps_the_momentum_and_never_raises_the_energy():
    """T' = -kappa/(D1 D2 D3) sum (Di - Dj)^2 (Di + Dj - Dk) wi^2 wj^2, not positive by the triangle inequality (theory)."""
    equations = derive(Scene(BODY, example("liquid_cavity")))
    laws = {law.name: law.rate for law in equations.balances}
    assert sp.expand(laws["momentum"]) == 0
    D, w, kappa = sp.symbols("D1:4", positive=True), equations.state, equations.symbols["kappa"]
    fall = sum((D[i] - D[j]) ** 2 * (D[i] + D[j] - D[k]) * w[i] ** 2 * w[j] ** 2 for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
    assert sp.expand(laws["energy"] + kappa * fall / (D[0] * D[1] * D[2])) == 0


def test_a_damper_alone_keeps_the_momentum_and_takes_energy_by_its_friction():
    """T' = -c |sigma|^2 and |H|^2 is constant, H = D omega + k sigma."""
    equations = derive(Scene(BODY, example("viscous_damper")))
    laws = {law.name: law for law in equations.balances}
    D, w, sigma = sp.symbols("D1:4", positive=True), equations.state[:3], equations.state[3:]
    k, c = (equations.symbols[name] for name in ("kd", "cd"))
    assert sp.expand(laws["energy"].rate + c * sum(s**2 for s in sigma)) == 0 and laws["momentum"].rate == 0
    H = [d * x + k * s for d, x, s in zip(D, w, sigma)]
    assert sp.expand(laws["momentum"].quantity - sum(h**2 for h in H) / 2) == 0


def test_a_linear_damper_takes_rayleighs_function_twice():
    """T' = -2 F, F = omega . C omega/2, whose slope is the torque against the motion."""
    equations = derive(Scene(BODY, example("rate_damper")))
    w, C = equations.state, sp.Matrix([[3, HALF, 0], [HALF, 2, -TENTH], [0, -TENTH, 1]])
    F = (sp.Matrix(w).T * C * sp.Matrix(w))[0] / 2
    laws = {law.name: equations.numeric(law.rate) for law in equations.balances}
    assert sp.expand(laws["energy"] + 2 * F) == 0
    assert all(sp.expand(equations.numeric(t) + F.diff(x)) == 0
               for t, x in zip(equations.torques["rate_damper"], w))


def test_eddy_currents_damp_what_crosses_the_field_and_keep_the_momentum_along_it():
    """T' = -k |omega x B|^2 and (H . gamma)' = 0, from Lorentz forces on the currents of a thin shell: E' = E + (omega
    x r) x B drives K = s d E', and the torque is the integral of r x (K x B); k = 2 pi s d r^4/3 (Youngquist et al.
    2016), here integrated over the sphere."""
    equations = derive(Scene(BODY, example("eddy_currents")))
    w, g, k = sp.Matrix(equations.state[:3]), sp.Matrix(equations.state[3:]), equations.symbols["kB2"]
    laws = {law.name: law.rate for law in equations.balances}
    assert sp.expand(laws["energy"] + k * w.cross(g).dot(w.cross(g))) == 0 and laws["area"] == 0
    # seen from the body the field changes at B' = -omega x B; its electric field on the shell is -B' x r/2, which
    # is along the shell, so that no charge gathers
    u, v = sp.symbols("u v", real=True)
    r = sp.Matrix([sp.sin(u) * sp.cos(v), sp.sin(u) * sp.sin(v), sp.cos(u)])
    current = w.cross(g).cross(r) / 2
    density = r.cross(current.cross(g)) * sp.sin(u)
    torque = density.applyfunc(lambda f: sp.integrate(sp.expand(f), (u, 0, sp.pi), (v, 0, 2 * sp.pi)))
    ours = sp.Matrix(equations.torques["eddy_currents"]).subs(k, 2 * sp.pi / 3)
    assert (torque - ours).expand() == sp.zeros(3, 1)


def test_a_damper_turns_as_body_and_sphere_apart_do():
    """Kane's two bodies: (D - k) omega' = ((D - k) omega) x omega + c (w_s - omega), k (w_s' + omega x w_s) =
    -c (w_s - omega), w_s = omega + sigma: written here for the absolute rate of the sphere."""
    equations = derive(Scene(BODY, example("viscous_damper")))
    w, sigma = sp.Matrix(equations.state[:3]), sp.Matrix(equations.state[3:])
    k, c = (equations.symbols[name] for name in ("kd", "cd"))
    A, ball = sp.diag(*(d - k for d in sp.symbols("D1:4", positive=True))), w + sigma
    change, relative = sp.Matrix(equations.rhs[:3]), sp.Matrix(equations.rhs[3:])
    assert sp.simplify(A * change - (A * w).cross(w) - c * sigma) == sp.zeros(3, 1)
    assert sp.simplify(k * (change + relative + w.cross(ball)) + c * sigma) == sp.zeros(3, 1)


def test_printed_and_consistent_liquid_differ_only_where_a_rotor_or_a_charge_is():
    cavity = effect_class("liquid_cavity")
    def torque(law, *others):
        return derive(Scene(BODY, cavity(1250, 1000, "1.9", law), *others)).torques["liquid_cavity"]
    free = [sp.expand(a - b) for a, b in zip(torque("consistent"), torque("printed"))]
    with_rotor = [sp.expand(a - b) for a, b in zip(torque("consistent", example("gyrostat")), torque("printed", example("gyrostat")))]
    assert free == [0, 0, 0] and any(with_rotor)


def test_the_printed_liquid_torque_is_equation_3_of_the_paper():
    """First component of Galal et al. (3), typed in from print."""
    equations = derive(Scene(BODY, effect_class("liquid_cavity")(1250, 1000, "1.9", "printed")))
    D1, D2, D3 = sp.symbols("D1:4", positive=True)
    p, q, r = equations.state
    printed = equations.symbols["kappa"] * p / (D1 * D2 * D3) * (
        D3 * (D1 - D3) * (D1 + D3 - D2) * r**2 + D2 * (D1 - D2) * (D1 + D2 - D3) * q**2)
    assert sp.expand(equations.torques["liquid_cavity"][0] - printed) == 0


def test_a_body_force_moves_the_body_by_newtons_law_and_does_not_turn_it():
    """m |v'| = |f| in every attitude of a unit quaternion; the rotation is orthogonal."""
    equations = derive(Scene(BODY, example("body_force")))
    assert equations.torques["body_force"] == (0, 0, 0) and equations.blocks == ("omega", "attitude", "velocity", "position")
    q, f = sp.symbols("q0:4", real=True), [equations.symbols[n] for n in ("f1", "f2", "f3")]
    size = sum(a**2 for a in equations.rhs[7:10]) * equations.symbols["mass"] ** 2
    assert sp.expand(size - sum(a**2 for a in q) ** 2 * sum(a**2 for a in f)) == 0
