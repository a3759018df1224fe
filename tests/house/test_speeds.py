"""Every speed that README and docs state is a number of benchmarks/results.json, which one command writes, with
its date and commit; nothing here looks at the clock. Expected numbers are worked out by hand."""
import re
from dataclasses import dataclass

import pytest

from benchmarks import pages, record, suite
from benchmarks.rows import Row

RESULTS = record.read()
ANEW = "run `python -m benchmarks docs`"
# Figures of time that a processor takes, in prose: small units, which no motion here is measured in; ratios of
# speed; what a command takes
SPEED = re.compile(
    r"[\d.,]+ ?(?:ns|us|µs|ms)\b|[\d.,]+ times (?:heyoka|as (?:long|fast)|faster|slower|the time)|"
    r"\b(?:take|takes|took|costs?) (?:some |about |only |less than |up to )?[\d.,]+ (?:s|seconds|min|minutes|h|hours)\b|"
    r"\d (?:points|cells|states|motions) (?:a|per) (?:second|minute)")
# What looks like one and is not: page and words
OTHERS = {("docs/validation.md", "1 ms")}  # a step of another program


def prose(page):
    """A page without blocks and lines of code, and without links to rows."""
    page = re.sub(r"^```.*?^```", "", page, flags=re.M | re.S)
    return re.sub(r"`[^`\n]*`", "", pages.LINK.sub("", page))


def test_the_page_of_results_is_what_the_file_holds():
    assert pages.PAGE.read_text(encoding="utf-8") == pages.text(RESULTS), ANEW


def test_every_speed_of_a_page_is_that_of_its_row():
    assert pages.missing(RESULTS) == []
    for path in pages.speed_pages():
        page = path.read_text(encoding="utf-8")
        assert page == pages.updated(page, RESULTS), f"{path.name}: {ANEW}"


def test_no_page_states_a_speed_that_is_not_measured():
    found = {(path.relative_to(record.ROOT).as_posix(), words) for path in pages.speed_pages()
             for words in SPEED.findall(prose(path.read_text(encoding="utf-8")))}
    assert found == OTHERS


@pytest.mark.parametrize("words", ["takes 20 ms", "0.3 us a state", "26 times heyoka", "3 times as long",
                                   "which took 9 minutes", "450 cells a second", "costs some 2.5 s"])
def test_a_speed_in_prose_is_seen(words):
    assert SPEED.search(prose(words)) and not SPEED.search(prose(f"`{words}`"))
    assert not SPEED.search(prose(f"[{words}](../benchmarks/RESULTS.md#fate-minor)"))


@pytest.mark.parametrize("value, unit, words", [
    (1.05e-7, "each", "110 ns"), (9.99e-4, "s", "1 ms"), (0.000123, "s", "120 us"), (1234.0, "s", "1,200 s"),
    (72e6, "bytes", "72 MB"), (0.0304, "s", "30 ms")])  # by hand, to two digits
def test_an_amount_has_two_digits_in_a_unit_that_reads_well(value, unit, words):
    assert pages.amount(value, unit, 2) == words


@dataclass
class Sandbox:
    """Results of two topics of which one breaks, and where they are written."""

    results: record.Results
    path: object
    calls: dict

    def measure(self, *topics, commit="bbb"):
        suite.measure(self.results, list(topics), record.Run("today", commit, "here", 0.1, "bench"), True, self.path)


@pytest.fixture
def sandbox(tmp_path, monkeypatch):
    made = Sandbox(record.Results(), tmp_path / "results.json", {})
    monkeypatch.setattr(suite, "calls_of", lambda topic, small: made.calls[topic])
    monkeypatch.setattr(record, "code_of", lambda topic: "code 1")
    return made


def breaks():
    raise ValueError("no such thing")


def test_what_fails_is_named_and_loses_no_other_row(sandbox):
    sandbox.calls = {"fates": [lambda: Row("fate", "f", 1.0), lambda: Row("other", "o", 2.0)],
                     "periods": [lambda: Row("period", "p", 3.0)]}
    sandbox.measure("fates", "periods", commit="aaa")
    sandbox.calls["fates"] = [breaks, lambda: Row("other", "o", 4.0)]
    sandbox.measure("fates", "periods")
    back = record.read(sandbox.path)
    assert {key: (row["ours"], back.runs[row["run"]]["commit"]) for key, row in back.rows.items()} == {
        "fate": (1.0, "aaa"), "other": (4.0, "bbb"), "period": (3.0, "bbb")}
    assert "fates: ValueError: no such thing" in pages.text(back)


def test_a_part_that_is_measured_anew_leaves_the_dates_of_the_others(sandbox):
    sandbox.calls = {"fates": [lambda: [Row("fate", "f", 1.0), Row("gone", "g", 1.0)]],
                     "periods": [lambda: Row("period", "p", 3.0)]}
    sandbox.measure("fates", "periods", commit="aaa")
    sandbox.calls["fates"] = [lambda: Row("fate", "f", 2.0)]
    sandbox.measure("fates")
    commits = {key: sandbox.results.runs[row["run"]]["commit"] for key, row in sandbox.results.rows.items()}
    assert commits == {"fate": "bbb", "period": "aaa"}  # a row that the topic has no longer goes


def test_a_link_to_a_row_has_its_number_and_one_to_none_stays(sandbox):
    sandbox.calls = {"fates": [lambda: Row("fate", "f", 2e-7, "each", 6e-6, "by hand", 30.0, 29.0, 31.0)]}
    sandbox.measure("fates")
    page = '[{}](../benchmarks/RESULTS.md#fate), [{}](../benchmarks/RESULTS.md#fate "ratio"), [{}]({}#gone)'.format
    assert pages.updated(page("?", "?", "?", "../benchmarks/RESULTS.md"), sandbox.results) == page(
        "200 ns", "30 times", "?", "../benchmarks/RESULTS.md")


def test_a_row_is_marked_when_its_code_has_changed(sandbox, monkeypatch):
    sandbox.calls = {"fates": [lambda: Row("fate", "f", 1.0)]}
    sandbox.measure("fates")
    assert "*changed* |" not in pages.text(sandbox.results)
    monkeypatch.setattr(record, "code_of", lambda topic: "code 2")
    assert "| 1, *changed* |" in pages.text(sandbox.results)


def test_words_do_not_change_a_fingerprint_and_code_does(tmp_path):
    def lines(text):
        path = tmp_path / f"{abs(hash(text))}.py"
        path.write_text(text)
        return record._code(path)
    plain = lines("def f(x):\n    return x\n")
    assert lines('"""Of a module."""\n\n\ndef f(x):\n    """Of f,\n    at length."""\n    # why\n    return x\n') == plain
    assert lines("def f(x):\n    return -x\n") != plain
    assert all(record.code_of(topic) for topic in record.TOPICS)  # what each measures exists
