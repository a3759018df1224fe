"""The table of hard cases: errors of naive formulas, of the program, and what half a unit in the last place
of the inputs does.

python -m tests.hard_table writes docs/hard-cases.md. Each case is a function of `tests.hard`: the naive
formula, the program's answer and an exact one side by side. Exact values: the potential in 60 and more
digits, Taylor series, equations typed in by hand and extrapolated, matrix exponentials and zeta functions in
ball arithmetic, rational arithmetic.
"""
from __future__ import annotations

import math
from functools import lru_cache
from pathlib import Path

from tests.hard import bodies, burns, charged, circles, damped, late, liquid, off_axis, orbit, sectors, top
from tests.hard.row import Row, Verdict

PAGE = Path(__file__).parents[1] / "docs" / "hard-cases.md"
ALLOWED = 32  # times the condition: some thirty operations, each as good as rounding its operands

# (what it is about, case, numbers of the default suite, numbers of the slow one)
CASES = [
    ("separatrix", circles.next_to_a_separatrix, [], [1e-15, 3e-16, 0.0]),
    ("separatrix", circles.margin_by_a_separatrix, [1e-14], [1e-15]),
    ("separatrix", circles.period_by_a_separatrix, [], [1e-9, 1e-12]),
    ("large circle", circles.on_a_large_circle, [], [1e3, 1e6, 1e8]),
    ("large circle", circles.margin_on_a_large_circle, [1e8], [3e7]),
    ("fold", circles.well_before_its_fold, [1e-4], [1e-2]),
    ("parameters", circles.huge_gyrostat, [1e6], [1e9]),
    ("parameters", bodies.tiny_torque, [], [1e-12, -1e-12]),
    ("parameters", bodies.slow_rates, [], [1e-12]),
    ("parameters", bodies.a_near_b, [1e-6, 1e-9], []),
    ("invariant planes", sectors.off_the_plane, [1e-30], [1e-100, 1e-300]),
    ("symmetric", bodies.nearly_symmetric, [], [1e-12, 1e-9, 2.0 ** -52]),
    ("symmetric", bodies.rod, [], [1e-6, 1e-9]),
    ("symmetric", bodies.symmetric, ["D1 = D2", "sphere"], []),
    ("conic", bodies.far_along_the_hyperbola, [2.0 ** -40], []),
    ("conic", bodies.two_lines, [0, 1, 2], []),
    ("start", sectors.exact_saddle, [1.3], [0.7, -1.3]),
    ("start", sectors.on_the_plane, [-2.0], [0.125, 1.0]),
    ("late", late.swings, [], [1e6]),
    ("late", late.stepped, [], [100]),
    ("late", late.spins_up, [], [3545.0]),
    ("late", late.released, [], [1e-3]),
    ("off axis", off_axis.verdict, [1e-9, 1e-14], []),
    ("off axis", off_axis.growth_rate, [1e-9, 1e-14], []),
    ("off axis", off_axis.far_away, [1e-8], []),
    ("cancellation", circles.far_from_the_origin, [1e8], [2.0 ** 40]),
    ("cancellation", circles.circle_of_no_radius, [0.0, 1e-170], []),
    ("cancellation", circles.minute_orbit, [], [1e-8, 1e-17]),
    ("cancellation", sectors.above_the_cusp, [1.76, 1.75477], []),
    ("cancellation", sectors.separatrix_above_the_cusp, [1.755], []),
    ("small divisors", charged.zero_frequency, [1e-9, 0.0], []),
    ("small divisors", charged.slow_spin, [0.0, 1e-6], []),
    ("small divisors", charged.resonance_plus, [1e-9, 0.0], []),
    ("small divisors", charged.resonance_minus, [1e-9, 0.0], []),
    ("small divisors", charged.unstable_band, [1e-8], []),
    ("small divisors", charged.late, [1e9], [1e6]),
    ("liquid", liquid.slow_damping, [1e-6, 1e-12], []),
    ("liquid", liquid.slow_growth, [1e-14], []),
    ("liquid", liquid.nearly_degenerate, [1e-9], []),
    ("liquid", liquid.amplitude_zero, [], [0.005]),
    ("liquid", liquid.printed_torque, [], [3.0]),
    ("liquid", liquid.stiff, [], [3000.0]),
    ("top", top.resonance_nearby, [1e-6, 1e-9], []),
    ("top", top.exact_resonance, ["240"], []),
    ("top", top.tilted, [], [(0.8, 0.0, 0.6), (1.0, 0.0, 0.0)]),
    ("top", top.upright, [], [1e-7]),
    ("orbit", orbit.wheel_by_a_pitchfork, [1e-12], []),
    ("orbit", orbit.wheel_beyond_a_pitchfork, [1e-14, 1e-20], []),
    ("orbit", orbit.nearly_equal_moments, [1e-14], []),
    ("burn", burns.closing, [0.5], [1.0]),
    ("damper", damped.nearly_free, [1e-12], [1e-6]),
    ("damper", damped.sphere_in_a_fluid, [1e-14], [1e-20]),
    ("damper", damped.in_a_field, [1e-14], [1e-20]),
]
ROWS = [(about, case, number, slow) for about, case, quick, long in CASES
        for slow, some in ((False, quick), (True, long)) for number in some]


@lru_cache
def row_of(n) -> Row | Verdict:
    _, case, number, _ = ROWS[n]
    return case(number)


def rows() -> list[Row | Verdict]:
    return [row_of(n) for n in range(len(ROWS))]


def size(error) -> str:
    """One digit, and what is rounding is called so: the same on every machine."""
    return "no answer" if not math.isfinite(error) else "< 1e-15" if error < 1e-15 else f"{error:.0e}"


def line(row) -> str:
    last = (row.naive, row.ours,
            row.exact) if isinstance(row, Verdict) else map(size, (row.naive, row.ours, row.condition))
    return f"| {' | '.join([row.case, row.asked, row.goes_wrong, *last])} |"


def page(found) -> str:
    """The table in Markdown: answers that are numbers first, then those that are words."""
    head = ["# Hard cases", "",
            "Formulas that are right on paper lose their digits near a separatrix, where two moments are "
            "nearly equal, and",
            "where numbers of very different sizes meet. This page lists such cases, with the answer of a "
            "plain program and",
            "that of stabilab.", "",
            "The errors are relative, and are measured against results with at least 25 digits by methods "
            "that share no code",
            "with the program. *Condition* is the change of the answer when every input changes by half a "
            "unit in its last",
            "place, and the answer is rounded; the error of the program stays below "
            f"{ALLOWED} times that. As inputs are exact",
            "numbers, a naive error below the condition is an error all the same; that of the program is "
            "mostly far below it.",
            "The averaged liquid is compared with a run at a tolerance of 1e-12, and its condition is the "
            "size of the terms",
            "beyond the second order, eps^(3/2). `python -m tests.hard_table` writes this page. Each line is "
            "a test, which",
            "also checks that the naive formula fails.", ""]
    tables = [(Row, "## Answers in numbers", "naive error | error of stabilab | condition"),
              (Verdict, "## Answers in words", "naive code | stabilab | right answer")]
    for kind, title, columns in tables:
        head += [title, "", f"| hard case | asked for | what goes wrong in naive code | {columns} |",
                 "|---" * 6 + "|"]
        head += [line(row) for row in found if isinstance(row, kind)] + [""]
    return "\n".join(head)


if __name__ == "__main__":
    PAGE.write_text(page(rows()), encoding="utf-8")
    print(PAGE.read_text(encoding="utf-8"))
