"""The table of hard cases: the naive formula fails there, the program is as good as its inputs allow, and the page is current."""
import math
import re

import pytest

from .hard_table import ALLOWED, MAKERS, PAGE, page, row_of, rows

each = pytest.mark.parametrize("n", [n if make.__name__ not in ("near_plane", "minute") else pytest.param(n, marks=pytest.mark.slow) for n, (make, _) in enumerate(MAKERS)],
                               ids=lambda n: f"{MAKERS[n][0].__name__} {MAKERS[n][1]:g}")


@each
def test_our_error_is_a_small_multiple_of_what_the_last_place_of_the_inputs_does(n):
    row = row_of(n)
    assert row.ours <= ALLOWED * row.condition


@each
def test_the_naive_formula_fails_where_a_case_is_called_hard(n):
    row = row_of(n)
    assert not math.isfinite(row.naive) or row.naive > 1e-11 and row.naive > 100 * row.ours


@pytest.mark.slow
def test_the_page_of_hard_cases_is_current():
    """Up to the digits, which may differ by a rounding between machines."""
    plain = lambda text: re.sub(r"\de[-+]\d+|< 1e-15", "#", text)  # noqa: E731
    assert plain(PAGE.read_text(encoding="utf-8")) == plain(page(rows()))
