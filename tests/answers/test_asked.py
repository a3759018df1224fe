"""What public functions say of something that is no scene and no case."""
import inspect

import pytest

import stabilab

STATE, TIMES = (0.1, 0.05, 0.02), (0.0, 1.0)
OF_A_SCENE = {"equilibria": (), "fate": (STATE,), "fate_grid": ([[0.1], [0.2], [0.3]],), "motion": (STATE,), "extremes": (STATE,), "period": (STATE,),
              "spin_up": (STATE,), "separatrix": (), "time_to": (STATE, 1.0), "trajectory": (STATE, TIMES), "ensemble": ([STATE], TIMES),
              "simulate": (STATE, TIMES), "derive": (), "validity": (STATE,), "chaos": (STATE,)}
PLANE = {"x[1]": "0:1", "x[3]": "0:1"}
OF_A_FILE = {"sweep": ({"x[1]": "0:1:2"},), "atlas": (), "basin": (PLANE,), "bifurcation": ({"x[1]": "0:1"},)}  # which take the path of a case file too
OF_A_CASE = {"stuck": (), "compare": (), "theory": ()} | OF_A_FILE


def test_every_public_function_of_a_scene_or_a_case_is_asked_here():
    """By the name of its first argument."""
    first = {}
    for name in stabilab.__all__:
        if inspect.isfunction(value := getattr(stabilab, name)):
            first.setdefault(next(iter(inspect.signature(value).parameters), ""), set()).add(name)
    assert first["scene"] == set(OF_A_SCENE) and first["case"] == set(OF_A_CASE)


@pytest.mark.parametrize("given", ["x", None, {}, (1, 2, 3)], ids=repr)
@pytest.mark.parametrize("name", [*OF_A_SCENE, *OF_A_CASE])
def test_what_is_no_scene_and_no_case_is_bad_input_that_says_what_is_expected(name, given):
    with pytest.raises(stabilab.InputError, match="x: no such file" if given == "x" and name in OF_A_FILE else "expected a"):
        getattr(stabilab, name)(given, *(OF_A_SCENE | OF_A_CASE)[name])


def test_a_comparison_of_a_case_without_a_span_says_what_to_give(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text("[body]\ninertia = [8.7, 8.6, 11.1]\nmass = 10\n[motion]\nangular_velocity = [0.01, 0, 0.28]\nattitude = [0, 0, 0]\n")
    with pytest.raises(stabilab.InputError, match="span"):
        stabilab.compare(stabilab.load(path))
