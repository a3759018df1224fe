"""Findings of the validation as text, JSON and an HTML page."""
from __future__ import annotations

from collections import Counter
from pathlib import Path

from ...show.report import html
from .findings import VERDICTS

SCHEMA = "stabilab.validate/1"


def as_dict(validated) -> dict:
    """{"schema", "sources"} of (source, findings) pairs."""
    return {"schema": SCHEMA,
            "sources": [_source(source) | {"values": [_value(source, one) for one in found]} for source,
                        found in validated]}


def _source(source):
    return {"source": source.name, "title": source.title, "repository": source.repository,
            "commit": source.commit, "licence": source.licence,
            "about": source.about}


def _value(source, one):
    return {"tool": one.printed.tool, "file": one.printed.file, "url": source.url(one.printed.file),
            "motion": one.printed.motion.id, "time_s": one.time,
            "quantity": one.component, "unit": one.unit, "ours": one.ours, "ours_within": one.bound,
            "theirs": one.theirs, "difference": one.difference,
            "tolerance": one.tolerance, "tolerance_is": one.printed.tolerance_is, "verdict": one.verdict,
            "cause": one.cause, "left": one.left}


def counts(found) -> str:
    """How many values have which verdict, in words."""
    number = Counter(one.verdict for one in found)
    told = {"agrees": "agree", "explained": "differ for a known cause", "differs": "differ"}
    words = {verdict: many if number[verdict] > 1
             else many.replace("agree", "agrees").replace("differ", "differs") for verdict,
             many in told.items()}
    return (", ".join(f"{number[verdict]} {words[verdict]}" for verdict in VERDICTS if number[verdict])
            or "no values are printed")


def text(validated) -> str:
    """How many values agree, then a table a source: a row a value, and what explains a tool's differences
    below its rows."""
    all_of = ([f"{len(validated)} sources: {counts([one for _, found in validated for one in found])}"]
              if len(validated) > 1 else [])
    return "\n\n".join([*all_of, *("\n".join(_lines(source, found)) for source, found in told(validated))])


def told(validated) -> list:
    """The sources in the order in which people read them: those without values last."""
    return sorted(validated, key=lambda pair: not pair[1])


def _lines(source, found):
    yield f"{source.name}: {counts(found)}: {source.title}"
    yield f"  {source.repository} at {source.commit[:12]}, {source.licence}; {source.about}"
    for group in grouped(found):
        printed = group[0].printed
        yield (
            f"  {printed.tool} ({printed.file.rsplit('/', 1)[-1]}; tolerance {_tolerance(printed)}: "
            f"{printed.tolerance_is})")
        yield from _table([("t (s)", "quantity", "ours", "theirs", "differs by", "")] + [
            (one.time, one.component, _short(one.ours), one.theirs,
             f"{one.difference:.1e} {one.unit}".strip(), one.verdict) for one in group])
        if words := cause(group):
            yield f"    cause: {words}"


def _table(rows):
    """Rows of cells, each column as wide as it needs; the words of the second and the last from the left,
    numbers from the right."""
    sizes = [max(len(row[n]) for row in rows) for n in range(len(rows[0]))]
    for row in rows:
        yield ("    " + "  ".join(cell.ljust(size) if n in (1, len(row) - 1) else cell.rjust(size) for n,
                                  (cell, size) in enumerate(zip(row, sizes)))).rstrip()


def _short(decimal: str) -> str:
    """A proved decimal, of more digits than a person reads, rounded to 14; JSON has them all."""
    from decimal import Context
    number = Context(prec=14).create_decimal(decimal)
    return f"{number.normalize():.14g}" if number else "0"


def _tolerance(printed):
    return f"{float(printed.tolerance):.2g}{' relative' * printed.relative}"


def unexplained(validated) -> list[str]:
    """A line for each value that is farther off than its tolerance without a cause."""
    return [f"{source.name}: {one.printed.tool}: {one.component} at {one.time} s differs by "
            f"{one.difference:.1e}, tolerance {one.tolerance:.1e}"
            for source, found in validated for one in found if one.verdict == "differs"]


def grouped(found) -> list[list]:
    """The findings of each set of printed values."""
    groups: dict = {}
    for one in found:
        groups.setdefault(id(one.printed), []).append(one)
    return list(groups.values())


def cause(group) -> str:
    """What explains the values of a set that are farther off than their tolerance: its worst remainder; empty
    where there is none."""
    explained = [one for one in group if one.verdict == "explained"]
    return max(explained, key=lambda one: one.left).cause if explained else ""


def page(validated, path, **around) -> Path:
    """The page of (source, findings) pairs as a file; around: of the pages beside it (`html.render`)."""
    sources = [{"source": source, "count": counts(found),
                "groups": [_group(source, group) for group in grouped(found)]} for source,
               found in told(validated)]
    return html.write(Path(path), "validation.html", title="Numbers of other tools beside ours",
                      sources=sources, **around)


def _group(source, group):
    printed = group[0].printed
    return {"printed": printed, "url": source.url(printed.file), "tolerance": _tolerance(printed),
            "rows": group, "cause": cause(group)}
