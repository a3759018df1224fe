"""Sentences that carry quantities: every hole is filled, codes are unique, bounds are rounded outward, and
what users wrote stays as they wrote it."""
from __future__ import annotations

import ast
import math
import pickle
from dataclasses import dataclass, replace

import numpy as np
import pytest

from stabilab.answers.dissipation.flat_spin import FlatSpin
from stabilab.errors import Caveat, Kind, key
from stabilab.reasons import Angle, Axis, Quantity, Rate, Reasoned, Sentence, Time, number, old
from stabilab.show.axes import Axes
from stabilab.show.units import SYSTEMS

from .house.sentences import KINDS, PAGE, modules, page, sentences

RESERVED = {"kind", "words", "code", "text", "then"}  # keys of JSON beside the quantities
ALL = [one for _, one in sentences()]


def test_every_code_is_one_sentence_and_no_hole_hides_a_key():
    codes = [one.code for one in ALL]
    assert len(codes) == len(set(codes)) > 15
    assert not [one.code for one in ALL if RESERVED & set(one.holes)]
    for tree, module in modules():  # none is hidden in a function
        inside = {id(one) for node in ast.walk(tree) if isinstance(node, (ast.FunctionDef, ast.Lambda))
                  for one in ast.walk(node)}
        assert not [node.lineno for node in ast.walk(tree) if id(node) in inside and isinstance(node, ast.Call)
                    and getattr(node.func, "id", "") == "Sentence"], module


def test_the_page_of_codes_is_what_the_package_says():
    assert {str(kind) for kind in Kind} == KINDS.keys()  # a line for each
    assert PAGE.read_text(encoding="utf-8") == page(), "python -m tests.house.sentences writes it anew"


def test_every_call_of_a_sentence_fills_its_holes_and_no_others():
    called = 0
    for tree, module in modules():
        named = {name: one for name, one in vars(module).items() if isinstance(one, Sentence)}
        for node in ast.walk(tree):
            if (isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in named
                    and all(one.arg for one in node.keywords)):
                given = {one.arg for one in node.keywords}
                assert given == set(named[node.func.id].holes), (module, node.lineno)
                called += 1
    assert called > 10


UNITS = replace(SYSTEMS["deg"], axes=Axes(("x", "y", "z"), ("major", "intermediate", "minor")))


def test_digits_units_axes_and_letters_are_put_in_when_it_is_printed():
    reason = Sentence("t", "about {axis}: |ω| ≤ {bound} after {time}, {angle} of {count} ({many})")(
        axis=Axis(3), bound=Rate(1.5), time=Time(600.0), angle=Angle(0.1), count=1200,
        many=(Axis(1), Axis(2)))
    assert str(reason) == ("about axis 3: |omega| <= 1.5 rad/s after 600 s, 0.1 rad of 1,200 "
                           "(axis 1 and axis 2)")
    assert UNITS.said(reason) == ("about the z axis: |ω| ≤ 85.944 deg/s after 10 min, 5.7296 deg of 1,200 "
                                  "(the x axis and the y axis)")
    assert reason.as_dict() == {"code": "t", "text": str(reason), "axis": 3, "bound": 1.5, "time": 600.0,
                                "angle": 0.1, "count": 1200, "many": [1, 2]}


def test_clauses_follow_and_are_left_out_again():
    first, last = Sentence("a", "first {n}")(n=1), Sentence("b", "last {n}")(n=2)
    both = first.then(last, ": ")
    assert str(both) == "first 1: last 2" and both.alone == first and first.then(None) == first
    assert both.as_dict()["then"] == [{"code": "b", "text": "last 2", "n": 2}]


@pytest.mark.parametrize("name", ["axis 3 after 200 s", "lambda 2", "t = 5 s", "omega1 rad/s", "{x}"])
def test_names_of_users_stay_as_they_are(name):
    reason = Sentence("named", "the tilt of {thruster}, {angle}")(thruster=name, angle=Angle(math.pi / 180))
    assert UNITS.said(reason) == f"the tilt of {name}, 1 deg"


@pytest.mark.parametrize("system", sorted(SYSTEMS))
@pytest.mark.parametrize("unit", ["rad/s", "rad", "s", "J", "1/s"])
def test_a_bound_that_is_read_back_is_never_beyond_the_number(system, unit):
    units = SYSTEMS[system]
    for value in 10.0 ** np.random.default_rng(5).uniform(-4, 4, 300):
        value = float(value)
        name, one = units.times(value) if unit == "s" else units.of(unit)
        for side in (1, -1):
            text = units.filled(Quantity(value, unit, side=side), 4)
            read = float(text.removesuffix(f" {name}")) / one
            assert side * (read - value) >= 0
            assert abs(read - value) <= 2e-3 * value


def test_rounding_outward_changes_nothing_that_is_printed_whole():
    assert [number(v, 4, side) for v in (0.25, 12.0, -3.5) for side in (1, -1)] == [
        "0.25", "0.25", "12", "12", "-3.5", "-3.5"]
    assert number(0.457951, 4, 1) == "0.458" and number(0.457951, 4, -1) == "0.4579"
    assert number(math.inf, 4, 1) == "inf"
    assert [number(v, 1, 1) for v in (1e-10, 1e-15, 0.1, 3e-7)] == ["1e-10", "1e-15", "0.1", "3e-07"]


def test_a_caveat_has_its_code_and_quantities_in_json():
    one = Caveat(Kind.TILT, Sentence("x", "tilted by {angle}")(angle=Angle(0.5)))
    assert key([one]) == {"caveats": [{"kind": "tilt", "words": "tilted by 0.5 rad", "code": "x",
                                       "angle": 0.5}]}


def test_an_axis_without_a_case_keeps_its_number():
    """By hand: no letter and no rank is known of it."""
    reason = Sentence("t", "about {axis} of {all}")(axis=Axis(1), all=(Axis(2), Axis(3)))
    assert SYSTEMS["deg"].said(reason) == "about axis 1 of axis 2 and axis 3"


def test_what_follows_is_rendered_each_by_itself():
    """By hand: pi/180 rad is a degree; words without quantities stay as they are, also behind a sentence."""
    reason = Sentence("t", "at {rate}")(rate=Rate(math.pi / 180)).then(old("turned by 3 rad"), ": ")
    assert SYSTEMS["deg"].said(reason) == "at 1 deg/s: turned by 3 rad"
    assert reason.as_dict()["then"] == [{"code": "", "text": "turned by 3 rad"}]
    known = Sentence("k", "bounded")().then(reason)
    assert known.says(reason.sentence) and known.without(reason.sentence) == Sentence("k", "bounded")()


@dataclass(frozen=True)
class Known(Reasoned):
    value: float
    more: int = 0


def test_what_derives_from_the_base_takes_words_and_reasons_and_is_compared_by_them():
    one, other = Known(1.0, reason="seen"), Known(1.0, 2, reason=Sentence("k", "at {rate}")(rate=Rate(2.0)))
    assert (one.because, other.because, other.more) == ("seen", "at 2 rad/s", 2)
    assert one == Known(1.0, reason=old("seen")) != replace(one, reason="not seen")
    assert pickle.loads(pickle.dumps(other)) == other and hash(other) == hash(replace(other))
    assert not Known(1.0, reason=None).reason and Known(1.0, reason=None).because == "" and one.reason
    with pytest.raises(TypeError):
        Known(1.0)  # nothing is known without a reason


def test_a_class_of_numbers_with_a_reason_is_compared_as_arrays_are():
    """`Compared` stands before `Reasoned` where both are bases: not by identity, and without a hash."""
    first, again = (FlatSpin("undecided", "exact", 1, 3, 1.0, 0.5, (0.0, 0.0, 0.5), 1.0, 0.5, 0.01,
                             reason="by hand") for _ in range(2))
    assert first == again != replace(again, reason="by eye") and FlatSpin.__hash__ is None
