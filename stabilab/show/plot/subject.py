"""What a plot is of: a scene, one motion of it where there is one, and what a case says besides."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from ...answers.motion import motion
from ...asked import checked_scene, checked_span
from ...case.read import Case
from ...errors import InputError
from ...orbit.result import Motion
from ...physics.coefficients import effective
from ...physics.scene import AnyScene, Scene
from ...physics.states import checked_states, start_of
from ..axes import PLAIN, Axes, axes_of
from ..text import law

DEFAULT_SPAN = (0.0, 15.0)  # in the scene's time, where nothing else says how far


@dataclass(frozen=True)
class Subject:
    """scene: as it was given; state: the three rates at t = 0 in the scene's variables (rad/s, or x), None without a motion; blocks: the rest
    of the state by name; span: (from, to) or None; heading: for titles, may be empty; case: where all this stands, or None;
    neighbours: how many motions a section shows beside it."""

    scene: AnyScene
    state: tuple[float, ...] | None
    blocks: Mapping[str, Any]
    span: tuple[float, ...] | None
    heading: str = ""
    case: Case | None = field(default=None, repr=False)
    neighbours: int = 0

    @property
    def physical(self) -> bool:
        """Whether there is a body with rates in rad/s; scaled scenes have x and tau."""
        return self.scene.variables == "physical"

    @property
    def variables(self) -> str:
        """"physical" or "scaled"."""
        return self.scene.variables

    @property
    def name(self) -> str:
        """The case's name, or a word where there is none."""
        return "motion" if self.case is None else self.case.name

    @property
    def path(self) -> str:
        """How messages name it."""
        return "plot" if self.case is None else self.case.path

    @property
    def axes(self) -> Axes:
        """The names of its axes."""
        return PLAIN if self.case is None else axes_of(self.case)

    @cached_property
    def twin(self) -> AnyScene:
        """The scene of a wheel and a torque with the same rates, where there is one; else the scene itself."""
        return effective(self.scene)

    @cached_property
    def start(self) -> Any:
        """The state as `trajectory` takes it: three numbers, or all blocks by name."""
        if self.scene.variables == "scaled" or self.scene.blocks == ("omega",):
            return self.state
        return start_of(self.scene, self.state, self.blocks)

    @property
    def exact_state(self) -> tuple[Any, ...] | None:
        """The rates at t = 0 as their decimals were written in a case."""
        return None if self.case is None else self.case.exact_state

    @cached_property
    def motion(self) -> Motion:
        """What is known of the motion: its fate, period and extremes."""
        gamma = tuple(self.blocks.get("gamma", ())) if "gamma" in self.scene.blocks else ()
        found = motion(self.scene, (*self.state, *gamma), self.span, exact=self.exact_state)
        return found if self.case is None else law.judged(self.case, found)


def subject(given: Any, state: Any = None, span: Any = None) -> Subject:
    """The subject of a Case or of a scene with a state: three rates, or a dict of blocks {"omega": ..., "gamma": ...}. A state or span given beside
    a case takes the place of the case's own. span: (from, to), or the end alone. Raises InputError for anything else."""
    ends = checked_span(span)
    if isinstance(given, Subject):
        return given
    if isinstance(given, Case):
        own = Subject(given.scene, given.state, given.blocks, ends or given.span, given.heading, given)
        return own if state is None else replace(own, case=None, **_state(given.scene, state))
    if not hasattr(given, "quadratic"):
        raise InputError(f"plot: expected a case (of stabilab.load) or a scene, got {given!r:.80}")
    start = {"state": None, "blocks": {}} if state is None else _state(given, state)
    return Subject(checked_scene(given), span=ends, **start)


def _state(scene: AnyScene, state: Any) -> dict[str, Any]:
    blocks = dict(state) if isinstance(state, Mapping) else {"omega": state}
    omega = blocks.pop("omega", blocks.pop("x", None))
    if omega is None:
        raise InputError(f"state: expected three rates, or a dict with the block omega, got {state!r:.80}")
    row = checked_states(omega)
    if row.shape != (3,):
        raise InputError(f"state: a plot is of one motion: expected three rates, got an array of shape {row.shape}")
    if isinstance(scene, Scene):
        start_of(scene, row.tolist(), blocks)  # says what is wrong with the rest
    return {"state": tuple(row.tolist()), "blocks": blocks}
