"""The compiled tests of spin-up against those of NumPy: other loops over other tables, the same inequality."""
import random
from importlib.util import find_spec

import numpy as np
import pytest

from stabilab.unreduced.spin_up import certificate, elimination, fixed_centre, moving_centre
from stabilab.unreduced.spin_up.certificate import Certifier
from stabilab.unreduced.spin_up.compiled import kernel, moving_kernel
from stabilab.unreduced.spin_up.compiled.door import FixedCertifier, MovingCertifier
from stabilab.unreduced.spin_up.fields import tests_of as certificates
from stabilab.unreduced.spin_up.follow import spin_up
from stabilab.unreduced.spin_up.many import spin_up_many

from .scenes import random_scene, sphere

numba = pytest.mark.skipif(find_spec("numba") is None, reason="needs the extra fast")
NAMES = ("A", "z", "eta", "z_up", "eta_up", "k")


def states(seed, n):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(n, 3)) * rng.choice([1, 3, 10, 50], size=(n, 1))


def assert_alike(one, other):
    assert np.array_equal(one.good, other.good)
    for name in NAMES:
        assert np.allclose(getattr(one, name)[one.good], getattr(other, name)[one.good], rtol=1e-11, atol=1e-13)


def test_constants_stand_twice_and_agree():
    assert (kernel.SLACK, kernel.GROWTH, kernel.PASSES) == (certificate.SLACK, certificate.GROWTH, certificate.PASSES)
    assert (moving_kernel.SLACK, moving_kernel.GROWTH, moving_kernel.PASSES) == (certificate.SLACK, certificate.GROWTH, certificate.PASSES)
    assert kernel.COEFFICIENT == moving_kernel.COEFFICIENT == certificate.COEFFICIENT
    assert kernel.ROUNDING == elimination.ROUNDING and kernel.BLUR == fixed_centre.BLUR
    assert moving_kernel.CONDITION == moving_centre.CONDITION * fixed_centre.BLUR


@pytest.mark.parametrize("wheel, orders", [(0, (2, 4)), (0.1, (4, 6)), (1, (0, 2)), (3, (2, 4))])
def test_loops_about_the_fixed_centre_find_what_the_arrays_find(wheel, orders):
    good = 0
    for field in certificates(random_scene(random.Random(31), wheel)).fixed:
        places = states(1, 60)
        found = Certifier(field, orders)(places, 1e-9)
        assert_alike(found, FixedCertifier(field, orders, vars(kernel))(places, 1e-9))
        good += found.good.sum()
    assert good


@pytest.mark.parametrize("wheel", [0.1, 0.3])
def test_loops_about_the_moving_centre_find_what_the_arrays_find(wheel):
    good = 0
    for field in certificates(random_scene(random.Random(31), wheel)).moving:
        places = states(2, 40)
        found = Certifier(field, (2, 4))(places, 1e-9)
        assert_alike(found, MovingCertifier(field, (2, 4), vars(moving_kernel))(places, 1e-9))
        good += found.good.sum()
    assert good


@numba
@pytest.mark.parametrize("wheel", [0, 1])
def test_motions_are_decided_alike_with_and_without_numba(wheel):
    scene, starts = random_scene(random.Random(31), wheel), np.random.default_rng(6).normal(size=(40, 3)) * 3
    slow, fast = (spin_up_many(scene, starts, 100, 3000, fast=way) for way in (False, True))
    for name in ("fate", "axis", "sense", "level", "t", "steps", "condition", "states"):
        assert np.array_equal(getattr(slow, name), getattr(fast, name))
    decided = int(np.flatnonzero(fast.level)[0])
    one, other = slow.row(decided), fast.row(decided)
    assert one.trap.orders == other.trap.orders and one.trap.form == other.trap.form
    assert np.allclose([one.trap.A, one.trap.z, one.trap.eta], [other.trap.A, other.trap.z, other.trap.eta], rtol=1e-11)


@numba
def test_wide_batches_and_narrow_ones_give_the_same_bytes():
    """Thirty-two lanes, eight, and one at a time."""
    scene = random_scene(random.Random(9), 0.1)
    starts = np.array([sphere(random.Random(n), 3) for n in range(45)])
    all_ = spin_up_many(scene, starts, 200, fast=True)
    some = spin_up_many(scene, starts[::7], 200, fast=True)
    for name in ("t", "steps", "states", "condition"):
        assert np.array_equal(getattr(all_, name)[::7], getattr(some, name))
    assert spin_up(scene, starts[7].tolist(), 200, fast=True).state == tuple(all_.states[7].tolist())
