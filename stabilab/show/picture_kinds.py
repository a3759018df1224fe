"""The kinds of picture of a case: a row each, with what draws it and where it stands on a page. Nothing is
loaded here, so that the command line can name them."""
from __future__ import annotations

from typing import NamedTuple


class Page(NamedTuple):
    """On the page of a case. place: "answer" (what would change it), "motion" or "equilibria", the part below
    which it stands; brief: also on a page among many; titled: the picture keeps its own title, which no
    heading says; size: inches, where these are not the usual ones."""

    title: str
    caption: str
    place: str = "motion"
    brief: bool = False
    titled: bool = False
    size: tuple[float, float] | None = None


class Picture(NamedTuple):
    """shows: in words; draws: "module.function" of `show.plot`, which takes a `Subject`, units and size and
    gives axes, or a list of figures; needs: what a case must have, a key of `NEEDS` in `plot/subject.py`;
    page: None where the page has none."""

    shows: str
    draws: str
    needs: str = "motion"
    page: Page | None = None


SMALL = (6.0, 3.8)
KINDS = {
    "time": Picture(
        "the rates over time, with limits, extremes and period", "over_time.time", "range",
        Page("Rates over time", "The rates along the principal axes.", brief=True)),
    "phase": Picture(
        "the plane of the reduced motion: turn about the torque's axis and its rate", "phase_plane.phase",
        "plane",
        Page("Phase plane",
             "Turn about one axis since the start, and the rate about it. A motion stays on its curve; black "
             "curves, where there are any, part motions of different kinds.", brief=True)),
    "potential": Picture(
        "the reduced potential: its wells, the energy of the motion and the barrier ahead",
        "phase_plane.potential", "plane",
        Page("Reduced potential",
             "The motion stays where its energy is above the potential; a barrier holds it.")),
    "sphere": Picture(
        "the surface on which the motion stays, with the other motions on it", "surfaces.sphere", "surface",
        Page("The surface on which the motion stays", "With the other motions on it.", titled=True)),
    "space": Picture("the motion in the space of rates, beside the separatrix", "in_space.space", "range"),
    "section": Picture(
        "the Poincaré section: passages of a plane, with neighbours and the periodic motion in the middle of "
        "an island; of a motion that repeats, the closed orbits of its island out to the separatrix",
        "phase_plane.section", "section"),
    "equilibria": Picture(
        "all equilibria, stable and unstable", "equilibria.equilibria", "equilibria",
        Page("All equilibria", "Stable and unstable ones in the space of the rates.", "equilibria",
             titled=True)),
    "budget": Picture("what accuracy costs in time", "path.whole", "span"),
    "state": Picture(
        "every part of the state over time, the analytic models beside the exact motion", "over_time.states",
        "theory",
        Page("Analytic models beside the exact motion", "Each part of the state over time; stabilab compare "
             "tells when a model is off by 1 % and 10 %.", brief=True, titled=True)),
    "nutation": Picture(
        "the angle of a body axis to the angular momentum over time, with its bounds and its end; of a top "
        "its lean", "nutation.nutation", "nutation",
        Page("Nutation over time", "The angle of a body axis to the angular momentum.")),
    "attitude": Picture("the body as it turns, as an animation", "turning.film", "body that turns"),
    "tilt": Picture(
        "the time to the limit against the tilt of the torque", "over_time.tilt", "tilt",
        Page("Time to the limit against the tilt",
             "From the earliest to the latest of runs at directions round the edge of each cone.", "answer",
             size=SMALL)),
    "wheel": Picture(
        "how much later the limit is reached with another momentum of a wheel", "over_time.wheel", "wheel",
        Page("Time gained by another momentum of a wheel", "The other wheels left as they are.", "answer",
             size=SMALL)),
    "histogram": Picture(
        "how often draws of the uncertain numbers reach the limit after which time, or their largest rates",
        "histogram.histogram", "draws",
        Page("Draws of the uncertain numbers", "Each bar: how many draws; the percentiles stand below, under "
             "uncertain numbers.", "answer", size=SMALL)),
    "body": Picture(
        "the body as the box of its moments, with thrusters, wheels and what else acts on it", "body.body",
        "body",
        Page("The body and what acts on it", "Directions are those of the case, lengths of arrows are not.",
             "answer", size=(5.2, 5.2))),
}
