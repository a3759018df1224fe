"""`make mutate`: how many small faults, written into the analysis one at a time, do the tests see?

python -m tests.mutate [--sample N] [--seed S] [--json FILE] [--only LINES] [SUBJECT...]; subjects are those
of `SUBJECTS`. The faults are those of cosmic-ray's operators (annotations and arguments' defaults of None
left alone), N drawn at random per subject; nothing is written into the tree. Each fault lives in a child
process that imports the package afresh. Slow independent answers (`ORACLES`, which share no code with the
package) are computed once and remembered.
"""
import argparse
import json
import sys
import time

from tests.mutate import faults, runs

# subject -> (modules, test files that belong to it)
SUBJECTS = {
    "equilibria": (("equilibrium/gyrostat", "equilibrium/result", "equilibrium/stability"),
                   ("equilibrium/test_gyrostat", "equilibrium/test_stability", "equilibrium/test_curve",
                    "answers/test_certificate", "equilibrium/test_curve_text")),
    "stability": (("equilibrium/stability",),
                  ("equilibrium/test_stability", "equilibrium/test_gyrostat", "answers/test_certificate",
                   "equilibrium/test_curve_text")),
    "reduction": (("orbit/reduction",),
                  ("orbit/test_against_the_potential", "orbit/fate/test_fate", "answers/test_certificate",
                   "orbit/test_reduction")),
    "fate": (("orbit/fate_arrays", "orbit/barriers_arrays", "orbit/landscape"),
             ("orbit/test_against_the_potential", "orbit/fate/test_fate", "orbit/fate/test_parabola",
              "orbit/fate/test_rounding_bounds", "orbit/fate/test_arrays")),
    "extremes": (("orbit/extremes_arrays", "numbers/polynomial"),
                 ("orbit/test_against_the_potential", "orbit/extremes/test_extremes", "numbers/test_roots",
                  "orbit/fine/test_rows", "orbit/extremes/test_arrays")),
    "quadrature": (("orbit/profile", "orbit/spin_up"),
                   ("orbit/extremes/test_extremes", "orbit/flow/test_flow")),
    "kernels": (("orbit/arc_kernel", "orbit/equilibria_kernel", "orbit/rows_kernel", "orbit/turns_kernel"),
                ("orbit/test_against_the_potential", "orbit/test_batches_of_random_scenes",
                 "orbit/fine/test_rows", "orbit/fine/test_nearly_equal_moments")),
    "separatrix": (("orbit/separatrix/branches", "orbit/separatrix/homoclinic",
                    "orbit/separatrix/homoclinic_arrays", "orbit/separatrix/saddles"),
                   ("orbit/separatrix/test_branches", "orbit/separatrix/test_grid")),
    "growth": (("unreduced/growth", "unreduced/growth_certificate"),
               ("unreduced/growth/test_law", "unreduced/growth/test_certificates")),
    "balls": (("orbit/one_orbit", "orbit/fate", "orbit/extremes"),
              ("orbit/test_against_the_potential", "orbit/fate/test_fate", "orbit/extremes/test_arrays",
               "orbit/fate/test_tie", "orbit/test_ball_orbit"))}


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="python -m tests.mutate", description=__doc__.splitlines()[0])
    parser.add_argument("subjects", nargs="*", metavar="SUBJECT", help=", ".join(SUBJECTS))
    parser.add_argument("--sample", type=int, default=60, help="faults drawn per subject (0: all)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--slowest", type=float, default=1.0,
                        help="tests that take longer (s) are left out: the score is a lower bound")
    parser.add_argument("--json", help="write every fault and what became of it")
    parser.add_argument("--again", help="a file of --json: the faults that survived there once more")
    asked = parser.parse_args(arguments)
    rows = []
    for subject in asked.subjects or SUBJECTS:
        modules, files = SUBJECTS[subject]
        if asked.again:
            with open(asked.again, encoding="utf-8") as file:
                before = json.load(file)
            left = [r for r in before if r["subject"] == subject and r["outcome"] == "survived"]
            chosen = faults.again(left)
        else:
            chosen = faults.drawn(modules, asked.sample, asked.seed)
        rows += judged(subject, chosen, files, asked.slowest)
        if asked.json:
            with open(asked.json, "w", encoding="utf-8") as file:
                json.dump(rows, file, indent=1)
    return rows


def judged(subject, chosen, files, slowest):
    """A row per fault; the score goes to stdout."""
    start, rows = time.time(), []
    tests = runs.Tests(files, slowest)
    print(
        f"{subject}: {len(chosen)} faults, {len(tests.names)} tests in {tests.seconds:.0f} s of "
        f"processor time", flush=True)
    for fault in chosen:
        outcome, by = tests.outcome(fault)
        rows.append({"subject": subject, "module": fault.module, "operator": fault.operator,
                     "occurrence": fault.occurrence,
                     "line": fault.line, "was": fault.was, "now": fault.now, "outcome": outcome, "by": by})
        if outcome == "survived":
            print(f"  survived {fault.module}:{fault.line}\n    - {fault.was}\n    + {fault.now}", flush=True)
    killed = sum(r["outcome"] != "survived" for r in rows)
    alone = sum(files[-1] in r["by"] for r in rows)
    print(f"{subject}: {alone} seen by {files[-1]} alone")
    print(f"{subject}: {killed} of {len(rows)} seen ({killed / max(len(rows), 1):.1%}), "
          f"{time.time() - start:.0f} s",
          flush=True)
    return rows


if __name__ == "__main__":
    sys.exit(not main())
