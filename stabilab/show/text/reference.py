"""A motion with guaranteed digits as JSON and CSV, with what it was made from."""
from __future__ import annotations

import math
import shlex
from collections.abc import Sequence
from decimal import Decimal, localcontext
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from ...answers.caveats import limited
from ...answers.certificate import subject
from ...answers.digits import ask
from ...answers.motion import motion
from ...answers.tabulated import Tabulated, tabulated
from ...errors import key
from ...files import write_text
from ...numbers.balls import working
from ...physics.coefficients import effective
from .. import endings, manifest
from ..data import as_json, csv_lines

if TYPE_CHECKING:
    from ...case.read import Case

REFERENCE_SCHEMA = "stabilab.reference/1"
VERSIONS = ("python", "python-flint")
SUFFIXES = (".csv", ".json")
READ_BITS = 1100  # more than any run has


def as_dict(case: Case, times: Sequence[Fraction], digits: int,
            arguments: Sequence[str] = ()) -> tuple[dict, Tabulated]:
    """(the reference as JSON has it, the run). times: rationals from 0 on; arguments: of the command line."""
    run = tabulated(case.scene, case.start, case.exact_state, times, digits)
    resolved = motion(case.scene, case.start, case.span, exact=case.exact_state)
    printed = {question: ask(question, case.scene, case.start, digits, case.span, resolved, case.exact_state)
            for question in ("period", "extremes")}
    return {"schema": REFERENCE_SCHEMA, "case": case.name, "title": case.title, "variables": case.variables,
            "time": case.scene.time_unit, "digits": digits,
            "provenance": _provenance(case, arguments),
            "subject": subject(effective(case.scene), case.exact_state),
            "trajectory": {"level": run.level, "because": run.because, "reason": run.reason.as_dict(),
                           "components": list(run.components),
                           "rows": [{"t": decimal(t), "values": texts, "within": within(row, texts)}
                                    for t, row in zip(run.t, run.states)
                                    for texts in [[written(v, digits) for v in row]]]},
            "events": {"because": run.events_because, "reason": run.events_reason.as_dict(),
                       "list": [{"kind": event.kind, "component": run.components[event.component],
                                 "t": t, "t_within": within([event.t], [t]),
                                 "value": value, "value_within": within([event.value], [value])}
                                for event in run.events
                                for t, value in [(written(event.t, digits), written(event.value, digits))]]},
            "period": _told(printed["period"]),
            "extremes": _told(printed["extremes"]) | {"over": resolved.extremes_over}
            } | key(limited(resolved, case.scene, case).caveats), run


def _provenance(case: Case, arguments: Sequence[str]):
    built = manifest.environment()
    return {"program": built["program"]["name"], "version": built["program"]["version"],
            "sources_sha256": built["program"]["sha256"],
            **{name: built["versions"][name] for name in VERSIONS}, "case_file": case.path,
            "case_sha256": manifest.sha256(case.path),
            "command": shlex.join(["stabilab", *arguments])}


def decimal(t) -> str:
    """A rational as a decimal where it has a short one, else as a ratio."""
    rest = t.denominator
    for prime in (2, 5):
        while rest % prime == 0:
            rest //= prime
    if rest != 1:
        return str(t)
    with localcontext() as context:
        context.prec = READ_BITS
        return f"{(Decimal(t.numerator) / t.denominator).normalize():f}"


def written(ball, digits) -> str:
    """The digits of a ball that are right, some more than were asked for at most; 0 where it holds zero."""
    with working(READ_BITS):
        return "0" if 0 in ball else ball.str(digits + 4, radius=False)


def within(balls, texts) -> float:
    """How far the written numbers are from the true ones at most."""
    with working(READ_BITS) as numbers:
        return max(math.nextafter(float((ball - numbers.ball(Fraction(text))).abs_upper()), math.inf)
                   for ball, text in zip(balls, texts))


def _told(printed) -> dict:
    values = printed.values if printed.decimals is None else printed.decimals
    value = (None if values is None else [[str(v) for v in pair] for pair in values]
             if printed.question == "extremes" else str(values))
    return {"value": value, "digits": None if printed.digits is None else min(printed.digits, 99.0),
            "because": printed.because, "reason": printed.reason.as_dict()}


def missing(case: Case, built: dict, run: Tabulated) -> list[tuple]:
    """(case, what falls short of the digits asked for) of a reference."""
    short = [] if run.reached else [f"states: {run.because}"]
    for question in ("period", "extremes"):
        text = built[question]
        if text["digits"] is not None and text["digits"] < built["digits"]:
            short.append(f"{question}: {text['digits']:.1f} of {built['digits']} digits: {text['because']}")
    return [(case, phrase) for phrase in short]


def csv(made: dict) -> str:
    """One table: a row a number; kind, time, quantity, value, within (how far it is off at most, where
    known), known as."""
    rows: list = [("kind", "time", "quantity", "value", "within", "known")]
    rows += [("provenance", None, key, value, None, None)
             for key, value in {"case": made["case"], "digits": made["digits"], **made["provenance"]}.items()]
    course = made["trajectory"]
    for row in course["rows"]:
        rows += [("state", row["t"], name, value, row["within"], course["level"])
                 for name, value in zip(course["components"], row["values"])]
    for item in made["events"]["list"]:
        rows.append((item["kind"], item["t"], item["component"], item["value"],
                     max(item["t_within"], item["value_within"]), course["level"]))
    period, extremes = made["period"], made["extremes"]
    rows.append(("period", None, made["time"], period["value"], None, period["because"]))
    for name, pair in zip(course["components"], extremes["value"] or ()):
        rows += [(f"{word} over {extremes['over']}", None, name, value, None, extremes["because"])
                 for word, value in zip(("least", "greatest"), pair)]
    rows += [("caveat", None, entry["kind"], entry["words"], None, None) for entry in made["caveats"]]
    return csv_lines(rows)


def write(built: dict, path) -> Path:
    """The reference as a file."""
    return write_text(path, csv(built) if endings.ending(path) == ".csv" else as_json(built) + "\n")
