"""The audit of printed formulas: its verdicts, and the audit itself held against a run of an independent integrator."""
from dataclasses import replace

import numpy as np
import pytest

from stabilab.theories import audit
from stabilab.theories.audit.published import FALSE_ABOVE, VERDICTS, examine, generic, parse, symbols

ROWS = [row for paper in audit.PAPERS for row in audit.rows(paper)]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row.where}: {row.printed[:40]}")
def test_every_verdict_agrees_with_its_residuals(row):
    found = examine(row)
    assert found.confirmed, (found.printed_residual, found.corrected_residual)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row.where}: {row.printed[:40]}")
def test_every_formula_that_is_not_right_has_its_correction(row):
    assert row.verdict in VERDICTS
    assert bool(row.corrected) == (row.verdict != "right")


def test_a_false_verdict_is_not_confirmed():
    wrong = next(row for row in ROWS if row.where == "eqs (17), (18)")
    right = next(row for row in ROWS if row.where == "eq. (1)")
    assert not examine(replace(wrong, verdict="right", corrected="")).confirmed
    assert not examine(replace(right, verdict="wrong", corrected="x")).confirmed
    assert examine(wrong).printed_residual > FALSE_ABOVE


def _run(mu, start, a, b):
    """States of the scaled system by SciPy's DOP853: shares no code with the audit."""
    from scipy.integrate import solve_ivp
    rates = lambda t, x: (x[1] * x[2] + mu[0], -x[2] * (x[0] + a) + mu[1], x[1] * (x[0] + b) + mu[2])
    return solve_ivp(rates, (0, 6), start, method="DOP853", rtol=1e-12, atol=1e-13, t_eval=np.linspace(0, 6, 61)).y


INTEGRALS = [  # (torque, start, printed integral, corrected integral): strings of the rows tested above
    ((0, 0, 1), (2.5, 4.0, 0.1), "x1**2+x2**2", "(x1+a)**2+x2**2"),
    ((0, 1, 0), (1.7, 1.1, -0.2), "x1**2-x3**2", "(x1+b)**2-x3**2"),
    ((0, 1, 0), (1.7, 1.1, -0.2), "x1**2/2+x2**2/2+(a+b)*x1-log(x1)", "x2**2+(x1+a)**2-2*log(x1+b+x3)"),
]


@pytest.mark.parametrize("mu, start, printed, corrected", INTEGRALS)
def test_the_corrected_integral_is_constant_along_a_run_and_the_printed_one_is_not(mu, start, printed, corrected):
    import sympy as sp
    s = symbols()
    states = _run(mu, start, 0.2, 0.4)
    spread = []
    for formula in (printed, corrected):
        function = sp.lambdify([s[n] for n in ("x1", "x2", "x3", "a", "b")], parse(formula))
        values = function(*states, 0.2, 0.4)
        spread.append(np.ptp(values))
    assert spread[0] > 0.1 and spread[1] < 1e-9


def test_the_test_state_is_special_in_no_symbol():
    values = list(generic().values())
    assert len(set(values)) == len(values) and all(v != 0 for v in values)
