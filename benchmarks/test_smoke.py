"""Small versions of the benchmarks: they run, and the contestants agree. Nothing here looks at the clock."""
import pytest

pytest.importorskip("heyoka")

from . import fates, orbit_extremes, spin_up, suite


@pytest.mark.parametrize("topic", suite.TOPICS)
def test_topic_gives_rows(topic):
    if topic == "surfaces":
        pytest.importorskip("pyvista")
    for row in suite.topic_rows(topic, small=True):
        assert row.name and row.ratio > 0 and row.spread[0] <= row.ratio <= row.spread[1] and row.error


def test_batch_integration_agrees_with_the_energy_law():
    # heyoka's run to a decision shares nothing with the reduced potential
    assert fates.against_batch(500, 200, 1).error.startswith("0 of ")


def test_events_agree_with_the_roots_of_the_potential():
    row = orbit_extremes.against_events(60, 20, 1)
    assert float(row.error.split()[-1]) < 1e-11  # the events' own accuracy at tolerance 1e-16


def test_spin_up_is_timed_beside_heyokas_own_batches(capsys):
    pytest.importorskip("heyoka")
    ours, raw = spin_up.pace(seed=2, scenes=1, states=24, times=50.0, steps=300)
    assert ours > 0 and raw > 0 and "times the raw integration" in capsys.readouterr().out
