"""Figure 1 of a paper shows what the scene of its case contains, and nothing else: data of the artists."""
from dataclasses import replace

import numpy as np
import pytest

from stabilab import Body, Charge, Scene, load
from stabilab.papers.figures.catalogue import figure
from stabilab.papers.table import cases_folder
from stabilab.physics.effects import REGISTRY
from stabilab.show import style
from stabilab.show.plot.body import PARTS, body

# paper -> what its own figure 1 shows besides the body, as each paper lists it in its problem's section
CONTENTS = {
    "constant-torque": {"momentum", "torque"},
    "charged": {"momentum", "torque", "force", "charge", "field"},
    "cavity": {"momentum", "torque", "charge", "field", "liquid", "resistance"},
    "top": {"momentum", "weight", "fixed point", "attracting centre"}}
CASES = {"constant-torque": "minor-axis-100", "charged": "charged-body", "cavity": "liquid-base",
         "top": "top-lx30-lz30"}
LABELS = set().union(*CONTENTS.values())


@pytest.fixture
def plt():
    with style.drawing() as found:
        yield found


def drawn(plt, paper):
    return figure(1, paper).draw(plt).axes[0]


def labels(ax):
    """The labels in words, without symbols and the names of the axes."""
    found = {text.get_text().strip() for text in ax.texts}
    return {word for word in LABELS for text in found if text.startswith(word)}, found


@pytest.mark.parametrize("paper", CONTENTS)
def test_the_model_has_what_the_paper_has_and_no_more(paper, plt):
    words, texts = labels(drawn(plt, paper))
    assert words == CONTENTS[paper]
    assert {"axis 1", "axis 2", "axis 3"} <= texts and len(texts) == 3 + len(CONTENTS[paper])


@pytest.mark.parametrize("paper", CONTENTS)
def test_the_box_has_the_moments_of_the_body(paper, plt):
    """A homogeneous box: D1 : D2 : D3 as the sums of the squares of the other two sides."""
    (box,) = [part for part in drawn(plt, paper).collections if len(getattr(part, "_faces", ())) == 6]
    corners = np.unique(np.round(np.concatenate(np.asarray(box._faces)), 12), axis=0)
    sides = np.ptp(corners, axis=0)
    assert len(corners) == 8 and sides.max() == pytest.approx(1)
    moments = (sides**2).sum() - sides**2
    D = np.array(load(cases_folder() / f"{CASES[paper]}.toml").physical.body.inertia)
    assert moments / moments.max() == pytest.approx(D / D.max(), rel=1e-10)


def arrows(ax):
    """Directions of the arrows, parallel ones once: shafts from start to tip."""
    found = []
    for part in ax.collections:
        if type(part).__name__ == "Line3DCollection":
            tip, start = part._segments3d[0]
            along = np.subtract(tip, start) / np.linalg.norm(np.subtract(tip, start))
            if all(np.linalg.norm(along - other) > 1e-6 for other in found):
                found.append(along)
    return found


@pytest.mark.parametrize("paper, vectors", [
    ("constant-torque", [(1, 0, 0), (0, 0, 1)]),
    ("charged", [(0, 0, 1), (1, 0, 0), (0, np.sin(0.37), np.cos(0.37))]),
    ("cavity", [(0, 0, 1), (0, 0, -1), (0, np.sin(0.3), np.cos(0.3)), (-9.51, 0, -9)]),
    ("top", [(1, 0, 1), (0.9999995, 0, 0.001)])])
def test_arrows_point_as_the_vectors_of_the_paper(paper, vectors, plt):
    """Data of the papers: lambda along 1, torque on the minor axis; eq. (13) ff. of the charged body; omega0
    = (1, 0, 1) of the liquid; Table 1 of the top with gamma0'' = 0.001."""
    found = arrows(drawn(plt, paper))
    assert len(found) == len(vectors)
    for vector in vectors:
        assert min(np.linalg.norm(d - np.divide(vector, np.linalg.norm(vector))) for d in found) < 1e-6


def test_every_effect_has_a_part():
    assert set(PARTS) == set(REGISTRY)


def test_the_charge_stands_at_its_arm_to_the_scale_of_a_body_with_a_mass(plt):
    """D1 = m (b^2 + c^2)/12: a box of 12 kg with moments (5, 5, 2) measures 1 x 1 x 2 m."""
    case = load(cases_folder() / "charged-body.toml")
    case = replace(case, physical=Scene(Body((5, 5, 2), mass=12), Charge(1, 1, 0.8, 0.1)))
    (ax,) = body(case, size=(7.2, 6.6), bare=True).figure.axes
    (ball,) = [line for line in ax.lines if line.get_marker() == "o"]
    assert np.ravel(ball.get_data_3d()) == pytest.approx([0, 0, 0.8 / 2])
