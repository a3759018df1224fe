"""What the command tells of a diagram, and its pictures."""
from __future__ import annotations

import json

import pytest

import stabilab
from stabilab.show.maps.bifurcation import picture, plane_picture, plane_words, words
from tests.shared import CASES

MINOR = CASES / "wheel-and-thruster.toml"


@pytest.fixture(scope="module")
def line():
    return stabilab.bifurcation(MINOR, {"torque[3]": "0:2000"})


@pytest.fixture(scope="module")
def plane():
    return stabilab.bifurcation(CASES / "middle-axis-double-well.toml", {"b": "0:4", "x[1]": "-3:3"})


def test_the_first_line_is_the_answer(line, plane):
    first, second = (told.splitlines()[0] for told in (words.text(line), plane_words.text(plane)))
    assert first == ("wheel-and-thruster: 4 equilibria for 0 <= torque[3] < 1084.686668 N m, 2 for 1084.686668 < torque[3] < 1281.113057, none above: "
                     "folds at 1084.686668 and 1281.113057")
    assert second == "middle-axis-double-well: 2 or 4 equilibria over b and x[1]; curves: fold; cusp at (1.754765351, -0.2799433883)"


def test_an_event_in_json_is_a_root_of_its_polynomial(line):
    told = json.loads(words.json(line))
    assert told["schema"] == "stabilab.bifurcation/1" and [piece["equilibria"] for piece in told["pieces"]] == [4, 2, 0]
    for event in told["events"]:
        value, total = event["value"], 0
        sizes = [abs(int(c)) * value**n for n, c in enumerate(event["polynomial"])]
        total = sum(int(c) * value**n for n, c in enumerate(event["polynomial"]))
        assert abs(total) < 1e-12 * max(sizes)


def test_curves_of_a_plane_in_json_are_zero_at_its_cusps(plane):
    told = json.loads(plane_words.json(plane))
    (curve,), (cusp,) = told["curves"], told["cusps"]
    terms = [int(term["coefficient"]) * cusp["at"][0]**term["powers"][0] * cusp["at"][1]**term["powers"][1] for term in curve]
    assert abs(sum(terms)) < 1e-12 * max(map(abs, terms))


def test_every_point_of_the_csv_is_an_equilibrium(line):
    rows = [row.split(",") for row in words.csv(line).splitlines()[1:]]
    assert len(rows) > 300
    for row in rows:
        torque, w1, w2 = (float(row[n]) for n in (0, 3, 4))
        assert abs(500 * w1 * w2 + 100 * w2 + torque) < 1e-9 * (1 + torque)  # by hand: (D1 - D2) w1 w2 + l1 w2 + M3 = 0


@pytest.mark.parametrize("ending", [".png", ".svg", ".pdf"])
def test_pictures_are_the_same_bytes_each_time(line, plane, tmp_path, ending):
    for number, (draw, found) in enumerate(((picture, line), (plane_picture, plane))):
        first, second = (draw.write(found, tmp_path / f"{number}-{n}{ending}").read_bytes() for n in (1, 2))
        assert first == second and len(first) > 3000
