"""The table of hard cases: the naive formula fails, the program is as good as its inputs allow, and the page
is current."""
import math
import re

import pytest

pytest.importorskip("flint")
pytest.importorskip("heyoka")

from tests.hard.row import Verdict
from tests.hard_table import ALLOWED, PAGE, ROWS, page, row_of, rows

NAMES = [f"{about}: {case.__name__.replace('_', ' ')} {number}" for about, case, number, _ in ROWS]
each = pytest.mark.parametrize("n", [pytest.param(n, marks=[pytest.mark.slow] * slow, id=name)
                                     for n, (name, (*_, slow)) in enumerate(zip(NAMES, ROWS))])


@pytest.mark.one_in(4)
@each
def test_the_program_is_right_and_as_good_as_its_inputs_allow(n):
    row = row_of(n)
    if isinstance(row, Verdict):
        assert row.ours == row.exact
    else:
        assert row.ours <= ALLOWED * row.condition


@each
def test_the_naive_formula_fails_where_a_case_is_called_hard(n):
    row = row_of(n)
    if isinstance(row, Verdict):
        assert row.naive != row.exact
    else:
        assert not math.isfinite(row.naive) or row.naive > 1e-11 and row.naive > 100 * row.ours


def test_every_kind_of_hard_case_has_a_quick_line():
    """Groups 1 to 11 of the gyrostat, the small divisors, the liquid, the top, the orbit, burns, dampers."""
    kinds = ["separatrix", "large circle", "fold", "parameters", "invariant planes", "symmetric", "conic",
             "start", "late",
             "off axis", "cancellation", "small divisors", "liquid", "top", "orbit", "burn", "damper"]
    assert list(dict.fromkeys(about for about, *_ in ROWS)) == kinds
    # a million turns are no quick line
    assert {about for about, *_, slow in ROWS if not slow} == set(kinds) - {"late"}


@pytest.mark.slow
def test_the_page_of_hard_cases_is_current():
    """Up to the digits, which may differ by a rounding between machines."""
    plain = lambda text: re.sub(r"\de[-+]\d+|< 1e-15|\d+ of", "#", text)
    assert plain(PAGE.read_text(encoding="utf-8")) == plain(page(rows()))

