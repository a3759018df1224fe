"""A diagram marks where the case itself is, in the unit of the range."""
import pytest

from stabilab.case.read import read_text
from stabilab.maps.bifurcation.ask import bifurcation
from stabilab.show import style
from stabilab.show.maps import bifurcation_picture as picture
from tests.shared import SATELLITE


def drawn(vary):
    found = bifurcation(read_text("tug.toml", SATELLITE), vary)
    with style.drawing() as plt:
        return picture.drawn(found, None, plt)


@pytest.mark.parametrize("text, value", [("0:0.05", 0.02), ("0:50 mN m", 20.0), ("0.1:0.2", None)])
def test_over_one_number_a_line_stands_at_the_value_of_the_file(text, value):
    figure = drawn({"torque[3]": text})
    own = [line.get_xdata()[0] for line in figure.axes[0].get_lines()
           if line.get_label() == "the case itself"]
    assert own == ([] if value is None else [pytest.approx(value)])


def test_over_two_numbers_a_mark_stands_at_both():
    figure = drawn({"torque[3]": "0:0.05", "momentum[1]": "0:2"})
    (own,) = [line for line in figure.axes[0].get_lines() if line.get_label() == "the case itself"]
    assert [*own.get_xdata(), *own.get_ydata()] == pytest.approx([0.02, 0.8])
