"""Commands about thrusters, limits, dissipation and orbits.

`stabilab stuck`: what a thruster stuck open does, how soon, and what helps; `burn`: what thrusters that
fire on a schedule leave, and by when they must close.

`stabilab when`: the first time at which a motion reaches a limit.

`stabilab flat-spin`: what internal dissipation makes of a spin.

`stabilab orbit`: the equilibria of a satellite on a circular orbit."""
from __future__ import annotations

from dataclasses import replace
from functools import partial

from ..answers.caveats import caveats_of
from ..answers.circular_orbit import circular_orbit
from ..answers.dissipation.flat_spin import flat_spin as ask_flat_spin
from ..answers.stuck.ask import each_firing
from ..answers.stuck.ask import stuck as ask
from ..answers.stuck.burn import burn as left_by
from ..answers.stuck.burn import time_of_burn
from ..answers.when import limited_time
from ..case.limit_options import stated_limit
from ..case.read import blamed_on, fires_on_schedule, load_burning, load_orbiting
from ..errors import InputError
from ..numbers.units import ANGLE, MOMENTUM, RATE, TIME, in_si
from ..show import endings
from ..show.data import as_json
from ..show.maps import bifurcation_picture
from ..show.progress import told
from ..show.text import headline, questions
from ..show.text import stuck as shown
from ..show.text.flat_spin import flat_spin_dict, flat_spin_text
from ..show.text.motion import circular_orbit_dict, circular_orbit_text
from .common import answers_of, load_cases, one_by_one, tell_all, units_asked
from .writing import (
    either,
    hold_laws,
    leave_undecided,
    say_written,
    write,
    write_json,
    written,
)


def stuck(case, all_thrusters, units, why, out, json, csv, strict):
    """Answer a case, every combination where it has a [sweep]."""
    loaded = load_cases([case], motion=True)
    loaded = list(map(each_firing, loaded)) if all_thrusters else loaded
    systems = units_asked(loaded, units)
    if out:
        endings.file(out, endings.PICTURES)
    with told() as tell:
        answered = answers_of(loaded, lambda one: ask(one, all_thrusters, tell))
    drawn = written(out, [(one, partial(_drawn, one, found, system))
                          for (one, found), system in zip(answered, systems)])
    if json:
        write_json(loaded, [shown.as_dict(*one) for one in answered])
    elif csv:
        write(shown.csv(answered))
    else:
        tell_all(answered, systems, shown.text, None if all_thrusters or why else shown.swept)
    say_written(drawn)
    leave_undecided(strict, any(row.fate == "undecided" for _, found in answered for row in found.rows))
    hold_laws(strict, (), loaded)


def _drawn(case, found, units, path):
    from ..show.plot.over_time import write_stuck
    return write_stuck(case, found, units, path)


def burn(case, stop, below, units, json, strict):
    """Answer one case."""
    burning = load_burning(case)
    craft = burning.craft
    system = units_asked([craft], units, below=below)[0]
    asked = {name: in_si(text.strip(), dimension, f"--{name}")
             for name, text, dimension in (("stop", stop, TIME), ("below", below, RATE)) if text is not None}
    with blamed_on(craft):
        found = left_by(burning, **asked)
    either(json, lambda: shown.burn_dict(craft, found), lambda: shown.burn_text(craft, found, system))
    open_ = found.latest is not None and found.latest.level == "undecided"
    leave_undecided(strict, open_ or found.closed.motion.fate.word == "undecided")


def when(cases, units, json, csv, strict, **limits):
    """Answer every case. limits: what is to be reached and by when, by the names of the options."""
    paths, answered = list(map(str, cases)), []
    burns = {path: load_burning(path) for path in paths if fires_on_schedule(path)}
    loaded = [*(one.craft for one in burns.values()),
              *load_cases([path for path in paths if path not in burns], motion=True)]
    loaded.sort(key=lambda case: paths.index(case.path))
    systems = units_asked(loaded, units, **{name: limits[name] for name in ("rate", "component", "tilt")})
    for case in one_by_one(loaded):
        limit = stated_limit(case, **limits)
        with blamed_on(case):
            found = (time_of_burn(burns[case.path], limit.ask, limit.until) if case.path in burns
                     else limited_time(case, limit.ask, limit.until))
            answered.append((case, limit, found))
    laws = [headline.until(case, found.validity, float(found.high)) for case, _, found in answered]
    answered = [(case, limit, replace(found, caveats=(*found.caveats,
                                                      *caveats_of(case.scene, validity=held))))
                for (case, limit, found), held in zip(answered, laws)]
    if json:
        write(as_json([questions.as_dict(*one) | headline.key(held) for one, held in zip(answered, laws)]))
    elif csv:
        write(questions.csv(answered))
    else:
        tell_all(answered, systems, questions.text, questions.swept, laws, between="\n")
    leave_undecided(strict, any(questions.unknown(found) or questions.varies(found)
                                for *_, found in answered))
    hold_laws(strict, laws, loaded)


def flat_spin(case, within, units, json, strict):
    """Answer a case, every combination where it has a [sweep]."""
    loaded = load_cases([case], motion=True)
    systems = units_asked(loaded, units, within=within)
    angle = in_si(within.strip(), ANGLE, "--within")
    answered = answers_of(loaded, lambda one: ask_flat_spin(one, angle))
    if json:
        write_json(loaded, [flat_spin_dict(*one) for one in answered])
    else:
        tell_all(answered, systems, flat_spin_text)
    leave_undecided(strict, any(found.outcome == "undecided" for _, found in answered))
    hold_laws(strict, (), loaded)


def orbit(case, up_to, out, units, json, strict):
    """Answer one case."""
    if out and up_to is None:
        raise InputError("--out: equilibria are drawn over the momentum of the wheels: say up to which, such "
                         'as --up-to "2 N m s"')
    if out:
        endings.file(out, endings.PICTURES)
    orbiting = load_orbiting(case)
    craft = orbiting.craft
    system = units_asked([craft], units)[0]
    most = None if up_to is None else in_si(up_to.strip(), MOMENTUM, "--up-to")
    with blamed_on(craft):
        found = circular_orbit(orbiting, most)
        drawn = [bifurcation_picture.write_orbit(craft, found, out, system)] if out else []
    either(json, lambda: circular_orbit_dict(craft, found),
           lambda: circular_orbit_text(craft, found, system))
    say_written(drawn)
    every = (*found.equilibria.points, *found.equilibria.families)
    leave_undecided(strict, any(one.verdict == "undecided" for one in every))
    hold_laws(strict, (), [craft])
