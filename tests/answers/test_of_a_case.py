"""The public functions take a case for its scene and its own start, and name the type of anything else."""
from pathlib import Path

import numpy as np
import pytest

import stabilab

CASE = stabilab.load(Path(__file__).parents[2] / "cases" / "thruster-stuck-major-axis.toml")


@pytest.mark.parametrize("ask", [stabilab.fate, stabilab.period, stabilab.extremes, stabilab.equilibria,
                                 stabilab.motion, stabilab.stuck,
                                 lambda given: stabilab.simulate(given, (1, 0, 0), [0.0, 1.0])])
@pytest.mark.parametrize("wrong, named",
                         [({"body": list(range(500))}, "body: expected a table [body], got a list"),
                          (np.zeros(300), "type ndarray"), ("cases/x.toml", "cases/x.toml: no such file")])
def test_a_wrong_type_is_named_and_never_shown_whole(ask, wrong, named):
    with pytest.raises(stabilab.InputError) as error:
        ask(wrong)
    assert named in str(error.value) and len(str(error.value)) < 160


def test_a_case_shows_itself_in_one_short_line():
    assert repr(CASE).startswith("Case(") and "thruster-stuck-major-axis.toml: physical, state (" in repr(
        CASE) and len(repr(CASE)) < 200


def test_a_scene_alone_needs_a_state():
    for ask in (stabilab.fate, stabilab.period, stabilab.extremes, stabilab.motion,
                lambda scene: stabilab.simulate(scene, times=[0, 1])):
        with pytest.raises(stabilab.InputError, match="state: expected"):
            ask(CASE.scene)
    with pytest.raises(stabilab.InputError, match="times: expected"):
        stabilab.simulate(CASE.scene, (1, 0, 0))
