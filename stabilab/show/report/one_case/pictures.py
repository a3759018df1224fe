"""The pictures of one motion on its page: the plots that a user can ask for, of each kind it has."""
from __future__ import annotations

from pathlib import Path

from ....theories.follow import models_of
from ...plot import subject as which
from ...plot import to_file
from ...plot.over_time import file_axes
from ...terminal.letters import printed
from ...units import units_of
from ..html import picture

# kind -> (title, caption)
SHOWN = {
    "time": ("Rates over time", "The rates along the principal axes."),
    "phase": ("Phase plane",
              "Turn about one axis since the start, and the rate about it. A motion stays on its curve; "
              "black curves, where there are any, part motions of different kinds."),
    "potential": ("Reduced potential",
                  "The motion stays where its energy is above the potential; a barrier holds it."),
    "sphere": ("The surface on which the motion stays", "With the other motions on it."),
    "equilibria": ("All equilibria", "Stable and unstable ones in the space of the rates."),
    "state": ("Analytic models beside the exact motion",
              "Each part of the state over time; stabilab compare tells when a model is off by 1 % "
              "and 10 %."),
    "tilt": ("Time to the limit against the tilt",
             "From the earliest to the latest of runs at directions round the edge of each cone."),
    "wheel": ("Time gained by another momentum of a wheel", "The other wheels left as they are."),
    "body": ("The body and what acts on it", "Directions are those of the case, lengths of arrows are not.")}
TITLED = ("sphere", "equilibria", "state")  # by what no heading of the page says
SIZES = {"tilt": (6.0, 3.8), "wheel": (6.0, 3.8), "body": (5.2, 5.2)}  # inches, of the smaller ones
ALONE = ("Every part of the state over time", "No approximate theory comes with these effects.")
OF_THE_FILE = "The rates along the axes of the file, about which its limits are."
BRIEF = ("time", "phase", "state")  # on a page among many


def pictures(one, folder: Path, stem: str, deep: bool, units: str = "deg", at_rest=None) -> list[dict]:
    """Draw every plot of a subject (`plot.subject`) that a page shows; file, size in pixels, title and
    caption of each, in order. deep: all kinds, not only those of the motion itself. at_rest: its
    equilibria."""
    found, offered = [], [kind for kind in SHOWN if not which.why_not(kind, one)]
    # what another part of the page has: table and space the single points, the plane what is wrapped round a
    # surface
    case, bodily = one.case, which.bodily(one)
    # a sketch of the body shows more than its moments: effects, or axes that the file has not
    acted_on = (bodily and bodily.effects) or case.thrusters or case.frame and not case.frame.as_given
    spared = {"equilibria": at_rest is not None and not at_rest.curves, "body": not acted_on,
              "sphere": "phase" in offered and not which.free(one), "state": which.rates_alone(one)}
    exact_alone = models_of(one.scene) == ("exact",)
    for kind, (title, caption) in SHOWN.items():
        if kind in offered and (deep or kind in BRIEF) and not spared.get(kind):
            if kind == "state" and exact_alone:
                title, caption = ALONE
            if kind == "time" and file_axes(one) is not None:
                caption = OF_THE_FILE
            if kind == "time":
                caption += _later(one)
            narrow = None if found or kind != "time" else folder / f"{stem}-{kind}-narrow.png"
            made, *more = to_file.write_all(one, folder / f"{stem}-{kind}.png", kind, SIZES.get(kind),
                                            units=units, narrow=narrow, titled=kind in TITLED)
            found.append(picture(made, "", narrow, caption=caption, kind=kind, title=title,
                                 more=[path.name for path in more],
                                 command=f"stabilab plot {one.path} --kind {kind}"))
    return found


def _later(one) -> str:
    """What a picture that ends before a spin-up begins has to say."""
    release = one.motion.evidence.get("release_time")
    if release is None or one.case is None or release <= max(one.seen):
        return ""
    units = units_of(one.case)
    told = printed(units.moment(release) if units.scaled else units.time(release))
    return f" The spin-up begins later: the turn reverses for the last time at {told}."
