"""The first line of a page, and the table of what is known of the motion."""
from __future__ import annotations

from ....orbit.result import Fate
from ...terminal.motion import names
from ...text import frame
from ...text.headline import greatest, rate_and_height, rate_margin, with_height
from ...text.headline import headline as answer
from ...units import but_for_rounding
from .measures import DIGITS, spoken, told, vector


def headline(case, motion, equilibria, measures) -> str:
    """The answer in one line, in the words and letters of a page; of a case without a motion what its equilibria are."""
    if motion is None:
        return f"No motion is given. Equilibria: {equilibria.kind if equilibria else 'not known'}"
    return spoken(answer(case, motion, measures.units))


def period(motion, measures) -> str:
    """The period of a motion that repeats."""
    return "" if motion.period is None else measures.time(motion.period)


def law(motion, measures) -> str:
    """What is to be said before the verdict where an approximate law does not hold along the motion."""
    return "" if motion is None or motion.validity is None or motion.validity.held else measures.reason(motion.validity.words)


def css(fate: str) -> str:
    """The class by which a page colours a fate or a verdict."""
    return {"stable": "bounded", "asymptotically stable": "bounded", "unstable": "spin-up"}.get(fate, fate)


def largest(motion, measures) -> str:
    """The largest rate and its axis, where it has an end."""
    return "" if motion.fate == Fate.EQUILIBRIUM else spoken(greatest(motion, measures.units))


def margin(motion, measures) -> str:
    """The distance from the separatrix, with that in energy in parentheses."""
    return spoken(with_height(*rate_and_height(motion, measures.units)))


def rows(case, motion, measures) -> list[tuple[str, str]]:
    """(what, its value) of everything known of the motion, in the order in which one asks."""
    found = [] if motion.validity is None or not motion.validity.held else [("law", measures.reason(motion.validity.words))]
    found += [("start", f"{_rates(motion.at[:3], measures)} at {'t' if measures.physical else 'τ'} = 0")]
    found += [("vertical at t = 0", vector(motion.at[3:]))] if len(motion.at) > 3 else []
    found += [("because", measures.reason(motion.because.removeprefix("undecided: ")))]
    if motion.margin_energy is not None:
        found.append(("margin in energy", f"{measures.energy(motion.margin_energy)} below the barrier ahead"
                      if motion.margin_energy >= 0 else f"{measures.energy(-motion.margin_energy)} above the barrier ahead"))
    if motion.margin_velocity is not None:
        found.append(("margin in rate", _distance(motion, measures)))
    elif motion.velocity_because:
        found.append(("margin in rate", measures.reason(motion.velocity_because)))
    if motion.period is not None:
        found.append(("period", period(motion, measures)))
    axes = frame.rows_of_axes(case)
    found += [("frame", spoken(frame.lines(case)[0].removeprefix("frame: "))), *((f"axis {name}", spoken(words)) for name, words in axes)] if axes else []
    seen = {name: value for name, value in motion.evidence.items() if value is not None and (name, value) != ("steps", 0)}  # a law needed no run
    return found + [_evidence(name, value, measures) for name, value in seen.items()]


def _rates(values, measures):
    unit, one = measures.rate_unit
    return f"{vector([v * one for v in values])} {unit}".rstrip()


def _distance(motion, measures):
    if motion.velocity_because and motion.velocity_bounds:
        return f"{spoken(rate_margin(motion, measures.units, DIGITS))}: {measures.reason(motion.velocity_because)}"
    return f"{measures.rate(motion.margin_velocity)}: the smallest change of the rates that reaches the separatrix"


EVIDENCE = {  # key of what a run showed -> (words, what it is)
    "span": ("followed for", "time"), "size_start": ("|ω| at the start", "rate"), "size_end": ("|ω| at the end", "rate"),
    "size_largest": ("largest |ω| seen", "rate"), "energy_start": ("energy at the start", "energy"), "energy_end": ("energy at the end", "energy"),
    "energy_change": ("change of energy", "energy"), "t_certificate": ("certificate holds from", "moment"),
    "followed_until": ("followed until", "moment"), "release_time": ("last reversal of the turn", "moment"),
    "release_estimate": ("barrier gone by about", "moment"), "rate_end": ("rates at the end", "rates"), "energy_trend": ("the energy", ""),
    "certificate": ("how it is certified", ""), "steps": ("steps of the run", ""), "invariant_drift": ("exact laws kept to", ""),
    "steps_followed": ("steps of the certified run", ""), "small_change_grew": ("a small change grew by a factor of", "")}
CERTIFIED = {"well": "the barrier ahead outgrows the energy", "spin-up": "the turn can reverse no more", "bound": "a bound of the rate that grows for ever",
             "axis": "a pure spin about the torque", "law": "an exact law of the motion", "none": "not at all"}
TRENDS = {"rises": "higher in the last quarter of the run than ever in the first", "falls": "lower in the last quarter of the run than ever in the first",
          "oscillates": "up and down: the last quarter of the run overlaps with the first"}


def _evidence(name, value, measures):
    words, kind = EVIDENCE.get(name, (name.replace("_", " "), ""))
    words = words if measures.physical else words.replace("ω", "x")
    if name == "release_time" and value == 0:
        return words, "none after the start"
    if name == "certificate":
        return words, CERTIFIED.get(value, value)
    if name == "energy_trend":
        return words, TRENDS[value]
    if kind == "rates":
        return words, _rates(value, measures)
    if kind:
        return words, getattr(measures, kind)(value)
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        return words, vector(value, 6) if all(isinstance(v, float) for v in value) else ", ".join(map(str, value))
    return words, told(value, digits=3) if isinstance(value, float) else str(value)


def extremes(case, motion, measures) -> list[dict]:
    """A row a component: least and greatest rate, and the bounds for all times where these are others."""
    if motion.extremes is None:
        return []
    unit, one = measures.rate_unit
    bounds = motion.bounds if motion.bounds is not None and motion.bounds != motion.extremes else [None] * 3
    return [{"name": spoken(name), "least": told(low * one, unit), "greatest": told(high * one, unit),
             "within": "" if pair is None else f"{told(pair[0] * one, unit)} to {told(pair[1] * one, unit)}"}
            for name, (low, high), pair in zip(case.scene.components, but_for_rounding(motion.extremes, motion.tolerance), bounds)]


def invariants(motion, measures) -> list[tuple[str, str]]:
    """(name, value with its unit where it is known what it is) of the constants of this motion."""
    known = {"energy": measures.energy, "rate_bound": measures.rate, "late_rate_bound": measures.rate,
             "Q": lambda v: told(v * measures.units.squares[1], measures.units.squares[0].replace("^2", "²")),
             "momentum": lambda v: measures.units.momentum(v, DIGITS), "J": lambda v: told(v, "(N m s)²" * measures.physical),
             "J_rate": lambda v: told(v, "(N m s)²/s" if measures.physical else "per unit of τ")}
    words = names(motion)
    return [(words.get(name, name.replace("_", " ")), known.get(name, lambda v: told(v, digits=6))(value)) for name, value in motion.invariants.items()]
