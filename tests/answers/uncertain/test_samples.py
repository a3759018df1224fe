"""Uncertain numbers beside products of inertia and for a flat body: by samples, told as such, against NumPy.
"""
import json

import numpy as np
import pytest

import stabilab as program
from stabilab.answers.motion import Needs, motion
from stabilab.answers.uncertain.boxes import box_of
from stabilab.answers.uncertain.fate import uncertain
from stabilab.answers.uncertain.search import SAMPLE, SEED
from stabilab.case.read import load

OBLIQUE = """[body]
inertia = ["20 +- 1 %", 15, "10 +- 2 %"]
products = {{xy = 0.5, yz = {yz}, convention = "positive"}}
[effects.gyrostat]
momentum = ["0.5 +- 0.1", 0.25, 0]
[effects.constant_torque]
torque = [0, 0, "0.5 +- 10 %"]
[motion]
angular_velocity = [0.5, 0.2, "0.3 +- 0.1"]
"""


@pytest.mark.parametrize("yz", [0, 0.7])
def test_a_point_beside_products_is_the_body_of_its_tensor(case_file, yz):
    """Rates and energy in the frame of the file by NumPy: I w' = (I w + h) x w + M; moments by its
    eigenvalues."""
    box = box_of(load(case_file(OBLIQUE.format(yz=yz))))
    rng = np.random.default_rng(5)
    for point in rng.uniform(-1, 1, (6, len(box.places))):
        values = {name: np.array([float(v) for v in row]) for name, row in box.values(point).items()}
        a, b, c, d, e = point
        assert values["inertia"] == pytest.approx([20 + 0.2 * a, 15, 10 + 0.2 * b])
        assert values["products"] == pytest.approx([-0.5, 0, -yz])
        assert values["momentum"] == pytest.approx([0.5 + 0.1 * c, 0.25, 0])
        assert values["torque"] == pytest.approx([0, 0, 0.5 + 0.05 * d])
        xy, xz, far = values["products"]
        tensor = np.diag(values["inertia"]) + [[0, xy, xz], [xy, 0, far], [xz, far, 0]]
        w = values["state"]
        assert w == pytest.approx([0.5, 0.2, 0.3 + 0.1 * e])
        scene, state = box.at(point)
        assert sorted(scene.body.inertia) == pytest.approx(np.linalg.eigvalsh(tensor), rel=1e-13)
        slope = np.linalg.solve(tensor, np.cross(tensor @ w + values["momentum"], w) + values["torque"])
        run = program.simulate(scene, state, [-1e-5, 1e-5]).state["omega"]
        assert np.linalg.norm((run[1] - run[0]) / 2e-5) == pytest.approx(np.linalg.norm(slope), rel=1e-7)
        assert np.array(scene.body.inertia) @ np.square(state) == pytest.approx(w @ tensor @ w, rel=1e-13)


def test_beside_products_the_fate_is_by_samples_with_number_seed_and_quantiles(case_file, stabilab):
    text = OBLIQUE.format(yz=0).replace("[\"0.5 +- 0.1\", 0.25, 0]",
                                        "[0, 0, 0]").replace("0.5 +- 10 %", "0.8 +- 10 %")
    path = case_file(text)
    found = uncertain(load(path), ("fate",))
    over, box = found.fate, box_of(load(path))
    points = np.random.default_rng(SEED).uniform(-1, 1, (SAMPLE, len(box.places)))
    # one by one, where the samples ask arrays
    motions = [motion(*box.at(point), needs=Needs.QUICK) for point in points]
    assert {m.fate.word for m in motions} == {"spin-up"} and over.samples.counts == {over.verdict: SAMPLE}
    assert over.samples.margins == pytest.approx(np.quantile([m.margin_energy for m in motions],
                                                             (0.05, 0.5, 0.95)), rel=1e-9)
    code, out, _ = stabilab("fate", path, "--json", "--strict")
    told = json.loads(out)[0]["uncertain"]["fate"]
    assert code == 3 and told["answer"] == "sampled" and told["samples"]["number"] == SAMPLE and told[
        "samples"]["seed"] == SEED
    assert told["samples"]["margin_quantiles"] == list(over.samples.margins)
    assert f"of 64 sampled points (seed {SEED})" in told["because"] and "quantiles" in told["because"] and [
        one.kind for one in found.caveats] == ["samples"]


def test_the_first_line_says_that_they_are_samples(case_file, stabilab):
    text = OBLIQUE.format(yz=0.1).replace("0.5 +- 10 %", "0").replace('["0.5 +- 0.1", 0.25, 0]', "[0, 0, 0]")
    code, out, _ = stabilab("fate", case_file(text))
    assert code == 0
    assert out.splitlines()[0].endswith(", uncertainties sampled")
    law = "[effects.liquid_cavity]\ndensity = 1\nviscosity = 1e-6\nradius = 0.1\n"  # a warning stands before the answer
    law = f'[body]\ninertia = [3, "2 +- 10 %", 1]\n{law}[motion]\nangular_velocity = ["1 +- 0.1", 0.2, 0.1]\n'
    assert ", uncertainties undecided" in stabilab("fate", case_file(law))[1].splitlines()[0]
    assert "the fate is the same at 64 sampled points and 8 corners within the uncertainties, without a proof" in out


def test_beside_products_two_fates_in_the_box_are_two_witnesses(case_file):
    over = uncertain(load(case_file(OBLIQUE.format(yz=0).replace("0.3 +- 0.1",
                                                             "0.3 +- 1.5").replace("[\"0.5 +- 0.1\", "
                                                                                   "0.25, 0]", "[0, 0, 0]")
                                .replace("0.5 +- 10 %", "0.2 +- 10 %"))), ("fate",)).fate
    assert over.answer == "depends" and len({w.verdict
                                             for w in over.witnesses}) == 2 == len(over.samples.counts)


def test_an_uncertain_flat_body_is_answered_by_proof(case_file):
    """diag(1, 2, 3) is a plate; with any uncertainty the box has bodies on both sides of the triangle
    inequality."""
    path = case_file('[body]\ninertia = ["3 +- 1 %", "2 +- 1 %", "1 +- 1 %"]\n[effects.constant_torque]\ntorque '
                 '= [0, 0, 0.001]\n'
                 "[motion]\nangular_velocity = [1, 0.1, 0]\n")
    case = load(path)
    over = uncertain(case, ("fate",)).fate
    assert {found.kind for found in case.caveats} == {"uncertain"}
    assert (over.answer, over.verdict) == ("holds", "bounded") and over.samples is None
