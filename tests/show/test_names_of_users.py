"""Names that users give to cases, thrusters, wheels, keys and files come out as written, in every command and
view, however much they look like letters, units, times or axes. What is right is the same text about a case
whose names no pattern knows, with the other names put in."""
from __future__ import annotations

import json
import re
from dataclasses import replace
from html import escape, unescape
from urllib.parse import unquote

import pytest

import stabilab
from stabilab.commands.common import load_cases
from stabilab.show import names, style
from stabilab.show.axes import Axes
from stabilab.show.explore.pictures import unframed
from stabilab.show.explore.session import Session
from stabilab.show.plot import canvas
from stabilab.show.report import html
from stabilab.show.terminal import lettered, printed, written
from stabilab.show.units import SYSTEMS
from tests.shared import MOVING, later

PLAIN = "Qqqq"  # no pattern knows it
HOSTILE = ["axis 3 after 200 s", "lambda 2", "t = 5 s", "omega1 10 rad", "mu_i +- 1 = 2^2", "gamma3 -5 rad",
           "s in [0, 600]", "tau 1.23456789", "T.omega2", "a - b . H.H", "within 3600 s, axes 1 and 2",
           "1 N m s at least 2 rad", "left; right"]
NEVER_IN_FILES = ["omega1 10 rad/s", "l_x <= 3 & <inf>", "x axis `lambda1`", "{omega1} 50 %s"]
TEXT = """title = {title}
caveats = [{title}]
[body]
inertia = [120, 100, 60]
centre_of_mass = [0, 0, 0]
[[thrusters]]
name = {first}
position = [1, 0, 0]
direction = [0, 1, 0]
force = "0.2 N"
{fires}
[[thrusters]]
name = {second}
position = [-1, 0, 0]
direction = [0, 1, 0]
force = "0.2 N"
{also}
[[wheels]]
name = {wheel}
axis = [0, 0, 1]
momentum = "4 N m s"
[limits]
rate = "20 deg/s"
[motion]
angular_velocity = ["0.1 deg/s", "0.2 deg/s", "0.1 deg/s"]
span = [0, "10 min"]
"""
STUCK, BURNS = 'stuck = true\nmisalignment = "1 deg"', 'start = "0 s"\nstop = "{} s"'


@pytest.fixture(autouse=True)
def no_name_is_left():
    """Other tests have other users."""
    before = dict(names._spared)
    names._spared.clear()
    yield
    names._spared.clear()
    names._spared.update(before)
    names._found.clear()


def write_case(folder, name, stem=None, burns=False, more=""):
    """A case all of whose names are this one, with a word behind it where they must differ."""
    path = folder / f"{stem or name}.toml"
    quoted = {key: json.dumps(value) for key, value in
              {"title": name, "first": name, "second": f"{name} too", "wheel": f"{name} wheel"}.items()}
    path.write_text(TEXT.format(**quoted, fires=BURNS.format(30) if burns else STUCK,
                                also=BURNS.format(20) if burns else "") + more, encoding="utf-8")
    return path


def one_blank(text):
    """Columns are as wide as the names in them, and a long line is broken between its clauses."""
    return re.sub(r"\s+", " ", re.sub(r"\n(?:# )? *", "; ", text))


def as_a_page(text):
    """A page's list of pictures has names as addresses; how high a picture is depends on how its title is broken."""
    text = re.sub(r'srcset="([^"]*)"', lambda found: f'srcset="{escape(unquote(found[1]))}"', text)
    return re.sub(r'(?<=height=)"\d+"', '"0"', text)


def same_but_for_names(told, name):
    """told(name) is a text about a case with this name."""
    usual = PLAIN.ljust(len(name), "z")  # as long: what a first line has room for depends on it
    text, plain = one_blank(told(name)), one_blank(told(usual))
    assert usual in plain and text.count(name) >= plain.count(usual)
    assert text == plain.replace(usual, name)


@pytest.mark.one_in(10)
@pytest.mark.parametrize("name", HOSTILE)
@pytest.mark.parametrize("command", ["show", "fate", "classify", "stuck", "when", "extremes", "period",
                                     "attitude", "simulate"])
def test_names_come_out_as_written_from_every_command(name, command, tmp_path, stabilab):
    def told(name):
        code, out, err = stabilab(command, write_case(tmp_path, name))
        assert code in (0, 3), err
        return out + err
    same_but_for_names(told, name)


@pytest.mark.one_in(6)
@pytest.mark.parametrize("name", HOSTILE)
@pytest.mark.parametrize("form", ["--json", "--csv"])
def test_names_come_out_as_written_in_json_and_csv(name, form, tmp_path, stabilab):
    same_but_for_names(lambda name: stabilab("stuck", write_case(tmp_path, name), form)[1].replace(
        '"' * (form == "--csv"), ""), name)  # a comma in a name is quoted


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", HOSTILE)
def test_a_burn_names_its_thrusters_as_written(name, tmp_path, stabilab):
    same_but_for_names(lambda name: stabilab("burn", write_case(tmp_path, name, burns=True))[1], name)


@pytest.mark.parametrize("name", NEVER_IN_FILES)
@pytest.mark.parametrize("command", ["show", "stuck", "classify"])
def test_names_that_no_file_can_have(name, command, tmp_path, stabilab):
    same_but_for_names(lambda name: stabilab(command, write_case(tmp_path, name, "case"))[1], name)


@pytest.mark.parametrize("name", ["lambda 2", "t = 5 s", "mu_i after 5 s"])
def test_keys_of_a_sweep_and_its_file_stay(name, tmp_path, stabilab):
    sweep = "[sweep]\n\"body.inertia\" = [[120, 100, 60], [130, 100, 60]]\n"
    same_but_for_names(lambda name: stabilab("fate", write_case(tmp_path, name, more=sweep))[1], name)
    same_but_for_names(lambda name: "".join(stabilab(
        "sweep", write_case(tmp_path, name), "--vary", "motion.angular_velocity[1]=1:2:2")[1:]), name)


@pytest.mark.parametrize("name", ["lambda 2", "t = 5 s", "mu_i after 5 s"])
def test_a_fault_names_its_file_and_thruster_as_written(name, tmp_path, stabilab):
    def told(name):
        path = write_case(tmp_path, name, more="[effects.x]\n")
        code, out, err = stabilab("fate", path)
        assert code == 2 and not out
        return err
    same_but_for_names(told, name)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", HOSTILE)
def test_the_explorer_has_names_as_written(name, tmp_path):
    def told(name):
        session = Session(load_cases([write_case(tmp_path, name)])[0])
        answer, _ = unframed(session.answer({}))
        del answer["analysis"], answer["work"]  # times
        return json.dumps([session.about(), answer], ensure_ascii=False)
    same_but_for_names(told, name)


@pytest.mark.one_in(8)
@pytest.mark.parametrize("name", ["axis 3 after 200 s", "lambda 2", "t = 5 s", "gamma3 -5 rad"])
@pytest.mark.parametrize("kind", ["body", "time"])
def test_pictures_have_names_as_written(name, kind, tmp_path, stabilab, monkeypatch):
    from matplotlib.text import Text
    seen, save = [], style.save
    monkeypatch.setattr(style, "save", lambda figure, *rest, **more: (
        seen.extend(one.get_text() for one in figure.findobj(Text)), save(figure, *rest, **more))[1])

    def told(name):
        seen.clear()
        code, out, err = stabilab("plot", write_case(tmp_path, name), "--kind", kind, "--out", tmp_path / "a.svg")
        assert code == 0, err
        return "\n".join(seen)
    same_but_for_names(told, name)


@pytest.mark.parametrize("title", ["omega1 10 rad", "lambda 2 in tau", PLAIN])
def test_a_picture_has_its_title_as_written_and_what_is_said_below_it_in_letters(title):
    """|omega| stands in the program's words alone."""
    case = stabilab.load(f"title = {json.dumps(title)}\n{MOVING}span = [0, 10]\n")
    ax = stabilab.plot.time(case)
    assert ax.get_title().split("\n") == [title, "Bounded only with torque exactly along z"]
    canvas.title(ax, title, "|omega| = 1")
    assert ax.get_title().split("\n") == [title, "|ω| = 1"]


@pytest.mark.parametrize("name", later(HOSTILE))
def test_pages_have_names_as_written(name, tmp_path, stabilab):
    def told(name):
        folder = tmp_path / f"of {name}"
        code, _, err = stabilab("report", write_case(tmp_path, name), "--out", folder)
        assert code == 0, err
        return as_a_page("\n".join(path.read_text(encoding="utf-8") for path in sorted(folder.rglob("*.html")))
                         ).replace(escape(name), name).replace("&#39;", "'")
    same_but_for_names(told, name)


@pytest.mark.parametrize("name", [*HOSTILE, *NEVER_IN_FILES])
def test_no_pattern_changes_a_name_that_is_spared(name):
    units = replace(SYSTEMS["deg"], axes=Axes(("x", "y", "z"), ("major", "intermediate", "minor")))
    names.spare([name])
    for change in (lettered, printed, written, units.axes.sentence):
        for text in ("the tilt of {}, {}", "{}: {} and another: {}", "{}"):
            assert change(text.format(name, name, name)) == text.format(name, name, name)
    assert lettered(f"{name}: omega1, lambda3") == f"{name}: ω1, λ3"
    assert units.axes.sentence(f"{name} about axis 2") == f"{name} about the y axis"


@pytest.mark.parametrize("name", NEVER_IN_FILES)
def test_a_name_on_a_page_is_escaped_and_as_written(name):
    names.spare([name])
    page = html._environment().from_string(
        "{{ t|written }}\0{{ t|book|signed }}\0{{ t|together }}\0{{ t|written|book|signed }}\0{{ t|sentence }}")
    for text in page.render(t=name).split("\0"):
        assert unescape(text) == name and "<" not in text


def test_a_name_within_a_longer_word_is_no_name():
    names.spare(["lambda1"])
    assert lettered("lambda12 lambda1") == "λ12 lambda1"


def test_names_that_no_pattern_changes_are_not_remembered():
    before = dict(names._spared)
    names.spare(["thruster", "A", "x", "3", "-1", "fly"])
    assert names._spared == before
