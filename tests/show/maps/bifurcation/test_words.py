"""What the command tells of a diagram, and its pictures."""
from __future__ import annotations

import json

import pytest

import stabilab
from stabilab.commands import maps
from stabilab.errors import InputError
from stabilab.maps.bifurcation.plane import Wall
from stabilab.show import style
from stabilab.show.maps import bifurcation as words
from stabilab.show.maps import bifurcation_picture as picture
from stabilab.show.maps.bifurcation_picture import GAP, GLYPH, rows_apart
from tests.shared import CASES, SATELLITE

MINOR = CASES / "wheel-and-thruster.toml"


@pytest.fixture(scope="module")
def line():
    return stabilab.bifurcation(MINOR, {"torque[3]": "0:2000"})


@pytest.fixture(scope="module")
def plane():
    return stabilab.bifurcation(CASES / "middle-axis-double-well.toml", {"b": "0:4", "x[1]": "-3:3"})


def test_an_event_in_json_is_a_root_of_its_polynomial(line):
    told = json.loads(words.json(line))
    assert told["schema"] == "stabilab.bifurcation/1" and [piece["equilibria"]
                                                           for piece in told["pieces"]] == [4, 2, 0]
    for event in told["events"]:
        value, total = event["value"], 0
        sizes = [abs(int(c)) * value**n for n, c in enumerate(event["polynomial"])]
        total = sum(int(c) * value**n for n, c in enumerate(event["polynomial"]))
        assert abs(total) < 1e-12 * max(sizes)


def test_curves_of_a_plane_in_json_are_zero_at_its_cusps(plane):
    told = json.loads(words.json(plane))
    (curve,), (cusp,) = told["curves"], told["cusps"]
    terms = [int(term["coefficient"]) * cusp["at"][0]**term["powers"][0] * cusp["at"][1]**term["powers"][1]
             for term in curve]
    assert abs(sum(terms)) < 1e-12 * max(map(abs, terms))


def test_every_point_of_the_csv_is_an_equilibrium(line):
    rows = [row.split(",") for row in words.csv(line).splitlines()[1:]]
    assert len(rows) > 300
    for row in rows:
        torque, w1, w2 = (float(row[n]) for n in (0, 3, 4))
        # by hand: (D1 - D2) w1 w2 + l1 w2 + M3 = 0
        assert abs(500 * w1 * w2 + 100 * w2 + torque) < 1e-9 * (1 + torque)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("ending", [".png", ".svg", ".pdf"])
def test_pictures_are_the_same_bytes_each_time(line, plane, tmp_path, ending):
    for number, (draw, found) in enumerate(((picture, line), (picture, plane))):
        first, second = (draw.write(found, tmp_path / f"{number}-{n}{ending}").read_bytes() for n in (1, 2))
        assert first == second and len(first) > 3000


def test_where_curves_of_equilibria_are_no_number_of_changes_is_told(case_file):
    told = words.text(stabilab.bifurcation(case_file(SATELLITE), {"torque[3]": "-1:1"})).splitlines()[0]
    assert told == "case: 2 changes of stability for -1 ≤ torque[3] ≤ 1 N m; but curves of equilibria at 0 N m; on a principal axis at 0 N m"


def test_labels_take_the_lowest_row_with_room_and_none_where_no_row_has():
    wide = 5 * GLYPH * 10  # points of a text of five digits
    # by hand
    assert rows_apart((0, wide + GAP + 1, wide + GAP + 2, wide + GAP + 3), ("12345",) * 4, 10,
                      2) == [0, 0, 1, None]


def test_a_range_that_is_missing_is_asked_for_in_the_form_that_a_diagram_takes():
    with pytest.raises(InputError, match=r'expected KEY=FROM:TO, got "torque\[3\]"'):
        maps.bifurcation(MINOR, ["torque[3]"], False, None, None, None, False, False, False)


def _band(p, q, count):
    """A rectangle from p[0] to p[1] and q[0] to q[1]."""
    return {"p": [p[0], sum(p) / 2, p[1]], "low": [q[0]] * 3, "high": [q[1]] * 3, "count": count,
            "area": (p[1] - p[0]) * (q[1] - q[0])}


def test_small_regions_have_their_number_beside_them_and_those_without_room_are_named():
    """Places by hand; boxes by Matplotlib."""
    with style.drawing() as plt:
        figure, ax = plt.subplots(layout="constrained", figsize=(8, 6))
        ax.set(xlim=(0, 10), ylim=(0, 10))
        small = [[_band((at, at + 0.1), (5, 5.1), n)] for n, at in enumerate((0, 3, 9.9))]
        assert not picture.numbered(ax, [[_band((0, 10), (0, 5), 7)], *small])
        figure.draw_without_rendering()
        shown = {text.get_text(): text.get_window_extent() for text in ax.texts}
        assert set(shown) == {"7", "0", "1", "2"}
        frame = ax.get_window_extent()
        for text, box in shown.items():
            assert frame.x0 < box.x0 < box.x1 < frame.x1 and frame.y0 < box.y0 < box.y1 < frame.y1, text
            assert not any(box.overlaps(other) for name, other in shown.items() if name != text), text
        (line,) = picture.numbered(ax, [[_band((5 + n / 50, 5.01 + n / 50), (8, 8.01), n)] for n in range(40)])
        assert line.startswith("too small for a number: ") and "39 at (5.785, 8.005)" in line


def test_regions_of_one_number_are_apart_where_a_curve_parts_them():
    halves = [_band((0, 1), (0, 1), 1), _band((1, 2), (0, 1), 1)]
    assert list(map(len, picture.regions_of(halves, 1.0))) == [2]
    assert list(map(len, picture.regions_of(halves, 1.0, [Wall(1.0, 0.0, 1.0, ("axis",))]))) == [1, 1]
    assert list(map(len, picture.regions_of(halves, 1.0, [Wall(1.0, 0.0, 0.5, ("axis",))]))) == [2]
