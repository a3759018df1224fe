"""Every verdict "wrong" of the audit, by a second method: `tests/papers/again` has the papers' formulas typed from
their texts, and what is so by SciPy and NumPy from equations written there."""
import ast
from pathlib import Path

import pytest

from .again import cavity_and_top, charged, gyrostat
from .recorded import RECORDED

CHECKS = {"constant-torque-gyrostat": gyrostat.CHECKS, **charged.CHECKS, **cavity_and_top.CHECKS}
WRONG = [(paper, row) for paper, rows in RECORDED.items() for row, verdict in rows.items() if verdict == "wrong"]


def test_every_wrong_row_of_every_paper_has_a_second_method_and_no_other_row_has_one():
    assert sorted(WRONG) == sorted((name, equation) for name, checks in CHECKS.items() for equation in checks)


def test_the_second_method_uses_nothing_of_the_package():
    for file in (Path(__file__).parent / "again").glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names = ([node.module or ""] if isinstance(node, ast.ImportFrom)
                     else [one.name for one in node.names] if isinstance(node, ast.Import) else [])
            assert all(name.split(".")[0] in ("__future__", "functools", "itertools", "numpy", "scipy", "sympy")
                       for name in names), (file.name, names)


@pytest.mark.parametrize("name, equation", WRONG)
def test_a_wrong_row_is_wrong_by_a_second_method_that_is_right_on_what_is_so(name, equation):
    printed, so = CHECKS[name][equation]()
    assert printed > 1e-2  # far above any rounding: a digit of the print, a share of the formula's terms
    assert so < 1e-6  # differences of a run, rounding
