"""The growth that a twin tells beside a saddle, without numba."""
import math

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.integrate.to_heyoka import heyoka_available
from stabilab.unreduced.spin_up.way import runs as module
from stabilab.unreduced.spin_up.way.runs import BEYOND, Runs

SPIN = Scene(Body((3, 2, 1)), Gyrostat((0, 0, 0)), ConstantTorque((0, 0, 0)))  # w2 = -20 about the middle axis: w1' = -20 w3/3, w3' = -20 w1


def growth(small, end):
    """(what the twin tells last, the most that it told) of a motion that starts so near to the saddle."""
    runs = Runs(SPIN, np.array([[small, -20.0, small]]))
    while runs.times[0] < end:
        runs.advance(np.arange(1), 1000, end)
    return runs.twins.growth[0], runs.twins.most[0]


@pytest.mark.one_in(4)
@pytest.mark.parametrize("taylor", [True, False])
@pytest.mark.parametrize("small", [1e-30, 1e-45])
@pytest.mark.parametrize("end", [1.0, 2.0, 3.5, 4.0, 6.0])
def test_a_twin_beside_a_saddle_tells_no_less_growth_than_there_is(monkeypatch, taylor, small, end):
    """Expected: cosh and sinh of 20 t/3^(1/2), the linear solution beside the spin, from the twin's first direction (1, 0, 1)."""
    if taylor and not heyoka_available():
        pytest.skip("needs heyoka")
    if not taylor:
        monkeypatch.setattr(module, "heyoka_available", lambda: False)
    last, most = growth(small, end)
    r, s = 3**0.5, 20 / 3**0.5 * end
    true = max(abs(math.cosh(s) - math.sinh(s) / r), abs(math.cosh(s) - r * math.sinh(s)))
    assert max(last, most) >= 0.98 * min(true, BEYOND)
    assert true > BEYOND or last == math.inf or last == pytest.approx(true, rel=0.02)
    assert not taylor or true > BEYOND or last < math.inf
