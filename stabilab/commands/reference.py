"""`stabilab reference`: a motion with guaranteed digits, for others to test against."""
from __future__ import annotations

import sys
from functools import partial

from ..case.read import blamed_on
from ..show.outside import reference as shown
from ..show.text import answers
from .common.cases import exact_times_asked, load_cases
from .common.output import all_reached, write, write_each


def reference(case, at, digits, out, json):
    """Write the states of a case, of every combination where it has a [sweep]."""
    loaded, made = load_cases([case], motion=True), []
    if out:
        shown.checked(out)
    for one in loaded:
        with blamed_on(one):
            made.append((one, *shown.as_dict(one, exact_times_asked(one, at), digits, sys.argv[1:])))
    if out:
        write_each(out, [(one, partial(shown.write, found)) for one, found, _ in made])
    else:
        write(answers.as_json([found for _, found, _ in made] if len(made) > 1 else made[0][1]) if json
              else "".join(shown.csv(found) for _, found, _ in made).rstrip("\n"))
    all_reached(short for one in made for short in shown.missing(*one))
