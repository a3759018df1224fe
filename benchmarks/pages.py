"""RESULTS.md, and the numbers of speed in README.md and docs/, from results.json.

A page states a speed as a link to its row: `[0.11 us](../benchmarks/RESULTS.md#fate-minor)` is ours of the
row `fate-minor`. A title says that another number of the row is meant: `(...#fate-minor "theirs")` the
other's, `"ratio"` how many times as long the other takes (`26 times`), `"inverse"` how many times as long we
take. `python -m benchmarks docs` writes the words of every such link anew; nobody types them.
"""
from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from .record import ROOT, TOPICS, Results

PAGE = Path(__file__).with_name("RESULTS.md")
LINK = re.compile(r"\[([^\]\n]*)\]\((?:\.\./)*benchmarks/RESULTS\.md#([\w-]+)"
                  r"(?: \"(theirs|ratio|inverse)\")?\)")
# Written by `make docs` from what stands elsewhere
MADE = {"readme.md", "results.md", "api.md", "commands.md", "gallery.md", "contributing.md", "changelog.md"}
HEAD = """# Speed, side by side

How long stabilab takes beside what a careful user would write with heyoka, SciPy or VTK: a ratio of 10 says
that stabilab needs a tenth of the time, one below 1 that it is slower. Ratios are medians of rounds in which
both took turns, in brackets their range. `make bench` measures everything and writes this page, and the
speeds of all others, from `benchmarks/results.json`. Times are those of the machine of the run; a row with
*changed* times code that has changed since its run, so that it is to be measured anew.
"""


def speed_pages() -> list[Path]:
    """The pages that may state speeds."""
    docs = ROOT / "docs"
    return [ROOT / "README.md", *(page for page in sorted(docs.glob("*.md")) if page.name not in MADE),
            *sorted((docs / "mathematics").glob("*.md"))]


def number(value: float, digits: int = 3) -> str:
    """So many digits, as one reads them: 3,590 and not 3.59e+03."""
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:,.0f}" if abs(rounded) >= 100 else f"{rounded:.{digits}g}"


def amount(value: float, unit: str, digits: int = 3) -> str:
    """Seconds or bytes in a unit that reads well."""
    sizes = (((1e9, "GB"), (1e6, "MB"), (1e3, "kB")) if unit == "bytes" else
             ((1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns")))
    value = float(f"{value:.{digits}g}")
    for size, name in sizes:
        if value >= size * (1 - 1e-12) or (size, name) == sizes[-1]:
            return f"{number(value / size, digits)} {name}"
    raise AssertionError


def figure(results: Results, key: str, part: str | None) -> str:
    """The words of a link: two digits."""
    row = results.rows[key]
    if part in ("ratio", "inverse"):
        ratio = row["ratio"] if part == "ratio" else 1 / row["ratio"]
        return f"{number(ratio, 2)} times"
    return amount(row["theirs" if part == "theirs" else "ours"], row["unit"], 2)


def text(results: Results) -> str:
    """RESULTS.md."""
    names = {run: str(n) for n, run in enumerate(sorted(results.runs, key=int, reverse=True), 1)}
    lines = [HEAD, "| run | when | commit | machine | load at its start | command |",
             "| --- | --- | --- | --- | --- | --- |"]
    for run, name in names.items():
        about = results.runs[run]
        load = "unknown" if about["load"] is None else f"{about['load']:.3g}"
        lines.append(f"| {name} | {about['date']} | {about['commit']} | {about['machine']} | {load} | "
                     f"`{about['command']}` |")
    failed = [words for topic in TOPICS for words in results.failed.get(topic, [])]
    if failed:
        lines += ["", "Not measured in the last run, whose rows are those of before:", "",
                  *(f"- {words}" for words in failed)]
    for topic, (heading, _) in TOPICS.items():
        rows = {key: row for key, row in results.rows.items() if row["topic"] == topic}
        if rows:
            lines += ["", f"## {heading}", "", *_table(results, rows, names), *_notes(rows)]
    return "\n".join(lines) + "\n"


def _table(results: Results, rows: dict[str, dict[str, Any]], names: dict[str, str]) -> Iterator[str]:
    yield "| what | stabilab | the other | ratio | wanted | error | run |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    for key, row in rows.items():
        each = " each" * (row["unit"] == "each")
        theirs = f"{amount(row['theirs'], row['unit'])}{each} {row['other']}" if row["theirs"] else ""
        ratio = (f"{number(row['ratio'])} ({number(row['low'])} to {number(row['high'])})"
                 if row["ratio"] else "")
        run = names[row["run"]] + ", *changed*" * results.changed(key)
        cells = [f'<a id="{key}"></a>{row["what"]}', f"{amount(row['ours'], row['unit'])}{each}", theirs,
                 ratio, number(row["wanted"]) if row["wanted"] else "", row["error"], run]
        yield "| " + " | ".join(cells) + " |"


def _notes(rows: dict[str, dict[str, Any]]) -> Iterator[str]:
    """Each note once, with the rows that it is about unless these are all."""
    about: dict[str, list[str]] = {}
    for row in rows.values():
        if row["note"]:
            about.setdefault(row["note"], []).append(row["what"])
    for note, whats in about.items():
        yield ""
        yield (f"{note[:1].upper()}{note[1:]}." if len(whats) == len(rows)
               else f"*{'; '.join(whats)}*: {note}.")


def updated(page: str, results: Results) -> str:
    """A page with the words of its links to rows written anew; one to no row (`missing`) stays."""
    def words(link: re.Match[str]) -> str:
        if link[2] not in results.rows:
            return link[0]
        return link[0].replace(f"[{link[1]}]", f"[{figure(results, link[2], link[3])}]", 1)
    return LINK.sub(words, page)


def write(results: Results) -> list[Path]:
    """Write RESULTS.md and the pages where they differ; which ones."""
    made = {PAGE: text(results), **{path: updated(path.read_text(encoding="utf-8"), results)
                                    for path in speed_pages()}}
    written = [path for path, page in made.items()
               if not path.exists() or path.read_text(encoding="utf-8") != page]
    for path in written:
        path.write_text(made[path], encoding="utf-8")
    return written


def missing(results: Results) -> list[str]:
    """Links to rows that there are not: `page: key`."""
    return [f"{path.relative_to(ROOT).as_posix()}: {link[2]}" for path in speed_pages()
            for link in LINK.finditer(path.read_text(encoding="utf-8")) if link[2] not in results.rows]


