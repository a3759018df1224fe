"""Every number that a text prints is in the JSON of the same command under a key of its own: a script never has
to read a sentence. Numbers inside the texts of JSON do not count. Of random scenes: test_views_of_random_scenes.py."""
from __future__ import annotations

import json
import math
import re
from fractions import Fraction

import pytest

from tests.recorded.answers import run
from tests.recorded.cases import ROOT, written

# of a text: not part of a name (omega1, x3, cubesat-3u), a formula's power or index, a list's place
NUMBER = re.compile(r"(?<![\w.^/])[-−+]?\d[\d,]*(?:\.\d+)?(?:e[-+]?\d+)?(?![\w]|\.\d|/\d)(?!\s*(?:\^|D\b))")
TURN = 180 / math.pi
RATES = {"rad/s": 1.0, "deg/s": 1 / TURN, "deg/day": 1 / TURN / 86400, "rpm": math.pi / 30, "rev/s": math.tau}
UNITS = RATES | {f"({name})²": size**2 for name, size in RATES.items()} | {
    "rad": 1.0, "deg": 1 / TURN, "deg/s²": 1 / TURN, "s": 1.0, "min": 60.0, "h": 3600.0, "day": 86400.0, "%": 0.01}
ANY = sorted({*UNITS.values()})  # of a number whose unit stands elsewhere, such as at the head of a column
# the unit of a number: behind it, behind others of a list, or behind the vector that it is in
ONE = r"[-−+]?[\d,.]+(?:e[-+]?\d+)?"
NAMES = "|".join(map(re.escape, sorted(UNITS, key=len, reverse=True)))
UNIT = re.compile(rf"(?:\s*(?:to|and|or|,|±|x)\s{ONE})*\s*({NAMES})(?![\w/²])")
OF_VECTOR = re.compile(rf"(?:,\s{ONE})*\)\s?({NAMES})?(?![\w/²])")
COMMANDS = {"fate": ("--why",), "extremes": ("--why",), "period": ("--why",), "classify": ("--why",),
            "stuck": ("--why",), "attitude": (), "flat-spin": (), "when": ("--rate", "30 deg/s")}


def numbers(value):
    """All numbers under keys of an object of JSON, and how many entries its lists have."""
    if isinstance(value, bool) or value is None:
        return
    if isinstance(value, (int, float)):
        yield float(value)
    elif isinstance(value, str):
        try:  # decimals that are asked for, exact ratios, and infinities
            yield float(value) if "/" not in value else float(Fraction(value))
        except (ValueError, ZeroDivisionError):
            return
    else:
        if isinstance(value, list):
            yield float(len(value))
        for one in value.values() if isinstance(value, dict) else value:
            yield from numbers(one)


def unit_of(before: str, behind: str) -> str:
    """The unit of the number that stands between these parts of a line; empty where none follows it."""
    inside = before.count("(") > before.count(")")
    out = UNIT.match(behind) or (OF_VECTOR.match(behind) if inside else None)
    return (out and out[1]) or ""


def known(text: str, unit: str, values) -> bool:
    """Whether a printed number is one of the values in SI, to its last digit (bounds are rounded outward)."""
    words = text.replace(",", "").replace("−", "-")
    value, (digits, _, power) = float(words), words.partition("e")
    last = 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
    if "." not in digits and not power and unit != "%":  # three or four significant digits
        whole = digits.strip("+-")
        last = max(0.5 * bool(unit), 10.0 ** (len(whole) - (3 if whole.endswith("0") or len(whole) < 4 else 4)))
    sizes = ANY if not unit or not value else (0.01, 1.0) if unit == "%" else (UNITS[unit],)
    return any(abs(abs(one) - abs(value) * size) <= (1.01 * last + 1e-9 * abs(value)) * size
               for size in sizes for one in values)


def missing(text: str, given, case: str):
    """Lines of a text with a number that the JSON has under no key; what stands between quotes is to be typed."""
    values, lines = [*numbers(given)], []
    for line in re.sub(r'"[^"]*"', "", text.replace(case, "CASE")).splitlines():
        lost = [out[0] for out in NUMBER.finditer(line)
                if not known(out[0], unit_of(line[:out.start()], line[out.end():]), values)]
        lines += [(lost, line)] if lost else []
    return lines


def asked(command, path):
    options = COMMANDS[command]
    text, found = run(command, str(path), *options), run(command, str(path), *options, "--json")
    return (text["answer"], found["answer"]) if isinstance(found["answer"], (list, dict)) else ("", None)


# a title is the user's text; a row of a sweep's table holds the values of its keys, which are the user's
def own(path, text):
    title = re.search(r'^title = "(.*)"', path.read_text(encoding="utf-8"), re.MULTILINE)
    lines = text.splitlines()
    letters = len(title[1]) if title else -1
    kept = "\n".join(line for line in lines if len(line) != letters or line.startswith(" "))
    # no quantities of the answer
    for words in ("along axes 1, 2, 3", "with 95 % confidence", "5, 50 and 95 % quantiles", "tends to 2 on tori"):
        kept = kept.replace(words, "")
    return kept


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("command", COMMANDS)
def test_every_number_of_a_text_is_a_key_of_json_in_all_cases(command, tmp_path):
    lost = {}
    for path in written(tmp_path):
        if "\n[sweep" in path.read_text(encoding="utf-8"):
            continue  # a table of combinations, beside an object for each
        text, given = asked(command, path)
        if found := missing(own(path, text), given, path.stem):
            lost[path.stem] = found
    assert lost == {}


def test_a_key_that_is_left_out_is_seen():
    path = ROOT / "cases/minor-axis-100.toml"
    text, (given,) = asked("fate", path)
    for name in ("largest_rate", "period", "margin", "invariants"):
        less = json.loads(json.dumps(given))
        del less["numbers"][name]
        if name == "largest_rate":
            less["numbers"].pop("extremes")
        if name == "margin":
            del less["margin"]
        assert missing(text, less, path.stem), name
