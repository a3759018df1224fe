"""The linearised motion in `classify` and `show`: Jacobian, characteristic polynomial, scaled constants."""
import json

import numpy as np
import pytest

CASES = ("minor-axis-100", "middle-axis-double-well", "off-axis-two", "thruster-negative-minor-axis",
         "two-wheels-minor-axis", "off-axis-fold")


def rates_of(scene):
    """Euler's equations as they stand, or (5) of the paper: no code in common with the program's."""
    if scene.variables == "scaled":
        m = scene.mu
        return lambda x: np.array([x[1] * x[2] + m[0], -x[2] * (x[0] + scene.a) + m[1],
                                   x[1] * (x[0] + scene.b) + m[2]])
    D = np.array(scene.body.inertia, float)
    wheel, torque = (np.array(scene.vector(name), float) for name in ("gyrostat", "constant_torque"))
    return lambda w: (np.cross(D * w + wheel, w) + torque) / D


def derivative(rates, x):
    """Central differences, exact but for rounding: the rates are quadratic."""
    step = 1e-3 * (1 + np.abs(x).max())
    return np.array([(rates(x + step * e) - rates(x - step * e)) / (2 * step) for e in np.eye(3)]).T


@pytest.mark.parametrize("name", CASES)
def test_jacobian_and_characteristic_polynomial_are_those_of_the_equations(stabilab, name):
    from stabilab import load
    answer, = json.loads(stabilab("classify", f"cases/{name}.toml", "--json")[1])
    rates, found = rates_of(load(f"cases/{name}.toml").scene), answer["equilibria"]
    points = [*found["points"], *(sample for curve in found["curves"] for sample in curve["samples"])]
    assert points
    for point in points:
        at, jacobian = np.array(point["at"]), np.array(point["jacobian"])
        size = np.abs(jacobian).max()
        np.testing.assert_allclose(jacobian, derivative(rates, at), rtol=0, atol=1e-9 * size)
        powers = size ** np.arange(4)
        np.testing.assert_allclose(np.array(point["characteristic"]) / powers, np.poly(jacobian) / powers,
                                   rtol=0, atol=1e-9)


def test_show_prints_the_scaled_constants_of_a_body_in_SI(stabilab, case_file):
    """k1 to k3, u, a, b by (2) and (4), with the root of u that the paper leaves out of a and b."""
    case = case_file("[body]\ninertia = [2000, 1500, 1000]\n[effects.gyrostat]\nmomentum = [100, 0, 0]\n"
                     "[effects.constant_torque]\ntorque = [0, 0, 500]\n", "my")
    text = stabilab("show", case)[1]
    k = np.array([500 / 2000, 1000 / 1500, 500 / 1000])
    u = np.sqrt(k[0] * k[1] * (500 / 1000) ** 2) / k.prod()
    a, b = 100 / (1000 * np.sqrt(u * k[0])), 100 / (500 * np.sqrt(u * k[0]))
    assert (f"k1 = {k[0]:.6g}, k2 = {k[1]:.6g}, k3 = {k[2]:.6g}, u = {u:.6g}, a = {a:.6g}, b = {b:.6g}, "
            "μ = (0, 0, 1)") in text
    assert "(ω2 (D1 - D2)/D3, (D1 ω1 - D2 ω1 + λ1)/D3, 0)" in text
