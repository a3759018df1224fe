"""Formulas in LaTeX: names that stand for a product or are a word. Expected: LaTeX's own rules, as a paper
writes weight, charge and mass."""
import re
from pathlib import Path

import pytest
import sympy

import stabilab
from stabilab.physics.equations import derive
from stabilab.show.report.typeset import PRODUCTS
from stabilab.show.text.scene import latex, tex

CASES = Path(__file__).parents[2] / "cases"
e, m, k = sympy.symbols("eHl2 mass k", positive=True)
Mgx = sympy.Symbol("Mgx")


@pytest.mark.parametrize("formula, made", [
    (e * k, "e H l^2 k"), (e**2, r"\left(e H l^2\right)^{2}"), (k / m, r"\frac{k}{\mathrm{mass}}"),
    (k / m**2, r"\frac{k}{\mathrm{mass}^{2}}"), (-Mgx, "- M g x_c")])
def test_a_name_that_stands_for_a_product_is_that_product_and_a_word_stands_upright(formula, made):
    assert tex(formula) == made


@pytest.mark.parametrize("name", ["charged-body-attitude", "top-fast", "charged-body"])
def test_no_name_of_the_program_is_left_in_the_equations_of_a_scene(name):
    """But for words set upright, every name in the formulas is one letter, with an index perhaps."""
    text = latex(derive(stabilab.load(CASES / f"{name}.toml").scene)).replace(r"\mathrm{mass}",
                                                                              "").replace("{align*}", "")
    assert not re.findall(r"(?<![\\A-Za-z])[A-Za-z]{2,}", text) and "{2}_" not in text
    assert all(word not in text for word in PRODUCTS)
