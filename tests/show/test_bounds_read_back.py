"""Bounds in text are read back and compared with the numbers that Python and JSON have: an upper bound is
never printed below itself, a lower one never above, in any units. What is right is the number itself; the
factors of the units are written here."""
from __future__ import annotations

import math
import re
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from stabilab import load
from stabilab.answers.caveats import caveats_of
from stabilab.answers.tilt import Tilt
from stabilab.reasons import Moment, Rate, Sentence, old
from stabilab.show.explore.session import rows
from stabilab.show.report.one_case import extremes as page_extremes
from stabilab.show.report.tables import tiles
from stabilab.show.text import motion as lines_of
from stabilab.show.text import questions
from stabilab.show.text.headline import bracketed, headline
from stabilab.show.units import SYSTEMS, bracket, units_of

NOT_REACHED = Sentence("not-reached", "not reached by {time}")

CASES = Path(__file__).parents[2] / "cases"
FEW = ("cubesat-3u-detumbling", "geostationary-22n", "off-axis-two", "dual-spin-turn", "top-fast",
       "middle-axis-spin-up", "liquid-base")
ALL = sorted(path.stem for path in CASES.glob("*.toml"))
MANY = [name if name in FEW else pytest.param(name, marks=pytest.mark.slow) for name in ALL]
RATES = {"deg/s": math.pi / 180, "deg/day": math.pi / 180 / 86400, "rpm": math.pi / 30,
         "rev/s": 2 * math.pi, "rad/s": 1.0, "": 1.0}
TIMES = {"s": 1.0, "min": 60.0, "h": 3600.0, "day": 86400.0, "τ": 1.0, "tau": 1.0}
NUMBER = r"(-?\d[\d.]*(?:e[-+]?\d+)?)"
RATE = rf"{NUMBER}(?: (deg/s|deg/day|rpm|rev/s|rad/s))?(?! J| N m|[\w^/.])"
UPPER = re.compile(rf"(?:at most|never exceeds|<=|≤) +{RATE}")
TIGHT = 2e-3  # relative: four digits, rounded outward


@cache
def known(name):
    case = load(CASES / f"{name}.toml")
    return case, None if case.state is None else case.motion()


def bounds_of(motion):
    """All that a text may call the most of a rate."""
    found = [motion.invariants[key] for key in ("rate_bound", "late_rate_bound") if key in motion.invariants]
    for pairs in (motion.bounds, motion.extremes):
        sizes = [max(map(abs, pair)) for pair in pairs or () if None not in pair]
        found += [*sizes, math.hypot(*sizes)]
    return np.array([v for v in found if math.isfinite(v)])


def nearest(value, among):
    return float(among[np.argmin(np.abs(among - value))])


def views(case, motion, units):
    """What is said of a motion in text, on its page and in the explorer."""
    yield headline(case, motion, units)
    yield "\n".join([*lines_of.table(case, motion, units), *lines_of.why(case, motion, units, True)])
    yield from (f"{value} {note}" for _, value, note in tiles(motion, units))
    yield "\n".join(" ".join(row) for row in rows(case, motion, units))


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", MANY)
def test_no_bound_of_a_rate_is_printed_below_itself(name):
    case, motion = known(name)
    if motion is None:
        pytest.skip("it states no motion")
    among, seen = bounds_of(motion), 0
    for system in ["scaled"] if case.variables == "scaled" else SYSTEMS:
        units = units_of(case, None if system == "scaled" else system)
        for text in views(case, motion, units):
            for value, unit in UPPER.findall(text):
                printed = float(value) * RATES[unit]
                true = nearest(printed, among)
                assert printed >= true * (1 - 1e-15), (system, text, true)  # the factors here are rounded
                assert printed <= true * (1 + TIGHT), (system, text, true)
                seen += 1
    assert seen or "at most" not in headline(case, motion)


@pytest.mark.parametrize("name", MANY)
def test_bounds_for_all_times_are_rounded_outward(name):
    case, motion = known(name)
    if motion is None or motion.bounds is None:
        pytest.skip("no bounds for all times")
    for system in ["scaled"] if case.variables == "scaled" else SYSTEMS:
        units = units_of(case, None if system == "scaled" else system)
        text = lines_of.bound_lines(case, motion, units)[-3:]
        page = [row["within"] for row in page_extremes(case, motion, units)]
        assert len(text) == 3
        for line, words, pair in zip(text, page, motion.bounds):
            ends = [(true, side) for true, side in zip(pair, (-1, 1)) if math.isfinite(true)]
            for view in (line, *[words] * bool(words)):
                view = view.replace("−", "-")
                told = [float(v) * RATES[units.rates[0]] for v in re.findall(rf"(?<!\S){NUMBER}(?!\S)", view)]
                assert len(told) == len(ends)
                for value, (true, side) in zip(told, ends):
                    assert 1e-3 * abs(true) >= side * (value - true) >= -1e-15 * abs(true), (system, view)


def read_time(text, before):
    found = re.search(rf"{before} +(?:t = |tau = )?{NUMBER} ?(s|min|h|day|τ)?\b", text)
    return float(found[1]) * TIMES[found[2] or ""] if found[2] else float(found[1])


@pytest.mark.parametrize("system", SYSTEMS)
def test_times_before_which_nothing_happens_are_rounded_down_in_every_view(system):
    case, motion = known("thruster-stuck-major-axis")
    units = units_of(case, system)
    for value in 10.0 ** np.random.default_rng(17).uniform(-2, 7, 60):
        value = float(value)
        tilt = Tilt(0.0123, "the torque", 0.5, True, value, None, None, "run", None, None, 10 * value,
                    np.zeros(3), np.full(3, math.inf))
        tilted = replace(motion, tilt=tilt, caveats=caveats_of(case.scene, True, tilt))
        one = SimpleNamespace(low=value, high=math.nan, level="proved", caveats=(), reason=old(""), ending=None, tilt=None, validity=None, decimals=None)
        asked = SimpleNamespace(kind="rate", names=("|omega|",), limits=(0.5,))
        for text, words in (("\n".join(lines_of.tilt_lines(case, tilted, units)), "not before"),
                            (questions.text(case, asked, one, units), "not before"),
                            (f"t {units.said(NOT_REACHED(time=Moment(value).lower))}", "not reached by")):
            read = read_time(text, words)
            assert value * (1 - 2e-3) <= read <= value * (1 + 1e-15), (text, value)
        followed = read_time("\n".join(lines_of.tilt_lines(case, tilted, units)), "followed for")
        assert followed <= 10 * value * (1 + 1e-15)


def test_both_ends_of_a_bracket_are_read_back_outside_of_it():
    rng = np.random.default_rng(3)
    for system, unit in product(SYSTEMS.values(), ("rad/s", "s")):
        for _ in range(100):
            low = float(10.0 ** rng.uniform(-3, 5))
            high = low * (1 + float(10.0 ** rng.uniform(-15, -1)))
            name, one = system.times(high) if unit == "s" else system.of(unit)
            for ends in (bracket(low, high, one), bracketed(low, high, (name, one), 4).split()[:3:2]):
                assert float(ends[0]) / one <= low and float(ends[1]) / one >= high


@pytest.mark.parametrize("words, value, side", [("so |ω| ≤ {rate} always", 0.457951234, 1),
                                                ("in the end by at least {rate}", 1.00004999, -1)])
def test_a_bound_within_a_sentence_stays_on_its_side_when_its_unit_changes(words, value, side):
    for system in SYSTEMS.values():
        text = system.said(Sentence("bound", words)(rate=Rate(value, side=side)), 4)
        read, of = re.search(rf"{NUMBER} (\S+)", text).groups()
        printed = float(read) * (RATES | TIMES)[of]
        assert side * printed >= side * value * (1 - side * 1e-15) and abs(printed - value) < 2e-3 * value
