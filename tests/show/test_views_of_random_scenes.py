"""What every view of an answer has, over random scenes of all effects: every number of a text is in the JSON of
its command, every caveat and how well the outcome is known are in text, CSV, Python, page and explorer."""
from __future__ import annotations

import html
import inspect
import re

import pytest

import stabilab as package
from stabilab.answers.caveats import IN_SHORT
from stabilab.cli import whole
from stabilab.errors import Kind
from stabilab.packages import present
from stabilab.show.explore.session import Session
from stabilab.show.report import one_case
from stabilab.show.terminal import plain
from tests.house.sentences import sentences
from tests.recorded.answers import run
from tests.show.explore.test_session import ask
from tests.show.random_scenes import KINDS, written
from tests.show.test_round_trip import missing, own

MANY = 60
# what a command cannot do without
OPTIONS = {"when": ("--rate", "2000 deg/s"), "chaos": ("--until", "5"), "simulate": ("--at", "0,1,10"),
           "reference": ("--at", "1", "--digits", "9"), "bifurcation": ("--vary", "body.inertia[1]=1:3"),
           "sweep": ("--vary", "motion.angular_velocity[1]=0.1,0.2"), "precision": ("--quick",),
           "basin": ("--vary", "angular_velocity[1]=0:1:3", "--vary", "angular_velocity[2]=0:1:3", "--depth", "0"),
           "atlas": ("--level", "0", "--refine", "0")}
WHY = ("fate", "extremes", "period", "classify", "stuck")
NO_TEXT = {"reference", "verify"}  # whose text is its CSV; a certificate's
QUICK = ("fate", "classify")
SLOW = ("precision",)  # half a minute each: of one scene, in the long tests
FEW, LONG = 12, [pytest.mark.slow, pytest.mark.long]  # scenes of the slow tests; the others take a quarter hour
SCENES = [f"{kind}-{n:02}" for n, kind in zip(range(MANY), [*KINDS] * MANY)]
TEMPLATES = {sentence.code: sentence.template for _, sentence in sentences()}
NO_LEVEL = ("exact", "undecided", "none")  # exact is a matter of course; what is undecided is headed so
LEVELS = {"run": "by a run alone"}


def commands():
    for command in whole().registered_commands:
        name, options = command.callback.__name__, inspect.signature(command.callback).parameters
        if {"case", "cases"} & set(options) and "json" in options and name not in NO_TEXT:
            yield name, "csv" in options


@pytest.fixture(scope="module")
def scenes(tmp_path_factory):
    return written(tmp_path_factory.mktemp("scenes"), MANY)


def even(text: str) -> str:
    """A text of any view in ASCII and small letters, without tags, with one blank between words."""
    bare = html.unescape(re.sub(r"<[^>]+>", " ", text))
    return re.sub(r"[\s;:.]+", " ", plain(bare.replace("−", "-").replace("–", "-"))).lower()


def says(text: str, code: str) -> bool:
    """Whether an even text has a sentence, whatever fills it, or its form in fewer words: a first line leaves out
    "holds" and "unstable"."""
    for template in (TEMPLATES[code], *([IN_SHORT[code].template] if code in IN_SHORT else [])):
        bare = even(template).removeprefix("holds ").removeprefix("unstable ")
        if re.search(".+?".join(re.escape(part.strip()) for part in re.split(r"\{\w+\}", bare)), text):
            return True
    return False


def codes(value):
    """The codes of a sentence in JSON: of itself, of what fills it, and of the clauses that follow."""
    if isinstance(value, dict):
        yield from [value["code"]] if value.get("code") else []
        for item in value.values():
            yield from codes(item)
    elif isinstance(value, list):
        for item in value:
            yield from codes(item)


def caveats(value, box: bool = False):
    """The caveats anywhere in an object of JSON; those of uncertain numbers are said by what a box of them does."""
    if isinstance(value, dict):
        box = box or bool(value.get("uncertain"))
        for item in value.get("caveats", ()) if isinstance(value.get("caveats"), list) else ():
            if isinstance(item, dict) and not (box and item["kind"] in ("uncertain", "samples")):
                yield item
        for item in value.values():
            yield from caveats(item, box)
    elif isinstance(value, list):
        for item in value:
            yield from caveats(item, box)


def lost(given, views: dict[str, str]) -> list[tuple[str, str]]:
    """(view, code) of every sentence in the caveats of JSON that a view does not say."""
    texts = {name: even(text) for name, text in views.items()}
    return sorted({(name, code) for item in caveats(given) for code in codes(item) for name, text in texts.items()
                   if not says(text, code) and (name != "csv" or code != "of-points")})


def asked(command: str, path, *more: str):
    options = (*OPTIONS.get(command, ()), *(("--why",) if command in WHY and "--csv" not in more else ()))
    return run(command.replace("_", "-"), str(path), *options, *more)


def rows():
    """One command of each kind of scene; every command of few scenes, slow; of all."""
    for command, tabled in commands():
        quick = [name for n, name in enumerate(SCENES[:len(KINDS)]) if command == QUICK[n % len(QUICK)]]
        slow = [name for name in SCENES[:FEW] if name not in quick and command not in SLOW]
        for name in (*quick, *slow):
            yield pytest.param(command, tabled, [name], marks=[] if name in quick else [pytest.mark.slow],
                               id=f"{command}-{name}")
        yield pytest.param(command, tabled, SCENES[:1] if command in SLOW else SCENES, marks=LONG, id=command)


@pytest.mark.parametrize("command, tabled, names", list(rows()))
def test_every_number_and_every_caveat_of_a_command_is_in_all_its_views(command, tabled, names, scenes):
    for name in names:
        has_all(command, tabled, name, scenes)


def has_all(command, tabled, name, scenes):
    text = asked(command, scenes[name])
    if text["exit"] == 2:  # another command's case
        assert text["message"] and not text["answer"]
        return
    assert text["exit"] in (0, 3), text["message"]
    given = asked(command, scenes[name], "--json")["answer"]
    views = {"text": text["answer"]} | ({"csv": asked(command, scenes[name], "--csv")["answer"]} if tabled else {})
    if command not in SLOW:  # which tells times of its own runs, others each time
        assert missing(own(scenes[name], text["answer"]), given, name) == []
    assert lost(given, views) == []


def view_texts(case, folder) -> dict[str, str]:
    """What page and explorer show of a case."""
    page, answer = one_case.sections(case, folder, "case", deep=False), ask(Session(case), moving=False)[0]
    parts = ("headline", "law", "exceeded", "caveats", "tiles", "facts")
    return {"page": str([page[part] for part in parts]), "explorer": f"{answer['headline']}; {answer['note']}"}


@pytest.mark.parametrize("name", [pytest.param(name, marks=[] if n in (1, 13) else [pytest.mark.slow] if n < FEW else LONG)
                                  for n, name in enumerate(SCENES) if not name.startswith(("burning", "satellite"))])
def test_python_page_and_explorer_have_every_caveat_and_the_level(name, scenes, tmp_path, undrawn):
    case = package.load(scenes[name])
    for question in ("fate", "extremes", "period", "motion", "equilibria"):
        found = getattr(case, question)()
        shown = [repr(found), html.unescape(found._repr_html_())]
        data = found.to_xarray() if present("xarray") else None
        shown += [data.attrs["caveats"]] if data is not None and found.caveats else []
        for item in found.caveats:
            assert all(item.words in text for text in shown), (question, item)
    motion, views = case.motion(), view_texts(case, tmp_path)
    given = asked("fate", scenes[name], "--json")["answer"]
    (printed,) = given
    assert printed["level"] == motion.level
    for view, text in views.items():
        # the explorer looks at no cone of torques, and says so; what uncertain numbers do has a part of its own
        limits = case.caveats if view == "explorer" else motion.caveats
        limits = (*limits, *(item for item in motion.caveats if item.kind not in (Kind.TILT, Kind.UNCERTAIN)))
        rows = [{"kind": str(item.kind)} | item.reason.as_dict() for item in limits]
        assert lost({"caveats": rows, "uncertain": bool(case.uncertain)}, {view: text}) == []
    if motion.level not in NO_LEVEL:
        word = LEVELS.get(motion.level, motion.level)
        for view, text in (views | {"text": asked("fate", scenes[name])["answer"], "repr": repr(case.fate()),
                                    "html": case.fate()._repr_html_()}).items():
            assert word in text or motion.level in text, view


def test_a_caveat_that_one_view_leaves_out_is_seen(scenes):
    name = next(name for name in SCENES if name.startswith("craft"))
    text, given = (asked("fate", scenes[name], *view)["answer"] for view in ((), ("--json",)))
    views = {"text": text, "page": text, "explorer": text}
    assert [*caveats(given)] and lost(given, views) == []
    for item in caveats(given):
        for view in views:
            short = re.sub(re.escape(item["words"].split(",")[0][:20]), "", text)
            assert lost(given, views | {view: short}) == [(view, item["code"])]
