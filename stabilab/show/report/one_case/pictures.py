"""The pictures of one motion on its page: the plots that a user can ask for, of each kind that the case has.
"""
from __future__ import annotations

from pathlib import Path

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
              "black curves, where there are any, "
                             "part motions of different kinds."),
    "potential": ("Reduced potential",
                  "The motion stays where its energy is above the potential; a barrier holds it."),
    "sphere": ("The surface on which the motion stays", "With the other motions on it."),
    "equilibria": ("All equilibria", "Stable and unstable ones in the space of the rates."),
    "state": ("Analytic models beside the exact motion",
              "Each part of the state over time; stabilab compare tells when a model is off by 1 % "
              "and 10 %.")}
OF_THE_FILE = "The rates along the axes of the file, about which its limits are."
BRIEF = ("time", "phase", "state")  # on a page among many


def pictures(one, folder: Path, stem: str, deep: bool, units: str = "deg") -> list[dict]:
    """Draw every plot of a subject (`plot.subject`) that a page shows; file, size in pixels, title and
    caption of each, in order. deep: all kinds, not only those of the motion itself."""
    found = []
    for kind in which.offered(one):
        if kind in (SHOWN if deep else BRIEF):
            title, caption = SHOWN[kind]
            if kind == "time" and file_axes(one) is not None:
                caption = OF_THE_FILE
            if kind == "time":
                caption += _later(one)
            narrow = None if found or kind != "time" else folder / f"{stem}-{kind}-narrow.png"
            made, *more = to_file.write_all(one, folder / f"{stem}-{kind}.png", kind, units=units,
                                            narrow=narrow)
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
