"""Whatever stands in a case file: it is a case, or an error that names file and line; nothing in it is ever
run."""
import ast
import os
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings

import stabilab as stabilab_package
from stabilab.case import source as case_sweep
from stabilab.case.read import load
from stabilab.errors import BAD_INPUT, OK, CaseError, printable
from tests.fuzz.grammar import CASES, mutated_cases, written_cases
from tests.fuzz.judge import judged
from tests.house.rooms import tree_of

QUICK = settings(max_examples=200, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))


@pytest.mark.slow
@QUICK
@given(written_cases())
def test_a_file_by_grammar_is_a_case_or_names_its_faults(tmp_path_factory, raw):
    judged(raw, tmp_path_factory.getbasetemp() / "written.toml")


@QUICK
@given(mutated_cases())
def test_a_mutated_case_is_a_case_or_names_its_faults(tmp_path_factory, raw):
    judged(raw, tmp_path_factory.getbasetemp() / "mutated.toml")


# -- what fuzzing found

BODY = "[body]\ninertia = [3, 2, 1]\n"


@pytest.fixture
def judge(tmp_path):
    """The words of the faults of a text, or its cases."""
    def result(text):
        found = judged(text.encode(), tmp_path / "my.toml")
        return found if isinstance(found, list) else [printable(p.message) for p in found.problems]
    return result


def test_a_long_number_with_a_wrong_letter_is_refused_at_once(judge):
    """A pattern that could match digits in many ways tried them all: 2^50 of them."""
    (message,) = judge(BODY
                       + f'[motion]\nx = [0, 0, "{"1234567890" * 30}b1"]\n[effects.constant_torque]\nmu = '
                         f'[0, 0, 1]\n')
    assert "expected a decimal or a ratio" in message


@pytest.mark.parametrize("number", ["1\\t/\\t2", " 1 / 2 ", "\\n1/2"])
def test_a_ratio_may_have_any_blank_in_it(judge, number):
    one, *_ = judge(f'[scaled]\na = "{number}"\nb = 1\nmu = [0, 0, 1]\n')
    assert one.scene.exact_ab == (Fraction(1, 2), 1)


@pytest.mark.parametrize("number",
                         ["١", "１", "1\\u00a0/2", "1__0", "1_", "_1", "1e", ".", "0x1", "1e12345", "", " "])
def test_what_only_looks_like_a_number_is_refused(judge, number):
    (message,) = judge(f'[scaled]\na = "{number}"\nb = 1\nmu = [0, 0, 1]\n')
    assert "expected a decimal or a ratio" in message


@pytest.mark.parametrize("text, words", [
    ('[scaled]\na = "\\u001b[31m\\u0007"\nb = 1\nmu = [0, 0, 1]\n', "\\x1b[31m\\x07"),
    (BODY + '"\\u202e" = 1\n', "unknown key"), ('title = "\\u001b[2J"\n' + BODY, "U+001B"),
    ('source = "a\\u202eb"\n' + BODY, "U+202E"),
    (BODY + '[effects]\n"a\\nb.toml:1: forged" = 1\n', "unknown effect")])
def test_no_file_sends_escape_codes_or_forges_a_line(judge, text, words):
    """`judged` looks at every character of the message."""
    (message,) = judge(text)
    assert words in message


def test_a_file_of_ten_thousand_faults_is_answered_with_the_first_fifty(judge, tmp_path):
    messages = judge(BODY + "".join(f"k{i} = 1\n" for i in range(10_000)))
    assert len(messages) == 10_000
    with pytest.raises(CaseError, match=f"and {10_000 - CaseError.SHOWN} more$") as caught:
        load(tmp_path / "my.toml")
    assert str(caught.value).count("\n") == CaseError.SHOWN


def test_one_case_of_a_sweep_file_makes_no_combinations(case_file, monkeypatch):
    """10,000 combinations of a large file would be copied only to be thrown away."""
    path = case_file(BODY + '[sweep]\n"body.inertia" = [[1, 1, 1], [2, 2, 1]]\n', "my")
    monkeypatch.setattr(case_sweep, "_with", lambda *_: pytest.fail("a combination was made"))
    assert load(path).scene.body.exact == (3, 2, 1)


# -- nothing of a case file is ever run

SOURCES = sorted((Path(stabilab_package.__file__).parent).rglob("*.py"))
# builtins that turn text into code
RUNNING = {"eval", "exec", "compile", "__import__", "execfile", "breakpoint"}
UNPACKING = {"pickle", "cPickle", "_pickle", "dill", "cloudpickle", "joblib", "marshal", "shelve",
             "jsonpickle", "yaml"}
EXPRESSIONS = {"sympify", "parse_expr", "parse_latex", "parse_mathematica", "S", "lambdify", "literal_eval",
               "from_string"}
# The formulas of the papers are texts of the package itself; lambdify gets expressions that the program
# built; a Taylor step is written out for two orders, which are numbers of its module.
STEPS = "unreduced/spin_up/steps.py"
ALLOWED = {("physics/to_numpy.py", "lambdify"), ("theories/cavity.py", "lambdify"), (STEPS, "exec"),
           (STEPS, "compile")}
# between the processes of one report, in a folder that the first has just made
OWN_OBJECTS = {("tasks.py", "pickle")}


def called(tree):
    """(name, line) of every function called by its own or by its last name; methods of the program's own
    objects count too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            function = node.func
            name = (function.id if isinstance(function, ast.Name)
                    else function.attr if isinstance(function, ast.Attribute) else "")
            yield name, isinstance(function, ast.Name), node


def dangers(path, tree):
    found = []
    for name, plain, node in called(tree):
        if (name in RUNNING and plain or name in EXPRESSIONS) and (path, name) not in ALLOWED:
            found.append((name, node.lineno))
        if any(k.arg == "allow_pickle" and getattr(k.value, "value", None) is not False or
               k.arg == "shell" and getattr(k.value, "value", None) is not False for k in node.keywords):
            found.append((name, node.lineno))
        if name == "load" and isinstance(node.func,
                                         ast.Attribute) and getattr(node.func.value, "id",
                                                                    "") in ("np", "numpy"):
            found.append(("numpy.load", node.lineno))
    for node in ast.walk(tree):
        names = ([a.name for a in node.names] if isinstance(node, ast.Import) else [node.module or ""]
                 if isinstance(node, ast.ImportFrom) else [])
        found += [(name, node.lineno) for name in names if name.split(".")[0] in UNPACKING
                  and (path, name) not in OWN_OBJECTS]
    return found


def test_no_module_turns_text_into_code_or_objects():
    names = {path.relative_to(Path(stabilab_package.__file__).parent).as_posix(): path for path in SOURCES}
    found = {name: dangers(name, tree_of(path)) for name, path in names.items()}
    assert not {name: wrong for name, wrong in found.items() if wrong}


def test_the_search_for_dangers_finds_each_of_them():
    text = ("import pickle\nfrom joblib import load\neval(x)\nexec(x)\nsp.sympify(x)\nnp.load(x)\nf(x, "
            "allow_pickle=True)\n"
            "subprocess.run(x, shell=True)\nroot.eval(x)\nre.compile(x)\n")
    assert sorted(line for _, line in dangers("case.py", ast.parse(text))) == [1, 2, 3, 4, 5, 6, 7, 8]


@pytest.mark.parametrize("text", ["__import__('os').mkdir('made')", "2*pi", "sqrt(2)", "9**9**9", "lambda: 0",
                                  "1 + 1", "(1)", "1;2", "1 if 1 else 2"])
def test_an_expression_in_a_case_file_is_refused_not_run(judge, tmp_path, monkeypatch, text):
    monkeypatch.chdir(tmp_path)
    (message,) = judge(f'[scaled]\na = "{text}"\nb = 1\nmu = [0, 0, 1]\n')
    assert "expected a decimal or a ratio" in message and not (tmp_path / "made").exists()


# -- files that are none


def refused(stabilab, *arguments):
    code, out, err = stabilab(*arguments)
    assert code == BAD_INPUT and out == "" and "Traceback" not in err and err
    return err


@pytest.mark.one_in(3)
@pytest.mark.parametrize("command", ["classify", "extremes", "show", "simulate", "plot", "precision",
                                     "compare", "surface", "report"])
def test_every_command_refuses_what_is_no_file_with_2(stabilab, tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    where = ["--out", "made"] if command in ("surface", "report") else []
    os.mkfifo("pipe.toml") if hasattr(os, "mkfifo") else None
    Path("folder.toml").mkdir()
    Path("huge.toml").write_bytes(b"#" * 10_000_000)
    Path("bytes.toml").write_bytes(os.urandom(0) + bytes(range(256)))
    Path("deep.toml").write_text("a = " + "[" * 50_000)
    Path("loop.toml").symlink_to("loop.toml")
    for name in sorted(p.name for p in tmp_path.iterdir()) + ["absent.toml"]:
        assert name in refused(stabilab, command, name, *where)
    assert not Path("made").exists()


@pytest.mark.skipif(os.name != "posix", reason="file permissions of POSIX")
def test_a_file_that_may_not_be_read_or_vanishes_is_refused(case_file, monkeypatch, stabilab):
    path = case_file(BODY, "my")
    real, failures = open, []

    def failing(file, *rest, **named):
        if str(file) == str(path):
            raise failures[-1]
        return real(file, *rest, **named)
    monkeypatch.setattr("builtins.open", failing)
    for failure, words in ((PermissionError(13, "Permission denied"), "Permission denied"),
                           (OSError(5, "Input/output error"), "Input/output"),
                           # it vanished after it was looked at
                           (FileNotFoundError(2, "No such file"), "no such file")):
        failures.append(failure)
        assert words in refused(stabilab, "classify", path)


@pytest.mark.parametrize("name", ["it's & <b> $x_1$ %.toml", "naïve Ω.toml", "new\nline.toml",
                                  "esc\x1b[31m.toml", "-.toml"])
def test_any_file_name_is_answered(stabilab, tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    Path(name).write_text(BODY)
    for command in (("classify", "--json"), ("classify",), ("show",)):
        code, out, err = stabilab(*command, f"./{name}")
        assert code == OK and "\x1b" not in out + err, err
    Path(name).write_text("x")
    assert "\x1b" not in refused(stabilab, "classify", f"./{name}")


@pytest.mark.skipif(os.name != "posix", reason="names of files are bytes on POSIX")
def test_a_file_name_that_is_not_utf8_is_refused(stabilab, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    name = os.fsdecode(b"\xff.toml")
    Path(name).write_text(BODY)
    assert "not UTF-8" in refused(stabilab, "classify", name)


def test_output_that_takes_ascii_only_is_no_fault(tmp_path):
    (tmp_path / "my.toml").write_text('title = "Ω → ω"\n' + BODY, encoding="utf-8")
    run = subprocess.run([sys.executable, "-m", "stabilab", "classify", tmp_path / "my.toml"],
                         capture_output=True,
                         env=os.environ | {"PYTHONIOENCODING": "ascii"})
    # letters that have a name are named, others escaped
    assert run.returncode == OK and rb"Omega \u2192 omega" in run.stdout, run.stderr


# -- pages and documents

HOSTILE = "<script>alert(1)</script> & \\\\input{/etc/passwd} $x_1$ %d {{ 7*7 }} \\\"q\\\" # ~ ^"


@pytest.mark.slow
def test_a_hostile_title_is_text_in_every_output_of_a_case(stabilab, tmp_path, monkeypatch):
    """Text, JSON, pictures (no mathematics is set in titles) and meshes; the report has its own test."""
    monkeypatch.chdir(tmp_path)
    text = next(p for p in CASES if p.stem == "minor-axis-100").read_text(encoding="utf-8")
    Path("my.toml").write_text(re.sub(r"(?m)^(title|source) = .*$", lambda m: f'{m[1]} = "{HOSTILE}"', text),
                               encoding="utf-8")
    for arguments in (["classify", "my.toml"], ["classify", "my.toml", "--json"], ["show", "my.toml"],
                      ["plot", "my.toml"],
                      ["simulate", "my.toml", "--at", "0,1", "--out", "my.nc"],
                      ["simulate", "my.toml", "--at", "0,1", "--out", "my.csv"]):
        code, out, err = stabilab(*arguments)
        assert code == OK, err
    assert "<script>" not in Path("my.csv").read_text()


@pytest.mark.parametrize("command", ["classify", "extremes", "fate", "period"])
def test_what_the_analysis_refuses_is_an_error_of_the_file_and_its_line(stabilab, tmp_path, monkeypatch,
                                                                        command):
    monkeypatch.chdir(tmp_path)
    Path("fast.toml").write_text("[body]\ninertia = [2000, 1500, 1000]\n[effects.gyrostat]\nmomentum = [100, "
                                 "0, 0]\n"
                                 "[effects.constant_torque]\ntorque = [-1, 0, 0]\n[motion]\nangular_velocity "
                                 "= [1e160, 2e160, 1]\n", encoding="utf-8")
    code, out, err = stabilab(command, "fast.toml")
    assert code == BAD_INPUT and not out
    assert err.startswith("fast.toml:8: motion.angular_velocity: ") and "largest double" in err
