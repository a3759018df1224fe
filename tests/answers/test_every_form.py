"""Every question takes every form of every kind of scene that the command of its name answers, and says the
same."""
import json
import math
import tomllib

import numpy as np
import pytest

import stabilab as program
from tests.shared import CASES

TEXTS = {
    "wheel motor": """[body]\ninertia = [3, 2, "1.5"]\n[effects.wheel_motor]\ntorque = ["0.01", 0, 0]
duration = "10 s"\n""",
    "damper": """[body]\ninertia = [3, 2, "1.5"]\n[effects.viscous_damper]\ninertia = "0.1"\ncoefficient = "0.01"\n""",
    "eddy currents": """[body]\ninertia = [3, 2, 1]\n[effects.eddy_currents]\ncoefficient = 1\nfield = 1\n""",
    "rate damper": """[body]\ninertia = [3, 2, 1]\n[effects.rate_damper]\ncoefficient = "0.1"\n""",
    "top": """[body]\ninertia = [2, 2, 1]\n[effects.gravity]\nweight = 1\ncentre_of_mass = [0, 0, 1]\n""",
    "off the axes": """[body]\ninertia = [12, 9, 5]\n[effects.constant_torque]\ntorque = ["0.01", "0.02", "0.02"]\n""",
    "on an axis": """[body]\ninertia = [12, 9, 5]\n[effects.gyrostat]\nmomentum = ["0.8", 0, 0]
[effects.constant_torque]\ntorque = [0, 0, "0.02"]\n""",
    "scaled": "[scaled]\na = \"0.6\"\nb = \"1.2\"\nmu = [0, 1, 0]\n",
    "tensor": """[body]\ninertia = [[12, 1, 0], [1, 9, 0], [0, 0, 7]]\n[effects.constant_torque]\ntorque = [0, 0, "0.02"]\n""",
}
RATES = ("1/10", "1/20", "9/10")
QUESTIONS = ("fate", "extremes", "period", "motion", "when", "attitude", "simulate", "equilibria", "chaos", "time_to")
COMMANDS = {"fate": ["fate"], "extremes": ["extremes"], "period": ["period"], "motion": ["classify"], "when": ["when", "--rate", "3"],
            "attitude": ["attitude"], "simulate": ["simulate", "--at", "0,1"], "equilibria": ["classify"]}
SPANS = ("fate", "extremes", "period", "motion", "when", "attitude")
OPTIONS = {"when": {"rate": "3"}, "time_to": {"rate": "3", "work": 10_000}, "simulate": {"times": [0.0, 1.0]},
           "chaos": {"until": 2.0}, "fate": {"follow": 30.0}, "extremes": {"follow": 30.0}, "period": {"follow": 30.0},
           "motion": {"follow": 30.0}}


def text_of(kind):
    key = "x" if kind == "scaled" else "angular_velocity"
    span = "tau = [0, 2]" if kind == "scaled" else "span = [0, 2]"
    vertical = "vertical = [0, 0, 1]\n" if "gravity" in TEXTS[kind] or "eddy" in TEXTS[kind] else ""
    return f"{TEXTS[kind]}[motion]\n{key} = {json.dumps(RATES)}\n{vertical}{span}\n"


def forms(kind, path):
    """(name, how a question is called) with every form of the case; of a scene, its start beside it."""
    text = text_of(kind)
    path.write_text(text, encoding="utf-8")
    case = program.load(text)
    start = case.exact_state
    blocks = {"omega": start, **case.blocks}
    return {"path": lambda ask, **options: ask(path, **options),
            "text": lambda ask, **options: ask(text, **options),
            "dict": lambda ask, **options: ask(tomllib.loads(text), **options),
            "scene and blocks": lambda ask, **options: ask(case.scene, state=blocks, **options),
            "case and blocks": lambda ask, **options: ask(case, state=blocks, **options),
            **({} if case.blocks else {"scene and text": lambda ask, **options: ask(
                case.scene, state=tuple(map(str, start)), **options)})}


SAID = ("fate", "level", "reason", "because", "values", "low", "high", "period", "extremes", "kind", "mode", "labels", "states", "state")


def told(found):
    """What an answer says, numbers to nine digits."""
    if isinstance(found, dict):
        return {name: told(one) for name, one in found.items()}
    if isinstance(found, (list, tuple, np.ndarray)):
        return [told(one) for one in found] if np.ndim(found) else told(np.asarray(found).item())
    if isinstance(found, float):
        return float(f"{found:.9g}") if math.isfinite(found) else str(found)
    return ({name: told(getattr(found, name)) for name in SAID if hasattr(found, name)} or str(found)
            if type(found).__module__.startswith("stabilab") and not hasattr(found, "word") else str(found))


def answered(call, ask, **options):
    try:
        return told(call(ask, **options))
    except program.InputError as error:
        return f"refused: {str(error).rpartition(': ')[2]}"


@pytest.mark.one_in(10)
@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("kind", TEXTS)
def test_every_form_of_every_kind_of_scene_has_the_same_answer(kind, question, tmp_path, stabilab):
    """Or the same error, in words as the command's."""
    ask, options = getattr(program, question), OPTIONS.get(question, {})
    case = program.load(text_of(kind))
    wanted = answered(lambda ask, **options: ask(case, **options), ask, **options)
    for name, call in forms(kind, tmp_path / "case.toml").items():
        given = options | ({"span": case.span} if "scene" in name and question in SPANS else {})
        if question != "equilibria" or " and " not in name:  # which have no start
            assert answered(call, ask, **given) == wanted, name
    if question in COMMANDS:
        code, _, error = stabilab(*COMMANDS[question], tmp_path / "case.toml", "--json")
        if str(wanted).startswith("refused"):
            assert code == 2 and wanted.removeprefix("refused: ")[:60] in error
        else:
            assert code in (0, 3), error


@pytest.mark.one_in(6)
@pytest.mark.parametrize("question", ["fate", "extremes", "period"])
@pytest.mark.parametrize("kind", TEXTS)
def test_many_starts_have_the_answers_of_each(kind, question):
    case, options = program.load(text_of(kind)), {"follow": 30.0}
    ask = getattr(program, question)
    rows = np.array([case.start, case.start]) * np.array([[1.0], [1.0]])
    rows[1, :3] *= 0.5
    many = ask(case, states=rows, **options)
    for n, row in enumerate(rows):
        one = ask(case, tuple(row.tolist()), **options)
        if question == "fate":
            assert (many.labels[n], many.axis[n], many.level[n]) == (one.labels, one.axis, one.level)
        else:
            # rows in doubles, one start in balls: both promise eleven digits
            np.testing.assert_allclose(np.asarray(many)[n], np.asarray(one), rtol=1e-10, atol=1e-12)


FILES = sorted(CASES.glob("*.toml"))


@pytest.mark.one_in(24)
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_python_answers_what_the_command_prints_as_json(path, stabilab):
    case = program.load(path)
    if case.state is None or case.swept or "[sweep]" in case.text:
        pytest.skip("no motion of its own")
    for question in ("fate", "extremes", "period"):
        code, out, error = stabilab(question, path, "--json")
        assert code == 0, error
        (wanted,), found = json.loads(out), getattr(case, question)()
        if question == "fate":
            assert (found.fate.word, found.sense or None, found.reason) == (
                wanted["fate"], wanted["sense"], wanted["because"])
            margin = found.margins.item()
            assert wanted["margin"] == (pytest.approx(margin, rel=1e-11) if math.isfinite(margin) else None)
        elif question == "period":
            # formulas and runs promise ten digits where nobody asks for more
            assert wanted["period"] is None and not 0 < float(found) < math.inf or float(
                found) == pytest.approx(wanted["period"], rel=1e-9)
        else:
            pairs = wanted["extremes"]
            assert np.isnan(found).all() if pairs is None else True
            for row, pair in zip(found, pairs or ()):
                size = max(abs(v) for v in row if math.isfinite(v)) if np.isfinite(row).any() else 1
                for one, other in zip(row, pair):
                    assert other == (pytest.approx(one, abs=1e-9 * size) if math.isfinite(one) else None)
        kinds = [one["kind"] for one in wanted["caveats"] if one["kind"] != "uncertain"]
        assert [one.kind for one in found.caveats if one.kind != "uncertain" and one.kind != "samples"] == [
            kind for kind in kinds if kind != "samples"], question
