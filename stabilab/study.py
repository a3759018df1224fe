"""A case that answers: its questions as methods, each the public function of the same name. It stands above
all rooms, and loads a question when it is asked."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from .case import read
from .case.far import in_doubles

if TYPE_CHECKING:
    import os
    from pathlib import Path

    import matplotlib.axes
    from numpy.typing import ArrayLike

    from .answers.dissipation.flat_spin import FlatSpin
    from .answers.dissipation.gyrostat import GyrostatSpin
    from .answers.dissipation.rotations import Rotations
    from .answers.motions.angles import Angles
    from .answers.motions.result import Motions, Values
    from .answers.passage import TimeTo
    from .answers.simulate import Simulation
    from .answers.stuck.burn import Burned
    from .answers.stuck.margins import Stuck
    from .answers.turning.result import Attitude
    from .answers.when import Crossings
    from .case.given import Amount, Given, Span, Start, Starts
    from .equilibrium.result import Equilibria
    from .maps.percentiles import Percentiles
    from .orbit.result import Motion


P = ParamSpec("P")
T = TypeVar("T")


def _in_doubles(question: Callable[P, T]) -> Callable[P, T]:
    """The question, with an error that names the number by which it leaves the range of doubles."""
    @wraps(question)
    def ask(*supplied: P.args, **named: P.kwargs) -> T:
        case: Any = supplied[0]
        with in_doubles(case, f"{case.place}: "):
            return question(*supplied, **named)
    return ask


@dataclass(frozen=True, eq=False, repr=False)
class Case(read.Case):
    __doc__ = read.Case.__doc__

    @_in_doubles
    def fate(self, state: Start | None = None, *, states: Starts | None = None, span: Span | None = None,
             tilt: Amount | None = None, digits: int | None = None, follow: Amount | None = None,
             proof: bool = False, fast: bool | None = None, tell: Callable[..., Any] | None = None,
             frame: str = "principal") -> Motions:
        """What becomes of the motion: see `stabilab.fate`."""
        from .answers.fate import fate
        return fate(self, state, states=states, span=span, tilt=tilt, digits=digits, follow=follow,
                    proof=proof, fast=fast, tell=tell, frame=frame)

    @_in_doubles
    def motion(self, state: Start | None = None, span: Span | None = None, *, states: Starts | None = None,
               tilt: Amount | None = None, follow: Amount | None = None, proof: bool = False,
               tell: Callable[..., Any] | None = None,
               frame: str = "principal") -> Motion | list[Motion]:
        """All that is known of the motion: see `stabilab.motion`."""
        from .answers.motions.one import motion
        return motion(self, state, span, states=states, tilt=tilt, follow=follow, proof=proof, tell=tell,
                      frame=frame)

    @_in_doubles
    def extremes(self, state: Start | None = None, span: Span | None = None, *, states: Starts | None = None,
                 digits: int | None = None, follow: Amount | None = None, fast: bool | None = None,
                 frame: str = "principal") -> Values:
        """The least and greatest value of each component: see `stabilab.extremes`."""
        from .answers.fate import extremes
        return extremes(self, state, span, states=states, digits=digits, follow=follow, fast=fast,
                        frame=frame)

    @_in_doubles
    def period(self, state: Start | None = None, *, states: Starts | None = None, span: Span | None = None,
               digits: int | None = None, follow: Amount | None = None, fast: bool | None = None,
               frame: str = "principal") -> Values:
        """The period of the motion: see `stabilab.period`."""
        from .answers.fate import period
        return period(self, state, states=states, span=span, digits=digits, follow=follow, fast=fast,
                      frame=frame)

    @_in_doubles
    def equilibria(self) -> Equilibria:
        """Every equilibrium with its stability: see `stabilab.equilibria`."""
        from .answers.equilibria import equilibria
        return equilibria(self)

    @_in_doubles
    def attitude(self, state: Start | None = None, digits: int | None = None, *, span: Span | None = None,
                 frame: str = "principal") -> Attitude:
        """How the motion turns in space: see `stabilab.attitude`."""
        from .answers.attitude import attitude
        return attitude(self, state, digits, span=span, frame=frame)

    @_in_doubles
    def angles(self, state: Start | None = None, axes: Sequence[str] = "xyz", *, span: Span | None = None,
               frame: str = "principal") -> Angles:
        """How far body axes lean from the momentum and from their start: see `stabilab.angles`."""
        from .answers.motions.angles import angles
        return angles(self, state, axes, span=span, frame=frame)

    @_in_doubles
    def when(self, state: Start | None = None, rate: Amount | None = None,
             component: str | tuple[str, Amount] | None = None, energy: Amount | None = None,
             tilt: str | tuple[str, Amount] | None = None, until: Amount | None = None, events: Any = None, *,
             below: Amount | None = None, nutation: str | tuple[str, Amount] | None = None,
             nutation_below: str | tuple[str, Amount] | None = None, states: Starts | None = None,
             span: Span | None = None, digits: int | None = None,
             frame: str = "principal") -> TimeTo | Crossings:
        """When the motion first reaches a limit: see `stabilab.when`."""
        from .answers.when import when
        return when(self, state, rate, component, energy, tilt, until, events, below=below,
                    nutation=nutation, nutation_below=nutation_below, states=states, span=span,
                    digits=digits, frame=frame)

    @_in_doubles
    def stuck(self, all_thrusters: bool = False, progress: Callable[[str], Any] | None = None, *,
              state: Start | None = None, span: Span | None = None, tilt: Amount | None = None,
              frame: str = "principal", workers: int | None = None) -> Stuck:
        """What the stuck thrusters do, and what helps: see `stabilab.stuck`."""
        from .answers.stuck.ask import stuck
        return stuck(self, all_thrusters, progress, state=state, span=span, tilt=tilt, frame=frame,
                     workers=workers)

    @_in_doubles
    def percentiles(self, samples: int = 1000, seed: int = 1, *, rate: Amount | None = None,
                    component: str | None = None, energy: Amount | None = None, tilt: str | None = None,
                    until: Amount | None = None, below: Amount | None = None, nutation: str | None = None,
                    nutation_below: str | None = None, largest: bool = True, workers: int | None = None,
                    state: Start | None = None, span: Span | None = None) -> Percentiles:
        """Percentiles over the uncertain numbers: see `stabilab.percentiles`."""
        from .maps.percentiles import percentiles
        return percentiles(self, samples, seed, rate=rate, component=component, energy=energy, tilt=tilt,
                           until=until, below=below, nutation=nutation, nutation_below=nutation_below,
                           largest=largest, workers=workers, state=state, span=span)

    @_in_doubles
    def burn(self, stop: Amount | None = None, below: Amount | None = None) -> Burned:
        """What the stuck thrusters leave when they close, and by when they must: see `stabilab.burn`."""
        from .answers.stuck.burn import burn
        return burn(self, stop, below)

    @_in_doubles
    def flat_spin(self, within: Amount = "5 deg", *, momentum: Amount | None = None,
                  state: Start | None = None,
                  span: Span | None = None) -> FlatSpin | GyrostatSpin | Rotations:
        """Where it ends if something inside takes energy, or all rotations at a momentum: see
        `stabilab.flat_spin`."""
        from .answers.dissipation.flat_spin import flat_spin
        return flat_spin(self, within, momentum=momentum, state=state, span=span)

    def simulate(self, times: ArrayLike | None = None, state: Start | None = None, blocks: Any = None,
                 method: str | None = None, rtol: float | None = None, attitude: str | None = None, *,
                 omega: Start | None = None,
                 frame: str = "principal", nutation: str | None = None) -> Simulation:
        """The motion at the given times: see `stabilab.simulate`."""
        from .answers.simulate import simulate
        return simulate(self, state, times, blocks, method, rtol, attitude, omega=omega, frame=frame,
                        nutation=nutation)

    @property
    def plot(self) -> Plots:
        """`case.plot.time()`, and the other kinds of `stabilab.plot`."""
        return Plots(self)

    def report(self, out: str | os.PathLike[str] = "report", precision: bool = False, certify: bool = False,
               workers: int | None = None) -> Path:
        """Write the pages of a report into a folder: see `stabilab.report`."""
        from .papers.report import report
        return report(self, out, precision, certify, workers)


@dataclass(frozen=True)
class Burning(read.Burning):
    __doc__ = read.Burning.__doc__

    def burn(self, stop: Amount | None = None, below: Amount | None = None) -> Burned:
        """What the burn leaves, and by when it must close: see `stabilab.burn`."""
        from .answers.stuck.burn import burn
        return burn(self, stop, below)

    def percentiles(self, samples: int = 1000, seed: int = 1, *, rate: Amount | None = None,
                    component: str | None = None, energy: Amount | None = None, tilt: str | None = None,
                    until: Amount | None = None, below: Amount | None = None, nutation: str | None = None,
                    nutation_below: str | None = None, largest: bool = True, stop: Amount | None = None,
                    closing_below: Amount | None = None, workers: int | None = None) -> Percentiles:
        """Percentiles over the uncertain numbers: see `stabilab.percentiles`; stop: all thrusters close then;
        closing_below: rad/s, asks for the latest closing time that keeps |omega| below it for ever."""
        from .maps.percentiles import percentiles
        return percentiles(self, samples, seed, rate=rate, component=component, energy=energy, tilt=tilt,
                           until=until, below=below, nutation=nutation, nutation_below=nutation_below,
                           largest=largest, workers=workers, stop=stop, closing_below=closing_below)

    def simulate(self, times: ArrayLike | None = None, attitude: str | None = None,
                 nutation: str | None = None) -> Simulation:
        """The motion at the given times, over all switches: see `stabilab.simulate`; attitude, nutation: as
        there."""
        from .answers.simulate import axis_of_nutation, with_nutation
        from .answers.stuck.chain import simulate_burn
        from .case.given import time_in
        if nutation is not None:
            axis_of_nutation(self.craft, nutation)
        run = simulate_burn(self, time_in(self.craft.scene, times, "times"), attitude)
        return run if nutation is None else with_nutation(self.craft, run, nutation)

    def when(self, rate: Amount | None = None, component: str | tuple[str, Amount] | None = None,
             energy: Amount | None = None, tilt: str | tuple[str, Amount] | None = None,
             until: Amount | None = None, below: Amount | None = None,
             nutation: str | tuple[str, Amount] | None = None,
             nutation_below: str | tuple[str, Amount] | None = None) -> TimeTo:
        """When the motion first reaches a limit, over all switches: see `stabilab.when`."""
        from .answers.stuck.burn import time_of_burn
        from .answers.when import limit_stated
        limit = limit_stated(self.craft, rate, component, energy, tilt, until, below, nutation,
                             nutation_below)
        return time_of_burn(self, limit.ask, limit.until)


class Plots:
    """The kinds of `stabilab.plot`, each of this case."""

    def __init__(self, case: Case):
        self._case = case

    def __getattr__(self, kind: str) -> Callable[..., matplotlib.axes.Axes]:
        if kind not in self.__dir__():
            raise AttributeError(f"there is no plot {kind!r:.60}; there are {', '.join(self.__dir__())}")
        from .show import plot
        draw = getattr(plot, kind)
        return lambda *supplied, **named: draw(self._case, *supplied, **named)

    def __dir__(self) -> list[str]:
        from .show import plot
        return [kind for kind in plot.__all__ if kind != "basin"]  # of a map, not of a case


def of(case: read.Case) -> Case:
    """The case with its questions."""
    return case if isinstance(case, Case) else Case(**{field.name: getattr(case, field.name)
                                                       for field in fields(read.Case)})


def load(given: Given, state: Start | None = None, span: Span | None = None) -> Case:
    return of(read.load(given, state, span))


def load_burning(given: Given) -> Burning:
    return Burning(read.load_burning(given).craft)


load.__doc__, load_burning.__doc__ = read.load.__doc__, read.load_burning.__doc__
