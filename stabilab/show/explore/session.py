"""One session of the explorer: what a page asks of a case, and what it is answered: the verdict of the
changed case, and everything that the page draws.

An answer for a moving slider is brief (no search for the nearest point of the separatrix, no run of a motion
off the axes, a coarser surface); one for a resting slider is whole. All of it does without NumPy (then the
surfaces are coarser, and no motion is followed off the axes), so that it also runs in a browser.
"""
from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import groupby
from typing import Any

from ...answers.equilibria import equilibria
from ...answers.kinds import KINDS, kind_of
from ...answers.motion import motion, with_ending
from ...case.read import Case
from ...case.write import data_of
from ...equilibrium.result import Equilibria
from ...errors import StabilabError
from ...orbit.result import Fate, Motion, Needs
from ...orbit.separatrix.saddles import REACH
from ...packages import explained, present
from ...physics.coefficients import content, gyrostat_scene
from ...physics.effects import effect_class
from ...physics.scene import AnyScene, QuadraticForm, ScaledGyrostat, Scene
from ...representation import values_of
from ...validation import reach_of
from ...verify import verify
from ...verify.form import about, parsed
from ...verify.form import line as about_line
from ...verify.numbers import Malformed
from .. import frame, limiting
from ..assumed import assumed
from ..axes import with_moments
from ..report.tables import tiles
from ..space import drawing
from ..space.box import box_of
from ..space.reach import PLACES, branches_of, curves_of
from ..space.span import natural, seen
from ..terminal import capital, lettered, written
from ..text.classification import called
from ..text.headline import headline, judged, look, two_lines
from ..text.motion import margins
from ..turns import band
from ..turns.moment import moment
from ..units import SHORT, Units, but_for_rounding, units_of
from . import parameters, pictures
from .parameters import changed
from .pictures import Bag, line

# --- The tables beside the pictures: what is known of the motion, and the equilibria
MAX_ROWS = 12  # rows of equilibria


def rows(case: Case, motion: Motion, units: Units) -> list[list[str]]:
    """[words, value] of what is known of the motion."""
    when, until = next(rest for name, *rest in tiles(motion, units) if name == "when")
    result = [*([["limit", f"{when}: {until}"]] if motion.first else []),
             ["start", units.vector(motion.at[:3], units.rates)],
             *([name, text] for name, text in margins(motion, units))]
    if motion.extremes is not None and not any(map(math.isnan, sum(map(list, motion.extremes), []))):
        for component, pair in zip(case.scene.components,
                                   but_for_rounding(motion.extremes, motion.tolerance)):
            result.append([component.replace("omega", "ω"), _range(*pair, units, motion.extremes_side)])
    return [*result, ["why", units.said(motion.reason)]]


def _range(low: float, high: float, units: Units, side: int) -> str:
    """Least and greatest rate. side: 1 of bounds, which are rounded outward."""
    smallest, greatest = units.rate(low, side=-side), units.rate(high, side=side)
    if math.isinf(low) or math.isinf(high):
        return ("without end both ways" if low == -high else f"from {smallest} up, without end"
                if math.isinf(high) else f"from {greatest} down, without end")
    return f"{smallest} to {greatest}"


def equilibrium_rows(result: Equilibria, units: Units) -> dict[str, Any]:
    """{reason, rows of (where, verdict)}: of a curve a state on each of its pieces, as `classify` has it."""
    printed = [[units.vector(point.at[:3], units.rates), point.verdict] for point in result.points]
    for curve in result.curves:
        for verdict, samples in groupby(curve.samples, lambda sample: sample.verdict):
            slowest = min(samples, key=lambda sample: max(map(abs, sample.at[:3])))
            name = called(curve.description.name, units)
            printed.append([f"{name}, such as {units.vector(slowest.at[:3], units.rates)}", verdict])
    more = len(printed) - MAX_ROWS
    return {"reason": units.said(result.reason),
            "rows": printed[:MAX_ROWS] + ([[f"and {more} more", ""]] if more > 0 else [])}


PLAIN = (18, 17)  # rows of a branch, and columns of half of it, while a slider moves
# of a piece of a curve of equilibria: to find what is in the box, and to draw it
POINTS = {True: (16, 40), False: PLACES}
TURNS = {True: 240.0, False: 2400.0}  # rad of turn at most that are drawn
FOLLOWED = "the torque is off the principal axes: keep still, and the motion is followed"
WORKED_OUT = "keep still, and this motion is worked out"
NO_ARRAYS = "this motion has to be followed, which needs NumPy, and that is not here"
SWEPT = (
    "The file has a [sweep]: the page is about the numbers in its body; stabilab fate and report answer "
    "every combination.")
QUICK = 2_000_000  # multiplications for the proof of a time at a limit: some tenths of a second
FILM = 20_000.0  # rad of turn at most, of which a film is followed
SLOW_SECONDS = 0.12  # s: a motion whose kind took longer the last time waits until the slider rests


class Stopped(Exception):
    """A newer question has come: nobody waits for this answer any more."""


class Session:
    """One case on one page. What only depends on the scene is kept for the next answer."""

    def __init__(self, case: Case) -> None:
        pictures.check(case)
        self.case, self.units = case, units_of(case)
        self._swept = SWEPT if "sweep" in data_of(case.text) else ""
        self._kept: dict[str, tuple[Any, Any]] = {}
        self._cost: dict[str, float] = {}  # s that the last motion of a kind took

    def about(self) -> dict[str, Any]:
        """What a page must know before its first question."""
        return {"name": self.case.name, "title": written(self.case.heading),
                "groups": parameters.groups(self.case, self.units),
                "axes": _named(self.units), "rates": self.units.rates[0], "scaled": self.units.scaled}

    def answer(self, asked: dict[str, Any], stopped: Callable[[], bool] = lambda: False) -> bytes:
        """The answer to a request as a framed message (`bag`). asked: as of `changed`, with moving (whether a
        hand still moves), box (that of the last answer, or None) and click (turn and rate of a point of the
        phase plane to start from, or None). stopped: asked on the way; Stopped is raised once it holds. What
        cannot be answered is reported under "error"."""
        bag = Bag()
        try:
            return bag.framed(self._answer(asked, bag, stopped))
        except StabilabError as error:
            return Bag().framed({"error": str(error)})
        except ImportError as error:
            if (text := explained(error)) is None:
                raise
            return Bag().framed({"error": str(text)})

    def _answer(self, request, bag, stopped):
        began = time.process_time()
        moving, clicked = bool(request.get("moving")), None
        case, note = changed(self.case, request, self.units)
        units = self.units
        if isinstance(case.scene, Scene):  # names of the axes by moments whose order the sliders may change
            units = replace(units, axes=with_moments(units.axes, case.scene.body.exact))
        if request.get("click"):
            clicked = pictures.clicked(self._twin(case), case.state, request["click"], self.units)
            case, note = changed(self.case, request | {"start": clicked, "click": None}, self.units)
        result, text = self._motion(case, moving, stopped)
        lines, runs = (text, ""), None
        if result is not None:
            result = judged(case, result, brief=True)
            if not moving and present("numpy"):
                result = with_ending(case, result)
            followed = result.fate is not Fate.BOUNDED or not result.for_all_time  # to the limit assumed
            if not moving and present("numpy") and (case.limits is not None or followed):
                from ...answers.when import time_of_case, with_first
                runs = lambda rate, until: time_of_case(case, {"rate": rate}, until, 0)
                result = result if case.limits is None else with_first(case, result, QUICK)
            text, lines = headline(case, result, units), two_lines(case, result, units)
        settled = time.process_time()
        twin = self._twin(case)
        at_rest = self._at_rest(case, twin, moving)
        form = None if twin is None else twin.quadratic()
        supposed = self._once("assumed", (case.scene, case.state, case.limits, moving), lambda: assumed(
            case, case.scene, case.state, result, runs,
            max(case.span or (0.0, natural(case.scene, case.state)))))
        until, cut = _length(case, result, form, moving, supposed and supposed.time)
        times, path = self._once("line", (case.scene, case.state, until, moving),
                                 lambda: line(case, form, until, moving))
        full = times, path
        if result is not None and result.ending is not None and result.ending.until is not None:
            end = seen(case.span, result, until)[1]  # past it, though its turns are too many for the space
            full = self._once("whole", (case.scene, case.state, end), lambda: pictures.path(case, end))
        long = self._turns(case, result, times, path, until, moving, supposed)
        cut = "" if long is not None and long[2] else cut
        picture = self._space(bag, case, twin, result, at_rest, times, path, request.get("box"), moving,
                              supposed, long)
        about_axes = frame.components(self.case, units.axes)  # of the file, where they are others
        shown = full[0][-1] if math.hypot(*case.state) * full[0][-1] <= FILM else times[-1]
        turns = not self.units.scaled and present("numpy") and (case.scene.plain or not moving)
        holds = None if result is None else result.validity  # of an approximate law
        notes = [note, self._swept, cut, holds and units.said(holds.reason),
                 *limiting.beside((case if result is None else result).caveats, units, text)]
        built = {"headline": text, "first": lines[0], "small": lines[1],
                "fate": "undecided" if result is None else result.fate.word,
                "look": "conditional" if result is None else look(result),
                "moving": moving, "start": clicked,
                "note": " ".join(map(capital, filter(None, notes))),
                "toml": case.text, "axes": _named(units), "space": picture,
                "rows": [*([["axes", lettered(about_axes)]] if about_axes else []),
                         *([] if result is None else rows(case, result, units)),
                         *([["limit", supposed.words(units)]] if supposed else [])],
                "plane": None if twin is None else pictures.drawn_planes(bag, twin, case.state, units),
                "time": pictures.over_time(bag, case, result, *full, units, supposed),
                "film": pictures.film(case, result, shown, bag, units, supposed) if turns else None}
        built["equilibria"] = equilibrium_rows(at_rest, units) if at_rest else pictures.NOT_YET
        return built | {"analysis": 1e3 * (settled - began), "work": 1e3 * (time.process_time() - began)}

    def _motion(self, case: Case, moving: bool, stopped: Callable[[], Any]) -> tuple[Motion | None, str]:
        """(what is known of the motion, the verdict in a line); None where a run would keep a moving hand
        waiting, or NumPy is needed and not here."""
        kind = kind_of(self._twin(case) or case.scene)
        runs = KINDS[kind].follows
        if moving and (runs or self._cost.get(kind, 0.0) > SLOW_SECONDS):
            return None, f"UNDECIDED so far: {FOLLOWED if runs else WORKED_OUT}" if present(
                "numpy") else f"UNDECIDED: {NO_ARRAYS}"

        def tell(*_):
            if stopped():
                raise Stopped
        began = time.process_time()
        try:
            result = motion(case.scene, case.start, needs=Needs.QUICK if moving else Needs.ALL,
                           exact=case.exact_state, tell=tell if runs else None)
        except ModuleNotFoundError as error:
            if error.name != "numpy":
                raise
            return None, f"UNDECIDED: {NO_ARRAYS}"
        self._cost[kind] = time.process_time() - began
        return result, ""

    def _twin(self, case: Case) -> AnyScene | None:
        """The scene of wheel and torque alone with the same rates; None where there is none."""
        return (None if pictures.needed(case.scene) else case.scene if case.scene.plain
                else gyrostat_scene(content(case.scene)))

    def _at_rest(self, case: Case, twin: AnyScene | None, moving: bool) -> Equilibria | None:
        """The equilibria; None where they wait until the slider rests, or are not known."""
        if twin is not None:
            return self._once("equilibria", twin, lambda: equilibria(twin))
        slow = self._cost.get("equilibria", math.inf) > SLOW_SECONDS
        if moving and slow and self._kept.get("equilibria", (None,))[0] != case.scene:
            return None
        began = time.process_time()
        result = self._once("equilibria", case.scene, lambda: pictures.at_rest(case.scene))
        self._cost["equilibria"] = max(self._cost.get("equilibria", 0.0), time.process_time() - began)
        return result

    def _turns(self, case, result, times, path, until, moving, supposed):
        """(what is drawn of a motion of many turns, the places from which that is made, whether of all of it:
        once the slider rests); None of one of few."""
        reached = supposed and supposed.time
        path = drawing.near_part(times, path, result, reached)
        times = times[:len(path)]
        key = case.scene, case.state, until, moving, result is None
        if result is not None and not moving and present("numpy") and band.often(path) > band.MANY:
            long = self._once("turns", key, lambda: pictures.turns_of(
                case, result, seen(case.span, result, until, reached)[1], self.units))
            return None if long is None else (*long, True)
        long = self._once("turns", key, lambda: band.along(
            times, path, self.units.times(times[-1]), result and moment(result, reached)))
        return None if long is None else (long, path, False)

    def _space(self, bag, case, twin, result, at_rest, times, path, request, moving, supposed, long):
        nearby = (drawing.near_part(times, path, result, supposed and supposed.time) if long is None
                  else long[1])
        bare, ghost = (None, False) if twin is None else _without_tilt(twin)
        marks = drawing.marks_of(case.state, result, at_rest)
        limit = drawing.limit_of(case, supposed)
        rests = [*drawing.beside_limit(limit, nearby), *([] if moving else drawing.nearest(at_rest, nearby))]
        box = box_of(nearby, marks + rests, reaching=True, asked=request, kept=moving or ghost)
        branches, text = (), pictures.why(case.scene)
        if bare is not None:  # as far as the box reaches
            reach = self._kept.get("reach", (None, REACH))[1]
            branches, text, far = self._once("branches", (bare, box, moving), lambda: branches_of(
                bare, box, plain=PLAIN if moving else None, reach=reach))
            self._kept["reach"], text = (None, far), capital(text)
        names = [component.replace("omega", "ω") for component in case.scene.components]
        known = self._once("places", (case.scene, at_rest is None), dict)
        curves = self._once("curves", (case.scene, box, moving, at_rest is None),
                            lambda: curves_of(at_rest, box, *POINTS[moving], known))
        drawn = drawing.space(names, self.units.rates, box, branches, nearby, marks, curves, text,
                      " without the tilt" * ghost, limit, long and long[0])
        if ghost:
            text = ("No separatrix is known for a torque off the axes"
                     + (": the surface drawn is that of the torque without its tilt" if drawn.branches
                        else ""))
        return drawing.data(drawn, partial(bag.add, "int16")) | {
            "words": text, "box": {"middle": box.middle, "half": box.half}}

    def _once(self, name: str, key: Any, make: Callable[[], Any]) -> Any:
        """What `make` gave for this key the last time, or gives now."""
        retained = self._kept.get(name)
        if retained is None or retained[0] != key:
            retained = self._kept[name] = (key, make())
        return retained[1]


def _named(units: Units) -> list[str]:
    return [units.axes.short(n) for n in (1, 2, 3)]


def _length(case: Case, result: Motion | None, form: QuadraticForm | None, moving: bool,
            reached: float | None) -> tuple[float, str]:
    """(how far a motion is drawn, what is said where that is less than every other view shows): so many
    radians of turn at most. form: its rates, where they are quadratic; reached: as of `seen`."""
    rate, torque = math.hypot(*case.state), math.hypot(*form.coefficients[3]) if form is not None else 0.0
    radian = 1.0 / max(rate, math.sqrt(torque)) if rate or torque else 1.0
    largest, alone = TURNS[moving] * radian, natural(case.scene, case.state)
    span = case.span or (0.0, alone) if result is None else seen(case.span, result, alone, reached)
    wanted = abs(reach_of(span))
    if wanted <= largest or moving:
        return min(wanted, largest), ""
    units = units_of(case)
    where = " in the space of the rates" if result is not None and result.ending is not None else ""
    return largest, f"Its first {units.time(largest, SHORT)} of {units.time(wanted, SHORT)} are drawn{where}."


def _without_tilt(scene: AnyScene) -> tuple[AnyScene, bool]:
    """The scene with the largest component of its torque alone, and whether that is another one."""
    torque = scene.exact_mu if scene.variables == "scaled" else scene.vector("constant_torque")
    acting = [n for n in range(3) if torque[n]]
    if len(acting) < 2:
        return scene, False
    main = max(acting, key=lambda n: abs(torque[n]))
    retained = tuple(v if n == main else 0 for n, v in enumerate(torque))
    if scene.variables == "scaled":
        return ScaledGyrostat(*scene.exact_ab, retained), True
    others = [effect for effect in scene.effects if effect.name != "constant_torque"]
    return Scene(scene.body, *others, effect_class("constant_torque")(retained)), True


def checked(request: dict[str, Any]) -> bytes:
    """The findings on the certificate asked["text"], as a framed message: status, about, a row a claim."""
    text = request.get("text")
    try:
        claims = parsed(text.encode() if isinstance(text, str) else b"")
        result = verify(claims)
    except (Malformed, UnicodeError) as error:
        return Bag().framed({"error": f"This is no certificate of stabilab classify --certify: {error}"})
    silent = f"; nothing is claimed of: {', '.join(result.silent)}" if result.silent else ""
    return Bag().framed({"status": result.status, "about": about_line(about(claims)) + silent,
                         "findings": [values_of(item, "claim status reason") for item in result.findings]})
