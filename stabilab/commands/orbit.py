"""`stabilab orbit`: the equilibria of a satellite on a circular orbit."""
from __future__ import annotations

from ..answers.circular_orbit.ask import circular_orbit
from ..case.read import blamed_on, load_orbiting
from ..errors import InputError
from ..numbers.units import MOMENTUM, in_si
from ..show.files import endings
from ..show.maps import orbit_picture
from ..show.text import circular_orbit as shown
from .common.cases import units_asked
from .common.output import either, hold_laws, leave_undecided, say_written


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
        drawn = [orbit_picture.write(craft, found, out, system)] if out else []
    either(json, lambda: shown.as_dict(craft, found), lambda: shown.text(craft, found, system))
    say_written(drawn)
    every = (*found.equilibria.points, *found.equilibria.families)
    leave_undecided(strict, any(one.verdict == "undecided" for one in every))
    hold_laws(strict, (), [craft])
