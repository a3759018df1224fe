"""A scene in words, its equations and laws; and all combinations of a [sweep] as one table.

The table has a column for each key that varies, then the answer's numbers."""
from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from ...answers.caveats import of_case
from ...errors import InputError
from ...numbers.exact import exact
from ...numbers.units import DIMENSIONS, NAMES
from ...orbit.result import HEADS
from ...physics.coefficients import shape_factors, to_scaled
from ...physics.effects.base import effect_words
from ...physics.equations import Balance, Equations, Symbolic, derive, invariants
from .. import ending, frame, limiting, terminal
from ..terminal import lettered, listed, some, table, width, written
from ..units import DEG, DIGITS, SHORT, Units, as_bound, but_for_rounding, number, parameter_unit, units_of
from .headline import known_as, rate_margin
from .motion import shown

if TYPE_CHECKING:
    from sympy import Expr

    from ...case.read import Case

EACH = "each "  # before what all of several cases do
LETTERS = {"angular_velocity": "ω", "mu": "μ"}  # keys with a shorter name
Column = tuple[str, str, Callable]  # its head, its unit, and what it says of a motion


def groups(cases: Sequence) -> list[list[int]]:
    """Indices of cases that belong together: all combinations of one file, or a case by itself."""
    out: list[list[int]] = []
    for n, case in enumerate(cases):
        if case.variant and out and cases[out[-1][-1]].path == case.path and cases[out[-1][-1]].variant:
            out[-1].append(n)
        else:
            out.append([n])
    return out


def text(cases: Sequence, answer: str, columns: Sequence[tuple[str, str]],
         rows: Sequence[Sequence[str]]) -> str:
    """The answer in a line, then the table. columns: (head, unit) after the swept keys; rows: one a case."""
    keys = swept_columns(cases)
    heads = [name for name, *_ in keys] + [head for head, _ in columns]
    units = [unit for _, unit, _ in keys] + [unit for _, unit in columns]
    cells = [[values[n] for *_, values in keys] + list(row) for n, row in enumerate(rows)]
    lines = terminal.table([heads, units, *cells], len(keys), terminal.width())
    name = cases[0].name.removesuffix(cases[0].variant)
    return "\n".join([f"{name}: {of_all_combinations(len(cases), answer)}", *lines])


def of_all_combinations(count: int, answer: str) -> str:
    """The answer of so many combinations: "each of 27 ...", or "27 combinations: ..." where they differ."""
    return (f"each of {count} {answer.removeprefix(EACH)}" if answer.startswith(EACH)
            else f"{some(count, 'combination')}: {answer}")


def swept_columns(cases: Sequence) -> list[tuple[str, str, list[str]]]:
    """(head, unit, a cell a case) of every swept key; of a vector the components that vary. A value with a
    unit of its own is printed as written."""
    return [column for location in range(len(cases[0].swept)) for column in key_columns(cases, location)]


def key_columns(cases: Sequence, location: int) -> list[tuple[str, str, list[str]]]:
    """(head, unit, a cell a case) of one swept key, the number of which is `location`."""
    key, values = cases[0].swept[location][0], [case.swept[location][1] for case in cases]
    path = key.split(".")
    alone = sum(other.split(".")[-1] == path[-1] for other, _ in cases[0].swept) == 1
    label = ".".join(LETTERS.get(word, word) for word in path[-1 if alone else -2:])
    # a matrix: which of those in the file
    if any(isinstance(v, list) and any(isinstance(item, list) for item in v) for v in values):
        return [(label, "", [f"no. {_of_matrices(case.variant, location)}" for case in cases])]
    if all(isinstance(v, list) and len(v) == len(values[0]) for v in values):
        moving = [i for i in range(len(values[0])) if len({repr(v[i]) for v in values}) > 1] or [0]
        return [(f"{label}[{i + 1}]", _unit(key, [v[i] for v in values]), [str(v[i]) for v in values])
                for i in moving]
    return [(label, _unit(key, values), [str(v) for v in values])]


def _of_matrices(variant: str, location: int) -> str:
    """Which value of a key a combination has; of keys that vary together all have the same."""
    numbers = variant.split("-")[1:]
    return numbers[location if len(numbers) > 1 else 0]


def _unit(key: str, values) -> str:
    """The unit of plain numbers of a key; nothing where they bring their own."""
    path = key.split(".")
    of = DIMENSIONS.get(".".join([path[0], path[-1]]) if path[0] in ("thrusters", "wheels") else key)
    if of is None or not all(map(_bare, values)):
        return ""
    return lettered(NAMES[of].partition("(")[2].rstrip(")"))


def _bare(value) -> bool:
    """Whether a value of a key is a number without a unit."""
    try:
        exact(value)
    except InputError:
        return False
    return True


def counted(answers: Sequence[tuple], phrase: Mapping[str, str], units: Units, between: str) -> str:
    """How many of the (fate, caveats) have which fate, with the condition that these share."""
    counts, printed = Counter(fate for fate, _ in answers), []
    for fate, count in counts.most_common():
        where = limiting.shared([caveats for item, caveats in answers if item == fate], units)
        name = (phrase[fate].removesuffix(" for ever") if where else phrase[fate]) + where
        printed.append(f"{name}: {count}" if len(counts) > 1 else f"{EACH}{name}")
    return between.join(printed)


def fates(motions: Sequence, units: Units) -> str:
    """How many motions have which fate, and the range of their largest rates."""
    phrase = counted([(_became(motion), motion.caveats) for motion in motions], HEADS | ending.ENDING_HEADS,
                    units,
                    ", ")
    sizes = [(_largest(motion), motion.largest is None) for motion in motions]
    sizes = [size for size in sizes if size[0] is not None]
    if not sizes:
        return phrase
    (smallest, _), (largest, side) = min(sizes), max(sizes)
    low, high = number(smallest * units.rates[1]), units.rate(largest, SHORT, side)
    return f"{phrase}; largest rate " + (high if high.split()[0] == low else f"{low} to {high}")


def _became(motion) -> str:
    """Its fate, or how it ends where it loses energy."""
    item = motion.ending
    return motion.fate.word if item is None or item.kind == "undecided" else item.kind


def _largest(motion):
    """|omega| at the most, or a bound of it."""
    pairs = motion.extremes if motion.bounds is None else motion.bounds
    if motion.largest is not None or pairs is None or any(None in pair for pair in pairs):
        return motion.largest
    bound = math.hypot(*(max(map(abs, pair)) for pair in pairs))
    return bound if bound < math.inf else None


def of_motions(motions: Sequence, units: Units) -> tuple[list[tuple[str, str]], list[list[str]]]:
    """Columns and rows of fate, axis, largest rate, margins and period, without those that say nothing."""
    name, item = units.rates
    longest = max((m.period for m in motions if m.period is not None), default=0.0)
    time, per_time = units.times(longest)
    over = max((m.ending.until for m in motions if m.ending is not None and m.ending.until), default=0.0)
    hour, per_hour = units.times(over)
    columns = [("limit", "", lambda m: limiting.reached(m.caveats, units)),
               ("fate", "", lambda m: _became(m) + known_as(m)),
             ("axis", "", lambda m: units.axes.signed(m.axis or (m.ending.axis if m.ending and m.ending.sense
                                                                 else 0),
                                                      m.sense or (m.ending.sense if m.ending else 0))),
             ("ends after", hour, lambda m: number(m.ending.until * per_hour, 6) if m.ending is not None
              and m.ending.until else ""),
             ("largest rate", name, lambda m: "" if _largest(m) is None else number(
                 as_bound(_largest(m), item, 6, m.largest is None), 6)),
             ("margin", name, lambda m: rate_margin(m, units, 6).removesuffix(f" {name}") if name
              else rate_margin(m, units, 6)),
             ("to barrier", units.of("J")[0],
              lambda m: "" if m.margin_energy is None else shown(m.margin_energy)),
             ("period", time, lambda m: "" if m.period is None else number(m.period * per_time, 6))]
    return filled(columns, motions)


def of_extremes(motions: Sequence, names: Sequence[str],
                units: Units) -> tuple[list[tuple[str, str]], list[list[str]]]:
    """Columns and rows of the fate, and of least and greatest of every component."""
    name, item = units.rates
    motions = [replace(m, extremes=but_for_rounding(m.extremes, m.tolerance)) for m in motions]
    columns: list[Column] = [("fate", "", lambda m: m.fate.word + known_as(m))]
    for i, component in enumerate(names):
        for end, word in enumerate(("least", "most")):
            columns.append((f"{lettered(component)} {word}", name, lambda m, i=i,
                            end=end: "" if m.extremes is None else shown(
                                m.extremes[i][end], item, side=m.extremes_side * (2 * end - 1))))
    return filled(columns, motions)


def filled(columns: Sequence[Column], answers: Sequence) -> tuple[list[tuple[str, str]], list[list[str]]]:
    """(columns, rows) of those columns that say something of an answer."""
    rows = [[phrase(answer) for _, _, phrase in columns] for answer in answers]
    retained = [n for n in range(len(columns)) if any(row[n] for row in rows)]
    return [columns[n][:2] for n in retained], [[row[n] for n in retained] for row in rows]


TOO_LONG = "too long for a page"  # of a formula
LONGEST = 1000  # operations of a rate, up to which it is written
RATIO_LETTERS = 12  # up to which a ratio is printed as such, not as a decimal
# parameters whose names are products
PRODUCTS = {"Mgx": "M g x_c", "Mgy": "M g y_c", "Mgz": "M g z_c", "eHl2": "e H l^2",
            "kd": "k_d", "cd": "c_d", "kB2": "k B^2", "Jw": "J_w", "cw": "c_w", "mud": "mu_d", "ks": "k_s",
            "cs": "c_s"}
WORD_NAMES = ("mass",)  # parameters whose names are words


def of_all(cases: Sequence[Case]) -> str:
    """What `stabilab show` prints of a case, or of all combinations of its [sweep]: those with the same
    equations and laws together, the first whole, the others by their values."""
    kinds: dict[tuple, list] = {}
    for case in cases:
        equations, own = derive(case.scene), invariants(case.scene)
        kinds.setdefault((*lines(equations), *(law.because for law in (*equations.balances, *own))),
                         []).append((case, equations, own))
    parts = []
    for kind in kinds.values():
        parts.append(limiting.noted(of_case(kind[0][0]), _whole(*kind[0]), units_of(kind[0][0])))
        if len(kind) > 1:
            some_cases = [case for case, _, _ in kind]
            columns = swept_columns(some_cases)
            rows = [["", *(head for head, _, _ in columns)], ["", *(unit for _, unit, _ in columns)],
                    *([case.name, *(cells[n] for _, _, cells in columns)]
                      for n, case in enumerate(some_cases))]
            told = (f"The same equations and laws hold for {some(len(kind) - 1, 'other combination')}; the "
                    f"numbers in them are those of {some_cases[0].name}.")
            parts.append("\n".join([f"{told} Swept keys:", *table(rows, 1, width())]))
    return "\n\n".join(parts)


def _whole(case: Case, equations: Equations, own: Sequence[Balance]) -> str:
    """Scene, parameters, equations of motion as text and LaTeX, invariants. own: the laws of this scene."""
    unit = parameter_unit if case.variables == "physical" else lambda name: ""
    parts = [_head(case), "Parameters",
             *(f"  {written(name)} = {_value(v)} {unit(name)}".rstrip()
               for name, v in equations.parameters.items()), "",
             "Equations of motion", *(f"  {lettered(_products(line))}" for line in lines(equations)), "",
             "Jacobian, the derivatives of each rate by the state", *_jacobian(case, equations), "",
             "In LaTeX", latex(equations), "", "Laws that hold for every value of the parameters"]
    said = units_of(case).said
    parts += [f"  {said(law.reason)}" for law in equations.balances]
    parts += ["", "Laws of this scene: first integrals, and what changes at a known rate"]
    for law in own:
        rate = "" if law.rate == 0 else f"   at the rate {_short(law.rate)}"
        parts += [f"  {said(law.reason)}", f"    {_short(law.quantity)}{rate}"]
    effects = listed([effect_words(effect.name) for effect in case.scene.effects] or ["no effect"])
    scene = "scaled gyrostat" if case.variables == "scaled" else f"body with {effects}"
    return "\n".join([f"{case.name}: a {scene}; laws known of this scene: {len(own)}", *parts,
                      *([] if own else ["  none is known"])])


def _head(case: Case) -> str:
    rows = [written(case.title) or case.name, f"  from {case.place}"]
    rows += [f"  source: {case.source}"] if case.source else []
    components = ", ".join(map(lettered, case.scene.components))
    rows += [f"  variables: {case.variables} ({components}; time in {lettered(case.scene.time_unit)})"]
    if case.physical:
        rows.append(f"  body with inertia {_triple(case.physical.body.inertia)} kg m²")
        for effect in case.physical.effects:
            values = [f"{written(name)} = {_number(v)} {parameter_unit(name)}".rstrip()
                      for name, v in effect.parameters().items()]
            rows.append(f"  {effect_words(effect.name)}: {', '.join(values)}")
    rows += [f"  {line}" for line in (*frame.lines(case), *_craft(case))]
    rows += _scaled(case)
    units = units_of(case)
    rows += [f"  motion from {units.vector(case.state[:3], units.rates, DIGITS)}"] if case.state else []
    rows += [f"  to 72 digits, as π is in the unit: {', '.join(case.inexact)}"] if case.inexact else []
    rows += [f"  note: {units.said(item)}" for item in case.assumed]
    return "\n".join(rows) + "\n"


def _scaled(case) -> list[str]:
    """The paper's scaled variables of a body in order D1 > D2 > D3 with its wheel along axis 1."""
    body = case.physical and case.physical.body
    if not body or not case.scene.plain or not body.exact[0] > body.exact[1] > body.exact[2]:
        return []
    names = ", ".join(f"k{n} = {_number(k)}" for n, k in enumerate(shape_factors(body), 1))
    try:
        twin, change = ((case.scene, case.scaling) if case.variables == "scaled"
                        else to_scaled(case.physical))
    except InputError:  # no torque, or a wheel off axis 1
        return [f"  scaled variables of Amer et al. 2024: {names}"]
    return [f"  scaled variables of Amer et al. 2024: {names}, u = {_number(change.u)}, "
            f"a = {_number(twin.a)}, b = {_number(twin.b)}, μ = {_triple(twin.exact_mu)}",
            f"  one unit of τ is {float(change.time):.6g} s; "
            f"ωⱼ = {', '.join(f'{float(r):.6g}' for r in change.rate)} times xⱼ (rad/s)"]


def _craft(case) -> list[str]:
    """Thrusters, wheels and limits, in the frame of the file."""
    lines = []
    for t in case.thrusters:
        cone = "" if t.misalignment is None else f", within {math.degrees(t.misalignment):.6g} deg"
        off = "" if t.force_tolerance is None else f" ± {float(t.force_tolerance):.6g}"
        lines.append(f"thruster {t.name}{' (stuck)' if t.stuck else ''}: {_number(t.force)}{off} N along "
                     f"{_triple(t.direction)}{cone} at "
                     f"{_triple(t.position)} m, torque {_triple(t.torque)} N m, all in the frame of the file")
    lines += [f"wheel {w.name}: {_number(w.momentum)} N m s about {_triple(w.axis)} in the frame of the file"
              for w in case.wheels]
    if case.limits and case.limits.rate is not None:
        lines.append(f"limit: |ω| up to {DEG.rate(case.limits.rate)}")
    elif case.limits:
        rates = ", ".join(map(DEG.rate, case.limits.rates))
        lines.append(f"limit: components up to {rates} in the frame of the file")
    return lines


def _triple(vector: Sequence[float | Fraction]) -> str:
    return f"({', '.join(map(_number, vector))})"


def _number(value: float | Fraction) -> str:
    """A number as it was given, where that is a short decimal; six digits of any other."""
    supplied = f"{float(value):.9g}"
    return supplied if Fraction(supplied) == Fraction(str(value)) else number(float(value), DIGITS)


def _value(v: Fraction) -> str:
    """Exact where that is short, with its decimal; else the decimal alone."""
    exact = str(v)
    return (exact if "/" not in exact and len(exact) <= RATIO_LETTERS
            else f"{exact} = {_number(v)}" if len(exact) <= RATIO_LETTERS else _number(v))


def _short(expression: Expr) -> str:
    """The expression with rationals that are long rounded to six digits."""
    from sympy import Rational
    long = {r: r.evalf(DIGITS) for r in expression.atoms(Rational) if len(str(r)) > RATIO_LETTERS}
    return lettered(_products(str(expression.xreplace(long))))


def _jacobian(case: Case, equations: Equations) -> list[str]:
    """A row of the matrix a line; that of a liquid in a cavity, or of long equations, would fill pages."""
    from sympy import factor_terms
    if ("liquid_cavity" in (effect.name for effect in case.scene.effects)
            or None in (right_side(equations, i) for i in range(len(equations.state)))):
        return [f"  {TOO_LONG}: stabilab.derive(case.scene).jacobian"]
    rows = equations.jacobian.applyfunc(factor_terms).tolist()
    return [f"  ({', '.join(lettered(_products(str(entry))) for entry in row)})" for row in rows]


def _products(formula: str) -> str:
    """A formula of SymPy with its factors side by side and ^ before powers."""
    return formula.replace("**", "^").replace("*", " ")


# --- The equations of motion as lines of text and as LaTeX
def lines(equations: Equations) -> tuple[str, ...]:
    """The equations of motion as plain text, one line each."""
    factor = lambda d: "" if d == 1 else f"({d}) " if d.is_Add else f"{d} "
    sides = (right_side(equations, i) for i in range(len(equations.state)))
    long = f"{TOO_LONG}: stabilab.derive(case.scene).rhs"
    return tuple(f"{factor(d)}{x}' = {long if side is None else side}"
                 for d, x, side in zip(equations.inertia, equations.state, sides))


def right_side(equations: Equations, i: int) -> Symbolic | None:
    """The rate of component i, times its moment of inertia: a sum ordered by the powers of the state; None
    where it is too long to be read."""
    from sympy import Poly, PolynomialError, prod
    total = sum(part[i] for part in equations.torques.values()) if i < 3 else equations.rhs[i]
    if total and total.count_ops() > LONGEST and not total.is_polynomial(*equations.state):
        return None  # to expand it would take minutes
    try:
        terms = Poly(total, *equations.state).terms()
    except PolynomialError:
        return total
    return sum(factor * prod(x**n for x, n in zip(equations.state, powers)) for powers, factor in terms)


def latex(equations: Equations) -> str:
    """The equations of motion as a LaTeX align* environment."""
    factor = lambda d: "" if d == 1 else rf"\left({tex(d)}\right) " if d.is_Add else f"{tex(d)} "
    sides = (right_side(equations, i) for i in range(len(equations.state)))
    rows = [rf"{factor(d)}\dot{{{tex(x)}}} &= "
            + (rf"\text{{{TOO_LONG}}}" if side is None else tex(side))
            for d, x, side in zip(equations.inertia, equations.state, sides)]
    return "\\begin{align*}\n" + " \\\\\n".join(rows) + "\n\\end{align*}"


def tex(expression: Symbolic) -> str:
    """A formula in LaTeX: words upright, and names that stand for a product as that product."""
    from sympy import latex as of_sympy
    names = {symbol: (rf"\mathrm{{{symbol.name}}}" if symbol.name in WORD_NAMES
                      else f"{{{PRODUCTS[symbol.name]}}}")
             for symbol in expression.free_symbols if symbol.name in PRODUCTS or symbol.name in WORD_NAMES}
    made = of_sympy(expression, symbol_names=names)
    for product in PRODUCTS.values():  # a power is that of all its letters
        made = made.replace(f"{{{product}}}^", rf"\left({product}\right)^").replace(f"{{{product}}}", product)
    return made
