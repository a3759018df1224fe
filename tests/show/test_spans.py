"""Every view of a motion shows one span, in which what its headline says happens."""
import numpy as np
import pytest

import stabilab
from stabilab.show.explore.pictures import unframed
from stabilab.show.explore.session import Session
from stabilab.show.plot.subject import subject
from stabilab.show.space.span import limit_time, seen, spin_up_time

CASES = ("minor-axis-100", "major-axis-captured", "middle-axis-spin-up", "middle-axis-plane-300", "cubesat-3u",
         "geostationary-22n", "upper-stage", "thruster-stuck-major-axis", "wheel-and-thruster", "off-axis-one",
         "torque-free-body", "symmetric-spin-up")


@pytest.fixture(scope="module", params=CASES)
def one(request):
    return subject(stabilab.load(f"cases/{request.param}.toml"))


@pytest.mark.one_in(2)
def test_what_the_headline_says_happens_within_the_span(one):
    low, high = one.seen
    if limit := limit_time(one.motion):
        assert low <= 0 and high >= 1.25 * limit
    elif one.motion.period:
        assert 2 <= (high - low) / one.motion.period <= 10 * (1 + 1e-12)
    else:
        assert high > spin_up_time(one.motion)


@pytest.mark.one_in(4)
def test_pictures_and_explorer_show_the_same_span(one):
    """By what each of them draws."""
    low, high = one.seen
    assert stabilab.plot.time(one.case, units="si").get_xlim() == pytest.approx((low, high))
    header, numbers = unframed(Session(one.case).answer({}))
    row = lambda told: np.frombuffer(numbers, "<f4", told["count"], told["from"]).astype(float)
    last = row(header["time"]["times"])[-1]
    assert any(last == pytest.approx(high * unit) for unit in (1, 1 / 60, 1 / 3600))  # s, min or h on the page
    rates = np.array([row(told) for told in header["time"]["rates"]])
    assert row(header["time"]["size"]) == pytest.approx(np.linalg.norm(rates, axis=0), rel=1e-5)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["minor-axis-100", "thruster-stuck-major-axis", "middle-axis-spin-up",
                                  "torque-free-body"])
def test_a_case_without_a_span_has_one_span_in_every_view_too(name):
    lines = stabilab.load(f"cases/{name}.toml").text.splitlines()
    case = stabilab.load("\n".join(line for line in lines if not line.startswith(("span =", "tau ="))) + "\n")
    assert case.span is None
    header, numbers = unframed(Session(case).answer({}))
    told = header["time"]["times"]
    last = float(np.frombuffer(numbers, "<f4", told["count"], told["from"])[-1])
    assert any(last == pytest.approx(subject(case).seen[1] * unit) for unit in (1, 1 / 60, 1 / 3600))


def test_a_span_that_is_asked_for_is_shown_as_it_is():
    case = stabilab.load("cases/minor-axis-100.toml")
    assert subject(case, span=(0.0, 0.5)).seen == (0.0, 0.5)
    assert stabilab.plot.time(case, span=0.5).get_xlim() == (0.0, 0.5)


def test_a_spin_up_beyond_the_span_of_its_case_is_reached_unless_it_is_very_late():
    """By the last reversal of the turn of the same motion, and the time of its certificate."""
    case = stabilab.load("cases/major-axis-spin3-300.toml")
    found = stabilab.motion(case.scene, case.state)
    late = max(found.evidence["release_time"], found.evidence["t_certificate"])
    assert seen((0.0, late / 3), found, 15.0)[1] == pytest.approx(1.5 * late)
    assert seen((0.0, late / 1e3), found, 15.0)[1] == late / 1e3
    assert seen((0.0, 10 * late), found, 15.0)[1] == 10 * late
    assert seen((-2.0, 0.0), found, 15.0) == (-2.0, 1.5 * late)
