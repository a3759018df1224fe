"""Small versions of the benchmarks: they run, and the contestants agree. Nothing here looks at the clock."""
import pytest

pytest.importorskip("heyoka")

from . import suite  # noqa: E402


def test_batch_integration_agrees_with_the_energy_law():
    # heyoka's run to a decision shares nothing with the reduced potential
    assert suite.fates(500, 200, 1).error.startswith("0 of ")


def test_events_agree_with_the_roots_of_the_potential():
    row = suite.orbit_extremes(60, 20, 1)
    assert float(row.error.split()[-1]) < 1e-11  # the events' own accuracy at tolerance 1e-16


@pytest.mark.slow
def test_surface_comparison_runs():
    pytest.importorskip("pyvista")
    assert suite.surfaces(48, 1)[0].ratio > 0
