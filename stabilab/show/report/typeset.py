"""Formulas as MathML, which a browser sets by itself: no script, no font, nothing from a network."""
from __future__ import annotations

import re

from ...physics.equations import Equations
from ..text.scene import PRODUCTS, right_side

# symbols and digits or so of a sum that fit beside each other on a page; a longer one goes on in the next
# line
LINE = 46
LONG = 40  # operations: a law of more is told in words alone


def equations_of_motion(equations: Equations) -> list:
    """An equation a component of the state: its factor and its rate with a dot, and the sum."""
    rows = []
    for number, (moment, part) in enumerate(zip(equations.inertia, equations.state)):
        factor = "" if moment == 1 else inner(moment)
        # the dot above the letter, not above the middle of letter and index
        dotted = re.sub(r"<mi>[^<]*</mi>", r"<mover>\g<0><mo>&#x2D9;</mo></mover>", inner(part), count=1)
        rows.append(display(f"{factor}{dotted}<mo>=</mo>{in_lines(right_side(equations, number))}"))
    return rows


def display(content: str):
    """A line of its own."""
    from markupsafe import Markup
    return Markup(f'<math display="block"><mrow>{content}</mrow></math>')


def inline(expression):
    """An expression within a sentence."""
    from markupsafe import Markup
    return Markup(f"<math><mrow>{inner(expression)}</mrow></math>")


def symbol(name: str):
    """A symbol by its name: lambda1 with its Greek letter and its index."""
    from sympy import Symbol
    return inline(Symbol(name))


def law(balance) -> str:
    """The quantity of a law, and its rate where that is not zero; empty where too long to be read."""
    from sympy import Integer, count_ops
    quantity, rate = rounded(balance.quantity), rounded(Integer(0) + balance.rate)
    if count_ops(quantity) + count_ops(rate) > LONG:
        return ""
    changes = ("<mtext>&#x2009;constant</mtext>" if rate == 0
               else f"<mo>)</mo><mo>&#x2D9;</mo><mo>=</mo>{inner(rate)}")
    return display(f"{'' if rate == 0 else '<mo>(</mo>'}{in_lines(quantity)}{changes}")


def rounded(expression):
    """The expression with numbers of many digits rounded to six."""
    from sympy import Float, Integer, Rational
    expression = Integer(0) + expression
    return expression.xreplace({number: Float(number, 6) for number in expression.atoms(Rational)
                                if len(str(number)) > 8})


def in_lines(expression) -> str:
    """A sum in as many lines as it takes, one below the other; everything else as `inner`."""
    from sympy import Add, Integer
    expression = Integer(0) + expression
    if not isinstance(expression, Add) or sum(map(_width, expression.args)) <= LINE:
        return inner(expression)
    lines: list[list] = [[]]
    for term in expression.as_ordered_terms():
        if lines[-1] and sum(map(_width, lines[-1])) + _width(term) > LINE:
            lines.append([])
        lines[-1].append(term)
    rows = ""
    for number, terms in enumerate(lines):  # the later ones begin with their sign
        sign = "<mo>+</mo>" if number and not terms[0].could_extract_minus_sign() else ""
        rows += f'<mtr><mtd style="text-align: left"><mrow>{sign}{inner(Add(*terms))}</mrow></mtd></mtr>'
    return f'<mtable displaystyle="true">{rows}</mtable>'


def _width(term) -> float:
    """How many symbols and digits stand beside each other in a term: a fraction counts by its wider part."""
    from sympy import fraction
    return max(sum(len(word) if word[0].isdigit() else 1.3
                   for word in re.findall(r"[A-Za-z]\w*|[\d.]+|[-+(]", str(part))) for part in fraction(term))


def inner(expression) -> str:
    """The expression as presentation MathML, without the element around it."""
    from sympy import Integer
    from sympy.printing.mathml import mathml
    text = numbered(mathml(Integer(0) + expression, printer="presentation"))
    # eHl2: SymPy sees an index
    text = re.sub(r"<msub><mi>(\w+)</mi><mi>(\d)</mi></msub>",
                  lambda found: _product(found[1] + found[2]) or found[0], text)
    text = re.sub(r"<mi>(\w+)</mi>", lambda found: _product(found[1]) or found[0], text)
    for product in map(_product, PRODUCTS):  # a power is that of all its letters
        text = text.replace(f"<msup>{product}", f"<msup><mrow><mo>(</mo>{product}<mo>)</mo></mrow>")
    return text


def numbered(mathml: str) -> str:
    """MathML of SymPy with the minus, the i and the e of a book, which SymPy has struck twice, with bars that
    browsers draw over conjugates, and whole numbers of six digits without a zero behind their point."""
    mathml = mathml.replace("&ImaginaryI;", "i").replace("&ExponentialE;", "e")
    mathml = mathml.replace("<mo>-</mo>", "<mo>&#x2212;</mo>").replace("<mn>-", "<mn>&#x2212;")
    mathml = re.sub(r'<menclose notation="top">(.*?)</menclose>',
                    r'<mover accent="true"><mrow>\1</mrow><mo>&#xAF;</mo></mover>', mathml)
    return re.sub(r"<mn>([^<>]*\d)\.0</mn>", r"<mn>\1</mn>", mathml)


def _product(name) -> str:
    """What a name stands for as a product of letters with indices and powers; empty where for itself."""
    made = (re.split("([_^])", word) for word in PRODUCTS.get(name, "").split())
    kind = {"_": "msub", "^": "msup"}
    letters = "".join(f"<{kind[part[1]]}><mi>{part[0]}</mi><mi>{part[2]}</mi></{kind[part[1]]}>"
                      if len(part) > 1 else f"<mi>{part[0]}</mi>" for part in made)
    return letters and f"<mrow>{letters}</mrow>"
