"""What public functions say of something that is no scene and no case."""
import inspect

import numpy as np
import pytest

import stabilab
from stabilab.errors import InputError
from stabilab.physics.effects.base import Effect
from tests.shared import CASES

STATE, TIMES = (0.1, 0.05, 0.02), (0.0, 1.0)
OF_A_SCENE = {"equilibria": (), "fate": (STATE,), "fate_grid": ([[0.1], [0.2], [0.3]],), "motion": (STATE,), "attitude": (STATE,), "angles": (STATE,),
              "extremes": (STATE,), "period": (STATE,),
              "spin_up": (STATE,), "separatrix": (), "time_to": (STATE, 1.0), "trajectory": (STATE, TIMES),
              "ensemble": ([STATE], TIMES),
              "simulate": (STATE, TIMES), "derive": (), "validity": (STATE,), "chaos": (STATE,)}
PLANE = {"x[1]": "0:1", "x[3]": "0:1"}
OF_A_CASE = {"stuck": (), "flat_spin": (), "compare": (), "theory": (), "when": (), "report": (),
             "sweep": ({"x[1]": "0:1:2"},), "atlas": (), "basin": (PLANE,), "bifurcation": ({"x[1]": "0:1"},),
             "percentiles": ()}


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
    with pytest.raises(stabilab.InputError,
                       match="x: no such file" if given == "x" else "expected a"):
        getattr(stabilab, name)(given, *(OF_A_SCENE | OF_A_CASE)[name])


def test_a_comparison_of_a_case_without_a_span_says_what_to_give(case_file):
    path = case_file("[body]\ninertia = [8.7, 8.6, 11.1]\nmass = 10\n[motion]\nangular_velocity = [0.01, 0, "
                     "0.28]\nattitude = [0, 0, 0]\n", "own")
    with pytest.raises(stabilab.InputError, match="span"):
        stabilab.compare(stabilab.load(path))


MADE = [value for name in stabilab.__all__ if inspect.isclass(value := getattr(stabilab, name))
        and (issubclass(value, Effect) or value in (stabilab.Body, stabilab.Scene, stabilab.ScaledGyrostat))]
NO_NUMBERS = (None, "x", b"1", [], (1, 2), {}, [None] * 3, 1j, float("nan"), "1/0", "1e999", 10**400, True,
              object, np.zeros((3, 3)), np.array(["1", "2"]))


@pytest.mark.parametrize("made", MADE, ids=lambda one: one.__name__)
def test_a_scene_s_parts_called_with_other_arguments_than_they_take_say_what_they_take(made):
    assert len(MADE) == 17
    expected = (
        rf"^{made.__name__}: .*; expected "
        rf"{made.__name__}\(.*{[*inspect.signature(made.__init__).parameters][-1]}.*\)$")
    with pytest.raises(stabilab.InputError, match=expected):
        made(other=1)
    # which takes any number of effects, and says itself that a body is missing
    if made is not stabilab.Scene:
        for given in ((), range(9)):
            with pytest.raises(stabilab.InputError, match=expected):
                made(*given)


@pytest.mark.parametrize("made", MADE, ids=lambda one: one.__name__)
@pytest.mark.parametrize("given", NO_NUMBERS, ids=lambda one: f"{one!r:.20}")
def test_a_scene_s_parts_made_of_no_numbers_are_bad_input_that_names_the_key(made, given):
    """In every place, the others holding what would do."""
    takes = [one.name for one in list(inspect.signature(made.__init__).parameters.values())[1:]
             if one.name != "ran"]  # of the program's own making
    fit = {"inertia": (3, 2, 2), "mass": 1, "slack": 0, "a": 1, "b": 2, "mu": (1, 0, 0), "moment": (1, 0, 0),
           "motor": (1, 0, 0), "duration": 1, "ran": 0,
           "vector": (1, 0, 0), "charge": 1,
           "field_strength": 1, "arm": 1, "angle": 0, "coefficient": 1, "density": 1, "viscosity": 1, "P0": 1,
           "law": "printed",
           "axis": (1, 0, 0), "place": (1, 0, 0), "line": (0, 0, 1), "stiffness": 1, "mass_of_body": 9,
           "strength": 1, "distance": 9, "weight": 1, "centre_of_mass": (0, 0, 1),
           "body": stabilab.Body((3, 2, 2)), "effects": ()}
    for place, name in enumerate(takes):
        if (given is None and name in ("mass", "slack", "distance", "duration")
                or name == "effects" and isinstance(given, (list, dict))):
            continue  # nothing is what may stand there
        if made is stabilab.RateDamper and getattr(given, "shape", ()) == (3, 3):
            continue  # a matrix is
        with pytest.raises(stabilab.InputError, match=r"^\w+: "):
            made(*(given if at == place else fit[one] for at, one in enumerate(takes)))


@pytest.mark.parametrize("make",
                         [lambda: stabilab.NewtonianField(1, 0), lambda: stabilab.NewtonianField(1, -7e6),
                          lambda: stabilab.Body((3, 2, 2), 0),
                                  lambda: stabilab.LiquidCavity.of_sphere(1000, 1, -0.1),
                          lambda: stabilab.Resistance(-1)])
def test_a_length_a_mass_and_a_resistance_below_zero_are_bad_input(make):
    with pytest.raises(stabilab.InputError, match="expected a (positive )?number"):
        make()


SCENES = {"bounded": stabilab.Scene(stabilab.Body((12, 9, 5)), stabilab.ConstantTorque((0, 0, 0.02))),
          "off the axes": stabilab.Scene(stabilab.Body((12, 9, 5)), stabilab.ConstantTorque((0.1, 0.2, 0.3)))}
OF_NUMBERS = {"fate": {"state", "states"}, "motion": {"state", "states", "span"},
              "extremes": {"state", "states", "span"}, "period": {"state", "states"}, "spin_up": {"state"},
              "chaos": {"states", "until"}, "separatrix": {"reach", "shape", "accuracy"},
              "time_to": {"states", "t_max", "work", "rate", "exact"},
              "trajectory": {"state", "times", "method", "rtol", "steps"},
              "ensemble": {"states", "times", "rtol", "workers"},
              "simulate": {"state", "times", "blocks", "method", "rtol"}}
FITTING = {"states": STATE, "state": STATE, "times": TIMES, "rate": 5.0, "t_max": 1.0}
OPTIONAL = {"span", "until", "reach", "shape", "accuracy", "t_max", "rtol", "steps", "blocks", "method",
            "exact"}


@pytest.mark.one_in(6)
@pytest.mark.parametrize("given", [*NO_NUMBERS, [[1, 2, 3], [4, 5]], [10**400, 0, 0], np.zeros((0, 3)),
                                   np.zeros((2, 2, 3)), [float("inf"), 0, 0], lambda: 0],
                         ids=lambda one: f"{one!r:.20}")
@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("name", OF_NUMBERS)
def test_what_is_no_number_no_state_and_no_time_is_bad_input_in_every_place_of_a_function(name, scene, given):
    """Nothing but InputError comes; what a place does take may come through (a truth value as a time, states
    in more rows, decimals as text)."""
    function = getattr(stabilab, name)
    for place in sorted(OF_NUMBERS[name]):
        if place in OPTIONAL and given is None:
            continue
        needed = ({one: FITTING[one] for one in inspect.signature(function).parameters if one in FITTING}
                  | {place: given})
        if "state" in needed and "states" in needed:  # one start, or many
            needed.pop("state" if place == "states" else "states")
        needed |= {"states": [STATE]} if name == "ensemble" and place != "states" else {}
        try:
            function(SCENES[scene], **needed)
        except stabilab.InputError as error:
            assert len(str(error)) < 500
        else:
            assert not (given is None or isinstance(given, (float, complex)) or callable(given)
                        or isinstance(given, str) and given != "1e999"), (place, given)


@pytest.mark.parametrize("digits", [0, 10_001, -1, 2.5, "x", True, [1]])
@pytest.mark.parametrize("name", ["fate", "extremes", "period"])
def test_digits_are_a_whole_number_from_1_to_10_000(name, digits):
    with pytest.raises(stabilab.InputError):
        getattr(stabilab, name)(SCENES["bounded"], STATE, digits=digits)


@pytest.mark.parametrize("given", [iter([1.0, 2.0]), object(), lambda: 1, map(float, "12")],
                         ids=["an iterator", "an object", "a function", "a map"])
def test_what_is_told_of_an_object_without_numbers_is_the_same_in_every_run(given):
    """Its address is another one each time."""
    scene = stabilab.Scene(stabilab.Body((3, 2, 1)), stabilab.ConstantTorque((0, 0, 1)))
    with pytest.raises(stabilab.InputError,
                       match=f"^times: expected numbers, got {type(given).__name__} that holds no numbers$"):
        stabilab.ensemble(scene, [STATE], given)


@pytest.mark.parametrize("ask", [lambda case: case.scene.quadratic(), stabilab.attitude])
def test_effects_that_an_answer_does_not_cover_have_their_article(ask):
    with pytest.raises(InputError, match="scene also has a rate damper"):
        ask(stabilab.load(CASES / "cubesat-3u-detumbling.toml"))
