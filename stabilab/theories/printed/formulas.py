"""Formulas as people type them, read as SymPy trees: names, numbers, + - * / **, a few functions, nothing
that runs code."""

from __future__ import annotations

import ast
from functools import lru_cache

from ...errors import InputError

FUNCTIONS = (
    "sin",
    "cos",
    "tan",
    "cot",
    "sec",
    "sinh",
    "cosh",
    "tanh",
    "exp",
    "log",
    "sqrt",
    "asin",
    "acos",
    "atan",
    "atan2",
    "asinh",
    "atanh",
    "conjugate",
    "re",
    "im",
    "Abs",
    "sign",
)
# rate(f[, n]) along the motion, diff(f, s), mean(f, angle), integral(f, s, a, b), at(f, s, value)
OPERATORS = ("rate", "diff", "mean", "integral", "at")


class FormulaError(InputError):
    """A formula that cannot be read, with the position of what stopped the reading."""


def parse(text: str, symbols: dict):
    """The SymPy expression of one side of a formula. symbols: name -> SymPy symbol. FormulaError names
    position and cure."""
    try:
        tree = ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        raise FormulaError(f"cannot read {text!r}: {error.msg} at position {error.offset}") from None
    return _build(tree, text.strip(), symbols)


def sides(text: str, symbols: dict):
    """(left, right) of "left = right"."""
    parts = text.split("=")
    if len(parts) != 2:
        raise FormulaError(f"expected one '=' in {text!r}, got {len(parts) - 1}: write left = right")
    return tuple(parse(part, symbols) for part in parts)


@lru_cache
def _vocabulary():
    import sympy as sp

    known = {name: getattr(sp, name) for name in FUNCTIONS}
    known |= {name: sp.Function(name) for name in OPERATORS}
    return known, {"pi": sp.pi, "I": sp.I}


def _build(node, text, symbols):
    import sympy as sp

    functions, constants = _vocabulary()

    def fault(words, at):
        raise FormulaError(f"{words} at position {at.col_offset + 1} of {text!r}")

    def visit(node):
        match node:
            case ast.Constant(value=int() | float()) if not isinstance(node.value, bool):
                return sp.Rational(ast.get_source_segment(text, node).replace("_", ""))
            case ast.Name(id=name):
                if name in symbols:
                    return symbols[name]
                if name in constants:
                    return constants[name]
                fault(f"unknown symbol {name!r}{_near(name, symbols)}", node)
            case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=inner):
                return -visit(inner) if isinstance(node.op, ast.USub) else visit(inner)
            case ast.BinOp(left=left, op=op, right=right):
                a, b = visit(left), visit(right)
                match op:
                    case ast.Add():
                        return a + b
                    case ast.Sub():
                        return a - b
                    case ast.Mult():
                        return a * b
                    case ast.Div():
                        return a / b
                    case ast.Pow():
                        return a**b
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
                if name not in functions:
                    fault(f"unknown function {name!r} (known: {', '.join(functions)})", node)
                return functions[name](*map(visit, args))
        return fault("expected names, numbers, + - * / ** and functions, found something else", node)

    return visit(node)


def _near(name, symbols):
    from difflib import get_close_matches

    close = get_close_matches(name, symbols, 3, 0.5)
    return (f" (near it: {', '.join(close)}; declare new ones under [symbols])" if close
            else " (declare it under [symbols])")
