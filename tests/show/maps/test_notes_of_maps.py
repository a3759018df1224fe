"""What limits the answers of a map stands in its picture too, in the words of its command."""
import pytest

import stabilab
from stabilab.maps.atlas import asked, drawn
from stabilab.show import style
from stabilab.show.maps import atlas_picture, bifurcation_picture, rotations
from stabilab.show.units import units_of
from tests.shared import CASES

ROWS = {"x[1]": "-4:4:3", "x[3]": "-3:3:3"}


def note(figure):
    return " ".join(figure.legends[0].get_title().get_text().split())


def test_a_picture_of_basins_has_the_condition_of_its_points():
    with style.drawing():
        ax = stabilab.plot.basin(stabilab.basin(CASES / "minor-axis-100.toml", ROWS, depth=0))
        assert note(ax.figure).startswith("holds only while the torque is exactly along the x3 axis (")


def test_a_picture_of_a_file_has_the_caveats_of_the_file(stabilab, tmp_path, monkeypatch):
    file, figures = tmp_path / "a.nc", []
    assert stabilab("sweep", CASES / "minor-axis-100.toml", "--vary", "x[1]=-4:4:5", "--vary", "x[3]=-3:3:5",
                    "--out", file)[0] == 0
    monkeypatch.setattr(style, "save", lambda figure, path, dpi: figures.append(note(figure)) or path)
    for kind in ("fate", "margin"):
        assert stabilab("plot", file, "--kind", kind, "--out", tmp_path / "a.png")[0] == 0
    assert len(figures) == 2 and all(text.startswith("holds only while the torque is") for text in figures)


def test_pictures_of_bifurcations_have_what_limits_their_case():
    diagram = stabilab.bifurcation(CASES / "uncertain-separatrix.toml", {"torque[3]": "0:3"})
    with style.drawing() as plt:
        assert note(bifurcation_picture.drawn(diagram, None, plt)) == "of the middles of the uncertain numbers"


@pytest.mark.parametrize("names", [("saddle", "maximum")])
def test_saddles_and_the_most_energy_are_told_apart(names):
    looks = [rotations.LOOKS[name] | {"marker": "."} | rotations.DOTS.get(name, {}) for name in names]
    assert looks[0]["marker"] != looks[1]["marker"]


@pytest.mark.slow
def test_a_picture_of_directions_names_areas_beside_thrusters_and_has_caveats():
    """The tolerance and the misalignment of the case's thruster; words by their drawn places."""
    case = stabilab.load(CASES / "geostationary-22n.toml")
    with drawn(asked(case, level=1, refine=0), workers=1) as found, style.drawing() as plt:
        figure = atlas_picture.drawn(found, units_of(case), atlas_picture.chosen(found, None), None, plt)
        assert "the tolerance of the force of R3" in note(figure)
        figure.draw_without_rendering()
        boxes = [text.get_window_extent() for text in figure.axes[0].texts if text.get_fontweight() == "bold"]
        assert len(boxes) == 4
        assert not any(a.overlaps(b) for n, a in enumerate(boxes) for b in boxes[:n])
        assert "|ωx|, |ωy| or |ωz| = 5 deg/s" in figure.axes[-1].get_xlabel()
