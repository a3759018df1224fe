"""What papers claim, read from TOML: formulas as people type them become SymPy trees (names, numbers, + - * /
**, a few functions, nothing that runs code), claims become rows."""
from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from operator import add, mul, sub, truediv
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...errors import InputError

if TYPE_CHECKING:
    from sympy import Expr

FUNCTIONS = ("sin cos tan cot sec sinh cosh tanh exp log sqrt asin acos atan atan2 asinh atanh "
             "conjugate re im Abs sign").split()
# rate(f[, n]) along the motion, diff(f, s), mean(f, angle), integral(f, s, a, b), at(f, s, value)
OPERATORS = ("rate", "diff", "mean", "integral", "at")
OPERATIONS = {ast.Add: add, ast.Sub: sub, ast.Mult: mul, ast.Div: truediv, ast.Pow: pow}


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
def _functions_and_constants():
    import sympy as sp

    resolved = {name: getattr(sp, name) for name in FUNCTIONS}
    resolved |= {name: sp.Function(name) for name in OPERATORS}
    return resolved, {"pi": sp.pi, "I": sp.I}


def _build(node, text, symbols):
    import sympy as sp

    functions, constants = _functions_and_constants()

    def fault(phrase: str, at: ast.Call | ast.Name | ast.Compare):
        raise FormulaError(f"{phrase} at position {at.col_offset + 1} of {text!r}")

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
                if type(op) in OPERATIONS:
                    return OPERATIONS[type(op)](a, b)
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
                if name not in functions:
                    fault(f"unknown function {name!r} (known: {', '.join(functions)})", node)
                return functions[name](*map(visit, args))
        return fault("expected names, numbers, + - * / ** and functions, found something else", node)

    return visit(node)


def _near(name: str, symbols: Mapping[str, Expr]):
    from difflib import get_close_matches

    close = get_close_matches(name, symbols, 3, 0.5)
    nearby = f"near it: {', '.join(close)}; declare new ones" if close else "declare it"
    return f" ({nearby} under [symbols])"


# --- What papers print, as data: a TOML file a paper, a row a claim. The format is in docs/audit.md
ROW_KINDS = {  # kind -> keys that a row of it needs besides `equation` and `printed`
    "holds": (),  # left = right along every motion of the system
    "solves": ("variable",),  # the printed functions of `variable` are a motion
    "equilibrium": (),  # the printed point is at rest
    "number": ("value",),  # an expression has the printed value
    "order": ("small", "order"),  # left - right is of this order in a small symbol
    "test": ("test",),  # two residuals decide: formulas, or a test of `papers.audit.measured` by its name
    "definition": ("defines",),
    "not-checkable": ("because",),
}
# of a row: fields of `Row`, then options
OWN = "equation kind says printed corrected system where corrected_where domain".split()
ROW_KEYS = {*OWN, *("variable speed start value small order test with defines because bound note solve "
                    "conditions residual verdict figures units repair numbers judged_by completed").split()}
KEYS = "name title source figures symbols formulas definitions systems conditions domain row".split()
# of a row: no formulas
CLAIM_WORDS = set("equation kind says note because defines residual test system numbers judged_by "
                  "completed".split())
NAME = re.compile(r"[A-Za-z_]\w*")
OF_FIGURE = re.compile(r"text-fig(\d+)")
FOLDER = Path(__file__).parent / "papers"
MAIN = "constant-torque-gyrostat"


@dataclass(frozen=True)
class Row:
    """One printed equation or claim.

    equation: its number, or `text-...` for a claim of the text; kind: a key of ROW_KINDS; printed, corrected:
    formulas "left = right" in the paper's notation; where: symbols that stand for expressions in this row
    (corrected_where: in the corrected one); domain: expressions that are positive; options: what the kind
    needs; place: file and row, for errors.
    """

    equation: str
    kind: str
    printed: tuple[str, ...]
    corrected: tuple[str, ...]
    says: str
    system: str | None
    where: dict
    corrected_where: dict
    domain: tuple[str, ...]
    options: dict
    place: str


@dataclass(frozen=True)
class Paper:
    """A paper's symbols, definitions, systems and rows."""

    name: str
    title: str
    symbols: dict = field(repr=False)  # name -> SymPy symbol
    units: dict = field(repr=False)  # name -> words
    definitions: dict = field(repr=False)  # name -> text
    # name -> text as printed, which stands wherever a row names it; `model = "printed"` evaluates it
    formulas: dict = field(repr=False)
    systems: dict = field(repr=False)
    conditions: tuple[str, ...] = field(repr=False)
    domain: tuple[str, ...] = field(repr=False)  # expressions that are positive wherever their symbols stand
    rows: tuple[Row, ...] = field(repr=False)
    source: str = ""
    figures: str = ""  # the short name under which `stabilab figures` draws the paper's figures


def read(path: Path) -> Paper:
    """The paper of a file. InputError with file, row and position for what cannot be read."""
    path, data = Path(path), _data(path)
    symbols, units, formulas, definitions = _vocabulary(data, path.name)
    rows = tuple(_row(_expanded(row, formulas), n, path.name, symbols)
                 for n, row in enumerate(data.get("row", ()), 1))
    visited: dict = {}
    for row in rows:
        if row.equation in visited:
            raise InputError(f"{row.place}: equation {row.equation} has a row already "
                             f"({visited[row.equation]}): give each its own name, as 18-a")
        visited[row.equation] = row.place
    paper = Paper(data.get("name", path.stem), data.get("title", path.stem), symbols, units, definitions,
                  formulas, data.get("systems", {}), tuple(data.get("conditions", ())),
                  _tuple(data.get("domain", ())), rows, data.get("source", ""), data.get("figures", ""))
    for table, texts in (("formulas", formulas), ("definitions", definitions)):
        for name, text in texts.items():
            _located(f"{path.name}, {table}.{name}", parse, text, symbols)
    for text in paper.domain:
        _located(f"{path.name}, domain", parse, text, symbols)
    return paper


def _formulas(table: Mapping[str, str], symbols: Mapping[str, Expr], file: str) -> dict:
    """Name -> text with every formula named before it put in."""
    out: dict = {}
    for name, text in table.items():
        if not name.isidentifier() or name in symbols:
            raise InputError(f"{file}, formulas: {name!r} is "
                             f"{'a symbol already' if name in symbols else 'no name (letters, digits, _)'}")
        out[name] = _expanded(text, out)
    return out


def _expanded(value, formulas):
    """Texts of a row, or of what it holds, with named formulas put in, in brackets."""
    if isinstance(value, dict):
        return {key: inner if key in CLAIM_WORDS else _expanded(inner, formulas)
                for key, inner in value.items()}
    if isinstance(value, list):
        return [_expanded(inner, formulas) for inner in value]
    if not isinstance(value, str) or not formulas:
        return value
    return NAME.sub(lambda match: f"({formulas[match[0]]})" if match[0] in formulas else match[0], value)


def _symbol(name: str, text: str):
    import sympy as sp

    if "complex" in text:
        return sp.Symbol(name)
    return sp.Symbol(name, positive=True) if "positive" in text else sp.Symbol(name, real=True)


def vocabulary(path: Path) -> tuple[dict, dict, dict]:
    """(name -> symbol, name -> formula, name -> definition), texts, of a paper's file without its rows.
    Errors as of `read`."""
    symbols, _, formulas, definitions = _vocabulary(_data(path), Path(path).name)
    return symbols, formulas, definitions


def _data(path: Path):
    path = Path(path)
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror}") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path.name}: no TOML: {error}") from None
    if unknown := set(data) - set(KEYS):
        raise InputError(
            f"{path.name}: unknown keys {', '.join(sorted(unknown))}; known are {', '.join(KEYS)}")
    return data


def _vocabulary(data: Mapping[str, Any], file: str):
    symbols, units = _symbols(data.get("symbols", {}), file)
    formulas = _formulas(data.get("formulas", {}), symbols, file)
    definitions = _expanded(data.get("definitions", {}), formulas)
    for name in definitions:
        symbols.setdefault(name, _symbol(name, ""))
    return symbols, units, formulas, definitions


def _symbols(table: Mapping[str, str], location: str):
    """("D1 D2" = "kg m^2, positive") -> symbols and units by name."""
    symbols, units = {}, {}
    for names, value in table.items():
        unit, _, kind = value.partition(",")
        kind = kind.strip()
        if kind not in ("", "positive", "complex"):
            raise InputError(
                f'{location}, symbols "{names}": expected "unit", "unit, positive" or "unit, complex", got '
                f'"{value}"')
        for name in names.split():
            if not name.isidentifier():
                raise InputError(f'{location}, symbols: "{name}" is no name (letters, digits, _)')
            symbols[name], units[name] = _symbol(name, kind), unit.strip() or "1"
    return symbols, units


def _row(data: Mapping[str, Any], number: int, file: str, symbols: dict[str, Expr]) -> Row:
    location = f"{file}, row {number} (equation {data.get('equation', '?')})"
    kind = data.get("kind", "holds")
    if kind not in ROW_KINDS:
        raise InputError(f"{location}: unknown kind {kind!r}; known are {', '.join(ROW_KINDS)}")
    missing = [key for key in ("equation", *ROW_KINDS[kind]) if key not in data]
    if missing:
        raise InputError(f"{location}: a row of kind {kind} needs {', '.join(missing)}")
    if unknown := set(data) - ROW_KEYS:
        raise InputError(
            f"{location}: unknown keys {', '.join(sorted(unknown))}; known are {', '.join(sorted(ROW_KEYS))}")
    printed, corrected = (_tuple(data.get(key, ())) for key in ("printed", "corrected"))
    where, corrected_where = data.get("where", {}), data.get("corrected_where", {})
    domain = _tuple(data.get("domain", ()))
    for name in (*where, *corrected_where):
        symbols.setdefault(name, _symbol(name, ""))
    if kind in ("holds", "solves", "equilibrium", "order"):
        if not printed:
            raise InputError(f'{location}: nothing printed: give printed = "left = right"')
        for text in (*printed, *corrected):
            _located(location, sides, text, symbols)
    for text in (*where.values(), *corrected_where.values(), *domain):
        _located(location, parse, text, symbols)
    options = {key: value for key, value in data.items() if key not in OWN}
    if named := OF_FIGURE.match(str(data["equation"])):  # a row on a figure is linked to it
        options["figures"] = sorted({int(named[1]), *options.get("figures", ())})
    return Row(str(data["equation"]), kind, printed, corrected, data.get("says", ""), data.get("system"),
               where, corrected_where, domain, options, location)


def _tuple(value: str | Sequence[str]):
    return (value,) if isinstance(value, str) else tuple(value)


def _located(location, read_it, text, symbols):
    try:
        return read_it(text, symbols)
    except FormulaError as error:
        raise FormulaError(f"{location}: {error}") from None


def key(equation: str) -> tuple:
    """Order of equations: by number, then by what follows it."""
    result = re.match(r"(\d+)", equation)
    return (0, int(result[1]), equation) if result else (1, 0, equation)


def papers() -> tuple[str, ...]:
    """Names of the papers on record, the main one first."""
    return tuple(sorted((path.stem for path in FOLDER.glob("*.toml")), key=lambda name: (name != MAIN, name)))


def named(text: str) -> str:
    """The name of a paper on record by that name, by the name of its figures, by its number among `papers`,
    or by words of its title. InputError lists what is known."""
    headers = {name: _data(FOLDER / f"{name}.toml") for name in papers()}
    wanted = text.strip().lower()
    exact = [name for number, (name, data) in enumerate(headers.items(), 1)
             if wanted in (name, data.get("figures"), str(number))]
    result = exact or [name for name, data in headers.items() if wanted and all(
        word in re.split(r"[^a-z0-9]+", f"{name} {data['title']}".lower())
        for word in re.split(r"[^a-z0-9]+", wanted) if word)]
    if len(result) == 1:
        return result[0]
    known = "; ".join(f"{number} {name}" + (f" or {data['figures']}" if data.get("figures") else "")
                      for number, (name, data) in enumerate(headers.items(), 1))
    several = f" fits {', '.join(result)}: name one" if result else ": there is none of this name"
    raise InputError(f"paper {text!r}{several}; known are {known}; a file of claims of your own ends in "
                     ".toml (docs/audit.md)")


def paper(name: str) -> Paper:
    """A paper on record, named as for `named`, or one in a file of that path. InputError names the known
    ones."""
    return read(Path(name)) if name.endswith(".toml") else read(FOLDER / f"{named(name)}.toml")


def figures_of(name: str) -> str:
    """The short name under which the figures of a paper are drawn; "" where it has none. Errors as of
    `named`."""
    return _data(FOLDER / f"{named(name)}.toml").get("figures", "")
