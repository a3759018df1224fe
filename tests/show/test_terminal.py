"""What a terminal shows: lines as wide as it, colours there alone, letters that its encoding has, groups of
commands, completion."""
import io
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

from stabilab import cli
from stabilab.show import command_groups
from stabilab.show import terminal as letters
from stabilab.show import terminal as page
from stabilab.show.command_groups import GROUPS
from tests.shared import CASES, MOVING

ROOT = Path(__file__).parents[2]
MINOR, OFF_AXIS = ROOT / "cases/minor-axis-100.toml", ROOT / "cases/off-axis-two.toml"


PROGRAM = "import sys; sys.argv = ['stabilab']; from stabilab.__main__ import main; main()"


class Screen(io.StringIO):
    """A stream that says it is a terminal, or not, with an encoding."""

    def __init__(self, terminal=True, encoding="utf-8"):
        super().__init__()
        self.terminal, self.name = terminal, encoding

    encoding = property(lambda self: self.name)

    def isatty(self):
        return self.terminal


@pytest.fixture
def shown(monkeypatch):
    """What a command writes to a stream: shown(stream, words of the command, columns)."""
    def run(screen, *words, columns=80, **environment):
        for name in ("NO_COLOR", "FORCE_COLOR", "TERM"):
            monkeypatch.delenv(name, raising=False)
        for name, value in {"TERM": "xterm-256color", "COLUMNS": str(columns), **environment}.items():
            monkeypatch.setenv(name, value)
        monkeypatch.setattr(sys, "stdout", screen)
        monkeypatch.setattr(sys, "argv", ["stabilab", *map(str, words)])
        with pytest.raises(SystemExit) as left:
            cli.main()
        assert not left.value.code
        return screen.getvalue()
    return run


def without_colour(text):
    return re.sub(r"\x1b\[[0-9;]*m", "", text)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("columns", [60, 80, 120])
@pytest.mark.parametrize("words", [("classify", OFF_AXIS), ("fate", MINOR), ("classify", MINOR, "--why")])
def test_no_line_is_wider_than_the_terminal_and_no_word_is_lost(shown, words, columns):
    narrow, plain = (shown(Screen(terminal), *words, columns=columns) for terminal in (True, False))
    assert max(map(len, without_colour(narrow).splitlines())) <= columns
    assert without_colour(narrow).split() == plain.split()


def test_a_clause_is_one_line_in_a_pipe(shown):
    """Wherever a terminal would break it; what has no room in the first hundred letters has lines of its own."""
    first, *rest = shown(Screen(False), "fate", MINOR, columns=40).splitlines()
    assert first.startswith("minor-axis-100: BOUNDED") and len(first) <= letters.LINE
    assert any(line.startswith("  period ") for line in rest) and max(map(len, rest)) > 100


def test_a_long_line_is_broken_between_its_clauses_alone():
    long = " ".join(["word"] * 12)
    assert letters.by_clauses(f"a; {long}; b; c (d; e) {long}") == f"a; {long}; b\n  c (d; e) {long}"
    assert letters.by_clauses(f"  {long}; [x; {long}]; \"y; z\"") == f"  {long}\n    [x; {long}]\n    \"y; z\""
    assert letters.by_clauses("a; b; c") == "a; b; c"


def test_colour_is_on_a_terminal_alone_and_never_where_it_is_not_wanted(shown):
    assert "\x1b[1;32mBOUNDED" in shown(Screen(), "fate",
                                        MINOR) and "\x1b[31munstable" in shown(Screen(), "classify", OFF_AXIS)
    assert "\x1b" not in shown(Screen(), "fate", MINOR,
                               NO_COLOR="1") and "\x1b" not in shown(Screen(), "fate", MINOR, TERM="dumb")
    assert "\x1b" not in shown(Screen(False), "fate", MINOR, FORCE_COLOR="1")


def test_data_is_not_for_people_wherever_it_goes(shown):
    for words in (("classify", MINOR, "--json"), ("extremes", MINOR, "--csv")):
        assert shown(Screen(), *words) == shown(Screen(False), *words)


def test_letters_that_an_encoding_lacks_are_written_out(shown):
    greek, plain = (shown(Screen(False, encoding), "extremes", OFF_AXIS) for encoding in ("utf-8", "ascii"))
    assert "ω1 " in greek and "omega" not in greek and "omega1 " in plain and plain.isascii()


@pytest.mark.parametrize("words", [
    ("fate", "toy-top"), ("fate", "minor-axis-100"), ("when", "toy-top", "--component", "z = 60 deg/s"),
    ("show", "minor-axis-100"), ("stuck", "cubesat-3u"), ("period", "minor-axis-100")])
def test_what_a_command_prints_has_letters_wherever_they_have_names_and_powers_are_raised(shown, words):
    """But for formulas in LaTeX, and names of files."""
    command, name, *options = words
    lines = shown(Screen(False), command, CASES / f"{name}.toml", *options).splitlines()
    left = [line for line in lines if "\\" not in line and ".toml" not in line
            and re.search(rf"(?<![\w-])({'|'.join(letters.ALPHABET)})(\d|\b)|\^\d", line)]
    assert left == []


def test_lines_that_go_on_stand_below_their_words():
    text = page.wrapped("  off that axis           " + "any tilt of the torque " * 4, 60).split("\n")
    assert len(text) > 1 and all(line.startswith(" " * 26 + "any") or line.startswith(" " * 26)
                                 for line in text[1:])
    assert [line[:4] for line in page.wrapped("why: " + "because " * 20, 50).split("\n")[1:]] == ["  be"] * 3


def test_a_message_wraps_to_the_terminal_that_stderr_is(shown, monkeypatch, tmp_path):
    """How far a law holds, said beside a file that has no place for it."""
    words = {}
    for terminal in (True, False):
        monkeypatch.setattr(sys, "stderr", Screen(terminal))
        shown(Screen(False), "simulate", ROOT / "cases/liquid-sensible.toml", "--out", tmp_path / "run.csv",
              columns=50)
        words[terminal] = sys.stderr.getvalue()
    assert words[True].split() == words[False].split()
    told = {terminal: text.splitlines()[1:] for terminal, text in words.items()}  # below the name of the file
    assert max(map(len, told[True])) <= 50 < max(map(len, told[False]))


def test_the_name_of_a_written_file_stays_in_one_piece(monkeypatch):
    monkeypatch.setenv("COLUMNS", "50")
    monkeypatch.setattr(sys, "stderr", Screen())
    page.say("written: a folder/two words lambda1/a very long name of a file.csv")
    assert sys.stderr.getvalue() == "written: a folder/two words lambda1/a very long name of a file.csv\n"


def test_a_fault_keeps_its_file_and_line_in_one_piece(monkeypatch, tmp_path):
    """Two faults of a file whose name has blanks, on a terminal of fifty columns: each begins with the place,
    and the rest stands below it."""
    case = tmp_path / "my own case.toml"
    case.write_text('[body]\ninertia = [3, 2]\n[motion]\nangular_velocity = ["3 apples/s", 0, 0]\n')
    monkeypatch.setenv("COLUMNS", "50")
    monkeypatch.setattr(sys, "argv", ["stabilab", "fate", str(case)])
    monkeypatch.setattr(sys, "stderr", Screen())
    with pytest.raises(SystemExit) as left:
        cli.main()
    lines = sys.stderr.getvalue().splitlines()
    assert left.value.code == 2 and [f"{case}:{n}:" in sys.stderr.getvalue() for n in (2, 4)] == [True, True]
    assert all(line.startswith("  ") or line.startswith(str(case)) for line in lines)
    assert max(len(line) for line in lines if line.startswith("  ")) <= 50


def test_a_stream_without_letters_gets_their_names(monkeypatch):
    for encoding, shown_as in (("ascii", "|omega|"), ("utf-8", "|ω|")):
        monkeypatch.setattr(sys, "stderr", Screen(False, encoding))
        page.say("the limit of |ω|")
        assert sys.stderr.getvalue() == f"the limit of {shown_as}\n"


def test_help_tells_the_commands_in_groups(stabilab):
    code, out, _ = stabilab("-h")
    assert code == 0 and stabilab("--help")[1] == out and stabilab("fate",
                                                                   "-h")[1] == stabilab("fate", "--help")[1]
    heads = [line[:-1] for line in out.splitlines() if line.endswith(":")
             and not line.startswith((" ", "Options"))]
    assert heads == list(GROUPS) and max(map(len, out.splitlines())) <= 80
    named = [line.split()[0] for line in out.split("Options:")[1].split("\n\n", 1)[1].splitlines()
             if line.startswith("  ")]
    assert sorted(named) == sorted({command.name or command.callback.__name__
                                    for command in cli.whole().registered_commands})


def test_a_shell_completes_case_files_and_names(tmp_path):
    """By the protocol of the shell, in a process of its own."""
    (tmp_path / "mine.toml").write_text("")
    (tmp_path / "mine.txt").write_text("")
    (tmp_path / "more").mkdir()
    for line, offered in (("stabilab classify m", ["mine.toml", "more/"]),
                          ("stabilab fate mine.toml --units ", ["deg", "deg/day", "rpm", "rev/s", "si"])):
        words = line.split(" ")
        run = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, cwd=tmp_path,
                             env=os.environ | {
            "_STABILAB_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(len(words) - 1),
            "PYTHONPATH": str(ROOT)})
        assert run.stdout.split() == offered, run.stderr


def test_names_that_are_offered_are_those_that_are_known():
    from stabilab.integrate.trajectory import SCIPY_METHODS
    from stabilab.show.plot.subject import KINDS
    from stabilab.show.units import SYSTEMS
    from stabilab.theories.follow import MODELS
    assert command_groups.units("") == list(SYSTEMS) and command_groups.kinds("") == list(KINDS)
    assert set(command_groups.methods("")) == {"taylor", "reduced",
                                           *SCIPY_METHODS} and set(command_groups.models("")) == set(MODELS)
    assert {"constant-torque-gyrostat"} <= set(command_groups.audited("")) and command_groups.sources("o") == [
        "orekit"]


def test_progress_tells_which_of_how_many_and_the_time_that_is_left_to_a_terminal_alone(monkeypatch):
    """Four items of two seconds each, by a clock of the test."""
    from stabilab.show import progress
    now, told = [0.0], {}
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    for terminal in (True, False):
        screen = Screen(terminal)
        monkeypatch.setattr(sys, "stderr", screen)
        for _ in progress.each("abcd", str.upper):
            now[0] += 2
        told[terminal] = [line.strip() for line in screen.getvalue().split("\r") if line.strip()]
    assert told == {True: ["2 of 4, about 6 s left: B", "3 of 4, about 4 s left: C",
                           "4 of 4, about 2 s left: D"], False: []}


def test_long_commands_count_their_steps(monkeypatch, stabilab, tmp_path):
    """audit, validate, tables: every step from 0 on, of the same number."""
    from contextlib import contextmanager

    from stabilab.commands import papers
    steps = []

    @contextmanager
    def counted():
        yield lambda done, count, words: steps.append((done, count))
    monkeypatch.setattr(papers, "counted", counted)
    paper = tmp_path / "claims.toml"
    paper.write_text('[symbols]\n"x y" = "m"\n'
                     + "".join(f'[[row]]\nequation = "{n}"\nprinted = "x + y = y + x"\n' for n in range(3)))
    for words in (("audit", paper), ("tables", "--out", tmp_path / "tables"), ("validate", "orekit")):
        steps.clear()
        assert stabilab(*map(str, words))[0] == 0
        assert len({count for _, count in steps}) == 1, words
        assert {done for done, _ in steps} == set(range(steps[0][1])), words


def test_thrusters_that_do_nothing_are_named_before_the_answer(stabilab, tmp_path):
    text = ('[body]\ninertia = [120, 95, 60]\n[motion]\nangular_velocity = [0.1, 0.2, 0]\n'
            '[[thrusters]]\nname = "T1"\nposition = [0.3, 0.4, 0]\ndirection = [0, 0, 1]\nforce = "1 N"\n')
    (tmp_path / "silent.toml").write_text(text)
    (tmp_path / "stuck.toml").write_text(text + "stuck = true\n")
    for command in ("fate", "classify", "extremes"):
        first, *others = stabilab(command, tmp_path / "silent.toml")[1].split("\n")
        assert first.startswith("silent: no thruster fires; ")
        assert "  caveat: no thruster fires: stuck = true in a table [[thrusters]] makes one act for ever (T1)" in others
        assert "no thruster fires" not in stabilab(command, tmp_path / "stuck.toml")[1]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("words, told", [
    (("fate", "--tilt", "1"), '--tilt: 1 alone is in rad: 57.2958 deg; for degrees write "1 deg"'),
    (("when", "--rate", "1/2"),
     '--rate: 1/2 alone is in rad/s: 28.6479 deg/s; for degrees write "1/2 deg/s"'),
    (("when", "--component", "z = 10"),
     '--component: 10 alone is in rad/s: 572.958 deg/s; for degrees write "10 deg/s"'),
    (("fate", "--tilt", "1 deg"), ""), (("when", "--rate", "10", "--units", "si"), "")])
def test_an_angle_without_a_unit_is_told_in_degrees_before_the_answer(stabilab, case_file, words, told):
    """180/pi = 57.2958."""
    code, _, err = stabilab(words[0], case_file(MOVING), *words[1:])
    assert code == 0 and err.strip() == told


def test_the_answer_comes_first_and_the_files_after_it(tmp_path):
    """On a terminal stderr and stdout are one: what stands first there is read as the answer."""
    case, file = CASES / "wheel-and-thruster.toml", tmp_path / "drawn.png"
    run = subprocess.run([sys.executable, "-m", "stabilab", "bifurcation", case, "--vary", "torque[3]=0:2000",
                          "--out", file], stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, text=True, encoding="utf-8")
    first, *_, last = run.stdout.splitlines()
    assert first.startswith(
        "wheel-and-thruster: 4 equilibria") and last == f"written: {file}" and file.exists()


def test_a_run_shows_no_digit_that_its_check_does_not_vouch_for(stabilab, case_file):
    """6 deg/s at the start is 6 and not 6.000000000000001, as the last place of a double has it after the
    turn from rad/s."""
    path = case_file("[body]\ninertia = [12, 9, 5]\n[effects.constant_torque]\ntorque = [0, 0, 0.02]\n"
                     '[motion]\nangular_velocity = ["6 deg/s", 0, "1 deg/s"]\n', "run")
    out = stabilab("simulate", path, "--at", "0,30", "--digits", "12")[1]
    reached = int(float(re.search(r"^# ([\d.]+) digits", out, re.MULTILINE)[1]))
    assert re.search(r"^ +0 +6 +0 +1$", out, re.MULTILINE)
    last = re.search(r"^ +30 +(\S+)", out, re.MULTILINE)[1]
    assert 12 <= len(last.replace(".", "").lstrip("-0")) <= reached < 16


@pytest.mark.parametrize("typed, printed", [  # by hand: as a book sets them
    ("1e-08 of 2e+06", "1e−8 of 2e6"), ("0e+00 s", "0e+00 s"), ("(-5, .5, -0.1)", "(−5, .5, −0.1)"),
    ("x = -b + (b-a) c - 2", "x = −b + (b−a) c − 2"), ("(- h²/24 ω'')", "(− h²/24 ω'')"),
    ("a spin-up of DOP853-1 at off-axis-2", "a spin-up of DOP853-1 at off-axis-2"), ("D^-1", "D^−1")])
def test_a_minus_is_that_of_a_book_and_a_hyphen_stays_one(typed, printed):
    assert letters.minus(typed) == printed


def test_a_command_between_backquotes_stays_as_it_is_typed_and_a_single_backquote_is_no_command():
    assert letters.printed("-1: `stabilab -1 omega1`, -2") == "−1: `stabilab -1 omega1`, −2"
    assert letters.printed("-1 ` -2") == "−1 ` −2"
