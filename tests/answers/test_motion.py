"""Tests of `answers/motion.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import json

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene, load
from stabilab.answers.motion import motion
from tests.shared import TIE, answer

# D = (9, 5, 4), lambda = (4, 0, 1), no torque: the planes omega1 + 1 = k s/3, omega3 - 1 = s, k = +-1, keep
# k: s' = k omega2 s/3.
# 5 omega2^2 = 2 T - 9 omega1^2 - 4 omega3^2 = 2 T - 13 - (8 - 6 k) s - 5 s^2, and s = 0 is the permanent
# rotation that they end in.
PLANES = Scene(Body((9, 5, 4)), Gyrostat((4, 0, 1)))


def on_plane(k, s, w):
    """[(least, greatest)] over t >= 0 by the two conservation laws: out to a turning point where k omega2 s >
    0, then in to s = 0."""
    b, sense = 8 - 6 * k, k
    level = 5 * w * w + b * s + 5 * s * s
    outward = sense * w > 0
    far = (-b + np.sign(s) * (b * b + 20 * level) ** 0.5) / 10 if outward else s

    def rates(one, other):
        """Least and greatest |omega2| with s between; 5 omega2^2 = level - b s - 5 s^2 is greatest at s =
        -b/10."""
        inside = [-b / 10] * (min(one, other) < -b / 10 < max(one, other))
        sizes = [max(0.0, (level - b * t - 5 * t * t) / 5) ** 0.5 for t in (one, other, *inside)]
        return min(sizes), max(sizes)
    least, most = rates(far, 0.0)
    found = [-sense * most, -sense * least]
    if outward:
        found += [0.0, sense * rates(s, far)[1]]
    return [sorted((-1 + k * far / 3, -1.0)), [min(found), max(found)], sorted((1 + far, 1.0))]


@pytest.mark.one_in(4)
@pytest.mark.parametrize("k", [1, -1])
@pytest.mark.parametrize("s", [3.0, -3.0])
@pytest.mark.parametrize("w", [-3.0, -1.0, -0.25, 0.25, 1.0, 3.0])
def test_on_a_plane_without_torque_the_motion_tends_to_a_permanent_rotation(k, s, w):
    state = (-1 + k * s / 3, w, 1 + s)
    found = motion(PLANES, state)
    assert found.fate in (Fate.SEPARATRIX,
                          Fate.BOUNDED) and found.fate == stabilab.fate(PLANES, np.array(state)).labels
    if found.fate == Fate.SEPARATRIX:
        np.testing.assert_allclose(found.extremes, on_plane(k, s, w), rtol=1e-11, atol=1e-11)
        np.testing.assert_allclose(stabilab.extremes(PLANES, np.array(state)), found.extremes, rtol=1e-12,
                                   atol=1e-12)


def test_on_a_plane_below_its_end_the_motion_is_bounded():
    # k = -1: 5 omega2^2 = level - 14 s - 5 s^2 with level = 5/4 - 21 + 45/4 < 0 at (s, omega2) = (-3/2, 1/2):
    # s = 0 is out of reach
    found = motion(PLANES, (-0.5, 0.5, -0.5))
    roots = sorted(np.roots([5, 14, 8.5]))
    assert found.fate == Fate.BOUNDED and found.period is not None
    np.testing.assert_allclose(found.extremes[2], [1 + r for r in roots], rtol=1e-12)
    np.testing.assert_allclose(found.extremes[0], sorted(-1 - r / 3 for r in roots), rtol=1e-12)


@pytest.mark.parametrize("w", [1.0, -1.0])
def test_on_a_loop_of_a_parabola_the_rate_about_the_torque_keeps_the_sense_of_each_leg(w):
    """With a the angle from the saddle omega3 = v - a/2, omega2 = u - v a/2 + a^2/8 (l2 = 1) and omega1^2 = 2
    (cubic's integral)."""
    scene, (u, v) = Scene(Body((4, 4, 2)), Gyrostat((0, 1, 0)), ConstantTorque((-50, 0, 0))), (-10.5, -2.5)
    rate = (np.polynomial.Polynomial([-50 / 4]) + np.polynomial.Polynomial([v, -0.5])
            * (2 * np.polynomial.Polynomial([u, -v / 2, 1 / 8]) + 1) / 4)
    square = 2 * rate.integ()
    start = 2 * (v + 3.5)
    assert square(start) == pytest.approx(1.0) and square.deriv()(0) == 0
    far = min((r.real for r in square.roots() if abs(r.imag) < 1e-9 and r.real * start > 1e-6), key=abs)
    tops = [t.real for t in rate.roots() if min(0, far) < t.real < max(0, far) and abs(t.imag) < 1e-9]
    outward = w * far > 0
    def span(one, other):
        return (max(square(t) for t in (one, other,
                                        *(t for t in tops if min(one, other) < t < max(one, other)))) ** 0.5)
    back = span(0.0, far) if outward else span(0.0, start)
    wanted = sorted((-np.sign(far) * back, np.sign(far) * span(start, far) if outward else 0.0))
    found = motion(scene, (w, -7.5, -3.5))
    assert found.fate == Fate.SEPARATRIX
    np.testing.assert_allclose(found.extremes[0], wanted, rtol=1e-10, atol=1e-12)
    ends = sorted((v, v - far / 2 if outward else -3.5))
    np.testing.assert_allclose(found.extremes[2], ends, rtol=1e-10)


def test_a_tie_of_written_decimals_is_the_separatrix(tmp_path, case_file):
    path = case_file(TIE, "tie")
    case = load(path)
    assert case.state != case.exact_state  # the doubles lie beside it
    assert motion(case.scene, case.state).fate == Fate.BOUNDED
    assert motion(case.scene, case.state, exact=case.exact_state).fate == Fate.SEPARATRIX
    for options in ((), ("--digits", "30")):
        assert '"separatrix"' in json.dumps(answer("fate", tmp_path, TIE, *options))
