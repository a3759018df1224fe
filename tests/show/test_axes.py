"""An axis has one name and one sign in every command: beside a run of Euler's equations in the frame of the
file, typed in here once more."""
import itertools
import json
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import load
from stabilab.answers.stuck.ask import stuck as ask
from stabilab.numbers.principal import IDENTITY, PrincipalAxes
from stabilab.show import limiting
from stabilab.show.axes import PLAIN, axes_of
from stabilab.show.data import as_json
from stabilab.show.text import stuck as shown
from stabilab.show.units import units_of
from tests.oracles.rigid import tensor
from tests.shared import in_one_line

MOMENTS = (100, 90, 40)
TEXT = """[body]
inertia = {J}
[effects.constant_torque]
torque = {M}
[motion]
angular_velocity = {start}
span = [0, 100]
[limits]
rate = 2
"""
# over 3: rotations in rationals
TURNS = ([[2, -1, 2], [2, 2, -1], [-1, 2, 2]], [[1, 2, 2], [2, 1, -2], [-2, 2, -1]])
# of the scenes: two orders of a diagonal tensor and a full one, against their axes and along them
QUICK = (1, 6, 13)
RANKS = ("major", "intermediate", "minor")


def scenes():
    """(name, tensor, torque, start) in the frame of the file. The torque is along a principal axis, which a
    faster spin about it follows."""
    found = []
    for order in itertools.permutations(MOMENTS):
        for rank, sign in ((0, 1), (2, -1)):
            along = sign * np.eye(3)[order.index(MOMENTS[rank])]
            found.append((f"{order} about {RANKS[rank]} {sign:+d}", np.diag(order), along))
    for n, turn in enumerate(TURNS):
        R = np.array(turn) / 3
        J = R.T @ np.diag(MOMENTS) @ R
        found += [(f"turn {n} about {RANKS[rank]} {sign:+d}", J, sign * R[rank]) for rank in (0, 2)
                  for sign in (1, -1)]
    return found


def file_of(case_file, J, along, speed=1.0):
    """A case, and the direction along which omega grows there by DOP853: of J omega' = M + J omega x omega,
    all in the frame of the file."""
    # ninths are exact, and the tensor's entries are ninths
    exact = lambda values: "[" + ", ".join(f'"{round(9 * v)}/9"' for v in values) + "]"
    M = np.round(9 * 0.6 * along * (5 / 3)) / 9 if np.count_nonzero(along) > 1 else along
    start = speed * along + np.cross(along, [0.01, 0.02, 0.03])
    rows = [exact(row) for row in J]
    inertia = "[" + ", ".join(rows) + "]" if np.count_nonzero(J - np.diag(np.diag(J))) else exact(np.diag(J))
    path = case_file(TEXT.format(J=inertia, M=exact(M), start=list(map(float, start))), "own")
    run = solve_ivp(tensor(J, torque=M), (0, 150), start, "DOP853", rtol=1e-8,
                    atol=1e-10)
    return path, run.y[:, -1] / np.linalg.norm(run.y[:, -1])


def agrees(told, axes, grows, word):
    """Whether the numbers, name and direction of spin of a JSON object are those of the run."""
    along = np.array(told["axis_direction"])
    assert told["sense"] * along @ grows > 0.999, (told, grows)
    assert word in told["axis_name"] and np.array_equal(axes[told["axis"] - 1], along)


@pytest.mark.parametrize("name, J, along",
                         [pytest.param(*one, id=one[0], marks=[pytest.mark.slow] * (n not in QUICK)) for n,
                          one in enumerate(scenes())])
def test_every_command_names_the_axis_along_which_a_run_grows(stabilab, case_file, name, J, along):
    path, grows = file_of(case_file, J, along)
    moments, word = sorted(np.linalg.eigvalsh(J), reverse=True), name.split()[-2]
    assert grows @ J @ grows == pytest.approx(moments[RANKS.index(word)], rel=1e-3)
    diagonal = not name.startswith("turn")
    case = load(path)
    found = ask(case)  # once for all that is told of it
    stuck = json.loads(as_json(shown.as_dict(case, found)))
    fate, classified = (json.loads(stabilab(command, path, "--json")[1])[0]
                        for command in ("fate", "classify"))
    row = stuck["rows"][0]
    axes = np.eye(3) if diagonal else np.array(fate["frame"]["axes"])
    agrees(fate, axes, grows, word)
    agrees(classified["motion"], axes, grows, word)
    agrees(row, np.array(stuck["principal"]["axes"]), grows, word)
    assert fate["axis"] == row["axis"] == classified["motion"]["axis"] and np.array_equal(
        axes, stuck["principal"]["axes"])
    assert row["direction"] == pytest.approx(grows, abs=0.05) and stuck["schema"] == "stabilab.stuck/2"
    letter = "xyz"[np.abs(grows).argmax()]
    texts = [shown.text(case, found, units_of(case)),
             *(stabilab(command, path)[1] for command in ("fate", "classify"))]
    for first in map(in_one_line, texts):
        if diagonal:
            sense = "positive" if grows["xyz".index(letter)] > 0 else "negative"
            assert f"SPINS UP about {letter} ({word} axis), {sense} direction" in first
        else:
            seen = re.search(rf"(?:SPINS UP about the {word} axis, (positive|negative) direction.*?the {word} axis is "
                             rf"|SPINS UP about the {word} axis, )\((.*?), (.*?), (.*?)\) in the file's frame"
                             rf"(?:, (positive|negative) direction)?", first)
            assert {"positive": 1, "negative": -1}[seen[1] or seen[5]] * np.array(seen.groups()[1:4], float) @ grows > 0.998
    head, lines = shown.CSV
    written = limiting.table(head, [(case, (), lines(case, found))])
    cells = dict(zip(*(line.split(",") for line in written.splitlines())))
    assert (cells["axis"], cells["axis_name"],
            cells["sense"]) == (str(row["axis"]), row["axis_name"], str(row["sense"]))


class Plain:
    """What `axes_of` asks of a case."""

    def __init__(self, moments, axes=IDENTITY, variables="physical"):
        self.variables, self.frame = variables, PrincipalAxes(moments, axes, True)
        self.scene = type("Scene", (), {"body": type("Body", (), {"exact": moments})})


@pytest.mark.parametrize("moments, names", [
    ((3, 2, 1), ("x (major)", "y (intermediate)", "z (minor)")),
    ((1, 3, 2), ("x (minor)", "y (major)", "z (intermediate)")),
    ((2, 3, 2), ("x (transverse)", "y (symmetry)", "z (transverse)")), ((2, 2, 2), ("x", "y", "z"))])
def test_words_are_those_of_the_moments_and_none_where_all_are_alike(moments, names):
    assert tuple(map(axes_of(Plain(moments)).name, (1, 2, 3))) == names
    assert tuple(map(axes_of(Plain(moments, variables="scaled")).name, (1, 2, 3))) == ("x1", "x2", "x3")


def test_sentences_have_names_for_numbers_and_scenes_without_a_file_keep_these():
    turned = axes_of(Plain((2, 2, 1), ((0, 1, 0), (0, 0, 1), (1, 0, 0))))
    words = "spin about axis 3, not axes 1 and 2; the torque is on principal axis 3"
    assert axes_of(Plain((3, 2,
                          1))).sentence(
                              words) == "spin about the z axis, not the x axis and the y axis; the torque is on the z axis"
    assert turned.sentence("about axis 3") == "about the symmetry axis" and turned.sentence(
        "on axis 1") == "on the transverse axis (0.000, 1.000, 0.000)"
    assert turned.signed(1, -1) == "-transverse 1" and turned.signed(3, 1) == "+symmetry"
    assert turned.signed(0, 0) == ""
    assert PLAIN.sentence(words) == words and PLAIN.whole(2) == "axis 2"
