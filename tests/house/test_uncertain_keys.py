"""Every key of a case file that may be uncertain, every command and every view: each says that the number has
an uncertainty, by what it does to the answer or by the words that it is not looked at.

The table is made of the program's own lists: the keys that `case` reads with an uncertainty, the commands
that take a case with their options. A key or a command that is added is in it by itself."""
from __future__ import annotations

import inspect
import json
import re
from fractions import Fraction

import pytest

import stabilab as package
from stabilab.case.hardware import THRUSTER
from stabilab.case.read import load
from stabilab.case.table import UNCERTAIN_KEYS, may_be_uncertain
from stabilab.case.write import text_of
from stabilab.cli import whole
from stabilab.errors import InputError
from stabilab.physics.effects import REGISTRY, effect_class
from stabilab.show.explore.session import Session
from stabilab.show.report import one_case
from tests.shared import later
from tests.show.explore.test_session import ask

BODY = {"body": {"inertia": [100, 90, 40]}}
START = {"motion": {"angular_velocity": ["0.1", "0.02", "0.01"], "span": [0, 50]}}
FORCE = {"name": "A", "position": ["0.1", 0, "0.05"], "direction": [0, 1, 0], "force": "0.5", "stuck": True}
FORMS = {  # cases that together have every key; each is asked with one number uncertain
    "torque": BODY | START | {"effects": {"gyrostat": {"momentum": [3, 0, 0]},
                                          "constant_torque": {"torque": [0, 0, "0.05"]}}},
    "mu": BODY | {"motion": {"x": ["0.1", "0.2", "0.3"], "tau": [0, 10]},
                  "effects": {"gyrostat": {"momentum": [3, 0, 0]}, "constant_torque": {"mu": [0, 0, 1]}}},
    "scaled": {"scaled": {"a": "0.2", "b": "0.4", "mu": [0, 0, 1]},
               "motion": {"x": ["0.1", "0.2", "0.1"], "tau": [0, 10]}},
    "tumbling": BODY | {"motion": {"rotation_period": 40, "precession_period": 30, "mode": "long-axis",
                                   "span": [0, 50]}},
    "tumbling by its cone": BODY | {"motion": {"precession_period": 30, "amplitude": "0.5",
                                               "mode": "long-axis", "span": [0, 50]}},
    "spinning": BODY | {"motion": {"spin": "0.1", "axis": [0, 0, 1], "nutation": "0.2", "span": [0, 50]},
                        "effects": {"constant_torque": {"torque": [0, 0, "0.05"]}}},
    "damper wheel": BODY | START | {"effects": {"damper_wheel": {"inertia": 3, "coefficient": 1, "axis": [0, 1, 1]}}},
    "sprung wheel": BODY | START | {"effects": {"damper_wheel": {"inertia": 3, "coefficient": 1, "axis": [0, 1, 1],
                                                                 "stiffness": 2}}},
    "damper": BODY | START | {"effects": {"viscous_damper": {"inertia": 3, "coefficient": 1}}},
    "thruster": BODY | START | {"thrusters": [FORCE]},
    "burning": BODY | START | {"thrusters": [{name: value for name, value in FORCE.items() if name != "stuck"}
                                             | {"start": 0, "stop": 20}]},
    "orbit": {"body": {"inertia": [100, 90, 40]}, "circular_orbit": {"altitude": 700000},
              "effects": {"gyrostat": {"momentum": [3, 0, 0]}}},
    "wheel": BODY | START | {"wheels": [{"name": "W", "axis": [1, 0, 0], "inertia": "0.01", "speed": 300}],
                             "effects": {"constant_torque": {"torque": [0, 0, "0.05"]}}},
    "wheel's momentum": BODY | START | {"wheels": [{"axis": [1, 0, 0], "momentum": 3}]},
    "leaning top": {"body": {"inertia": [15, 15, 10]}, "effects": {"gravity": {"weight": 20,
                                                                               "centre_of_mass": [0, 0, "0.5"]}},
                    "motion": {"spin": 20, "lean": "0.6", "precession": "slow", "span": [0, 1]}},
    "top": {"body": {"inertia": [15, 15, 10]}, "effects": {"gravity": {"weight": 20,
                                                                       "centre_of_mass": [0, 0, "0.5"]}},
            "motion": {"angular_velocity": ["0.1", 0, 20], "vertical": ["0.6", 0, "0.8"], "span": [0, 1]}},
}
FIELD = {"motion": START["motion"] | {"vertical": ["0.6", 0, "0.8"]}}
# a key of each other effect alone: their numbers are read, and what is not looked at is said, in the same places
OTHERS = {
    "products": {"body": BODY["body"] | {"products": {"xy": 1, "xz": 2, "yz": -1, "convention": "negative"}}} | START,
    "damper mass": {"body": BODY["body"] | {"mass": 50}} | START | {"effects": {"damper_mass": {
        "mass": 1, "place": ["0.5", 0, 0], "line": [0, 0, 1], "stiffness": 2, "coefficient": "0.3"}}},
    "rate damper": BODY | START | {"effects": {"rate_damper": {"coefficient": "0.5"}}},
    "resistance": BODY | START | {"effects": {"resistance": {"coefficient": "0.01"}}},
    "eddy currents": BODY | FIELD | {"effects": {"eddy_currents": {"coefficient": 1, "field": "0.5"}}},
    "liquid": BODY | START | {"effects": {"liquid_cavity": {"density": 1000, "viscosity": "0.01", "radius": "0.1"}}},
    "charged": BODY | START | {"effects": {"charge": {"charge": "0.01", "field": 1, "arm": "0.5", "angle": "0.3"}}},
    "motor": BODY | START | {"effects": {"gyrostat": {"momentum": [3, 0, 0]},
                                         "wheel_motor": {"torque": ["0.1", 0, 0], "duration": 5}}},
    "newtonian": BODY | FIELD | {"effects": {"newtonian_field": {"lambda": 3, "R": 100}}},
    "strength": BODY | FIELD | {"effects": {"newtonian_field": {"strength": "1e-6"}}},
    "liquid by P0": BODY | START | {"effects": {"liquid_cavity": {"density": 1000, "viscosity": "0.01", "P0": "1e-6"}}},
    **{f"orbit by {key}": {"body": BODY["body"], "circular_orbit": {key: value}}
       for key, value in (("rate", "0.001"), ("period", 6000), ("radius", 7000000))},
    "forced": {"body": BODY["body"] | {"mass": 50}} | START | {"effects": {"body_force": {"force": [1, 0, 0]}}},
}
EXTRA = {"force_tolerance": "30 %", "misalignment": "2 deg"}  # keys that say by themselves what is uncertain
WORDS = {"misalignment": "tilt|misalignment"}
SAID = r"uncertain numbers|uncertainties|\buncertain: |\"uncertain\": \{|tolerance|with the force of A within"
UNSAID = re.compile(r'uncertain_|"tolerances": null')  # names of keys, which say nothing
# options without which a command asks nothing, or is slow
OPTIONS = {
    "when": {"rate": "{}"}, "burn": {"below": "8 deg/s", "stop": "20 s"}, "simulate": {"at": "1"},
    "chaos": {"until": "50"}, "reference": {"at": "1", "digits": "9"}, "precision": {"quick": None},
    "sweep": {"vary": "{}"}, "basin": {"vary": "{}", "depth": "0"}, "bifurcation": {"vary": "{}"},
    "atlas": {"level": "0", "refine": "0"},
}
QUICK = (("extremes", "json"), ("show", ""), ("orbit", ""), ("orbit", "json"))  # run by default
DEAR = (("precision", ""), ("precision", "csv"))  # a minute and a half each: its JSON is slow, these are long
# what a view does with a caveat is the same for every caveat (test_no_view_loses_a_caveat): beside the JSON of a
# command its other views are for the long tests
VARIED = {  # of each form, what is varied that stays certain
    "torque": "effects.gyrostat.momentum[2]", "mu": "motion.x[3]", "scaled": "motion.x[3]",
    "tumbling": "motion.span[1]", "tumbling by its cone": "motion.span[1]", "spinning": "motion.span[1]",
    "wheel": "motion.angular_velocity[3]", "wheel's momentum": "motion.angular_velocity[3]",
    "damper": "motion.angular_velocity[3]", "damper wheel": "motion.angular_velocity[3]",
    "sprung wheel": "motion.angular_velocity[3]",
    "thruster": "motion.angular_velocity[3]",
    "burning": "motion.angular_velocity[3]", "orbit": "effects.gyrostat.momentum[2]",
    "top": "motion.angular_velocity[3]", "leaning top": "motion.span[1]"}
# commands whose answer is a file: pages and the explorer have tests of their own below
DRAWN = {"plot": "pictures (tests/show/test_plots.py)", "surface": "meshes", "report": "the page below",
         "explore": "the session below", "verify": "certificates",
         "export": "a body for others (tests/case/test_export.py)"}


def uncertain_keys() -> set[tuple[str, ...]]:
    """The paths of all keys of the program whose numbers may be uncertain."""
    effects = {("effects", name, key) for name in REGISTRY for key in effect_class(name).keys
               if may_be_uncertain(("effects", name), key)}
    return effects | {(*table, key) for table, keys in UNCERTAIN_KEYS.items() for key in keys}


def keys() -> list[tuple]:
    """(form, path) of every number that may be uncertain: those of the program's set, and those of a
    thruster."""
    found = []
    for path in sorted(uncertain_keys()):
        forms = [name for name, data in FORMS.items() if place(data, path) is not None]
        assert forms or path in {one for _, one in of_others()}, (
            f"{path}: no case of this test has the key: add it to FORMS or OTHERS")
        found += [(form, path) for form in forms]
    return found + [(form, ("thrusters", key)) for form in ("thruster", "burning")
                    for key in (*loose_of_thrusters(), *EXTRA)]


def of_others() -> list[tuple]:
    """(form, path) of the keys of effects that are looked at alone."""
    return [(name, path) for path in sorted(uncertain_keys()) for name, data in OTHERS.items()
            if place(data, path) is not None and path != ("body", "inertia") and path[0] != "motion"]


def loose_of_thrusters() -> list[str]:
    """The keys of a thruster whose number is read with an uncertainty."""
    found = []
    for key in THRUSTER:
        if key in FORCE and not isinstance(FORCE[key], (list, bool)) and key != "name":
            try:
                load(text(FORMS["thruster"] | {"thrusters": [FORCE | {key: f"{FORCE[key]} +- 1 %"}]}))
            except InputError:
                continue
            found.append(key)
    return found


def place(data, path):
    for part in path:
        data = (data[0] if isinstance(data, list) else data).get(part)
        if data is None:
            return None
    return data


def text(data) -> str:
    return text_of(json.loads(json.dumps(data)))


def loosened(form, path) -> str:
    """The case of this form with that number uncertain."""
    data = json.loads(json.dumps((FORMS | OTHERS)[form]))
    *tables, last = path
    table = data
    for part in tables:
        table = table[part][0] if isinstance(table[part], list) else table[part]
    if last in EXTRA:
        table[last] = EXTRA[last]
        return text(data)
    value = table[last]
    at = next((n for n, one in enumerate(value) if Fraction(one)), 0) if isinstance(value, list) else None
    told = f"{value if at is None else value[at]} +- 1 %"
    table[last] = told if at is None else [told if n == at else one for n, one in enumerate(value)]
    return text(data)


KEYS = keys()
NAMES = [f"{form}: {path[0]}.{path[-1]}" for form, path in KEYS]
PARTS = 6  # of the keys of each form, in turn: a view by default or slowly sees one, and the long tests all


def part(n: int) -> list[tuple]:
    """(form, path, label) of one part of the keys, in which every form has one at least."""
    forms = list(dict.fromkeys(form for form, _ in KEYS))
    own = {form: [(*key, label) for key, label in zip(KEYS, NAMES) if key[0] == form] for form in forms}
    return [row for form in forms for row in own[form][n % min(PARTS, len(own[form]))::PARTS]]


def in_parts(rows: list, quick) -> list:
    """Rows with parts: the nth row with the nth of them by default where it is quick, else slowly, the others in the
    long tests."""
    for n, row in enumerate(rows):
        for k in range(PARTS):
            marks = ([pytest.mark.slow, pytest.mark.long] if k != n % PARTS or row in DEAR else [] if quick(*row)
                     else [pytest.mark.slow])
            yield pytest.param(*row, k, id=" ".join(map(str, (*row, k))), marks=marks)


def commands() -> dict[str, set]:
    """Name -> its parameters, of all that take a case file."""
    found = {}
    for command in whole().registered_commands:
        takes = set(inspect.signature(command.callback).parameters)
        if takes & {"case", "cases"}:
            found[command.name or command.callback.__name__] = takes
    return found


COMMANDS = commands()
VIEWS = [(name, view) for name, takes in COMMANDS.items() if name not in DRAWN
         for view in ("", "json", "csv") if not view or view in takes]


def words_of(name, form, view) -> list[str]:
    found = []
    for option, value in OPTIONS.get(name, {}).items():
        if option == "rate":  # scaled systems have no unit
            value = "2" if form in ("mu", "scaled") else "8 deg/s"
        if option == "vary":
            span = "0.1:0.2" if name == "bifurcation" else "0.1,0.2"
            value = f"{VARIED[form]}={span}" if name != "basin" else None
            if value is None:
                two = ("motion.x[1]", "motion.x[2]") if form in ("mu", "scaled") else (
                    "motion.angular_velocity[1]", "motion.angular_velocity[2]")
                found += [part for one in two for part in ("--vary", f"{one}=0.1:0.2:3")]
                continue
        found += [f"--{option}"] + ([value] if value is not None else [])
    return found + ([f"--{view}"] if view else [])


def says(key, told) -> bool:
    return re.search(WORDS.get(key, SAID), told) is not None


@pytest.mark.parametrize("name, view, n", list(in_parts(VIEWS, lambda *row: row in QUICK)))
def test_every_command_and_view_says_of_every_key_that_it_is_uncertain(stabilab, case_file, name, view, n):
    refused = {}
    for form, path, label in part(n):
        options = words_of(name, form, view)
        if form not in refused:
            code, out, err = stabilab(name, case_file(text(FORMS[form]), f"plain-{form}"), *options)
            refused[form] = code
            assert code in (0, 2), (form, err)
            assert code or not says("force", UNSAID.sub("", out)), (form, out)
        code, out, err = stabilab(name, case_file(loosened(form, path), "case"), *options)
        assert code == refused[form], (label, err)
        empty = view == "csv" and out.count("\n") == 1  # the heads of a table without a line
        assert code or empty or says(path[-1], out), (label, out)
    assert 0 in refused.values(), refused


@pytest.mark.one_in(3)
@pytest.mark.parametrize("form, path", of_others(), ids=[f"{form}: {path[-1]}" for form, path in of_others()])
def test_a_number_of_any_effect_may_be_uncertain(stabilab, case_file, form, path):
    """By one command, in text: views and commands have no other place for it than those of the keys above."""
    command = ("orbit",) if path[0] == "circular_orbit" else ("simulate", "--at", "0.5")
    code, out, err = stabilab(command[0], case_file(loosened(form, path)), *command[1:])
    assert code == 0 and says(path[-1], out), (out, err)
    code, out, err = stabilab(command[0], case_file(text(OTHERS[form]), "plain"), *command[1:])
    assert code == 0 and not says(path[-1], out), (out, err)


MOVING = [(form, path) for form, path in KEYS if form not in ("burning", "orbit")]


@pytest.mark.parametrize("form, path", later(MOVING), ids=[f"{form}: {path[0]}.{path[-1]}" for form, path in MOVING])
def test_page_and_explorer_say_of_every_key_that_it_is_uncertain(tmp_path, form, path, undrawn):
    for told, wanted in ((text(FORMS[form]), False), (loosened(form, path), True)):
        (tmp_path / "case.toml").write_text(told)
        case = load(tmp_path / "case.toml")
        page = one_case.sections(case, tmp_path, "case", deep=False)
        shown = f"{page['headline']} {' '.join(page['caveats'])} {page['uncertain']}"
        assert says(path[-1], shown) == wanted, shown
        answer = ask(Session(case), moving=False)[0]
        assert says(path[-1], f"{answer['headline']} {answer['note']}") == wanted, answer


QUESTIONS = {"motion": {}, "attitude": {}, "when": {"rate": "8 deg/s"}, "stuck": {}, "burn": {}, "flat_spin": {},
             "circular_orbit": {}}


@pytest.mark.parametrize("name, n", list(in_parts([(name,) for name in QUESTIONS],
                                                  lambda name: name in ("attitude", "burn", "circular_orbit"))))
def test_results_in_python_say_of_every_key_that_it_is_uncertain(case_file, name, n):
    """Results that are arrays alone (extremes, period) have no words: those of `motion` are theirs."""
    question, asked = getattr(package, name), 0
    for form, path, _ in part(n):
        options = QUESTIONS[name] | ({"rate": "2"} if name == "when" and form in ("mu", "scaled") else {})
        try:
            question(case_file(text(FORMS[form])), **options)
        except InputError:
            continue
        found = question(case_file(loosened(form, path)), **options)
        asked += 1
        assert any(says(path[-1], one.words) for one in found.caveats), (form, path, found.caveats)
    assert asked
