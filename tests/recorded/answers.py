"""What is recorded of every command, how it is run, and when two answers are the same.

A record is a folder with one text file a case: the command, its exit code, its messages ("! ..."), an empty
line, its answer. A view that no command prints has a name in place of the command."""
from __future__ import annotations

import contextlib
import io
import json
import math
import re
import sys
from collections.abc import Callable
from pathlib import Path

from stabilab import cli

from .cases import ROOT, written
from .views import VIEWS

HERE = Path(__file__).parent
ONE_CASE = {  # of every case
    "classify": ["classify", "--json"], "fate": ["fate", "--json"], "extremes": ["extremes", "--json"],
    "period": ["period", "--json"],
    "stuck": ["stuck", "--json"], "when": ["when", "--rate", "30 deg/s", "--json"],
    "simulate": ["simulate", "--at", "0,1,10", "--json"],
    "show": ["show"], "classify-text": ["classify"], "fate-text": ["fate", "--why"], "stuck-text": ["stuck"],
    "period-text": ["period"], "extremes-text": ["extremes"], "extremes-csv": ["extremes", "--csv"],
    "when-text": ["when", "--rate", "30 deg/s"], "attitude": ["attitude", "--json"],
    "attitude-text": ["attitude"], "flat-spin": ["flat-spin", "--json"], "flat-spin-text": ["flat-spin"],
}
SEVERAL = {  # from the repository's root
    "compare": [["compare", f"cases/{name}.toml", "--json"]
                for name in ("top-fast", "charged-body-small-torque", "liquid-torque-3")],
    "audit": [["audit", "--json"]],
    "digits": [["fate", "cases/minor-axis-100.toml", "cases/middle-axis-300.toml",
                "cases/major-axis-100.toml", "--digits", "30", "--json"],
               ["period", "cases/minor-axis-100.toml", "cases/middle-axis-300.toml", "--digits", "40",
                "--json"],
               ["extremes", "cases/minor-axis-100.toml", "cases/middle-axis-300.toml", "--digits", "40",
                "--json"]],
    "tilt": [["fate", "cases/geostationary-22n.toml", "cases/cubesat-3u.toml", "--tilt", "1 deg", *form]
             for form in ([], ["--json"])],
    "certificates": [["classify", "cases/minor-axis-100.toml", "--certify", "--out", "{}/certificate.json"],
                     ["verify", "{}/certificate.json", "--json"],
                     ["classify", "cases/off-axis-one.toml", "--certify", "--out", "{}/spin-up.json"],
                     ["verify", "{}/spin-up.json", "--json"],
                     ["fate", "cases/off-axis-two.toml", "--certify"],
                     ["classify", "cases/torque-free-gyrostat.toml", "--certify", "--out", "{}/free.json"],
                     ["verify", "{}/free.json"], ["verify", "{}/certificate.json"]],
    "bifurcation": [["bifurcation", "cases/wheel-and-thruster.toml", "--vary", "torque[3]=0:2000", "--json"],
                    ["bifurcation", "cases/wheel-and-thruster.toml", "--vary", "torque[3]=0:2000"],
                    ["bifurcation", "cases/minor-axis-100.toml", "--vary",
                     "effects.gyrostat.momentum[1]=-200:400", "--json"],
                    ["bifurcation", "cases/two-wheels-minor-axis.toml", "--vary", "torque[1]=-1:1", "--vary",
                     "torque[3]=-1:1", "--json"]],
    "maps": [["sweep", "cases/minor-axis-100.toml", "--vary", "x[1]=-4:4:9", "--vary", "x[3]=-3:3:7",
              "--answer",
              "fate,level,reason,margin,distance,extremes,period,equilibria", "--csv"],
             ["atlas", "cases/thruster-stuck-major-axis.toml", "--level", "0", "--refine", "1", "--csv"],
             ["basin", "cases/minor-axis-100.toml", "--vary", "x[1]=-4:4:17", "--vary", "x[3]=-3:3:17",
              "--json"]],
    "words": [["compare", "cases/top-lx30-lz30.toml"], ["compare", "cases/charged-body.toml"],
              ["compare", "cases/liquid-base.toml"],
              ["stuck", "cases/upper-stage.toml", "--why"],
              ["stuck", "cases/thruster-stuck-major-axis.toml", "--why"],
              ["stuck", "cases/geostationary-22n.toml", "--all-thrusters"],
              ["classify", "cases/liquid-sensible.toml", "--units", "si"],
              ["classify", "cases/charged-body-attitude.toml", "--why"],
              ["classify", "cases/charged-body.toml", "--strict"], ["fate", "cases/charged-body.toml", "--strict"],
              ["extremes", "cases/charged-body.toml", "--strict"], ["period", "cases/charged-body.toml", "--strict"],
              ["extremes", "cases/charged-body.toml"], ["extremes", "cases/charged-sweep.toml"],
              ["when", "cases/cubesat-3u.toml"], ["when", "cases/geostationary-22n.toml"],
              ["when", "cases/liquid-base.toml", "--rate", "2 rad/s"],
              ["when", "cases/liquid-base.toml", "--rate", "2 rad/s", "--strict"],
              ["when", "cases/uncertain-separatrix.toml", "--rate", "1.5"],
              ["when", "cases/charged-body.toml", "--tilt", "z = 20 deg"],
              ["when", "cases/charged-body.toml", "--rate", "5"],
              ["when", "cases/charged-sweep.toml", "--rate", "3", "--csv"],
              ["when", "cases/cubesat-3u.toml", "--until", "5 s"],
              ["when", "cases/cubesat-3u.toml", "--until", "5 s", "--strict"],
              ["when", "cases/thruster-stuck-major-axis.toml", "--rate", "5", "--strict"],
              ["stuck", "cases/geostationary-22n.toml", "--all-thrusters", "--csv"],
              ["compare", "cases/minor-axis-100.toml"],
              ["simulate", "cases/charged-body.toml", "--model", "printed", "--at", "0,1"],
              ["simulate", "cases/charged-body.toml", "--model", "linear", "--at", "0,1"],
              ["chaos", "cases/minor-axis-100.toml", "--until", "300", "--csv"],
              ["chaos", "cases/minor-axis-100.toml", "--until", "300", "--json"],
              ["sweep", "cases/minor-axis-100.toml", "--vary", "inertia[1]=2000,2001,-9000"],
              ["sweep", "cases/minor-axis-100.toml", "--vary", "x[1]=2.5"],
              ["when", "cases/cubesat-3u.toml", "--component", "z = 30 deg/s", "--units", "si"],
              ["simulate", "cases/minor-axis-100.toml", "--at", "0,1"],
              ["simulate", "cases/cubesat-3u.toml", "--at", "0,1", "--attitude"],
              ["attitude", "cases/phone.toml"], ["attitude", "cases/toutatis.toml"],
              ["attitude", "cases/toy-top.toml"], ["orbit", "cases/orbits/boom.toml"],
              ["burn", "cases/burns/stage.toml"],
              ["chaos", "cases/minor-axis-100.toml", "--until", "300"], ["chaos", "cases/off-axis-fold.toml"],
              ["sweep", "cases/minor-axis-100.toml", "--vary", "x[1]=-4:4:5", "--answer",
               "fate,margin,extremes,period"],
              ["sweep", "cases/off-axis-two.toml", "--vary", "torque[3]=-0.1,0.1", "--answer",
               "equilibria,verdict"],
              ["sweep", "cases/charged-body.toml", "--vary", "charge=0.002,0.003"],
              ["basin", "cases/minor-axis-100.toml", "--vary", "x[1]=-4:4:9", "--vary", "x[3]=-3:3:9",
               "--depth", "2"],
              ["atlas", "cases/thruster-stuck-major-axis.toml", "--level", "0", "--refine", "1"],
              ["bifurcation", "cases/middle-axis-double-well.toml", "--vary", "b=0:4", "--vary", "x[1]=-3:3"],
              ["bifurcation", "cases/off-axis-two.toml", "--vary", "torque[3]=-1:1"],
              ["example"]],
}
ALL = (*ONE_CASE, *SEVERAL, *VIEWS)
# Numbers agree to so much of the largest in their list: extremes are promised to 1e-12, periods to 1e-11 of
# themselves; a run keeps its own tolerance
# (explorer and pictures: of single precision)
RELATIVE = {"simulate": 1e-9, "compare": 1e-9, "explorer": 1e-6, "pictures": 1e-6}
USUAL = 1e-11
# a direction of an atlas that a run of thousands of steps decides, or not: there a processor's last digits count
BY_A_RUN = re.compile(r"^,,.*,(?:certified,certified|undecided,off_axis),.*\n", re.MULTILINE)
ROUNDING = 1e-14  # a number in words, or an error, below it is what rounding left
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def run(*arguments: str) -> dict:
    """Exit code, answer (parsed where it is JSON) and message of a command, run in this process."""
    out, err, before = io.StringIO(), io.StringIO(), sys.argv
    sys.argv = ["stabilab", *arguments]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            cli.main()
        code = 0
    except SystemExit as end:
        code = end.code or 0
    finally:
        sys.argv = before
    text = out.getvalue()
    text = json.loads(text) if "--json" in arguments and text else BY_A_RUN.sub("", text)
    return {"exit": code, "answer": text, "message": err.getvalue()}


def now(record: str, folder: Path, wanted: Callable[[str], bool] = lambda key: True) -> dict:
    """{case, or command line: what is said of it} of one of the records, of the wanted ones."""
    if record in SEVERAL:
        lines = {" ".join(line): [word.format(folder) for word in line] for line in SEVERAL[record]}
        return {key: _without(run(*line), folder) for key, line in lines.items() if wanted(key)}
    if record in VIEWS:
        return {path.stem: _without(VIEWS[record](path), folder, path)
                for path in sorted((ROOT / "cases").glob("*.toml")) if wanted(path.stem)}
    command, *options = ONE_CASE[record]
    return {path.stem: _without(run(command, str(path), *options), folder, path)
            for path in written(folder) if wanted(path.stem)}


def _without(found: dict, folder: Path, *paths: Path) -> dict:
    """The same without where it was run."""
    text = json.dumps(found)
    for place in (*(str(p.parent) for p in paths), str(folder), str(ROOT)):
        text = text.replace(place, ".")
    return json.loads(text)


def recorded(name: str) -> dict:
    """{case, or command line: what was said of it}."""
    texts = (path.read_text(encoding="utf-8") for path in sorted((HERE / name).glob("*.txt")))
    return dict(_read(name, text) for text in texts)


def record(name: str, found: dict) -> list[str]:
    """Writes the files of the answers that are not the recorded ones, and deletes those of answers that are
    no more; numbers that differ by less than their tolerance change no file. Gives the names of the files."""
    folder, before, changed = HERE / name, recorded(name), []
    folder.mkdir(exist_ok=True)
    files = {_file(key): key for key in found}
    assert len(files) == len(found), "two answers with one file"
    for file, key in files.items():
        if key not in before or differences(before[key], found[key], RELATIVE.get(name, USUAL)):
            (folder / file).write_text(_text(name, key, found[key]), encoding="utf-8")
            changed.append(file)
    for path in folder.glob("*.txt"):
        if path.name not in files:
            path.unlink()
            changed.append(path.name)
    return changed


def _file(key: str) -> str:
    return re.sub(r"[^\w.=+-]+", "-", key).strip("-") + ".txt"


def _text(name: str, key: str, found: dict) -> str:
    if name in VIEWS:
        return f"{name}: {key}\n\n{_json(found)}\n"
    message = "".join(f"! {line}\n" for line in found["message"].splitlines())
    answer = found["answer"]
    return (f"$ {_command(name, key)}\nexit {found['exit']}\n{message}\n"
            f"{answer if isinstance(answer, str) else _json(answer)}\n")


def _command(name: str, key: str) -> str:
    return key if name in SEVERAL else " ".join([*ONE_CASE[name][:1], f"{key}.toml", *ONE_CASE[name][1:]])


def _read(name: str, text: str) -> tuple[str, dict]:
    head, _, answer = text.removesuffix("\n").partition("\n\n")
    if name in VIEWS:
        return head.partition(": ")[2], json.loads(answer)
    command, end, *messages = head.split("\n")
    key = command.removeprefix("$ ")
    key = key if name in SEVERAL else key.split(" ")[1].removesuffix(".toml")
    words = command.split(" ")
    return key, {"exit": int(end.removeprefix("exit ")),
                 "message": "".join(f"{line.removeprefix('! ')}\n" for line in messages),
                 "answer": json.loads(answer) if "--json" in words and answer else answer}


def _json(value: object, indent: str = "") -> str:
    """JSON, of which what fits is one line."""
    short, inner = json.dumps(value, sort_keys=True, ensure_ascii=False), indent + " "
    if len(indent) + len(short) <= 110 or not value or not isinstance(value, (dict, list)):
        return short
    if isinstance(value, dict):
        rows = [f"{inner}{json.dumps(key)}: {_json(value[key], inner)}" for key in sorted(value)]
        return "{\n" + ",\n".join(rows) + f"\n{indent}}}"
    return "[\n" + ",\n".join(inner + _json(one, inner) for one in value) + f"\n{indent}]"


def differences(before, now, relative: float, where: str = "", size: float = 0.0) -> list[str]:
    """Where two answers differ, in words: words and whole numbers exactly, others to `relative` of the
    largest in their lists, numbers inside words to one in their last digit."""
    if isinstance(before, dict) and isinstance(now, dict):
        found = ([f"{where}: {sorted(before.keys() ^ now.keys())} in one only"] if before.keys() != now.keys()
                 else [])
        return (found + [d for key in before.keys() & now.keys()
                         for d in differences(before[key], now[key], relative, f"{where}.{key}")])
    if isinstance(before, list) and isinstance(now, list):
        if len(before) != len(now):
            return [f"{where}: {len(before)} entries, now {len(now)}"]
        largest = max(size, _largest(before))
        return [d for i, pair in enumerate(zip(before, now))
                for d in differences(*pair, relative, f"{where}[{i}]", largest)]
    if isinstance(before, (int, float)) and isinstance(now, (int, float)) and isinstance(before + now, float):
        if where.endswith(".reached"):  # digits of a run
            same = abs(before - now) <= 0.5
        elif where.endswith(".error") and max(abs(before), abs(now)) < ROUNDING:
            same = True  # what rounding left, another thing on another processor
        elif where.endswith(".growth_time"):  # of an eigenvalue beside others that are 1e5 times as large
            same = abs(before - now) <= 1e-10 * abs(before)
        else:  # of an estimated error two digits are meant
            same = before == now or abs(before - now) <= max(
                relative * max(abs(before), size), 0.01 * abs(before) if ".error." in where else 0)
    elif isinstance(before, str) and isinstance(now, str):
        same = _same_words(before, now)
    else:
        same = before == now
    return [] if same else [f"{where}: {before!r}, now {now!r}"]


def _largest(numbers: list) -> float:
    """The size of the largest number in lists of lists: one eigenvalue is as near as the largest lets it be."""
    return max((_largest(v) if isinstance(v, list) else abs(v) for v in numbers
                if isinstance(v, list) or isinstance(v, float) and math.isfinite(v)), default=0.0)


def _same_words(before: str, now: str) -> bool:
    one, other = NUMBER.findall(before), NUMBER.findall(now)
    return NUMBER.sub("#", before) == NUMBER.sub("#", now) and all(
        a == b or abs(float(a) - float(b)) <= max(1.5 * _last(a), ROUNDING) for a, b in zip(one, other))


def _last(number: str) -> float:
    """The unit of a printed number's last digit; 0 of a whole number, which counts something."""
    digits, _, power = number.partition("e")
    after = len(digits.partition(".")[2])
    return 10.0 ** (int(power or 0) - after) if after or power else 0.0
