"""`stabilab when`: the first time at which a motion reaches a limit."""
from __future__ import annotations

from dataclasses import replace

from ..answers.caveats import of_law
from ..answers.stuck.burn import time_of_burn
from ..answers.when import limited_time
from ..case.limit_options import stated_limit
from ..case.read import blamed_on, fires_on_schedule, load_burning
from ..show.data import as_json
from ..show.text import law
from ..show.text import when as shown
from .common.cases import load_cases, one_by_one, tell_all, units_asked
from .common.output import hold_laws, leave_undecided, write


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
    laws = [law.until(case, found.validity, float(found.high)) for case, _, found in answered]
    answered = [(case, limit, replace(found, caveats=(*found.caveats, *of_law(held))))
                for (case, limit, found), held in zip(answered, laws)]
    if json:
        write(as_json([shown.as_dict(*one) | law.key(held) for one, held in zip(answered, laws)]))
    elif csv:
        write(shown.csv(answered))
    else:
        tell_all(answered, systems, shown.text, shown.swept, laws, between="\n")
    leave_undecided(strict, any(shown.unknown(found) for *_, found in answered))
    hold_laws(strict, laws, loaded)
