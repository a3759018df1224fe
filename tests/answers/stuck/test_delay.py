"""The momentum of a wheel that delays a limit: where the runs that are compared end before it, the answer
does not say 'most of all'."""
from __future__ import annotations

import pytest

import stabilab
from stabilab.answers.stuck import fate
from tests.shared import craft_file


@pytest.mark.parametrize("budget, most", ((20_000, True), (40, False)))
def test_the_best_of_runs_that_end_before_the_limit_is_not_called_most_of_all(case_file, monkeypatch, budget,
                                                                              most):
    pytest.importorskip("heyoka")
    monkeypatch.setattr(fate, "SEARCHED", budget)
    file = case_file(craft_file([12, 9, 5], ([1, 0, 0.2], [0.1, 1, 0.3], 0.2), [([1, 0, 0], 0.8)],
                                [0.1, 0.05, 0.3]) + '\n[limits]\nrate = "120 deg/s"\n', "craft")
    (wheel,) = stabilab.stuck(stabilab.load(file)).rows[0].wheels
    assert wheel.best is not None and wheel.most is most
