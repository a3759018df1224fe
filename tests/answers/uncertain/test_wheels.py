"""Wheels of uncertain momentum, inertia or speed: what the box holds, against the file with other numbers in it."""
from __future__ import annotations

import numpy as np
import pytest

from stabilab.answers.uncertain.boxes import box_of
from stabilab.answers.uncertain.fate import uncertain
from stabilab.case.read import load

BODY = "[body]\ninertia = {}\n[motion]\nangular_velocity = [0.1, 0.05, 0.02]\n"
TENSORS = ("[12, 9, 5]", "[[12, 0.4, 0.1], [0.4, 9, -0.3], [0.1, -0.3, 5]]")
WHEELS = ('[[wheels]]\naxis = [1, 2, -1]\ninertia = {}\nspeed = {}\n'
          '[[wheels]]\naxis = [0, 0, 3]\nmomentum = {}\n[effects.gyrostat]\nmomentum = [0.2, {}, 0]\n')
LOOSE = ('"0.004 +- 3 %"', '"250, sigma 4"', '"0.7 +- 0.1"', '"0.3 +- 0.05"')
HALVES = ((0.004, 0.00012), (250, 12), (0.7, 0.1), (0.3, 0.05))  # of a normal number 3 sigma


@pytest.mark.parametrize("tensor", TENSORS)
def test_a_point_of_the_box_is_the_file_with_its_numbers(tensor):
    """All four numbers at random points; moments and momentum (squares along the axes) of a file written so."""
    case = load(BODY.format(tensor) + WHEELS.format(*LOOSE) + "[effects.constant_torque]\ntorque = [0, 0, 0.02]\n")
    box, rng = box_of(case), np.random.default_rng(1)
    names = {"wheel_inertia": 0, "wheel_speed": 1, "wheel_momentum": 2, "momentum": 3}
    assert sorted(names[name] for name, _ in box.places) == [0, 1, 2, 3]
    for _ in range(5):
        point = rng.uniform(-1, 1, 4)
        numbers = [0.0] * 4
        for (name, _), e in zip(box.places, point):
            middle, half = HALVES[names[name]]
            numbers[names[name]] = middle + e * half
        other = load(BODY.format(tensor) + WHEELS.format(*numbers) + "[effects.constant_torque]\ntorque = [0, 0, 0.02]\n")
        scene, state = box.at(tuple(point))
        for of in ("gyrostat", "constant_torque"):
            assert np.allclose(np.array(scene.vector(of), float), np.array(other.physical.vector(of), float), rtol=0, atol=1e-12)
        assert np.allclose(state, other.state, rtol=0, atol=1e-15)


@pytest.mark.parametrize("half", [0.05, 3])
def test_a_wheel_along_an_axis_is_the_momentum_of_a_gyrostat(half):
    """The same number in another table: its answer and where it changes are the same."""
    torque = "[effects.constant_torque]\ntorque = [0, 0, 0.02]\n"
    wheel, gyrostat = (uncertain(load(BODY.format(TENSORS[0]) + text + torque)) for text in (
        f'[[wheels]]\naxis = [1, 0, 0]\nmomentum = "0.8 +- {half}"\n',
        f'[effects.gyrostat]\nmomentum = ["0.8 +- {half}", 0, 0]\n'))
    assert (wheel.fate.answer, wheel.fate.changes_at) == (gyrostat.fate.answer, gyrostat.fate.changes_at)
    assert wheel.fate.answer == ("holds" if half < 1 else "depends")
    assert wheel.equilibria.answer == gyrostat.equilibria.answer


def test_the_inertia_beside_a_momentum_has_no_part():
    text = '[[wheels]]\naxis = [1, 0, 0]\nmomentum = 1\nspeed = 250\ninertia = "0.004 +- 3 %"\n'
    case = load(BODY.format(TENSORS[0]) + text)
    assert len(case.uncertain) == 1 and box_of(case).places == ()


def test_draws_of_a_wheel_are_those_of_its_numbers(stabilab, case_file):
    """All draws of a speed and an inertia: their product lies within (1 - 0.03) (1 - 0.04) and (1 + 0.03) (1 + 0.04)."""
    path = case_file(BODY.format(TENSORS[0]) + '[[wheels]]\nname = "w"\naxis = [1, 0, 0]\ninertia = "0.004 +- 3 %"\n'
                     'speed = "250 +- 4 %"\n')
    code, out, err = stabilab("sweep", path, "--samples", "20", "--csv")
    assert code == 0, err
    head, *rows = [line.split(",") for line in out.splitlines() if line and not line.startswith("#")]
    columns = [n for n, name in enumerate(head) if "wheels.w" in name]
    assert len(columns) == 2 and len(rows) == 20
    values = np.array([[float(row[n]) for n in columns] for row in rows])
    assert len(set(values[:, 0])) == 20 and np.all(abs(values.prod(1) - 1) <= 1.03 * 1.04 - 1)


def test_a_product_of_inertia_turns_the_axes_of_the_box():
    """At a point the tensor of the file with that product in it: moments by NumPy's eigenvalues. Products are integrals here."""
    text = ("[body]\ninertia = [12, 9, 5]\nproducts = {{xy = {}, xz = 0, yz = 0.2, convention = 'positive'}}\n"
            "[motion]\nangular_velocity = [0.1, 0.05, 0.02]\n")
    box = box_of(load(text.format("'0.4 +- 0.1'")))
    assert box.places == (("products", 0),)
    for e in (-0.75, 0.25):
        xy = -(0.4 + 0.1 * -e)  # of the entry of the tensor, which has the opposite sign
        moments = np.linalg.eigvalsh([[12, xy, 0], [xy, 9, -0.2], [0, -0.2, 5]])
        assert sorted(map(float, box.at((e,))[0].body.exact)) == pytest.approx(moments, rel=1e-13)


def test_products_about_zero_are_no_box(stabilab, case_file):
    path = case_file("[body]\ninertia = [12, 9, 5]\nproducts = {xy = '0 +- 0.1', xz = 0, yz = 0, convention = 'positive'}\n"
                     "[motion]\nangular_velocity = [0.1, 0.05, 0.02]\n")
    code, out, _ = stabilab("fate", path)
    assert code == 0 and "uncertainties undecided" in out and "diagonal in the middle alone" in out
