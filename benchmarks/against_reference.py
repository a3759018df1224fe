"""How integrators fare against references with guaranteed digits: the table of docs/reference.md.

`python -m benchmarks.against_reference` writes it anew. The errors are those of this machine's roundings:
other processors differ in the last one.
"""
from __future__ import annotations

from fractions import Fraction
from pathlib import Path

from stabilab.answers.simulate import trajectory
from stabilab.answers.tabulated import tabulated
from stabilab.case.read import load
from stabilab.numbers.balls import working
from stabilab.papers.validation.quantities import rk4, run

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "reference.md"
CASES = {"minor-axis-100": "15", "torque-free-gyrostat": "200", "off-axis-two": "30"}
TIMES = 20  # states that are compared, equally spaced
RUNS = (("RK4, step 0.1", None, None), ("RK4, step 0.01", None, None), ("DOP853, rtol 1e-6", "DOP853", 1e-6),
        ("DOP853, rtol 1e-10", "DOP853", 1e-10),
        ("DOP853, rtol 1e-13", "DOP853", 1e-13), ("heyoka, its default", "taylor", None))
MARKS = "<!-- table -->\n", "<!-- end of table -->"


def errors(name: str) -> list[float]:
    """The largest error of each run on a case, over the largest rate of the reference."""
    case, end = load(ROOT / "cases" / f"{name}.toml"), Fraction(CASES[name])
    times = [end * k / TIMES for k in range(1, TIMES + 1)]
    made = tabulated(case.scene, case.start, case.exact_state, times, 30, events=False)
    with working(160):
        exact = [[(float(v), float((v - float(v)).mid())) for v in row] for row in made.states]
    largest = max(abs(v) for row in exact for v, _ in row)
    found = []
    for words, method, rtol in RUNS:
        rows = (trajectory(case.scene, case.state, [float(t) for t in times], method, rtol).states if method
                else _fixed(case, times, words.split()[-1]))
        found.append(max(abs((float(a) - v) - rest) for row, right in zip(rows, exact) for a,
                         (v, rest) in zip(row, right)) / largest)
    return found


def _fixed(case, times, step):
    """States of the classical rule of order four with a fixed step that divides the times."""
    rates, state, rows, before = case.scene.quadratic().rate, list(map(float, case.state)), [], Fraction(0)
    for t in times:
        count = (t - before) / Fraction(step)
        # where the step does not divide, the nearest smaller one
        whole = -(-count.numerator // count.denominator)
        state, before = run(rates, state, float((t - before) / whole), whole, rk4), t
        rows.append(state)
    return rows


def table() -> str:
    """The table in Markdown."""
    columns = [errors(name) for name in CASES]
    head = ["| integrator | " + " | ".join(f"{name}, to {end}" for name, end in CASES.items()) + " |",
            "|---" * (len(CASES) + 1) + "|"]
    return ("\n".join(head + ["| " + " | ".join([words, *(f"{column[n]:.1e}" for column in columns)]) + " |"
                              for n, (words, *_) in enumerate(RUNS)]) + "\n")


def main() -> None:
    """Write the table into docs/reference.md, between its two marks."""
    text = PAGE.read_text(encoding="utf-8")
    head, rest = text.split(MARKS[0], 1)
    PAGE.write_text(f"{head}{MARKS[0]}\n{table()}\n{MARKS[1]}{rest.split(MARKS[1], 1)[1]}", encoding="utf-8")


if __name__ == "__main__":
    main()
