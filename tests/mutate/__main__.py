"""`make mutate`: how many small faults, written into the analysis one at a time, do the tests see?

python -m tests.mutate [--sample N] [--seed S] [--json FILE] [--only LINES] [SUBJECT...]; subjects are those of `SUBJECTS`.
The faults are those of cosmic-ray's operators (annotations and arguments' defaults of None left alone), N drawn at random
per subject; nothing is written into the tree. Each fault lives in a child process that imports the package afresh. Slow
independent answers (`ORACLES`, which share no code with the package) are computed once and remembered.
"""
import argparse
import json
import sys
import time

from tests.mutate import faults, runs

# subject -> (modules, test files that belong to it)
SUBJECTS = {
    "equilibria": (("equilibria", "isolated_equilibria", "equilibrium_conics", "equilibrium_curve",
                     "torque_free_equilibria", "pencil"),
                   ("test_equilibria", "test_stability", "test_certificate", "test_small_faults", "test_curve_words")),
    "stability": (("stability", "eigenvalues"),
                  ("test_stability", "test_equilibria", "test_certificate", "test_curve_words", "test_small_faults")),
    "reduction": (("reduction",), ("test_fate", "test_one_state", "test_extremes", "test_certificate", "test_small_faults")),
    "fate": (("fate", "landscape", "table_fate"), ("test_fate", "test_one_state", "test_fate_speed", "test_error_bounds",
                                                   "test_fate_faults", "test_small_faults")),
    "extremes": (("extremes", "turning", "rootfind"), ("test_extremes", "test_rootfind", "test_one_state",
                                                         "test_extremes_speed", "test_extremes_bounds",
                                                         "test_extremes_faults", "test_small_faults")),
    "quadrature": (("quadrature", "repeating_motion", "spin_up_motion"),
                   ("test_extremes", "test_late_times", "test_one_state", "test_quadrature_faults")),
    "barriers": (("barrier_heights", "barrier_table"), ("test_fate_speed", "test_fate_faults", "test_small_faults")),
    "separatrix": (("separatrix", "loop", "loops", "saddle_branches"),
                   ("test_separatrix", "test_separatrix_accuracy", "test_separatrix_fast")),
    "captured": (("captured", "captured_form"), ("test_captured", "test_captured_faults")),
    "precise": (("precise", "precise_extremes", "precise_period", "exact_tie", "one_state"),
                ("test_fate", "test_extremes", "test_hunted", "test_one_state", "test_exact_tie", "test_precise_faults",
                 "test_small_faults"))}


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
    print(f"{subject}: {len(chosen)} faults, {len(tests.names)} tests in {tests.seconds:.0f} s of processor time", flush=True)
    for fault in chosen:
        outcome, by = tests.outcome(fault)
        rows.append({"subject": subject, "module": fault.module, "operator": fault.operator, "occurrence": fault.occurrence,
                     "line": fault.line, "was": fault.was, "now": fault.now, "outcome": outcome, "by": by})
        if outcome == "survived":
            print(f"  survived {fault.module}:{fault.line}\n    - {fault.was}\n    + {fault.now}", flush=True)
    killed = sum(r["outcome"] != "survived" for r in rows)
    alone = sum(files[-1] in r["by"] for r in rows)
    print(f"{subject}: {alone} seen by {files[-1]} alone")
    print(f"{subject}: {killed} of {len(rows)} seen ({killed / max(len(rows), 1):.1%}), {time.time() - start:.0f} s",
          flush=True)
    return rows


if __name__ == "__main__":
    sys.exit(not main())
