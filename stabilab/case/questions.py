"""The questions of the package as methods of a case: each is the public function of the same name, which
stands above the cases and is therefore imported by name."""
from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any

from .far import in_doubles

if TYPE_CHECKING:
    from pathlib import Path


def _asked(name: str, words: str) -> Callable[..., Any]:
    """A question as a method."""
    def ask(self: Any, *given: Any, **named: Any) -> Any:
        with in_doubles(self, f"{self.place}: "):
            return _public(name)(self, *given, **named)
    ask.__name__, ask.__doc__ = name, f"{words}: see `stabilab.{name}`."
    return ask


class Questions:
    """What a case can be asked; the arguments are those of the function of the same name in `stabilab`."""

    fate = _asked("fate", "What becomes of the motion")
    motion = _asked("motion", "All that is known of the motion")
    equilibria = _asked("equilibria", "Every equilibrium with its stability")
    period = _asked("period", "The period of the motion")
    extremes = _asked("extremes", "The least and greatest value of each component")
    attitude = _asked("attitude", "How the motion turns in space")
    when = _asked("when", "When the motion first reaches a limit")
    stuck = _asked("stuck", "What the stuck thrusters do, and what helps")
    burn = _asked("burn", "What the stuck thrusters leave when they close, and by when they must")

    def simulate(self, times: Any = None, **named: Any) -> Any:
        """The motion at the given times: see `stabilab.simulate`."""
        return _public("simulate")(self, times=times, **named)

    @property
    def plot(self) -> Plots:
        """`case.plot.time()`, and the other kinds of `stabilab.plot`."""
        return Plots(self)

    def report(self, out: str | Path = "report", **named: Any) -> Path:
        """Write the pages of a report into a folder: see `stabilab.report`."""
        return _public("report")(self, out, **named)  # type: ignore[no-any-return]

    def to_toml(self) -> str:
        """The case as text that `stabilab.load` reads."""
        return import_module("stabilab.case.read").text_of_case(self)  # type: ignore[no-any-return]


class BurningQuestions:
    """What a case whose thrusters fire on a schedule can be asked."""

    burn = _asked("burn", "What the burn leaves, and by when it must close")

    def simulate(self, times: Any = None, attitude: str | None = None) -> Any:
        """The motion at the given times, over all switches: see `stabilab.simulate`; attitude: as there."""
        burns = import_module("stabilab.answers.stuck.chain")
        times = import_module("stabilab.public").in_numbers("times", times)
        return burns.simulate_burn(self, times, attitude)

    def when(self, **limit: Any) -> Any:
        """When the motion first reaches a limit, over all switches: rate, component, energy, tilt, until as
        of `stabilab.when`."""
        case = self.craft  # type: ignore[attr-defined]
        stated = import_module("stabilab.answers.when").limit_stated(case, **limit)
        return import_module("stabilab.answers.stuck.burn").time_of_burn(self, stated.ask, stated.until)


class Plots:
    """The kinds of `stabilab.plot`, each of this case."""

    def __init__(self, case: Questions):
        self._case = case

    def __getattr__(self, kind: str) -> Any:
        draw = getattr(_public("plot"), kind) if kind in self.__dir__() else None
        if draw is None:
            raise AttributeError(f"there is no plot {kind!r:.60}; there are {', '.join(self.__dir__())}")
        return lambda *given, **named: draw(self._case, *given, **named)

    def __dir__(self) -> list[str]:
        return [kind for kind in _public("plot").__all__ if kind != "basin"]  # of a map, not of a case


def _public(name: str) -> Any:
    return getattr(import_module("stabilab"), name)
