"""Commands about thrusters, limits, dissipation and orbits.

`stabilab stuck`: what a thruster stuck open does, how soon, and what helps; `burn`: what thrusters that
fire on a schedule leave, and by when they must close.

`stabilab when`: the first time at which a motion reaches a limit.

`stabilab flat-spin`: what internal dissipation makes of a spin.

`stabilab orbit`: the equilibria of a satellite on a circular orbit."""
from __future__ import annotations

from dataclasses import replace
from functools import partial

from ..answers.circular_orbit import circular_orbit
from ..answers.dissipation.flat_spin import flat_spin as ask_flat_spin
from ..answers.stuck.ask import each_firing
from ..answers.stuck.ask import stuck as ask
from ..answers.stuck.burn import burn as left_by
from ..answers.stuck.burn import time_of_burn
from ..answers.when import limited_time
from ..case.limit_options import OPTIONS, stated_limit
from ..case.read import fires_on_schedule, load_burning, load_orbiting
from ..errors import InputError
from ..maps.percentiles import of_burn_drawn
from ..numbers.units import ANGLE, MOMENTUM, RATE, TIME, in_si
from ..show.maps import bifurcation_picture
from ..show.progress import told
from ..show.text import headline, questions
from ..show.text import stuck as shown
from ..show.text.flat_spin import any_dict, any_text
from ..show.text.motion import circular_orbit_dict, circular_orbit_text
from .common import drawn, expected, load_cases
from .runner import View, every, run


def _drawn(case, result, units, path):
    from ..show.plot.over_time import write_stuck
    return write_stuck(case, result, units, path)


STUCK = View(text=shown.text, data=shown.as_dict, csv=shown.CSV, swept=shown.swept, parts=True, drawn=_drawn,
             open=lambda result: any(row.fate == "undecided" for row in result.rows))
BURN = View(text=shown.burn_text, data=shown.burn_dict, open=shown.burn_undecided)
WHEN = View(text=questions.text, data=questions.as_dict, csv=questions.CSV, swept=questions.swept,
            between="\n", axes=True, packed=every,
            law=lambda case, limit, result: headline.until(case, result.validity, float(result.high)),
            open=lambda limit, result: questions.unknown(result) or questions.varies(result))
FLAT_SPIN = View(text=any_text, data=any_dict,
                 open=lambda result: getattr(result, "outcome", "") == "undecided")
ORBIT = View(text=circular_orbit_text, data=circular_orbit_dict,
             open=lambda result: any(item.verdict == "undecided"
                                    for item in (*result.equilibria.points, *result.equilibria.families)),
             drawn=lambda case, out, units, path: bifurcation_picture.write_orbit(case, out, path, units))


def stuck(case, all_thrusters, units, why, out, json, csv, strict, samples=None, seed=1, workers=None):
    """Answer a case, every combination where it has a [sweep]."""
    loaded = load_cases([case], motion=True)
    loaded = list(map(each_firing, loaded)) if all_thrusters else loaded
    view = replace(STUCK, swept=None) if all_thrusters or why else STUCK

    def asked(item):
        with told() as tell:
            return ask(item, all_thrusters, tell, workers=workers)
    run(view, loaded, asked, units=units, out=out, json=json, csv=csv, strict=strict,
        drawn=drawn(samples, seed, workers, lambda item: item.limits is not None, True, each=all_thrusters))


def burn(case, stop, below, units, json, strict, samples=None, seed=1, workers=None):
    """Answer one case."""
    burning = load_burning(case)
    query = {name: in_si(text.strip(), dimension, f"--{name}")
             for name, text, dimension in (("stop", stop, TIME), ("below", below, RATE)) if text is not None}
    draws = None if samples is None else lambda craft: of_burn_drawn(
        burning, samples, seed, workers, craft.limits is not None, True, stop, below)
    run(BURN, [burning.craft], lambda craft: left_by(burning, **query), units=units, json=json, strict=strict,
        drawn=draws, below=below)


def when(cases, units, json, csv, strict, digits, samples=None, seed=1, workers=None, **limits):
    """Answer every case. limits: what is to be reached and by when, by the names of the options."""
    paths = list(map(str, cases))
    burns = {path: load_burning(path) for path in paths if fires_on_schedule(path)}
    loaded = [*(item.craft for item in burns.values()),
              *load_cases([path for path in paths if path not in burns], motion=True)]
    loaded.sort(key=lambda case: paths.index(case.path))

    declared = {case.place: stated_limit(case, **limits) for case in loaded}

    def asked(case):
        limit = declared[case.place]
        if case.path not in burns:
            return limit, limited_time(case, limit.ask, limit.until, digits, partial(expected, case))
        if digits is not None:
            raise InputError(f"{case.path}: digits: a burn is followed in time: leave them out")
        return limit, time_of_burn(burns[case.path], limit.ask, limit.until)
    ordinary = drawn(samples, seed, workers, lambda item: True, False, **limits)
    draws = ordinary and (lambda case: ordinary(case) if case.path not in burns else of_burn_drawn(
        burns[case.path], samples, seed, workers, True, False, **limits))
    run(WHEN, loaded, asked, units=units, json=json, csv=csv, strict=strict, drawn=draws,
        **{name: limits[name] for name in OPTIONS if name != "energy"})


def flat_spin(case, within, momentum, units, json, strict):
    """Answer a case, every combination where it has a [sweep]."""
    angle = in_si(within.strip(), ANGLE, "--within")
    size = None if momentum is None else in_si(momentum.strip(), MOMENTUM, "--momentum")
    if size is not None and size < 0:
        raise InputError('--momentum: expected a size of at least 0, such as "100 N m s", got '
                         f"{momentum!r:.40}")
    run(FLAT_SPIN, load_cases([case], motion=size is None),
        lambda item: ask_flat_spin(item, angle, momentum=size), units=units, json=json, strict=strict,
        within=within)


def orbit(case, up_to, out, units, json, strict):
    """Answer one case."""
    if out and up_to is None:
        raise InputError("--out: equilibria are drawn over the momentum of the wheels: say up to which, such "
                         'as --up-to "2 N m s"')
    orbiting = load_orbiting(case)
    largest = None if up_to is None else in_si(up_to.strip(), MOMENTUM, "--up-to")
    run(ORBIT, [orbiting.craft], lambda craft: circular_orbit(orbiting, largest), units=units, out=out,
        json=json, strict=strict)
