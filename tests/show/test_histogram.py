"""The histogram of draws of uncertain numbers."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
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
