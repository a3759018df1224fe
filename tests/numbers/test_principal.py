"""Principal axes of exact tensors: what stays exact, how well the rest is known, and what is no inertia
tensor."""
import random
from fractions import Fraction

import pytest

from stabilab.errors import InputError
from stabilab.numbers.principal import IDENTITY, principal_axes
from stabilab.numbers.vectors import cross, dot

# orthogonal, by hand
TURN = tuple(tuple(Fraction(v, 3) for v in row) for row in ((2, -1, 2), (2, 2, -1), (-1, 2, 2)))
GOOD = Fraction(1, 1 << 240)


def turned(rows, moments):
    """R D R^T of a rotation in exact numbers."""
    return [[sum(rows[i][k] * moments[k] * rows[j][k] for k in range(3)) for j in range(3)] for i in range(3)]


def tensor_of_points(rng):
    """The tensor of four points of mass 1: possible by its definition, sum of |r|^2 I - r r^T."""
    points = [[Fraction(rng.randint(-999, 999), 1000) for _ in range(3)] for _ in range(4)]
    return [[sum((dot(p, p) if i == j else 0) - p[i] * p[j] for p in points) for j in range(3)]
            for i in range(3)]


def judge(tensor, found):
    """The definition: orthonormal right-handed axes that make the tensor diagonal, to the error told."""
    assert found.error < GOOD and found.exact == (found.error == 0)
    slack = 4 * found.error
    for i, axis in enumerate(found.axes):
        image = [dot([Fraction(v) for v in row], axis) for row in tensor]
        assert all(abs(a - found.moments[i] * v) <= slack * max(found.moments) for a, v in zip(image, axis))
        assert all(abs(dot(axis, other) - (i == j)) <= slack for j, other in enumerate(found.axes))
    assert all(abs(a - b) <= 4 * slack for a, b in zip(cross(found.axes[0], found.axes[1]), found.axes[2]))


def test_a_diagonal_tensor_keeps_its_order_and_is_exact():
    found = principal_axes([[Fraction(1, 3), 0, 0], [0, Fraction(1, 2), 0], [0, 0, Fraction(2, 5)]])
    assert found.moments == (Fraction(1, 3), Fraction(1, 2),
                             Fraction(2, 5)) and found.axes == IDENTITY and found.exact and found.as_given


DECIMAL = tuple(map(Fraction, ("1.553", "1.35", "0.935")))  # none of them a double


@pytest.mark.parametrize("moments",
                         [(3, 2, Fraction(3, 2)), (5, 3, 2), (3, 2, 2 + Fraction(1, 10**60)), DECIMAL])
def test_rational_axes_stay_exact(moments):
    found = principal_axes(turned(TURN, moments))
    judge(turned(TURN, moments), found)
    assert found.exact and found.moments == tuple(sorted(moments, reverse=True))


@pytest.mark.parametrize("moments", [(3, 3, Fraction(3, 2)), (3, 2, 2)])
def test_equal_moments_are_equal_exactly_whatever_axes_are_chosen_there(moments):
    found = principal_axes(turned(TURN, moments))
    judge(turned(TURN, moments), found)
    assert found.moments == moments


@pytest.mark.parametrize("seed", range(20))
def test_axes_of_random_bodies_are_known_to_240_bits_and_descend(seed):
    tensor = tensor_of_points(random.Random(seed))
    found = principal_axes(tensor)
    judge(tensor, found)
    assert found.moments[0] > found.moments[1] > found.moments[2] and sum(found.moments) == sum(
        tensor[i][i] for i in range(3))


def test_moments_that_are_almost_equal_are_told_apart():
    small = Fraction(1, 10**80)
    tensor = [[2, small, 0], [small, 2, small / 10], [0, small / 10, 2]]
    found = principal_axes(tensor)
    judge(tensor, found)
    assert found.moments[0] > 2 > found.moments[2]


def test_a_flat_body_keeps_the_equality_of_its_moments():
    """A plate in the plane x y has Dz = Dx + Dy; in its plane the moments are irrational here (discriminant 1
    + 4/9 = 13/9)."""
    found = principal_axes([[2, Fraction(1, 3), 0], [Fraction(1, 3), 1, 0], [0, 0, 3]])
    assert found.moments[0] == found.moments[1] + found.moments[2] == 3


def test_a_vector_along_a_rational_axis_has_no_component_across_it():
    """The eigenvector (1, 1, 1) of moment 10 is by hand; the other moments are 8 +- sqrt(3)."""
    tensor = [[8, 0, 2], [0, 9, 1], [2, 1, 7]]
    found = principal_axes(tensor)
    judge(tensor, found)
    along = found.turned((2, 2, 2))
    assert sorted(v == 0 for v in along) == [False, True, True] and not found.exact


def test_turning_there_and_back_is_the_identity_to_the_error():
    found = principal_axes(tensor_of_points(random.Random(7)))
    vector = (Fraction(1, 7), -2, 3)
    assert all(abs(a - b) < 64 * GOOD for a, b in zip(found.back(found.turned(vector)), vector))


@pytest.mark.parametrize("tensor, words", [
    ([[1, Fraction(1, 10), 0], [Fraction(1, 5), 1, 0], [0, 0, 1]],
     "not symmetric: its xy entry is 0.1 and its yx entry 0.2, they differ by 0.1"),
    # 1 - 2, by hand
    ([[1, 2, 0], [2, 1, 0], [0, 0, 1]], "not positive definite: its least principal moment is -1 "),
    ([[1, 1, 0], [1, 1, 0], [0, 0, 1]], "not positive definite")])  # its determinant is 0
def test_what_no_body_has_is_refused_by_exact_signs(tensor, words):
    with pytest.raises(InputError) as caught:
        principal_axes(tensor)
    assert words in str(caught.value)


@pytest.mark.parametrize("largest", [3, Fraction(7, 2), 30])
def test_moments_are_exact_on_both_sides_of_the_triangle_inequality(largest):
    assert principal_axes(turned(TURN, (largest, 2, 1))).moments == (largest, 2, 1)
