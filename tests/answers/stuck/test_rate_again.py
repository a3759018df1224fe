"""Along the direction of the least change of rate: where the fate changes, and where it is again what it was,
against the balance of energy."""
import math

import numpy as np
import pytest

from stabilab import load, stuck
from tests.answers.stuck import energy
from tests.answers.stuck.brute import Craft
from tests.answers.stuck.random_crafts import on_an_axis
from tests.shared import later

PLACES = 12


@pytest.mark.one_in(2)
@pytest.mark.parametrize("n, axis",
                         [(6, 0), (15, 0), (20, 2), *later((n, n % 3) for n in range(23, 60) if n % 3 != 1)])
def test_beyond_a_margin_of_rate_the_fate_is_another_up_to_where_it_is_told_to_be_back(tmp_path, n, axis):
    """By the least value of the energy ahead of the start (`energy.fate`, in the frame of the file), at
    places on both sides."""
    text = on_an_axis(np.random.default_rng([14, n]), axis)
    (tmp_path / "own.toml").write_text(text)
    craft, row = Craft(text), stuck(load(tmp_path / "own.toml")).rows[0]
    margin = row.margins["rate"]
    if margin.size is None or not margin.beyond:
        return
    assert margin.until is not None and margin.until > margin.size
    by_energy = lambda s: energy.fate(craft.J, craft.torque(), craft.l,
                                      craft.start + s * np.array(margin.direction))[0]
    back = math.isfinite(margin.until)
    last = margin.until * (1 - 1e-9) if back else 20 * margin.size
    assert by_energy(margin.size * (1 - 1e-6)) == row.fate and back == ("again" in margin.because)
    assert all(by_energy(s) != row.fate for s in np.linspace(margin.size * (1 + 1e-6), last, PLACES))
    assert not back or by_energy(margin.until * (1 + 1e-9)) == row.fate
