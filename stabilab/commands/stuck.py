"""`stabilab stuck`: what a thruster stuck open does, how soon, and what helps; `burn`: what thrusters that
fire on a schedule leave, and by when they must close."""
from __future__ import annotations

from functools import partial

from ..answers.stuck.ask import stuck as ask
from ..answers.stuck.burn import burn as left_by
from ..case.read import blamed_on, load_burning
from ..numbers.units import RATE, TIME, in_si
from ..show.files import endings
from ..show.progress import told
from ..show.text import burn as burns
from ..show.text import stuck as shown
from .common.cases import answers_of, load_cases, tell_all, units_asked
from .common.output import either, hold_laws, leave_undecided, say_written, write, write_json, written


def stuck(case, all_thrusters, units, why, out, json, csv, strict):
    """Answer a case, every combination where it has a [sweep]."""
    loaded = load_cases([case], motion=True)
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
    either(json, lambda: burns.as_dict(craft, found), lambda: burns.text(craft, found, system))
    open_ = found.latest is not None and found.latest.level == "undecided"
    leave_undecided(strict, open_ or found.closed.motion.fate.word == "undecided")
