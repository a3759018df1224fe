"""`stabilab simulate` and `reference`: a motion in time, by the equations or by a theory, and with guaranteed
digits for others to test against."""
from __future__ import annotations

import sys
from functools import partial

from ..answers.caveats import answered
from ..answers.digits_asked import DEFAULT
from ..answers.digits_run import best_reached, missed
from ..answers.simulate import Simulation, axis_of_nutation, in_matrices, with_nutation, with_quaternion
from ..answers.stuck.chain import simulate_burn
from ..case.read import Case, blamed_on, fires_on_schedule, load_burning
from ..errors import InputError
from ..show import endings, terminal
from ..show.data import as_json
from ..show.terminal import say
from ..show.text import headline, simulation
from ..show.text import reference as shown
from ..show.text.aem import epoch_of
from ..theories.euler_angles import with_euler_angles
from ..theories.follow import MODELS, follow
from ..theories.theory import theory
from .common import exact_times_asked, load_cases, one_by_one, say_repeated, times_asked, units_asked
from .runner import View, collected, judge, show
from .writing import all_reached, write, write_each


def simulate(case, at, model, order, method, rtol, digits, angles, attitude, matrix, out, json, strict,
             units, epoch=None, nutation=None):
    """Follow the motion of a case, of every combination where it has a [sweep]."""
    ephemeris = bool(out) and endings.ending(out) == ".aem"
    if epoch and not ephemeris:
        raise InputError("--epoch is the date of time 0 in an attitude ephemeris: give it with --out "
                         "FILE.aem")
    if ephemeris and matrix:
        raise InputError("--matrix: an attitude ephemeris has quaternions: leave it away with --out FILE.aem")
    moment, attitude = epoch_of(epoch) if ephemeris else None, attitude or ephemeris
    burning = load_burning(case) if fires_on_schedule(case) else None
    if burning is not None and (model != "exact" or angles or not method is rtol is order is digits is None):
        raise InputError(f"{case}: its thrusters fire on a schedule, so that it is followed from switch to "
                         "switch: give it without --model, --order, --method, --rtol, --digits and --angles")
    loaded = [burning.craft] if burning else load_cases([case], motion=True)
    if attitude or matrix:
        if model != "exact" or angles or (attitude and matrix):
            raise InputError(
                f"--{'attitude' if attitude else 'matrix'}: the attitude is that of the exact motion, in one "
                f"form: give it without --model, --angles and --{'matrix' if attitude else 'attitude'}")
        loaded = [with_quaternion(entry) for entry in loaded]
    for item in loaded if nutation and model in MODELS else ():
        with blamed_on(item):
            axis_of_nutation(item, nutation, model)
    systems = units_asked(loaded, units)
    say_repeated(loaded[0], at)
    if out:
        simulation.checked(out)
    if burning is not None:
        with blamed_on(loaded[0]):
            turning = "quaternion" if attitude or matrix else None
            runs = [(loaded[0], simulate_burn(burning, times_asked(loaded[0], at), turning), None)]
    else:
        runs = [(entry, *_followed(entry, times_asked(entry, at), model, method, rtol, order, digits))
                for entry in one_by_one(loaded)]
    if matrix:
        runs = [(entry, in_matrices(run), reached) for entry, run, reached in runs]
    for n, (item, run, reached) in enumerate(runs if angles else ()):
        with blamed_on(item):
            runs[n] = item, with_euler_angles(item, run, model, order), reached
    for n, (item, run, reached) in enumerate(runs if nutation else ()):
        with blamed_on(item):
            runs[n] = item, with_nutation(item, run, nutation), reached
    if out:
        write_each(out, [(entry, partial(simulation.write, entry, run, epoch=moment))
                         for entry, run, _ in runs])
    view = _view(digits)
    rows = collected(view, loaded, systems, [(answered(run, entry, run.validity), reached)
                                             for entry, run, reached in runs])
    if json or not out:
        show(view, rows, json)
    else:
        for line in headline.lines_of([(entry, run.validity) for entry, run, _ in runs]):
            say(line)
        for item, _, reached in runs:
            if reached and not reached.enough:
                say(f"{item.place}: checked to {reached.digits:.1f} digits: {reached.because}")
        for item, run, _ in runs:
            for name, error in simulation.lost_columns(run):
                say(f"{item.place}: {name}: {simulation.zero_within(error)} where it is smaller than that")
    judge(view, rows, strict)


def _view(digits):
    """How runs are printed of which so many digits were asked for, None where none were."""
    width = terminal.width()

    def text(case, run, reached, units):
        return _as_text(case, run, reached, digits, units, width)

    def short(run, reached):
        """Why a run stopped or digits were not reached, unasked where none was."""
        if run.status != "reached":
            return [run.reason]
        missing = reached and not reached.enough and (digits is not None or reached.digits < 1)
        return [missed(reached)] if missing else []
    return View(text=text, data=_as_dict, law=lambda case, run, reached: run.validity, axes=True, short=short)


def _followed(case, times, model, method, rtol, order, digits):
    """(the motion, what the check of its digits showed or None)."""
    chosen = model != "exact" or not (method is None and rtol is None and order is None)
    with blamed_on(case):
        if digits is None and chosen:
            return follow(case, times, model, method, rtol, order), None
        if chosen:
            raise InputError("--digits chooses method and tolerance of the exact motion itself: give it "
                             "without --model, --method, --rtol and --order")
        reached = best_reached(case, times, DEFAULT if digits is None else digits, aim=digits is None)
        return reached.run, reached


def _as_dict(case, run, reached) -> dict:
    printed = reached and {"asked": reached.asked, "reached": reached.digits, "because": reached.because,
                        "reason": reached.reason.as_dict()}
    return simulation.as_dict(case, run) | {"digits": printed, "theory": _theory(case, run)}


def _as_text(case, run, reached, digits, units, width) -> str:
    checked = "checked to " if digits is None else ""
    last = f"\n# {checked}{reached.digits:.1f} digits: {reached.because}" if reached else ""
    printed = "".join(f"\n# {line}" for line in simulation.theory_lines(_theory(case, run), units))
    # as many as the check vouches for, those asked for at least: exit code 5 says where they are not reached
    resolved = None if digits is None else max(digits, int(min(reached.digits, 99.0)))
    return simulation.text(case, run, units, resolved, width) + last + printed


def _theory(case: Case, run: Simulation) -> list:
    """What the theory of an analytic model says, as rows; nothing of an exact run."""
    return ([] if run.model == "exact"
            else theory(case, model=run.model, end=max(map(float, run.t), key=abs, default=None)))


def reference(case, at, digits, out, json):
    """Write the states of a case, of every combination where it has a [sweep]."""
    loaded, built = load_cases([case], motion=True), []
    say_repeated(loaded[0], at)
    if out:
        endings.file(out, shown.SUFFIXES)
    for item in loaded:
        with blamed_on(item):
            built.append((item, *shown.as_dict(item, exact_times_asked(item, at), digits, sys.argv[1:])))
    if out:
        write_each(out, [(entry, partial(shown.write, result)) for entry, result, _ in built])
    else:
        write(as_json([result for _, result, _ in built] if len(built) > 1 else built[0][1]) if json
              else "".join(shown.csv(result) for _, result, _ in built).rstrip("\n"))
    all_reached(short for entry in built for short in shown.missing(*entry))
