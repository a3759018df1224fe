"""From SymPy to heyoka: polynomials written so that few series are multiplied."""
import sympy

from stabilab import Body, Charge, ConstantTorque, Gravity, Gyrostat, LiquidCavity, Resistance, Scene
from stabilab.integrate.to_heyoka import nested
from stabilab.physics.to_numpy import to_numpy

PLAIN = Gyrostat((0.3, -0.2, 0.5)), ConstantTorque((0.1, 0.2, 0.1))
FULL = Scene(Body((3, 2, 1.5)), *PLAIN, Gravity(1, (0.3, 0.1, 0.2)), LiquidCavity("0.05", 1000, "0.01"),
             Resistance("0.01"))


def series_products(expression, state):
    """How many products of two factors that hold the state an expression has, as it is written."""
    held = [arg for arg in expression.args if arg.free_symbols & set(state)]
    own = max(len(held) - 1, 0) if expression.is_Mul else int(expression.exp) - 1 if expression.is_Pow else 0
    return own + sum(series_products(arg, state) for arg in held)


def test_a_polynomial_written_with_fewer_products_of_series_is_the_same():
    """Expanded by SymPy."""
    form = to_numpy(FULL).rhs
    before, after = 0, 0
    for expression in form.expressions:
        result = nested(expression, form.state)
        assert sympy.expand(result - expression) == 0
        before += series_products(expression, form.state)
        after += series_products(result, form.state)
    assert after < before / 2


def test_what_has_no_product_to_save_and_what_is_no_polynomial_stay_as_they_are():
    for scene in (Scene(Body((3, 2, 1.5)), *PLAIN), Scene(Body((3, 2, 1.5)), *PLAIN, Charge(0.2, 1, 1, 0.5))):
        form = to_numpy(scene).rhs
        assert all(nested(expression, form.state) is expression for expression in form.expressions)
    x, y, c = sympy.symbols("x y c")
    for expression in (c * x * sympy.sin(y) + x * y + x**2, x * y / (1 + x) + x * y + x**2):
        assert nested(expression, (x, y)) is expression
    assert nested(c * x * y + x**2 + c, (x, y)) == x * (c * y + x) + c
