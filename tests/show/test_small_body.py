"""The body as a small drawing: beside the tiles of a page, on the start page and in the README."""
import re
from pathlib import Path

import numpy as np
from PIL import Image

import stabilab
from stabilab.show import style
from stabilab.show.axes import axes_of
from stabilab.show.plot import to_file
from stabilab.show.plot.body import body
from stabilab.show.plot.subject import subject
from stabilab.show.report import one_case
from tests.shared import CASES

ROOT = Path(__file__).parents[2]
SHOWN = 272  # px: 17rem, of head.html


def test_axes_are_labelled_by_letter_number_and_rank():
    """The ranks by the moments of the files, by hand: 2000, 1500, 1000 kg m^2; a full tensor has no letters."""
    full = lambda name: [axes_of(stabilab.load(CASES / f"{name}.toml")).full(n) for n in (1, 2, 3)]
    assert full("wheel-and-thruster") == ["x, 1, major", "y, 2, intermediate", "z, 3, minor"]
    assert full("space-station") == ["1, major", "2, intermediate", "3, minor"]
    assert full("minor-axis-100")[2].startswith("x3")
    with style.drawing():
        ax = body(CASES / "wheel-and-thruster.toml")
        labels = {text.get_text().strip(): text.get_color() for text in ax.texts}
        assert [labels[name] for name in full("wheel-and-thruster")] == list(style.AXES)


def test_a_small_body_has_letters_of_nine_pixels_and_no_legend(tmp_path):
    with style.drawing():
        ax = body(CASES / "wheel-and-thruster.toml", size=one_case.SMALL_BODY)
        wide = one_case.SMALL_BODY[0] * 72
        assert min(text.get_fontsize() for text in ax.texts) * SHOWN / wide >= 9
        assert not ax.figure.legends and {"M", r"$\lambda$"} <= {text.get_text().strip() for text in ax.texts}
    small = one_case.small_body(subject(CASES / "wheel-and-thruster.toml"), tmp_path, "a", "deg")
    assert (tmp_path / small["file"]).stat().st_size < 30_000
    drawn = np.asarray(Image.open(tmp_path / small["file"]).convert("L"))
    assert min(edge.min() for edge in (drawn[0], drawn[-1], drawn[:, 0], drawn[:, -1])) == 255  # nothing is cut
    assert small["size"] == [round(side * style.DPI) for side in one_case.SMALL_BODY]


def test_the_picture_of_the_readme_is_that_of_its_case(tmp_path):
    """To what another version of Matplotlib moves: a shade in the mean."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    case = stabilab.load(re.search(r"```toml\n(.*?)```", text, re.DOTALL)[1])
    made, *_ = to_file.write_all(case, tmp_path / "body.png", "body", one_case.SMALL_BODY, titled=False)
    drawn, shown = (np.asarray(Image.open(path).convert("L"), float) for path in (made, ROOT / "figures/body.png"))
    assert drawn.shape == shown.shape and np.abs(drawn - shown).mean() < 3
