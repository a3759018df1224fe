"""`stabilab sweep`: one case at every point of ranges of its numbers. No other map or picture is loaded."""
from __future__ import annotations

from ..maps.plan import planned, split_keys
from ..maps.run import run
from ..show.maps import sweep as sweep_shown
from .writing import of_map


def sweep(case, vary, samples, seed, answer, follow, out, workers, scheduler, csv, json, strict, **limits):
    """Answer the case at every point. limits: those of the answer when, by the names of their options."""
    plan = planned(case, split_keys(vary or []), samples, seed, answer, follow, **limits)
    if out:
        sweep_shown.checked(out)
    with run(plan, out, workers, scheduler, in_file=True) as result:
        files = [sweep_shown.write(sweep_shown.dataset(result), out)] if out else []
    of_map(sweep_shown, result, plan.case, files, json, csv, strict)
