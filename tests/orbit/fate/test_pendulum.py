"""A free symmetric body with a wheel across its axis is a pendulum: exact separatrices of it, and captured
motions on planes.

D = (2, 2, 1), lambda = (l, 0, 0), u = omega1 + l, v = omega2:  u' = v omega3/2, v' = -u omega3/2, omega3' = l
v, so
omega3^2/2 - 2 l u is constant on the circle u^2 + v^2 = A^2 and the top u = -A (l > 0) is the saddle.
"""
import numpy as np
import pytest

import stabilab
from stabilab import Body, Fate, Gyrostat, Scene
from stabilab.answers.motion import motion

# l = 2, A = 5, (u, v) = (3, 4): omega3^2 = 4 l (u + A) = 64. The motion falls to u = -5; on the way through u
# = 5 omega3^2 = 80.
TIED = [((1.0, 4.0, 8.0), [(-7, 3), (-5, 4), (0, 80**0.5)]), ((1.0, 4.0, -8.0), [(-7, 1), (0, 5), (-8, 0)]),
        ((1.0, -4.0, 8.0), [(-7, 1), (-5, 0), (0, 8)]),
        ((1.0, -4.0, -8.0), [(-7, 3), (-4, 5), (-(80**0.5), 0)])]


@pytest.mark.parametrize("state, wanted", TIED)
def test_a_pendulum_of_the_wheel_on_its_separatrix_ends_upright(state, wanted):
    scene = Scene(Body((2, 2, 1)), Gyrostat((2, 0, 0)))
    found = motion(scene, state)
    assert found.fate == Fate.SEPARATRIX and found.period is None
    for one in (found.extremes, stabilab.extremes(scene, np.array(state))):
        np.testing.assert_allclose(one, wanted, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("push", [1 - 2**-40, 1 + 2**-40])
def test_beside_it_the_pendulum_swings_or_turns(push):
    state = (1.0, 4.0, 8.0 * push)
    found = motion(Scene(Body((2, 2, 1)), Gyrostat((2, 0, 0))), state)
    least, most = found.extremes[2]
    assert found.fate == Fate.BOUNDED and np.isfinite(found.period)
    # omega3^2 = 64 push^2 - 64 at the top: below it there is a swing back, above it the rate keeps its sign
    assert (least > 0) == (push > 1) and most == pytest.approx((16 + 64 * push**2) ** 0.5, rel=1e-12)
    assert least == pytest.approx((64 * push**2 - 64) ** 0.5 if push > 1 else -most, rel=1e-9)
