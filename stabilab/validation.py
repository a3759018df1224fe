"""Arguments of public functions, checked."""
from __future__ import annotations

import math
from inspect import signature
from typing import Any

from .errors import InputError


class Asked(type):
    """The class of what users make by its name: a call that gives it too much, too little or what it does not
    know is bad input."""

    def __call__(cls, *supplied: Any, **named: Any) -> Any:
        try:
            return super().__call__(*supplied, **named)
        except TypeError:
            takes = signature(cls.__init__)  # type: ignore[misc]  # the very class that was called
            try:
                takes.bind(None, *supplied, **named)
            except TypeError as error:
                names = [str(parameter.replace(annotation=parameter.empty))
                         for parameter in list(takes.parameters.values())[1:]]
                raise InputError(
                    f"{cls.__name__}: {error}; expected {cls.__name__}({', '.join(names)})") from None
            raise


def checked_scene(scene):
    """The scene itself, if it is one."""
    if not (hasattr(scene, "plain") and hasattr(scene, "variables")):
        raise InputError(
            f"scene: expected a Scene, a ScaledGyrostat or a case, as stabilab.load gives it, got "
            f"{came(scene)}")
    return scene


def is_case(supplied) -> bool:
    """Whether it is a case, which stands for its scene and its own motion."""
    return hasattr(supplied, "scene") and hasattr(supplied, "exact_state")


def scene_and_state(supplied, state):
    """(scene, state) that a function is asked with; of a case its scene and, where no state is given, its own
    start."""
    if is_case(supplied):
        supplied, state = supplied.scene, supplied.start if state is None else state
    scene = checked_scene(supplied)
    if state is None:
        raise InputError(
            "state: expected three numbers for a scene; a case without a [motion] needs them too")
    return scene, state


def came(value) -> str:
    """What was given, in a few words: a short value itself, of anything else its type."""
    return (f"{value!r:.80}" if value is None or isinstance(value, (str, int, float, complex))
            else "an object of type " + type(value).__name__)


def checked_span(span) -> tuple[float, float] | None:
    """(from, to) of a span given by its two ends, or by its length; None stays."""
    if span is None:
        return None
    try:
        ends = tuple(map(float, span)) if hasattr(span, "__len__") else (0.0, float(span))
        if len(ends) == 2 and all(map(math.isfinite, ends)):
            return ends
    except (TypeError, ValueError, OverflowError):
        pass
    raise InputError(f"span: expected two finite times (from, to), or one length, got {span!r:.80}")


def reach_of(span) -> float | None:
    """How far a span (from, to) reaches from the state, which is that of time 0: to its end, or back to its
    beginning where it ends by then; None without a span. Extremes are searched over all of that way, as the
    motion takes it."""
    return None if span is None else float(span[1] if span[1] > 0 or not span[0] else span[0])


def real(values, name: str):
    """The values, if they are no complex numbers: NumPy would drop their imaginary parts."""
    if getattr(getattr(values, "dtype", None), "kind", "") == "c":
        raise InputError(f"{name}: expected real numbers, got complex ones")
    return values
