"""The derived equations and the gate to numbers."""
import copy
import pickle
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest
import sympy as sp

from stabilab import Body, ConstantTorque, DamperMass, Gyrostat, ScaledGyrostat, Scene
from stabilab.errors import InputError
from stabilab.physics.effects.body_force import BodyForce
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from stabilab.physics.effects.resistance import Resistance
from stabilab.physics.equations import _varies, derive, invariants
from stabilab.physics.to_numpy import extent, form, to_numpy
from stabilab.show.text.scene import latex, lines

BODY = Body((2000, "1500.5", 1000))
WHEEL, THRUST = Gyrostat((100, "2/3", 0)), ConstantTorque((1, -2, "204.1"))
SCENES = [Scene(BODY), Scene(BODY, WHEEL), Scene(BODY, THRUST), Scene(BODY, WHEEL, THRUST),
          Scene(BODY, THRUST, WHEEL), ScaledGyrostat("0.2", "0.4", (1, -2, "1/3")),
          ScaledGyrostat(0, 0, (0, 0, 1))]


def exact_states(count=4):
    rng = np.random.default_rng(0)
    return [[Fraction(int(v), 7) for v in rng.integers(-40, 40, 3)] for _ in range(count)]


def at(equations, expression, x):
    return equations.numeric(expression).subs(dict(zip(equations.state,
                                                       [sp.Rational(v.numerator, v.denominator) for v in x])))


@pytest.mark.parametrize("scene", SCENES)
def test_closed_forms_are_the_derived_equations_exactly(scene):
    """QuadraticForm, written by hand for the analyses, against the one derivation; rational arithmetic on
    both sides."""
    equations, quadratic = derive(scene), scene.quadratic()
    for x in exact_states():
        rows = quadratic.rate(x), quadratic.jacobian(x)
        assert [at(equations, r, x)
                for r in equations.rhs] == [sp.Rational(v.numerator, v.denominator) for v in rows[0]]
        derived = equations.jacobian.applyfunc(lambda e: at(equations, e, x))
        assert [[sp.Rational(Fraction(v).numerator, Fraction(v).denominator) for v in row]
                for row in rows[1]] == derived.tolist()


def test_parameters_keep_the_order_of_declaration():
    assert list(derive(Scene(BODY, THRUST, WHEEL)).parameters) == [
        "D1", "D2", "D3", "M1", "M2", "M3", "lambda1", "lambda2"]
    assert derive(SCENES[5]).parameters["mu3"] == Fraction(1, 3)


@pytest.mark.parametrize("effects, absent",
                         [((), {"lambda1", "M1"}), ((WHEEL,), {"M1", "M2", "M3"}), ((THRUST,), {"lambda1"})])
def test_unnamed_effects_leave_no_symbol_state_or_torque(effects, absent):
    equations = derive(Scene(BODY, *effects))
    names = {str(s) for r in equations.rhs for s in r.free_symbols} | set(equations.parameters)
    assert not names & absent
    assert len(equations.state) == 3 and list(equations.torques) == ["inertia", *(e.name for e in effects)]


LIQUID = (LiquidCavity(1000, 1, "0.001"), Resistance("0.01"), Charge("0.1", 1, 1, "0.3"))
ZEROS = [  # effects with components that are zero, the same with none, the symbols that must not be there
    ((Gyrostat((0, 0, 1)),), (Gyrostat((1, 1, 1)),), {"lambda1", "lambda2"}),
    ((ConstantTorque((0, 2, 0)), WHEEL), (ConstantTorque((1, 2, 1)), Gyrostat((100, "2/3", 1))),
     {"M1", "M3", "lambda3"}),
    ((Gravity(3, (0, 0, 1)), Gyrostat((1, 0, 0))), (Gravity(3, (1, 1, 1)), Gyrostat((1, 1, 1))),
     {"Mgx", "Mgy", "lambda2", "lambda3"}),
    ((BodyForce((0, 0, 3)),), (BodyForce((1, 1, 3)),), {"f1", "f2"}),
    ((Gyrostat((0, 0, 1)), ConstantTorque((0, 0, -1)), *LIQUID),
     (Gyrostat((1, 1, 1)), ConstantTorque((1, 1, -1)), *LIQUID),
     {"lambda1", "lambda2", "M1", "M2"})]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("effects, full, absent", ZEROS)
def test_zero_components_leave_no_symbol_and_the_same_equations(effects, full, absent):
    few, many = (derive(Scene(Body(BODY.inertia, 10), *chosen)) for chosen in (effects, full))
    rows = (*few.rhs, *few.jacobian, *(v for law in few.balances for v in (law.quantity, law.rate)))
    assert not ({str(s) for r in rows for s in sp.sympify(r).free_symbols} | set(few.parameters)
                | set(few.symbols)) & absent
    swap = {many.symbols[name]: 0 for name in absent}  # the equations with every symbol, those put to zero
    assert all(sp.expand(one - two.subs(swap)) == 0 for one, two in zip(few.rhs, many.rhs))
    assert sum(map(sp.count_ops, few.rhs)) < sum(map(sp.count_ops, many.rhs))


def test_zero_numbers_of_a_scaled_system_leave_no_symbol():
    equations = derive(ScaledGyrostat(0, "1/2", (0, 0, 1)))
    assert list(equations.parameters) == ["b", "mu3"]
    assert {str(s) for r in equations.rhs for s in r.free_symbols} == {"x1", "x2", "x3", "b", "mu3"}


def run_python(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout


def test_unnamed_effects_are_not_imported():
    code = (
        "import sys; from stabilab import Body, Scene; from stabilab.physics.equations import derive; "
        "derive(Scene(Body((3, 2, 2))));"
        "print(*[m for m in sys.modules if m.startswith('stabilab.physics.effects.')])")
    assert run_python(code).split() == ["stabilab.physics.effects.base"]


def test_deriving_waits_to_import_sympy_and_compiling_heyoka():
    code = (
        "import sys, stabilab.physics.equations, stabilab.physics.to_numpy, stabilab.integrate.trajectory, "
        "stabilab.unreduced.growth;"
        "print(*[m for m in ('sympy', 'heyoka', 'scipy') if m in sys.modules])")
    assert run_python(code).split() == []


@pytest.mark.parametrize("scene", SCENES)
def test_numpy_rates_are_the_exact_rates_rounded(scene):
    system = to_numpy(derive(scene))
    states = exact_states(6)
    batch = np.array([[float(v) for v in x] for x in states]).reshape(2, 3, 3)
    exact = np.array([[float(v) for v in scene.quadratic().rate([Fraction(float(v)) for v in x])]
                      for x in states]).reshape(2, 3, 3)
    size = np.abs(batch).max()**2 + 1
    assert np.abs(system(batch) - exact).max() <= 1e-15 * size
    assert system.rate(batch[0, 0].tolist()) == system(batch)[0, 0].tolist()


@pytest.mark.parametrize("scene", SCENES)
def test_jacobian_is_that_of_complex_steps(scene):
    system = to_numpy(derive(scene))
    x = np.random.default_rng(3).normal(size=(4, 3)) * 2
    jacobian = system.jacobian(x)
    assert jacobian.shape == (4, 3, 3)
    for j in range(3):
        complex_step = system(x + 1e-200j * np.eye(3)[j]).imag / 1e-200
        assert np.abs(jacobian[..., j] - complex_step).max() < 1e-14


def test_nearly_equal_moments_keep_their_difference():
    """D1 - D2 = 1e-12: the coefficient is formed before rounding, so all its digits stand."""
    scene = Scene(Body(("1.000000000001", 1, "0.5")))
    rate = to_numpy(derive(scene)).rate([1.0, 1.0, 0.0])[2]
    assert rate == float(Fraction(1, 10**12) / Fraction(1, 2))


def test_equations_read_as_text_and_latex():
    equations = derive(Scene(BODY, WHEEL, THRUST))
    assert lines(equations)[0] == "D1 omega1' = M1 + lambda2*omega3 + omega2*omega3*(D2 - D3)"
    assert r"D_{1} \dot{\omega_{1}} &=" in latex(equations)


def test_long_equations_are_named_and_not_expanded():
    """A damper's mass on an oblique line: its rates have thousands of operations each. The law by hand: no torque from
    outside, so |H| stays, and nothing else does."""
    scene = Scene(Body(("1.2", "1.5", 2), 10), DamperMass("0.5", ("0.4", "0.1", "-0.05"), ("0.3", "0.2", 1), 2, "0.3", 10))
    written = lines(derive(scene))
    assert written[0] == "D1 omega1' = too long for a page: stabilab.derive(case.scene).rhs" and written[3] == "xm' = vm"
    assert latex(derive(scene)).count("too long for a page") == 4
    assert [law.name for law in invariants(scene)] == ["momentum"]


@pytest.mark.parametrize("text, varies", [("x", True), ("(x + 1)**2 - x**2 - 2*x", False), ("x*y/(1 + x)", True), ("3", False)])
def test_what_varies_with_the_state_is_told_by_two_points(text, varies):
    from sympy import sympify
    assert _varies(sympify(text)) is varies


@pytest.mark.parametrize("scene, names", [
    (Scene(BODY), ["energy", "momentum"]),
    (Scene(BODY, Gyrostat((1, 2, 3))), ["energy", "momentum"]),
    (Scene(BODY, Gyrostat((1, 2, 0)), ConstantTorque((0, 0, 5))), ["energy with turn angles", "quadratic"]),
    (Scene(BODY, ConstantTorque((1, 0, 5))), ["energy with turn angles", "momentum with turn angles"]),
    (Scene(Body((2, 2, 1)), Gyrostat((0, 0, 3)), ConstantTorque((0, 0, 1))),
     ["energy with turn angles", "quadratic", "spin 3"]),
    (ScaledGyrostat(1, 2, (0, 0, 1)), ["circle", "hyperbola with turn angles"]),
    (ScaledGyrostat(1, 2, (0, 1, 0)),
     ["hyperbola", "circle with turn angles", "plane x1 + b = x3", "plane x1 + b = -x3"]),
    (ScaledGyrostat(1, 2, (1, 0, 0)), ["circle with turn angles", "hyperbola with turn angles", "J"]),
])
def test_each_scene_has_its_own_laws(scene, names):
    assert [law.name for law in invariants(scene)] == names


@pytest.mark.parametrize("wrong, got",
                         [((), "nothing"), ((5,), "5"), ((ConstantTorque((1, 2, 3)),), "ConstantTorque")])
def test_a_scene_without_a_body_is_refused_in_words(wrong, got):
    with pytest.raises(InputError, match=f"scene: expected a Body first, such as .*, got {got}"):
        Scene(*wrong)


def test_compiled_rates_load_none_of_numpys_tools():
    """A star import of NumPy loads its tests and its reader of Fortran, a fifth of a small command's time."""
    code = ("import sys, stabilab; from stabilab.physics.to_numpy import to_numpy; "
            "to_numpy(stabilab.derive(stabilab.Scene(stabilab.Body((3, 2, 1.5)))))([1, 2, 3]); "
            "print(*{'numpy.f2py', 'numpy.testing'} & set(sys.modules))")
    assert subprocess.run([sys.executable, "-c", code], check=True, capture_output=True,
                          text=True).stdout == "\n"


def test_numbers_that_are_equal_as_doubles_alone_have_equations_of_their_own():
    """0.1 in decimals is 1/10; the double next to it is 3602879701896397/2^55 (IEEE 754)."""
    double = Fraction(3602879701896397, 2**55)
    for given, moment in (("0.1", Fraction(1, 10)), (0.1, double)):
        scene = Scene(Body((given, "0.12", "0.15")), ConstantTorque((given, 0, 0)),
                      LiquidCavity(1000, 1e-4, 1e-9))
        parameters = derive(scene).parameters
        assert parameters["D1"] == parameters["M1"] == moment


def test_a_scene_is_hashed_once_and_as_an_equal_one_in_any_process():
    """Counted by the hashes of its effect; hashes of names differ between processes, so none is sent along."""
    class Counted(Gyrostat):
        hashed = 0

        def __hash__(self):
            Counted.hashed += 1
            return 1
    scene = Scene(Body((3, 2, 1)), Counted((0.1, 0, 0)))
    assert hash(scene) == hash(scene) and Counted.hashed == 1
    plain, twin = (Scene(Body((3, 2, 1)), Gyrostat((0.1, 0, 0))) for _ in range(2))
    assert hash(plain) == hash(twin) and plain == twin
    sent = pickle.loads(pickle.dumps(plain))
    assert "_hash" not in vars(sent) and sent == plain and hash(sent) == hash(plain)
    assert copy.copy(plain) == plain


def test_a_parameter_is_one_number_in_all_rates_so_that_what_they_share_is_formed_once():
    """Beside a mass on a line the rates have one divisor, the determinant, and are no polynomials: all parameters
    of the file are numbers, and shared terms are found only where these are the same in every rate."""
    equations = derive(Scene(Body((3, 2, 2), 10), DamperMass("0.1", (0.2, 0.1, 0.05), (1, 1, 2), 2, "0.3", 10)))
    rates = form(equations, equations.rhs)
    assert len(rates.symbols) == len(equations.parameters) == 12
    shared, rest = sp.cse(rates.expressions)
    assert sum(map(sp.count_ops, (*(e for _, e in shared), *rest))) < 0.05 * sum(map(sp.count_ops, rates.expressions))
    written, different = extent(rates.expressions)
    assert written > 20 * different  # so that code in which nothing is shared takes as many times as long
    start = np.linspace(0.1, 0.4, 5)
    exactly = sp.lambdify((*rates.state, *rates.symbols), list(rates.expressions), "mpmath")  # shares nothing
    np.testing.assert_allclose(to_numpy(equations).rate(start.tolist()),
                               [float(v) for v in exactly(*start, *rates.numbers)], rtol=1e-14)
