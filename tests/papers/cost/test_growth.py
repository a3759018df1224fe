"""How cost grows: counts that do not depend on the machine, and pictures that hold what was measured."""
import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene, load
from stabilab.answers.fate import fate
from stabilab.orbit.result import Fate
from stabilab.papers import cost_growth
from stabilab.papers import cost_growth as shown
from stabilab.papers.cost_growth import (
    Growth,
    bits_needed,
    engines,
    near,
    nodes_needed,
    with_closeness,
    with_digits,
    with_states,
)
from tests.oracles import energy
from tests.oracles.model import physical, scaled

MINOR = load(Path(__file__).parents[3] / "cases" / "minor-axis-100.toml")


@pytest.mark.parametrize("decade", [1, 6, 13])
def test_states_stand_at_the_distance_that_is_asked_for(decade):
    # against the margin in 60 digits (tests/oracles/energy.py, mpmath)
    state, distance = near(MINOR, decade)
    model = scaled(MINOR.scene.a, MINOR.scene.b, MINOR.scene.mu)
    at_rest = (*state[:2], 0.0)
    exact = float(energy.margin(model, tuple(state), digits=60) / energy.margin(model, at_rest, digits=60))
    assert exact == pytest.approx(distance, rel=1e-6) and distance == pytest.approx(10.0**-decade, rel=1e-2)
    assert fate(MINOR.scene, state).labels == Fate.BOUNDED


def test_bits_for_the_fate_grow_by_three_and_a_third_a_decade():
    # a margin of 10^-n of the energy's terms is told from 0 by n log2(10) bits, and a few for the rounding on
    # the way
    for decade in (4, 8, 14):
        bits = bits_needed(MINOR.scene, near(MINOR, decade)[0])
        assert decade * math.log2(10) <= bits <= decade * math.log2(10) + 24


def test_nodes_for_the_period_grow_towards_the_separatrix():
    far, close = (nodes_needed(MINOR.scene, near(MINOR, n)[0]) for n in (1, 5))
    assert 8 <= far <= 64 < close


def test_in_moments_and_metres_the_distance_is_that_of_the_kinetic_energy():
    # a body of moments (2000, 1500, 1000) with a wheel: 1/2 D3 omega3^2 is what parts the state from rest
    # about axis 3
    scene = Scene(Body((2000, 1500, 1000)), Gyrostat((70, 0, 0)), ConstantTorque((0, 0, 100)))
    state, distance = near(SimpleNamespace(scene=scene, state=(1.3, 0.9, 0.1)), 3)
    exact, at_rest = (float(energy.margin(physical((2000, 1500, 1000), (70, 0, 0), (0, 0, 100)), tuple(s),
                                          digits=60))
                      for s in (state, (*state[:2], 0.0)))
    assert at_rest - exact == pytest.approx(500 * state[2] ** 2, rel=1e-12)
    assert exact / at_rest == pytest.approx(distance, rel=1e-9)
    assert distance == pytest.approx(1e-3, rel=1e-9)


def test_on_the_separatrix_no_bits_are_enough_and_beside_it_no_nodes():
    # Euler's polhode through the middle axis: D1 (D1 - D2) w1^2 = D3 (D2 - D3) w3^2
    assert bits_needed(Scene(Body((4, 3, "1.5"))), (3.0, 1.0, 4.0)) is None
    # 1e-15 below the barrier the rate dips over a part of 1e-7 of the turn, so 32768 equal parts leave digits
    # out
    assert nodes_needed(MINOR.scene, near(MINOR, 15)[0]) is None


@pytest.mark.slow
def test_digits_are_measured_by_every_method_of_a_motion_that_repeats(monkeypatch):
    monkeypatch.setattr(cost_growth, "MANY", (12,))
    rows = with_digits(replace(MINOR, span=(0.0, 2.0)), "glance")
    found = {(r.question, r.method) for r in rows}
    assert found >= {("states over the span", "taylor"), ("states over the span", "DOP853"),
                     ("extremes", "formulas"), ("period", "formulas"),
                     ("extremes", "balls"), ("period", "balls"), ("margin", "balls")}
    assert all(0 < r.x < 16 for r in rows if r.method in ("taylor", "DOP853", "reduced"))


def test_every_question_is_measured_at_every_distance(monkeypatch):
    monkeypatch.setattr(cost_growth, "DISTANCES", (2, 9))
    rows = with_closeness(MINOR)
    assert [(r.question, round(-math.log10(r.x)))
            for r in rows] == [(q, n) for n in (2, 9) for q in ("fate", "extremes", "period")]
    assert all(r.seconds > 0 and r.repeats >= 1 for r in rows)


def test_arrays_are_answered_by_every_engine_that_is_there(monkeypatch):
    monkeypatch.setattr(cost_growth, "STATES", {"fate": (2, 3)})
    rows = with_states(MINOR, full=True)
    assert [r.x for r in rows
            if r.method == "NumPy"] == [100, 1000] and {r.count_name for r in rows} == {"states in balls"}
    assert engines("extremes") == [("row by row", {})] and engines("fate")[0] == ("NumPy", {"fast": False})


ROWS = [Growth("states", "fate", "NumPy", 100.0, 1e-5, 3), Growth("states", "fate", "NumPy", 1000.0, 1e-4, 3),
        Growth("digits", "states over the span", "taylor", 6.0, 1e-5, 3, 100, "evaluations"),
        *(Growth("digits", q, m, x, x * 1e-3, 2) for q,
          m in (("states over the span", "Taylor in many digits"), ("period", "balls"))
          for x in (16.0, 30.0)),
        *(Growth("separatrix", q, "as called", x, 1e-3, 2, n, "") for q,
          n in (("fate", 20), ("period", 64)) for x in (1e-1, 1e-15))]


def test_page_has_words_and_a_picture_of_each_growth(tmp_path, monkeypatch):
    for name, about in (("with_states", "states"), ("with_digits", "digits"),
                        ("with_closeness", "separatrix")):
        monkeypatch.setattr(shown, name, lambda *_, about=about: [r for r in ROWS if r.about == about])
    html = shown.page(MINOR, tmp_path).read_text(encoding="utf-8")
    for about, title in shown.TITLES.items():
        assert title in html and (tmp_path / "growth" / f"{about}.png").stat().st_size > 5000
    assert (tmp_path / "growth.csv").read_text().count("\n") == len(ROWS) + 1 and "nan" not in html
