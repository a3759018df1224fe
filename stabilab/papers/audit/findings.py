"""A paper's rows, each with its verdict: held against the equations of motion, with condition, correction and
how it was decided."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from ...errors import InputError
from ...theories.printed.claims import Paper, Row, parse
from .checks import bound_of, raw
from .checks import pairs as pairs_of
from .conditions import condition_of, singles
from .decide import Decision, decide, free
from .other_kinds import number, order, tested
from .repair import repairs
from .systems import stated, system_of
from .unit_check import unit_fault

VERDICTS = ("holds", "only-if", "wrong", "definition", "not-checkable")


@dataclass(frozen=True)
class Finding:
    """What the machine says of one row.

    verdict: of VERDICTS; condition: under which it holds, "" if none is known; correction: a formula that
    passes the check which the printed one fails; method: how it was decided; residual: of the printed
    formula; corrected_residual: of the correction; repairs: formulas one edit away that pass; unit_fault: ""
    or which terms differ.
    """

    row: Row
    verdict: str
    condition: str
    correction: str
    method: str
    residual: float
    corrected_residual: float
    repairs: tuple[str, ...] = ()
    unit_fault: str = ""


def audit(paper: Paper, equation: str | None = None, search: bool = True,
          tell: Callable[[int, int, str], None] | None = None) -> tuple[Finding, ...]:
    """Findings of a paper's rows, or of one equation. search: whether conditions and repairs are looked for;
    tell(done, count, words): before each row."""
    prove_systems(paper)
    rows = [row for row in paper.rows if equation in (None, row.equation)]
    if not rows:
        raise InputError(
            f"{paper.name} has no row for equation {equation!r}; it has "
            f"{', '.join(row.equation for row in paper.rows)}")
    found = []
    for done, row in enumerate(rows):
        if tell:
            tell(done, len(rows), f"equation {row.equation}")
        found.append(examine(paper, row, search))
    return tuple(found)


def prove_systems(paper: Paper) -> None:
    """Every system stated by rates follows from its parent; InputError names one that does not."""
    bound = {name: parse(text, paper.symbols) for name, text in paper.definitions.items()}
    for name, parent, pairs in stated(paper):
        decision = decide(pairs, bound, parent, name, domain_of(paper, (), pairs, bound, parent))
        if not decision.holds:
            raise InputError(
                f"{paper.name}, systems.{name}: its rates do not follow from those of its parent "
                f"({decision.method}, residual {decision.residual:.2g})"
            )


def domain_of(paper: Paper, texts, pairs, bound, system) -> list:
    """What is positive at the points tried: the row's own domain, and of the paper's all that speaks of
    symbols of these pairs."""
    own = [parse(text, paper.symbols) for text in texts]
    standing = set(free(pairs, own, bound, system))
    shared = [parse(text, paper.symbols) for text in paper.domain]
    return own + [d for d in shared if set(free([(d, d)], (), bound, None)) <= standing]


def examine(paper: Paper, row: Row, search: bool = True) -> Finding:
    """The finding of one row. InputError where the row cannot be tried, with file and row."""
    if row.kind in ("definition", "not-checkable"):
        words = f"defines {row.options['defines']}" if row.kind == "definition" else row.options["because"]
        return Finding(row, row.kind, "", "", words, float("nan"), float("nan"),
                       unit_fault=unit_fault(paper, row))
    if row.kind == "number":
        return Finding(row, *number(paper, row))
    if row.kind == "test":
        return Finding(row, *tested(row))
    return _formula(paper, row, search)


def _formula(paper, row, search):
    system, printed, bound = system_of(paper, row.system,
                                       row.place), raw(paper, row.printed), bound_of(paper, row)
    domain = domain_of(paper, row.domain, pairs_of(paper, row, printed, system, bound), bound, system)
    fault, decision = unit_fault(paper, row), _decided(paper, row, printed, system, bound, domain)
    if decision.holds is None:
        raise InputError(f"{row.place}: {decision.method}")
    if decision.holds:
        method = decision.method + (f"; units differ: {fault}" if fault else "")
        return Finding(row, "wrong" if fault else "holds", "", "", method, decision.residual, float("nan"),
                       unit_fault=fault)
    (condition, how), (fixes, under) = ("", ""), ((), "")
    if search and row.kind == "order":
        condition, how = _order_condition(paper, row, pairs_of(paper, row, printed, system, bound), system,
                                          bound, domain)
    elif search:
        condition, how = condition_of(paper, row, pairs_of(paper, row, printed, system, bound), bound, system,
                                      domain)
        fixes, under = _fixes(paper, row, printed, system, bound, domain, condition)
    correction, corrected_residual = _corrected(paper, row, system, domain)
    method = (decision.method + (f"; {how} under the condition" if condition else "")
              + ("; correction passes the same check" if correction else ""))
    method += f"; one edit makes it hold{under}" if fixes else ""
    verdict = "only-if" if condition and not fixes and not fault else "wrong"
    return Finding(row, verdict, condition, correction or (*fixes, "")[0], method, decision.residual,
                   corrected_residual, fixes, fault)


def _order_condition(paper, row, pairs, system, bound, domain):
    """The first single condition under which the remainder is of the claimed order."""
    for words, fixed in singles(paper, row, pairs, bound, system, domain):
        decision = order(paper, row, pairs, bound | fixed, system)
        if row.options["small"] not in fixed and decision.holds:
            return words, decision.method
    return "", ""


def _corrected(paper, row, system, domain):
    """(words of the row's correction, its residual), "" where it has none. InputError where it fails the
    check as well."""
    if not row.corrected:
        return "", float("nan")
    better = _decided(paper, row, raw(paper, row.corrected), system, bound_of(paper, row, corrected=True),
                      domain)
    if not better.holds:
        raise InputError(
            f"{row.place}: the corrected formula fails the check as well ({better.method}, residual "
            f"{better.residual:.2g})")
    where = ", ".join(f"{name} = {text}" for name, text in row.corrected_where.items())
    return "; ".join(row.corrected) + (f" with {where}" if where else ""), better.residual


def _fixes(paper, row, printed, system, bound, domain, condition):
    """(formulas one edit away that pass, "" or the condition that they need): a misprint is wrong even where
    a condition hides it.

    Under a condition they are looked for only where no single one helps the printed formula.
    """
    if row.options.get("repair") is False:
        return (), ""
    fixes = repairs(paper, row, printed, system, bound, domain)
    if fixes or (condition and " and " not in condition):
        return fixes, ""
    for words, fixed in singles(paper, row, pairs_of(paper, row, printed, system, bound), bound, system,
                                domain):
        if words in (condition
                     or words) and (fixes := repairs(paper, row, printed, system, bound, domain, fixed)):
            return tuple(f"{fix} (where {words})" for fix in fixes), f" where {words}"
    return (), ""


def _decided(paper, row, formulas, system, bound, domain) -> Decision:
    pairs = pairs_of(paper, row, formulas, system, bound)
    return (order(paper, row, pairs, bound, system) if row.kind == "order"
            else decide(pairs, bound, system, row.equation, domain))


def key(equation: str):
    """Order of equations: by number, then by what follows it."""
    found = re.match(r"(\d+)", equation)
    return (0, int(found[1]), equation) if found else (1, 0, equation)
