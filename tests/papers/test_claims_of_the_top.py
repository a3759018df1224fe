"""Claims of the paper on the top about its figures 6 and 7, by its (43) typed again."""
import numpy as np
import pytest

from tests.papers.recorded import RECORDED


def test_phi_of_the_papers_43_drifts_by_what_the_audit_says():
    """phi3 as the paper prints it, in NumPy: a turn later it is more by 2 pi (x0' + k C1 tan theta0/4)."""
    x0, y0, k, C1, tan, r0 = 0.7, 0.3, 1.3, 0.4, 2.1, 5.0
    phi3 = lambda t: (x0 * (r0 * t - np.sin(r0 * t)) - y0 * np.cos(r0 * t)
                      + k * C1 * tan / 8 * (2 * r0 * t - np.sin(2 * r0 * t)))
    t = np.linspace(0, 3, 7)
    assert phi3(t + 2 * np.pi / r0) - phi3(t) == pytest.approx(2 * np.pi * (x0 + k * C1 * tan / 4), rel=1e-12)
    verdicts = RECORDED["newtonian-field-top"]
    assert (verdicts["text-fig6"], verdicts["text-fig6-1"]) == ("holds", "only-if")
