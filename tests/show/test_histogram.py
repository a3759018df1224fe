"""The histogram of draws of uncertain numbers."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab import percentiles
from stabilab.errors import InputError
from stabilab.show.plot import histogram

pytest.importorskip("matplotlib")
FREE = '[body]\ninertia = [12, 9, 5]\n[motion]\nangular_velocity = [0, 0, "0.09, sigma 0.01"]\n'


def test_bars_are_the_draws_and_lines_their_quantiles():
    case = stabilab.load(FREE)
    found, ax = case.percentiles(80, 1).largest, histogram(case, units="si", samples=80, seed=1)
    bars = [bar.get_height() for bar in ax.patches if bar.get_height() > 1]
    edges = np.array([(bar.get_x(), bar.get_x() + bar.get_width()) for bar in ax.patches])
    assert sum(bar for bar in bars if bar == int(bar)) + sum(bar.get_height() == 1 for bar in ax.patches) >= 80
    assert edges[:, 0].min() == pytest.approx(found.high.min()) and ax.get_xlabel() == "largest rate |ω| (rad/s)"
    lines = [line.get_xdata()[0] for line in ax.lines]
    assert lines == pytest.approx([quantile.high for quantile in found.quantiles])
    assert "80 draws" in ax.get_title() and "no proof" in ax.get_title()


def test_what_has_no_draws_or_no_finite_one_is_refused():
    with pytest.raises(InputError, match="no number of the case has an uncertainty"):
        histogram(FREE.replace(", sigma 0.01", ""))
    spun = FREE + '[effects.constant_torque]\ntorque = [0, 0, "0.02"]\n'
    with pytest.raises(InputError, match="a limit in .limits. has a time to it"):
        histogram(spun, samples=5)


BURN = FREE + """[[thrusters]]
name = "P"
position = [1, 0, 0]
direction = [0, 1, 0]
force = "0.5 N, sigma 5 %"
start = 0
stop = 2
"""


@pytest.mark.parametrize("limit", [pytest.param("", marks=pytest.mark.slow), "[limits]\nrate = 0.15\n"])
def test_of_a_burn_draws_are_those_of_the_burn_and_what_follows(limit):
    """The body only spins up, about z: w(t) = w(0) + F t/5, by hand; 20 draws are within a tenth of that of the middles."""
    text = BURN + limit
    found, ax = percentiles(text, 20, 1), histogram(text, units="si", samples=20)
    spread = found.time if limit else found.largest
    edges = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in ax.patches]
    assert min(low for low, _ in edges) == pytest.approx(np.nanmin(spread.high[np.isfinite(spread.high)]))
    assert ax.get_xlabel() == ("time to the limit (s)" if limit else "largest rate |ω| (rad/s)")
    assert "20 draws" in ax.get_title() and "last closing" not in ax.get_title()
    middle = (0.15 - 0.09) * 5 / 0.5 if limit else 0.09 + 2 * 0.5 / 5  # of the middles of both numbers
    lines = [line.get_xdata()[0] for line in ax.lines]  # one or two a quantile
    assert lines[len(lines) // 2] == pytest.approx(middle, rel=0.1)
