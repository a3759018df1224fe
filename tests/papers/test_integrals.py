"""The integrals of the paper's motions, the equilibria beside them and their eigenvalues, by mpmath from the
paper's equations (5): y' = (x2 x3 + mu1, -x3 (x1 + a) + mu2, x2 (x1 + b) + mu3), written here."""
import mpmath as mp
import pytest

from stabilab.case.read import load
from stabilab.papers import index, table
from stabilab.papers.figures import catalogue

CASES = [f"{family}-{lam}" for family in ("minor-axis", "middle-axis", "middle-axis-equal", "middle-axis-plane")
         for lam in (100, 300, 500)]


def rates(x, a, b, mu):
    return [x[1] * x[2] + mu[0], -x[2] * (x[0] + a) + mu[1], x[1] * (x[0] + b) + mu[2]]


def eigenvalues(x, a, b):
    """Of the Jacobian of the rates, largest first."""
    jacobian = mp.matrix([[0, x[2], x[1]], [-x[2], 0, -(x[0] + a)], [x[1], x[0] + b, 0]])
    return sorted(mp.eig(jacobian, right=False), key=lambda z: -abs(z))


def integral(name, x, a, b):
    """G1, G2, G3 as derived in docs/mathematics/reduction.md; dG/dtau = 0 is tested below by differences."""
    c, (x1, x2, x3) = b - a, x
    if name == "G1":
        return 2 * x3**2 + x2**2 - (x1 + a) ** 2 - 4 * c * (x1 + a) - 4 * mp.atan2(x1 + a, x2)
    if name == "G2":
        return 2 * x2**2 + (x1 + b) ** 2 + x3**2 - 4 * c * (x1 + b) - 4 * mp.atanh(x3 / (x1 + b))
    return (x2**2 + x3**2) / 2 - c * x3 - mp.log(abs(x3))


def row(stem):
    family, _, lam = stem.rpartition("-")
    case = load(table.case_file(family, int(lam)))
    return case, dict(zip(table.MOTIONS_HEADER, table._motion_row(case, int(lam))))


@pytest.mark.parametrize("stem", CASES)
def test_integrals_and_eigenvalues_are_those_of_the_papers_equations(stem):
    case, cells = row(stem)
    exact = lambda v: mp.mpf(v.numerator) / v.denominator
    with mp.workdps(30):
        (a, b), x = (tuple(map(exact, values)) for values in (case.scene.exact_ab, case.exact_state))
        mu = case.scene.mu
        name, = (name for name in ("G1", "G2", "G3") if cells[name] is not None)
        step = [v + mp.mpf(10) ** -12 * rate for v, rate in zip(x, rates(x, a, b, mu))]
        assert abs(integral(name, step, a, b) - integral(name, x, a, b)) < 1e-20  # of second order in the step
        assert cells[name] == pytest.approx(float(integral(name, x, a, b)), rel=1e-14)
        conic = lambda y: ((y[0] + a) ** 2 + y[1] ** 2 if name == "G1" else (y[0] + b) ** 2 - y[2] ** 2)
        assert (cells["F"] ** 2 if name == "G1" else 2 * cells["N"]) == pytest.approx(float(conic(x)), abs=1e-13)
        centre = [cells[f"centre x{n}"] for n in (1, 2, 3)]
        for at, turn, name_of in ((centre, 1j, "eigenvalue ±i"),
                                  ([cells[f"saddle x{n}"] for n in (1, 2, 3)], 1, "eigenvalue ±")):
            if at[0] is None:
                assert name != "G1" and at is not centre  # |b - a| < 4 (1/27)^(1/4): no saddle for the paper's data
                continue
            # places have twelve digits, and rates and integrals change by some twenty times what they do
            assert max(map(abs, rates(at, a, b, mu))) < 1e-10
            assert float(conic(at)) == pytest.approx(float(conic(x)), abs=1e-10)
            pair, other, zero = eigenvalues(at, a, b)
            assert abs(zero) < 1e-6  # a zero eigenvalue of a matrix with rounding
            for value in (pair, other):
                assert min(abs(value - sign * turn * cells[name_of]) for sign in (1, -1)) < 1e-10
        if name == "G1":  # the saddle ahead is within one turn of the angle, where that of G1 counts on
            saddle = [cells[f"saddle x{n}"] for n in (1, 2, 3)]
            ahead = integral(name, saddle, a, b)
            ahead -= 0 if mp.atan2(saddle[0] + a, saddle[1]) > mp.atan2(x[0] + a, x[1]) else 8 * mp.pi
            assert cells["on separatrix"] == pytest.approx(float(ahead), rel=1e-11)  # of twelve digits of the place
            assert cells["on separatrix"] > cells[name]  # all three are bounded


def test_the_printed_rows_hold_what_30_71_and_79_give():
    """F and G1 at the start of table 2 by (18) and (30), lambda1 = 100: sqrt(2.5^2 + 4^2), 3.5356 by hand."""
    cells = dict(zip(table.EXTREMES_HEADER + ("F", "G1"), table.extremes_table(2).rows[1]))
    assert (cells["case"], cells["F"]) == ("as printed", pytest.approx(22.25**0.5))
    by_30 = 2 * 0.1**2 + 4**2 - 2.5**2 - 4 * 0.4 * 2.5 - 4 * mp.atan(mp.mpf(2.5) / 4)
    assert cells["G1"] == pytest.approx(float(by_30), rel=1e-14)
    by_79 = 2.5**2 / 2 + 1.3**2 / 2 + 0.6 * 2.5 - float(mp.log(2.5))
    assert table.extremes_table(4).rows[1][-1] == pytest.approx(by_79, rel=1e-14)


@pytest.mark.parametrize("paper, name, equation", [((), "G1", "30"), (("constant-torque",), "G3", "79")])
def test_the_audit_finds_an_integral_by_its_name(stabilab, paper, name, equation):
    code, out, _ = stabilab("audit", *paper, "--equation", name)
    assert code == 0 and any(line.startswith(f"{equation} ") for line in out.splitlines())


def test_an_equation_that_no_paper_has_is_refused(stabilab):
    code, out, err = stabilab("audit", "--equation", "G99")
    assert (code, out) == (2, "") and "no paper has a row for it" in err and err.count("\n") == 1


def test_a_figure_of_the_main_paper_leads_to_the_pages_of_its_cases():
    pages = {path.stem: f"cases/{path.stem}.html" for path in table.cases_folder().glob("*.toml")}
    for figure in catalogue.FIGURES:
        cases = index.cases_of(figure, pages)
        assert [case["link"] for case in cases] == [pages[case["name"]] for case in cases]
        assert len(cases) == (0 if figure.added else 3)
    assert index.cases_of(catalogue.FIGURES[4], {}) == []  # of a report on other cases
    fragment = table.html_fragment(table.extremes_table(2), pages)
    assert fragment.count('<a href="cases/minor-axis-') == 3
