"""What each kind of claim says, as pairs of expressions that are equal where the claim is true."""

from __future__ import annotations

from importlib import import_module

from ...errors import InputError
from ...theories.printed.claims import Paper, Row, parse, sides
from ...theories.printed.evaluate import Evaluator


def pairs(paper: Paper, row: Row, printed, system, bound) -> list:
    """[(left, right)] that agree wherever the row's formulas are true. printed: [(left, right)] of the
    formulas, as raw SymPy trees."""
    carried = Evaluator(None, {}, bound, system).carried
    return [(carried(left), carried(right)) for left,
            right in CHECKS[row.kind](paper, row, printed, system, bound)]


def raw(paper: Paper, formulas) -> list:
    """The sides of typed formulas as SymPy trees."""
    return [sides(text, paper.symbols) for text in formulas]


def bound_of(paper: Paper, row: Row, corrected=False) -> dict:
    """Symbol name -> what it stands for in this row."""
    where = row.where | row.corrected_where if corrected else row.where
    return {name: parse(text, paper.symbols) for name,
            text in (paper.definitions | where).items() if text != name}


def _holds(paper, row, printed, system, bound):
    return printed


def _solves(paper, row, printed, system, bound):
    """The printed functions of `variable`, put into the rates; `speed` is d variable / d time; `start` their
    values at 0."""
    if system is None:
        raise InputError(f"{row.place}: a row of kind solves needs a system")
    variable, speed = parse(row.options["variable"],
                            paper.symbols), parse(row.options.get("speed", "1"), paper.symbols)
    rates = dict(zip(system.state, system.rates))
    plain = Evaluator(None, {}, bound, system).plain
    solution = {left: plain(right) for left, right in printed}
    out = []
    for left, right in solution.items():
        if left not in rates:
            raise InputError(
                f"{row.place}: {left} is no state of the system {row.system}: its states are "
                f"{', '.join(map(str, rates))}")
        out.append((right.diff(variable) * plain(speed).xreplace(solution),
                    plain(rates[left]).xreplace(solution)))
        start = row.options.get("start", {}).get(left.name)
        if start is not None:
            out.append((right.subs(variable, 0), parse(start, paper.symbols)))
    return out


def _equilibrium(paper, row, printed, system, bound):
    """The point that the printed equations give, put into the rates; `solve` names unknowns that the
    equations give by themselves."""
    import sympy as sp

    plain = Evaluator(None, {}, bound, system).plain
    if "solve" in row.options:
        unknowns = [paper.symbols[name] for name in row.options["solve"]]
        found = sp.solve([plain(left - right) for left, right in printed], unknowns, dict=True)
        if not found:
            raise InputError(
                f"{row.place}: the printed equations have no solution for {', '.join(row.options['solve'])}")
    else:
        found = [{left: plain(right) for left, right in printed}]
    return [(plain(rate).xreplace(point).xreplace(point), sp.Integer(0)) for point in found
            for rate in system.rates]


CHECKS = {"holds": _holds, "order": _holds, "solves": _solves, "equilibrium": _equilibrium}


def residuals_of(row: Row):
    """(residual of the printed claim, of the corrected one) by the test that the row names, `module:test`, of
    the modules in `special`."""
    module, _, function = row.options["test"].partition(":")
    try:
        return tuple(abs(float(v))
                     for v in import_module(f".special.{module}", __package__).TESTS[function]())
    except (ModuleNotFoundError, KeyError) as error:
        raise InputError(f"{row.place}: no function {row.options['test']!r} ({error})") from None
