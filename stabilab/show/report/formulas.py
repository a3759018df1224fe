"""Formulas as MathML, which the browser sets itself: no script, no font, nothing from a network."""
from __future__ import annotations

from functools import lru_cache
from html import unescape
from typing import Any

from ...physics.equations import Equations
from ..text.scene import PRODUCTS, TOO_LONG, right_side

# symbols and digits or so of a sum that fit beside each other on a page; a longer one goes on in the next
# line
LINE = 46
LONG = 40  # operations: a law of more is stated in words alone
LETTER = 1.3  # width of a symbol or a sign, in digits


def equations_of_motion(equations: Equations) -> list:
    """An equation a component of the state: its factor and its rate with a dot, and the sum."""
    rows = []
    for number, (moment, part) in enumerate(zip(equations.inertia, equations.state)):
        factor = "" if moment == 1 else inner(moment)
        side = right_side(equations, number)
        sum_of_torques = f"<mtext>{TOO_LONG}</mtext>" if side is None else in_lines(side)
        rows.append(display(f"{factor}{_printer().dotted(part)}<mo>=</mo>{sum_of_torques}"))
    return rows


def display(content: str):
    """A line of its own."""
    from markupsafe import Markup
    return Markup(f'<math display="block"><mrow>{content}</mrow></math>')


def symbol(name: str):
    """A symbol by its name, within a sentence: lambda1 with its Greek letter and its index."""
    from markupsafe import Markup
    from sympy import Symbol
    return Markup(f"<math><mrow>{inner(Symbol(name))}</mrow></math>")


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


def inner(expression, products: bool = True) -> str:
    """The expression as presentation MathML, without the element around it. products: whether names of
    `PRODUCTS` are set as what they stand for."""
    from sympy import Integer
    return _printer(products).doprint(Integer(0) + expression if products else expression)


def _width(term) -> float:
    """How many symbols and digits stand beside each other in a term: a fraction counts by its wider part."""
    from sympy import fraction
    return max(_beside(_printer().element(part)) for part in fraction(term))


def _beside(element: Any) -> float:
    """The same of an element of MathML: a letter with its index is one symbol."""
    inside = [childnode for childnode in element.childNodes if childnode.nodeType == childnode.ELEMENT_NODE]
    match element.tagName:
        case "mn":
            return len(unescape(element.firstChild.data))
        case "mo":
            return LETTER if element.firstChild.data in ("(", "+", "&#x2212;") else 0.0
        case "mi" | "msub":
            return LETTER
        case "mfrac":
            return max(map(_beside, inside))
        case "msqrt":
            return LETTER + sum(map(_beside, inside))
    return sum(map(_beside, inside))


@lru_cache(maxsize=2)
def _printer(products: bool = True):
    """The printer of SymPy with the signs of a book."""
    from sympy import Symbol
    from sympy.printing.mathml import MathMLPresentationPrinter
    from sympy.printing.precedence import PRECEDENCE

    class Book(MathMLPresentationPrinter):
        """With the minus, the i and the e of a book, which SymPy has struck twice, with bars that browsers
        draw over conjugates, whole numbers of six digits without a zero behind their point, and names that
        stand for a product as that product."""

        def __init__(self):
            super().__init__()
            raw = self.dom.createTextNode
            self.dom.createTextNode = lambda text: raw(_set(text))

        def element(self, expression):
            """The element of an expression."""
            return self._print(expression)

        def dotted(self, symbol) -> str:
            """The rate of a symbol: the dot stands above the letter, not above the middle of letter and
            index."""
            built = self.dom.createElement("mrow")
            built.appendChild(self._print(symbol))
            letter = built.getElementsByTagName("mi")[0]
            full = letter.parentNode
            dot = self._element("mover")
            full.replaceChild(dot, letter)
            dot.appendChild(letter)
            dot.appendChild(self._element("mo", "&#x2D9;"))
            return built.firstChild.toxml().encode("ascii", "xmlcharrefreplace").decode()

        def parenthesize(self, item, level, strict=False):
            # a power is that of all letters of a product
            product = level == PRECEDENCE["Pow"] and isinstance(item, Symbol) and self._stands_for(item)
            return super().parenthesize(item, PRECEDENCE["Atom"] + 1 if product else level, strict)

        def _print_Symbol(self, symbol, style="plain"):
            product = self._stands_for(symbol)
            if not product:
                return super()._print_Symbol(symbol, style)
            row = self._element("mrow")
            for factor in product.split():
                row.appendChild(self._factor(factor))
            return row

        def _print_conjugate(self, expression):
            bar = self._element("mover")
            bar.setAttribute("accent", "true")
            row = bar.appendChild(self._element("mrow"))
            row.appendChild(self._print(expression.args[0]))
            bar.appendChild(self._element("mo", "&#xAF;"))
            return bar

        def _stands_for(self, symbol) -> str:
            return PRODUCTS.get(symbol.name, "") if products else ""

        def _factor(self, written):
            for mark, tag in (("_", "msub"), ("^", "msup")):
                letter, result, beside = written.partition(mark)
                if result:
                    built = self._element(tag)
                    for part in (letter, beside):
                        built.appendChild(self._element("mi", part))
                    return built
            return self._element("mi", written)

        def _element(self, tag, text=None):
            built = self.dom.createElement(tag)
            if text is not None:
                built.appendChild(self.dom.createTextNode(text))
            return built
    return Book()


def _set(text: str) -> str:
    """A name, a number or a sign of SymPy as a book sets it."""
    text = {"&ImaginaryI;": "i", "&ExponentialE;": "e"}.get(text, text)
    text = f"&#x2212;{text[1:]}" if text.startswith("-") else text
    return text.removesuffix(".0")
