"""Printed formulas as functions of NumPy arrays: what `model = "printed"` draws is what the audit holds
against the equations of motion."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from ...physics.to_numpy import lambdified
from .claims import FOLDER, vocabulary
from .formulas import parse
from .values import Evaluator


@lru_cache
def printed_formulas(paper: str) -> PrintedFormulas:
    """The formulas of a paper on record, by the name of its file without `.toml`."""
    return PrintedFormulas(FOLDER / f"{paper}.toml")


class PrintedFormulas:
    """The [formulas] of a paper's file, each called by its name with the values of the symbols that stand in
    it."""

    def __init__(self, path: Path):
        self.symbols, self.formulas, definitions = vocabulary(path)
        bound = {name: parse(text, self.symbols) for name, text in definitions.items()}
        self._plain = Evaluator(None, {}, bound, None).plain
        self._made: dict = {}

    def __call__(self, name: str, values: dict, **more):
        """The value of a formula; values, more: symbol name -> number or array, of which it takes those that
        stand in it. KeyError for one that is missing."""
        if name not in self._made:
            expression = self._plain(parse(self.formulas[name], self.symbols))
            names = sorted(s.name for s in expression.free_symbols)
            self._made[name] = names, lambdified([self.symbols[n] for n in names], expression)
        names, function = self._made[name]
        return function(*(more[n] if n in more else values[n] for n in names))
