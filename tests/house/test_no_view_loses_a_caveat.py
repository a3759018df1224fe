"""A caveat that one more function of CAVEATS gives is in every view of every command about a case at once: the
table of commands and views is made from the command line itself."""
from __future__ import annotations

import inspect
import json
from dataclasses import replace

import pytest

import stabilab as package
from stabilab import cli
from stabilab.answers import caveats
from stabilab.commands.runner import View, run
from stabilab.errors import Caveat, Kind
from stabilab.packages import present
from stabilab.reasons import Sentence
from stabilab.representation import Shown
from stabilab.show import limiting
from stabilab.show.explore.session import Session
from stabilab.show.report import one_case
from stabilab.show.results.kinds import KINDS
from tests.shared import CASES
from tests.show.explore.test_session import ask

WORDS = "a caveat that nobody thought of"
PROBE = Sentence("probe", WORDS)
# what a command cannot do without, and the case where the usual one will not do
NEEDS = {"when": ("--rate", "3"), "sweep": ("--vary", "torque[3]=0.01,0.02"), "precision": ("--quick",),
         "basin": ("--vary", "angular_velocity[1]=0:1:3", "--vary", "angular_velocity[2]=0:1:3", "--depth", "0"),
         "bifurcation": ("--vary", "torque[3]=0.01:0.02"), "atlas": ("--level", "0", "--refine", "0"),
         "reference": ("--at", "1", "--digits", "9"), "chaos": ("--until", "30 s"), "simulate": ("--at", "0,1")}
CASE = {"burn": "burns/stage", "orbit": "orbits/boom", "flat_spin": "rahn-barba", "compare": "top-fast",
        "stuck": "thruster-stuck-major-axis"}
USUAL = """[body]
inertia = [12, 9, 5]
[effects.gyrostat]
momentum = [0.8, 0, 0]
[effects.constant_torque]
torque = [0, 0, 0.02]
[motion]
angular_velocity = [0.1, 0.05, 0.02]
span = [0, 30]
"""
# a file or a server, not an answer: below; a body for others: tests/case/test_export.py
WRITES = {"plot", "surface", "report", "explore", "export"}
SLOW = {"precision", "atlas", "burn", "orbit", "surface", "flat_spin", "compare", "chaos"}  # but for JSON
VERY_SLOW = {"precision json", "flat_spin json"}


def views():
    for command in cli.whole().registered_commands:
        name, options = command.callback.__name__, inspect.signature(command.callback).parameters
        if {"case", "cases"} & set(options) and name not in WRITES | {"verify"}:
            for view in ("text", *(one for one in ("json", "csv") if one in options)):
                yield pytest.param(name, view, id=f"{name} {view}",
                                   marks=[pytest.mark.slow] * (name in SLOW and view != "json"
                                                               or f"{name} {view}" in VERY_SLOW))


@pytest.fixture
def probed(monkeypatch):
    monkeypatch.setattr(caveats, "CAVEATS", (*caveats.CAVEATS, lambda known: (Caveat(Kind.STATED, PROBE()),)))


@pytest.fixture
def usual(case_file):
    return case_file(USUAL, "usual")


@pytest.mark.parametrize("name, view", list(views()))
def test_every_command_shows_a_new_caveat_in_every_view(stabilab, probed, usual, name, view):
    case = CASES / f"{CASE[name]}.toml" if name in CASE else usual
    code, out, err = stabilab(name.replace("_", "-"), case, *NEEDS.get(name, ()),
                              *([] if view == "text" else [f"--{view}"]))
    assert code in (0, 3), err
    assert WORDS in out
    if view == "json":
        def lists(value):
            if isinstance(value, dict):
                yield from ([value["caveats"]] if "caveats" in value else [])
                value = value.values()
            for one in value if not isinstance(value, (str, int, float, bool, type(None))) else ():
                yield from lists(one)
        found = [one for rows in lists(json.loads(out)) for one in rows]
        assert any(one["code"] == "probe" and one["kind"] == "stated" for one in found)


@pytest.mark.one_in(16)
@pytest.mark.parametrize("kind", list(Kind))
def test_a_caveat_of_every_kind_is_in_every_view(monkeypatch, stabilab, usual, tmp_path, undrawn, kind):
    """No view chooses by the kind what it leaves out: kinds that some view treats by itself as well."""
    monkeypatch.setattr(caveats, "CAVEATS", (*caveats.CAVEATS, lambda known: (Caveat(kind, PROBE()),)))
    shown = {(name, *form): stabilab(name, usual, *NEEDS.get(name, ()), *form)[1]
             for name, forms in {"fate": ((), ("--json",)), "classify": ((), ("--json",)), "period": ((),),
                                 "extremes": ((), ("--csv",)), "when": ((), ("--csv",))}.items() for form in forms}
    case = package.load(usual)
    shown |= {question: repr(getattr(case, question)()) for question in ("fate", "extremes", "period", "motion")}
    page, answer = one_case.sections(case, tmp_path, "case", deep=False), ask(Session(case), moving=False)[0]
    shown |= {"page": f"{page['caveats']} {page['headline']} {page['tiles']}",
              "explorer": f"{answer['headline']} {answer['note']}"}
    assert [view for view, text in shown.items() if WORDS not in text.lower()] == []


def test_a_command_whose_views_say_nothing_shows_every_caveat(case_file, capsys):
    """Text, JSON and CSV get them from the runner, that on a law as well, though this command judges none."""
    case = package.load(case_file(USUAL, "usual"))
    law = Caveat(Kind.LAW, Sentence("probe-law", "a law that does not hold")())
    found = replace(package.motion(case), caveats=(Caveat(Kind.STATED, PROBE()), law))
    silent = View(text=lambda *found: "silent", data=lambda *found: {},
                  csv=((), lambda *found: [limiting.Line(())]))
    said = {}
    for view in ("text", "json", "csv"):
        run(silent, [case], lambda one: found, **({} if view == "text" else {view: True}))
        said[view] = capsys.readouterr().out
    assert all(WORDS in out and "a law that does not hold" in out for out in said.values()), said
    assert [one["kind"] for one in json.loads(said["json"])["caveats"]] == ["stated", "law"]


def test_without_the_function_no_view_has_it(stabilab, usual):
    assert WORDS not in stabilab("fate", usual)[1]


def test_a_page_the_explorer_and_python_show_a_new_caveat(probed, usual, tmp_path, undrawn):
    case = package.load(usual)
    made = one_case.sections(case, tmp_path, "case", deep=False)
    assert any(WORDS in words.lower() for words in made["caveats"])
    answer = ask(Session(case), moving=False)[0]
    assert WORDS in f"{answer['headline']} {answer['note']}".lower()
    for found in (case.fate(), case.motion(), case.extremes(), case.period(), case.attitude(),
                  case.when(rate="3 rad/s"), case.when(events="omega1"), case.equilibria(), case.simulate(),
                  case.stuck(), package.compare(case), package.spin_up(case), package.trajectory(case),
                  package.ensemble(case), package.separatrix(case), package.chaos(case, until="5 s"),
                  package.bifurcation(case, {"torque[3]": "0.01:0.02"})):
        assert any(one.words == WORDS for one in found.caveats), found
        assert WORDS in repr(found) and WORDS in found._repr_html_(), found
        if present("xarray"):
            assert WORDS in found.to_xarray().attrs["caveats"], found


def test_every_result_that_is_shown_says_what_limits_it():
    """Results of rows alone, and the end of a motion, which is a part of one, are no answers of a case."""
    def kinds(one):
        yield one
        for kind in one.__subclasses__():
            yield from kinds(kind)

    for name in package.__all__:
        getattr(package, name)
    shown = {one.__name__: one for one in kinds(Shown) if one.__name__ in KINDS}
    assert shown.keys() == KINDS.keys()
    assert {name for name, one in shown.items() if not hasattr(one, "caveats")} == {"FateResult", "Ending"}
