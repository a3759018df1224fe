"""How a printed equation is tried on the program's own equations of motion, in the paper's letters, and what
is decided of it.

A system is either derived (`effects`: the equations that the program integrates, renamed by `names`), or
stated by its rates in other variables (`follows`, `meaning`, `pace`) and then proved to follow from its
parent before anything is compared with it, or a parent with some symbols set (`set`).

Whether two expressions are one: by symbols where SymPy can, else by their values at random points with 50
and 80 digits."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal, InvalidOperation
from itertools import combinations
from typing import TYPE_CHECKING, Any

from ...errors import InputError
from ...physics.body import Body
from ...physics.effects import effect_class
from ...physics.equations import derive
from ...physics.scene import Scene
from ...theories.printed.claims import FormulaError, Paper, Row, parse, sides
from ...theories.printed.evaluate import Evaluator, Setting, Undefined, precise
from . import measured, trends

if TYPE_CHECKING:
    from fractions import Fraction

    from sympy import Expr

# effect -> arguments that leave no parameter zero
EFFECTS = {"gyrostat": ((2, 3, 5),), "constant_torque": ((2, 3, 5),), "charge": (2, 3, 5, "1/2"),
           "gravity": (7, (2, 3, 5)), "newtonian_field": (3,), "liquid_cavity": (2, 3, 5), "resistance": (2,)}


@dataclass(frozen=True)
class System:
    """state: SymPy symbols; rates: their rates by the system's own time; set: symbols with a value in it;
    time: unit of that time, words."""

    name: str
    state: tuple
    rates: tuple
    set: dict
    time: str

    def rate(self, expression: Expr):
        """Rate of an expression along the motion."""
        return sum((expression.diff(x) * r for x, r in zip(self.state, self.rates)), 0 * expression)


def system_of(paper: Paper, name: str | None, index: str = "") -> System | None:
    """The system of a name; None for None. InputError where it is not described or does not follow from its
    parent."""
    if name is None:
        return None
    if name not in paper.systems:
        raise InputError(
            f"{index or paper.name}: unknown system {name!r}; described are "
            f"{', '.join(paper.systems) or 'none'}")
    data, index = paper.systems[name], f"{paper.name}, systems.{name}"
    unknown = (set(data) - {"effects", "names", "blocks", "state", "rates", "follows", "meaning", "pace",
                            "set", "time"})
    if unknown:
        raise InputError(f"{index}: unknown keys {', '.join(sorted(unknown))}")
    values = {symbol: _read(paper, index, text) for symbol, text in data.get("set", {}).items()}
    if "effects" in data:
        return _derived(paper, name, data, values, index)
    if "rates" in data:
        state = tuple(_symbol(paper, index, s) for s in data["state"])
        return System(name, state, tuple(_put(_read(paper, index, r), values) for r in data["rates"]), values,
                      data.get("time", "s"))
    if "follows" not in data:
        raise InputError(f"{index}: give effects (derived), rates (stated) or follows with set")
    parent = system_of(paper, data["follows"], index)
    return System(name, parent.state, tuple(_put(r, values) for r in parent.rates), parent.set | values,
                  parent.time)


def stated(paper: Paper):
    """(system's name, parent, pairs that vanish if its stated rates follow from the parent's) for every
    system stated by rates."""
    for name, data in paper.systems.items():
        if "rates" not in data or "follows" not in data:
            continue
        index = f"{paper.name}, systems.{name}"
        parent, own = system_of(paper, data["follows"], index), system_of(paper, name)
        meaning = {_symbol(paper, index, s): _read(paper, index, text) for s, text in data["meaning"].items()}
        pace = _read(paper, index, data.get("pace", "1"))
        yield name, parent, [(parent.rate(meaning[x]) / pace, rate.xreplace(meaning))
                             for x, rate in zip(own.state, own.rates)]


def _derived(paper, name, data, values, location):

    equations = derive(_scene(data, location), tuple(data.get("blocks", ())))
    import sympy as sp

    renamed = {}
    for theirs in (*equations.state, *equations.symbols.values()):
        text = data.get("names", {}).get(theirs.name, theirs.name)
        renamed[theirs] = sp.Integer(0) if text == "0" else _read(paper, location, text)
    state = tuple(renamed[s] for s in equations.state)
    if not all(s.is_Symbol for s in state):
        raise InputError(f"{location}: names of the state are to be plain symbols")
    return System(name, state, tuple(_put(r.xreplace(renamed), values) for r in equations.rhs), values,
                  data.get("time", "s"))


def _scene(data: Mapping[str, Any], location: str):

    effects = []
    for effect in data["effects"]:
        if effect not in EFFECTS:
            raise InputError(f"{location}: unknown effect {effect!r}; known are {', '.join(EFFECTS)}")
        effects.append(effect_class(effect)(*EFFECTS[effect]))
    return Scene(Body((7, 6, 4)), *effects)


def _put(expression, values):
    """The expression with values in the place of symbols by their names."""
    return expression.subs({s: values[s.name] for s in expression.free_symbols if s.name in values})


def _read(paper: Paper, location: str, text: str):
    try:
        return parse(text, paper.symbols)
    except FormulaError as error:
        raise FormulaError(f"{location}: {error}") from None


def _symbol(paper: Paper, location: str, name: str):
    if name not in paper.symbols:
        raise InputError(f"{location}: unknown symbol {name!r}; declare it under [symbols]")
    return paper.symbols[name]


# --- Under which condition a wrong formula is right: a = 0, D1 = D2, no wheel. Singles first, then pairs
def candidates(paper: Paper, row: Row) -> list[tuple[str, dict]]:
    """(words, {name: expression}) of every condition to try: the row's own, then the paper's."""
    out = []
    for text in dict.fromkeys((*row.options.get("conditions", ()), *paper.conditions)):
        left, _, right = text.partition("=")
        out.append((text.strip(), {left.strip(): parse(right, paper.symbols)}))
    return out


def condition_of(paper: Paper, row: Row, pairs: Sequence[tuple[Expr, Expr]],
                 setting: Setting) -> tuple[str, str]:
    """(condition, method) under which the pairs agree; ("", "") where none of the candidates helps. Singles
    are tried before pairs."""
    import mpmath

    single = singles(paper, row, pairs, setting)
    double = [(f"{a} and {b}", first | second)
              for (a, first), (b, second) in combinations(single, 2) if first.keys() != second.keys()]
    for text, fixed in [*single, *((phrase, fixed) for phrase, fixed in double if _plain(fixed))]:
        under = replace(setting, fixed=fixed)
        if not _quick(mpmath.fp, pairs, under, text):
            continue
        decision = decide(pairs, under, row.equation + text)
        if decision.holds:
            return text, decision.method
    return "", ""


def singles(paper: Paper, row: Row, pairs: Sequence[tuple[Expr, Expr]],
            setting: Setting) -> list[tuple[str, dict]]:
    """(words, {name: expression}) of the single conditions that speak of symbols of the pairs."""
    standing = {s.name for s in free(pairs, setting)}
    return [(text, fixed)
            for text, fixed in candidates(paper, row) if fixed.keys() <= standing and _plain(fixed)]


def _plain(fixed: Mapping[str, Expr]):
    """Whether no fixed symbol stands in what another is fixed to."""
    return not any(s.name in fixed for value in fixed.values() for s in value.free_symbols)


def _quick(numbers, pairs, setting, seed):
    """Whether doubles leave it open that the pairs agree under the condition."""
    try:
        chosen = setting.points(free(pairs, setting), seed, 2)
    except InputError:
        return False
    rows = [residual(pairs, numbers, point, setting) for point in chosen]
    return all(r is not None and r < 1e-7 for r in rows)


# --- What each kind of claim says, as pairs of expressions that are equal where the claim is true
def pairs(paper: Paper, row: Row, printed, setting: Setting) -> list:
    """[(left, right)] that agree wherever the row's formulas are true. printed: [(left, right)] of the
    formulas, as raw SymPy trees."""
    carried = setting.evaluator().carried
    return [(carried(left), carried(right))
            for left, right in CHECKS[row.kind](paper, row, printed, setting)]


def raw(paper: Paper, formulas: Sequence[str]) -> list:
    """The sides of typed formulas as SymPy trees."""
    return [sides(text, paper.symbols) for text in formulas]


def bound_of(paper: Paper, row: Row, corrected: bool = False) -> dict:
    """Symbol name -> what it stands for in this row."""
    where = row.where | row.corrected_where if corrected else row.where
    return {name: parse(text, paper.symbols)
            for name, text in (paper.definitions | where).items() if text != name}


def _holds(paper, row, printed, setting):
    return printed


def _solves(paper: Paper, row: Row, printed: Sequence[tuple[Expr, Expr]], setting: Setting):
    """The printed functions of `variable`, put into the rates; `speed` is d variable / d time; `start` their
    values at 0."""
    system = setting.system
    if system is None:
        raise InputError(f"{row.place}: a row of kind solves needs a system")
    variable, speed = (parse(text, paper.symbols)
                       for text in (row.options["variable"], row.options.get("speed", "1")))
    rates = dict(zip(system.state, system.rates))
    plain = setting.evaluator().plain
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


def _equilibrium(paper, row, printed, setting):
    """The point that the printed equations give, put into the rates; `solve` names unknowns that the
    equations give by themselves."""
    import sympy as sp

    plain = setting.evaluator().plain
    if "solve" in row.options:
        unknowns = [paper.symbols[name] for name in row.options["solve"]]
        result = sp.solve([plain(left - right) for left, right in printed], unknowns, dict=True)
        if not result:
            raise InputError(
                f"{row.place}: the printed equations have no solution for {', '.join(row.options['solve'])}")
    else:
        result = [{left: plain(right) for left, right in printed}]
    return [(plain(rate).xreplace(point).xreplace(point), sp.Integer(0)) for point in result
            for rate in setting.system.rates]


CHECKS = {"holds": _holds, "order": _holds, "solves": _solves, "equilibrium": _equilibrium}


def residuals_of(row: Row):
    """(residual of the printed claim, of the corrected one): two formulas of numbers, or the test of
    `measured` that the row names, with the arguments that it gives."""
    if isinstance(row.options["test"], list):
        value = Evaluator(precise(30), {}, {}, None)
        return tuple(abs(float(value(parse(text, {})))) for text in row.options["test"])
    name = row.options["test"]
    if name not in measured.TESTS:
        raise InputError(f"{row.place}: no test {name!r}; known are {', '.join(measured.TESTS)}")
    result = measured.TESTS[name](**row.options.get("with", {}))
    return tuple(abs(float(v)) for v in result)


CLAIM_DIGITS = (50, 80)  # a claim "holds" by values only if its residual shrinks with the digits
POINTS = 5
SLACK = 14  # digits that cancellation may cost at points of order one
APART = 1e-6  # relative difference at a point that settles it
SYMBOLIC_SIZE = 250  # operations up to which symbols are tried


@dataclass(frozen=True)
class Decision:
    """holds: True, False, or None where it could not be decided; residual: largest relative difference seen;
    method: words."""

    holds: bool | None
    residual: float
    method: str


def decide(pairs: Sequence[tuple[Expr, Expr]], setting: Setting, seed: str,
           symbolic: bool = True) -> Decision:
    """Whether left equals right in every pair, for all values of the free symbols at which the domain is
    positive, under the condition of the setting."""

    chosen: list[dict] = []
    none = ""
    try:
        chosen = setting.points(free(pairs, setting), seed, POINTS)
    except InputError as error:
        none = str(error)
    if symbolic and not setting.fixed and all(_same_in_symbols(left, right, setting, chosen[:1])
                                              for left, right in pairs):
        return Decision(True, 0.0, "symbols")
    if none:
        return Decision(None, float("nan"), none)
    worst, visited = {}, 0
    for digits in CLAIM_DIGITS:
        numbers = precise(digits)
        rows = [residual(pairs, numbers, point, setting) for point in chosen]
        rows = [r for r in rows if r is not None]
        visited, worst[digits] = len(rows), max(rows, default=None)
        if rows and worst[digits] > 10.0 ** -(CLAIM_DIGITS[0] - SLACK):
            return Decision(False, float(worst[digits]), f"residual at random points, {digits} digits")
    if not visited:
        return Decision(None, float("nan"), "the formula has no value at any of the random points")
    if worst[CLAIM_DIGITS[1]] > 10.0 ** -(CLAIM_DIGITS[1] - SLACK):
        return Decision(None, float(worst[CLAIM_DIGITS[1]]), "the residual does not shrink with the digits")
    return Decision(True, float(worst[CLAIM_DIGITS[1]]),
                    f"residuals at {visited} random points, {CLAIM_DIGITS[0]} and {CLAIM_DIGITS[1]} digits")


def residual(pairs, numbers, point, setting: Setting):
    """Largest relative difference at one point; None where the formula has no value there."""
    ready = setting.settled(numbers, point)
    if ready is None:
        return None
    value, worst = setting.evaluator(numbers, ready), numbers.mpf(0)
    try:
        for left, right in pairs:
            a, b = value(left), value(right)
            size = max(abs(a), abs(b), _largest_term(value, left), _largest_term(value, right))
            if size:
                worst = max(worst, abs(a - b) / size)
    except Undefined:
        return None
    return worst


def _largest_term(value: Evaluator, expression: Expr):
    """Size of the largest term of a sum: what a difference of rounding is to be compared with."""
    return max((abs(value(term)) for term in expression.args), default=0) if expression.is_Add else 0


def free(pairs: Sequence[tuple[Expr, Expr]], setting: Setting) -> list:
    """Symbols of the pairs and the domain that need a value, in order of their names."""
    import sympy as sp

    result, waiting, done = set(), [e for pair in pairs for e in pair] + list(setting.domain), set()
    if setting.system is not None and any(e.has(sp.Function("rate")) for e in waiting):
        waiting += list(setting.system.rates)
    meant = setting.fixed | setting.bound
    while waiting:
        for s in waiting.pop().free_symbols:
            if s.name not in meant:
                result.add(s)
            elif s.name not in done:
                done.add(s.name)
                waiting.append(meant[s.name])
    return sorted(result, key=lambda s: s.name)


def _apart(left: Expr, right: Expr, setting: Setting, chosen: Sequence[dict[str, Fraction]]):
    """Whether two expressions differ by so much at a point that no rounding of 50 digits makes up for it."""
    rows = [residual([(left, right)], precise(CLAIM_DIGITS[0]), point, setting) for point in chosen]
    return any(r is not None and r > APART for r in rows)


def _same_in_symbols(left: Expr, right: Expr, setting: Setting, chosen: Sequence[dict[str, Fraction]]):
    """Whether symbols show it; chosen: points at which expressions that differ plainly are separated before
    their terms are multiplied out."""
    import sympy as sp

    plain = setting.evaluator().plain
    try:
        difference = plain(left) - plain(right)
    except InputError:
        return False
    if difference == 0:
        return True
    if difference.has(sp.Function("mean"), sp.Function("integral"), sp.Function("diff"),
                      sp.Function("at")) or sp.count_ops(difference) > SYMBOLIC_SIZE:
        return False
    try:
        if _apart(left, right, setting, chosen):
            return False
        if sp.expand(difference) == 0:
            return True
        numerator = sp.numer(sp.together(difference))
        return sp.expand(numerator) == 0 or sp.expand(sp.expand_trig(sp.expand(numerator))) == 0
    except (RecursionError, sp.PolynomialError):
        return False


# --- Claims that are no identities: the order of a remainder, a printed number, a named test
TEST_BOUND = 1e-12  # residuals of named tests: 30 digits or exact counts


def order(paper: Paper, row: Row, pairs: Sequence[tuple[Expr, Expr]], setting: Setting) -> Decision:
    """Whether left - right falls like the stated power of the small symbol: halved thrice, watched."""
    small, claimed = row.options["small"], row.options["order"]
    symbols = [s for s in free(pairs, replace(setting, domain=())) if s.name != small]
    lower, numbers = float("inf"), precise(60)
    setting = replace(setting, domain=tuple(parse(t, paper.symbols) for t in row.domain if small not in t))
    for point in setting.points(symbols, row.equation, 3):
        sizes = []
        for halvings in (14, 16, 18):
            ready = setting.settled(numbers, point) | {small: numbers.mpf(2) ** -halvings}
            value = setting.evaluator(numbers, ready)
            try:
                sizes.append(max(abs(value(left) - value(right)) for left, right in pairs))
            except Undefined:
                return Decision(None, float("nan"), f"no value at a small {small}")
        for first, second in zip(sizes, sizes[1:]):
            if second:
                lower = min(lower, float(numbers.log(first / second, 4)))
    return Decision(lower > claimed - 0.1, lower, f"observed order {lower:.3g} in {small}, claimed {claimed}")


def number(paper: Paper, row: Row) -> tuple:
    """(verdict, condition, correction, method, residual, corrected residual) of printed digits held against
    the value of an expression."""
    setting = Setting(bound_of(paper, row), system_of(paper, row.system, row.place))
    value = setting.evaluator(precise(40))(parse(row.options["value"], paper.symbols))
    try:
        text = row.printed[0].replace("\u2212", "-")
        # finite, so its exponent is a number
        printed = Decimal(text)
        step = Decimal(1).scaleb(printed.as_tuple().exponent)  # type: ignore[arg-type]
    except (InvalidOperation, IndexError):
        raise InputError(f"{row.place}: expected a printed number, got {row.printed}") from None
    error = abs(float(value.real) - float(printed))
    holds = error <= 0.5 * float(step) * (1 + 1e-9) and abs(float(value.imag)) < 1e-12
    digits = max(0, -printed.as_tuple().exponent) + 2  # type: ignore[operator]
    correction = "" if holds else f"{float(value.real):.{digits}f}"
    return ("holds" if holds else "wrong", "", correction, f"value of {row.options['value']} with 40 digits",
            error, float("nan") if holds else 0.0)


def tested(row: Row) -> tuple:
    """The same six of a claim that a named test decides; InputError where the stated verdict is not that of
    its residuals. A claim on data that were completed is never called wrong."""
    printed, corrected = residuals_of(row)
    bound = row.options.get("bound", TEST_BOUND)
    declared = row.options.get("verdict", "holds" if printed <= bound else "wrong")
    completed = row.options.get("completed", "")
    if ((declared == "holds") != (printed <= bound) or completed and declared in ("wrong", "only-if")
            or declared != "holds" and row.corrected and not corrected <= bound):
        raise InputError(
            f"{row.place}: stated {declared}, but its residuals are {printed:.3g} (printed) and "
            f"{corrected:.3g} (corrected), with the bound {bound:.3g}"
        )
    text = "; ".join(filter(None, (completed, row.options.get("residual", "residual of the claim"))))
    conditions = row.options.get("conditions", ())
    return (declared, conditions[0] if declared == "only-if" and conditions else "", "; ".join(row.corrected),
            text, printed, corrected)


# --- What a claim is held against, and whether the exact motion does what a claim of a model says
YARDSTICKS = {"exact": "the exact motion", "linear": "the paper's linear model", "averaged1":
              "the averaged motion", "printed": "the paper's solution as printed"}
OF_MODELS = ("trend", "side", "turns back", "closed", "falls throughout", "waves")  # tests that take a model


def judged_by(paper: Paper, row: Row) -> str:
    """What a row's claim is held against, in words; "" where it is not tried."""
    if row.kind in ("definition", "not-checkable"):
        return ""
    if row.kind == "number":
        return row.options.get("judged_by", "the value of its own formula")
    if row.options.get("test") in OF_MODELS:
        return YARDSTICKS[_model(paper, row)]
    if row.kind == "test":
        return row.options.get("judged_by", YARDSTICKS[trends.MODELS[paper.figures]] if paper.figures
                               else "the equations of motion")
    return "the equations of motion" if row.system else "its own definitions"


def of_exact_motion(paper: Paper, row: Row) -> str:
    """Whether the exact motion goes as a claim says that speaks of a model: "as said", or what it does; ""
    for other claims."""
    test = row.options.get("test")
    if test not in OF_MODELS or _model(paper, row) == "exact":
        return ""
    arguments = row.options.get("with", {}) | {"model": "exact"}
    printed = abs(float(measured.TESTS[test](**arguments)[0]))
    if printed <= row.options.get("bound", TEST_BOUND):
        return "as said"
    if test != "trend":
        return "not so"
    keys = ("family", "part", "measure", "axis", "only", "model", "wheels")
    rows = trends.of_all(**{key: arguments[key] for key in keys if key in arguments})
    failed = next(values for values in rows
                  if trends.missed(values, arguments["goes"], arguments.get("within", trends.ROUNDING)))
    return f"not so: {', '.join(f'{value:.4g}' for value in failed)}"


def _model(paper: Paper, row: Row) -> str:
    return row.options.get("with", {}).get("model") or trends.MODELS[paper.figures]
