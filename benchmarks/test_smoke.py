"""Small versions of the benchmarks: they run, and the contestants agree. Nothing here looks at the clock."""
import pytest

pytest.importorskip("heyoka")

from stabilab.orbit.reduction import reduce

from . import fates, orbit_extremes, random_scenes, record, spin_up, spin_up_sample, suite

# they compile kernels, for half a minute and more where no cache is
SLOW = ("scenes", "surfaces", "orbit_extremes", "arrays", "digits", "maps", "proofs", "spin_up",
        "trajectories")  # it runs many methods


@pytest.mark.one_in(4)
@pytest.mark.parametrize("topic",
                         [pytest.param(topic, marks=pytest.mark.slow if topic in SLOW else ())
                          for topic in record.TOPICS])
def test_topic_gives_rows(topic):
    if topic == "surfaces":
        pytest.importorskip("pyvista")
    rows = list(suite.topic_rows(topic, small=True))
    assert rows and len({row.key for row in rows}) == len(rows)
    for row in rows:
        assert row.what and (row.ours > 0 or row.unit == "bytes")
        assert (row.ratio is None) == (row.theirs is None)
        assert row.ratio is None or 0 < row.low <= row.ratio <= row.high


def test_batch_integration_agrees_with_the_energy_law():
    # heyoka's run to a decision shares nothing with the reduced potential
    assert fates.against_batch(500, 200, 1).error.startswith("0 of ")


def test_events_agree_with_the_roots_of_the_potential():
    row = orbit_extremes.against_events(60, 20, 1)
    assert float(row.error.split()[-1]) < 1e-11  # the events' own accuracy at tolerance 1e-16


def test_spin_up_is_timed_beside_heyokas_own_batches():
    row = spin_up.pace(scenes=1, states=24, times=50.0, steps=300, seed=2)
    assert row.ours > 0 and row.theirs > 0 and row.error.endswith(" undecided")


def test_the_sample_of_every_kind_holds_what_its_kinds_say():
    """The moments as they stand in Euler's equations: pairs equal to a share of them, exactly or not."""
    sample = random_scenes.of_every_kind()
    assert len(sample) == random_scenes.EVERY and sample[7:9] == random_scenes.of_every_kind(2, 7)
    assert {one.kind for one in sample} == set(random_scenes.DRAWS)
    assert 15 < sum(not any(one.wheel) for one in sample) < 60
    for one in sample:
        axis = next(i for i in range(3) if one.torque[i])
        about, others = one.moments[axis], [one.moments[axis - 1], one.moments[axis - 2]]
        apart = min(abs(about - other) / other for other in others)
        assert max(one.moments) <= sum(one.moments) / 2 and reduce(one.scene) is not None
        assert one.kind != "near" or 0.9e-13 < apart < 1.1e-3
        assert (apart == 0) == (one.kind in ("across", "sphere"))
        assert (others[0] == others[1]) == (one.kind in ("along", "sphere"))
        assert one.kind != "right" or about * sum(others) == others[0] ** 2 + others[1] ** 2


@pytest.mark.slow
def test_the_sample_of_scenes_is_gathered_in_pieces_and_told_as_a_table(tmp_path, monkeypatch):
    pieces, page = [tmp_path / name for name in ("late", "early")], tmp_path / "page.md"
    for path, first in zip(pieces, (2, 0)):
        spin_up_sample.run(path, first, 4)
    page.write_text(f"before\n{spin_up_sample.BEGIN}\nold\n{spin_up_sample.END}\nafter", encoding="utf-8")
    monkeypatch.setattr(spin_up_sample, "PAGE", page)
    spin_up_sample.write(*pieces)
    rows = spin_up_sample.rows_of(pieces)
    assert [row["number"] for row in rows] == [0, 1, 2, 3, 4,
                                               5] and all(row["cause"] for row in rows
                                                          if row["level"] == "undecided")
    text = page.read_text(encoding="utf-8")
    assert "| all | 6 |" in text and "old" not in text and text.startswith("before") and text.endswith(
        "after") and "Undecided: " in text
