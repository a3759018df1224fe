"""What users give a question, as a case: a case, the path, text or dict of one, or a scene with its start.

Numbers stay what they are: the rates of one start as text ("0.1", "1/3", "3 deg/s"), as Fractions and as
Decimals are exact, doubles are taken at their word. Its other blocks, and many starts, are doubles."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeAlias
from warnings import warn

from ..errors import InputError
from ..numbers.exact import exact, floats
from ..numbers.principal import IDENTITY, PrincipalAxes, oblique
from ..numbers.units import (
    ANGLE,
    LENGTH,
    MIXED,
    MOMENTUM,
    NONE,
    RATE,
    TIME,
    VELOCITY,
    Dimension,
    in_si,
    split,
)
from ..numbers.vectors import Exact3
from ..physics.scene import (
    BLOCKS,
    INSIDE,
    NO_MOTION,
    VECTORS_INSIDE,
    AnyScene,
    ScaledGyrostat,
    Scene,
    slices,
)
from ..validation import checked_span
from .read import Case, load, with_text
from .write import STATES

if TYPE_CHECKING:
    from decimal import Decimal

    from numpy.typing import ArrayLike

Amount: TypeAlias = "float | str | Fraction | Decimal"  # text may have a unit
Given: TypeAlias = "Case | Scene | ScaledGyrostat | str | PathLike[str] | Mapping[str, object]"
Start: TypeAlias = "Sequence[Amount] | Mapping[str, Sequence[Amount]] | ArrayLike"  # one, or blocks by name
Starts: TypeAlias = "ArrayLike | Sequence[Mapping[str, Sequence[Amount]]]"  # many
Span: TypeAlias = "Amount | Sequence[Amount]"  # (from, to), or the end

FRAMES = ("principal", "file")
# of the blocks of a state; of each number, where these are several
UNITS: dict[str, Dimension | tuple[Dimension, ...]] = {
    "omega": RATE, "x": NONE, "gamma": NONE, "attitude": ANGLE, "velocity": VELOCITY,
    "position": LENGTH, "damper": RATE, "wheel": MOMENTUM, "damper_wheel": RATE,
    "sprung_wheel": MIXED["motion.sprung_wheel"], "damper_mass": MIXED["motion.damper_mass"]}


def as_case(supplied: Given, state: Start | None = None, span: Span | None = None,
            frame: str = "principal") -> Case:
    """The case that is given: a `Case`, whatever `load` takes, or a scene; with this start and span in place
    of its own, where they are given.

    state: numbers in the variables of the case (as many as the scene has components, or the three rates
    alone), or blocks by name; frame: in which its vectors are, "principal" or "file" (of a full tensor);
    span: (from, to), or its length, numbers or text with a unit. Raises InputError for what is none of these.
    """
    case = (supplied if isinstance(supplied, Case)
            else of_scene(supplied) if isinstance(supplied, (Scene, ScaledGyrostat)) else load(supplied))
    if state is not None:
        case = started(case, state, frame)
    return case if span is None else replace(case, span=checked_span(time_in(case.scene, span, "span")))


def as_text(supplied: Given, state: Start | None = None, span: Span | None = None) -> Case:
    """`as_case` for questions that vary what is written in a file."""
    return with_text(as_case(supplied, state, span))


def written(raw: Given, state: Start | None = None, span: Span | None = None) -> Case | str | PathLike[str]:
    """The path of a file as it is; anything else as a case with its text."""
    path = isinstance(raw, PathLike) or isinstance(raw, str) and "\n" not in raw
    if path and state is None and span is None:
        return raw  # type: ignore[return-value]  # as the line above tells
    return as_text(raw, state, span)


def scene_of(supplied: Given) -> AnyScene:
    """The scene that is given, or that of the case."""
    return supplied if isinstance(supplied, (Scene, ScaledGyrostat)) else as_case(supplied).scene


def of_scene(scene: AnyScene) -> Case:
    """The case of a scene, without a start."""
    case = _of_scene(scene)  # of an equal one, whose frame or caveats may be others
    return case if case.scene is scene else _of_scene.__wrapped__(scene)


@lru_cache(maxsize=16)
def _of_scene(scene: AnyScene) -> Case:
    if isinstance(scene, ScaledGyrostat):
        return Case("scene", "", "", scene, "scaled")
    return Case("scene", "", "", scene, "physical", scene,
                frame=scene.frame or PrincipalAxes(scene.body.exact, IDENTITY, True),
                caveats=(*scene.body.caveats, *(item for effect in scene.effects for item in effect.caveats)))


def turning(case: Case, frame: str) -> PrincipalAxes | None:
    """The principal axes, along which vectors given in this frame are turned; None where they are so."""
    if frame not in FRAMES:
        raise InputError(f'frame: expected "principal" or "file", got {frame!r:.40}')
    return oblique(case.frame) if frame == "file" else None


def started(case: Case, state: Any, frame: str = "principal") -> Case:
    """The case with another start, whose vectors are in this frame."""
    rates, blocks = _parts(case.scene, state)
    if (axes := turning(case, frame)) is not None:
        rates = axes.turned(rates)
        blocks |= {name: floats(axes.turned(tuple(map(Fraction, blocks[name]))))
                   for name in ("gamma", *VECTORS_INSIDE) if name in blocks}
    retained = {} if isinstance(state, Mapping) else {name: value for name, value in case.blocks.items()
                                                  if name not in blocks}
    return replace(case, state=floats(rates), decimals=rates, blocks=retained | blocks)


def _parts(scene: AnyScene, state: Any) -> tuple[Exact3, dict[str, tuple[float, ...]]]:
    """(the rates, exact; the other blocks by name) of a start."""
    if isinstance(state, Mapping):
        unknown = [str(name) for name in state if name not in STATES]
        rates = state.get("omega", state.get("x"))
        if unknown or rates is None:
            raise InputError(f"state: expected the block omega and any of {', '.join(list(STATES)[2:])}; got "
                             f"{', '.join(map(str, state)) or 'none'}")
        blocks = {name: values for name, values in state.items() if name not in ("omega", "x")}
    else:
        row, names = _row(state), slices(scene.blocks)
        if len(row) == 3:
            rates, blocks = row, {}
        else:
            short = [name for name in scene.blocks if name in ("omega", "gamma", *INSIDE)]
            # what the question needs, of which what turns inside may be left out at the end; or all of it
            resolved = next((dict(list(parts.items())[:n + 1]) for parts in (slices(short), names)
                          for n, part in enumerate(parts.values()) if len(row) == part.stop), None)
            if resolved is None:
                raise InputError(f"state: expected {_expected(scene)}, got {len(row)} of them")
            blocks = {name: row[part] for name, part in resolved.items()}
            rates = blocks.pop("omega")
            if "attitude" in blocks:  # scalar first in a row of the state
                blocks["attitude"] = (*blocks["attitude"][1:], blocks["attitude"][0])
    return _numbers(scene, "omega", rates), {name: floats(_numbers(scene, name, values))
                                             for name, values in blocks.items()}


def _expected(scene: AnyScene) -> str:
    if scene.blocks == ("omega",):
        return "three numbers"
    names = [name for block in scene.blocks for name in BLOCKS[block].components]
    return f"three numbers, or {len(names)} ({', '.join(names)})"


def _row(state: Any) -> Sequence[Any]:
    """A start as a sequence of numbers."""
    values = state.tolist() if hasattr(state, "tolist") else state
    if isinstance(values, str) or not hasattr(values, "__len__"):
        raise InputError(f"state: expected three numbers in a row, got {values!r:.80}")
    return list(values)


def _numbers(scene: AnyScene, name: str, values: Any) -> tuple[Fraction, ...]:
    """The numbers of one block, exact, in SI."""
    unit: Any = NONE if scene.variables == "scaled" else UNITS[name]
    where = "state" if name == "omega" else f"state: {name}"
    row = _row(values)
    if name == "omega" and len(row) != 3:
        raise InputError(f"state: expected three numbers, got {len(row)} of them")
    size = len(NO_MOTION.get(name, (0.0,) * 3))
    if len(row) != size and (name, len(row)) != ("attitude", 4):
        raise InputError(f"state: {name} has {size} components, got {len(row)}")
    units = unit if isinstance(unit[0], tuple) else (unit,) * len(row)
    return tuple(_number(value, each, where) for value, each in zip(row, units))


def _number(value: Any, unit: Dimension, where: str) -> Fraction:
    if isinstance(value, str) and (split(value) or ("", ""))[1]:
        return in_si(value, unit, where)
    return exact(value.item() if hasattr(value, "item") else value, where)


def time_in(scene: AnyScene, value: Any, name: str) -> Any:
    """A time, or several, with text that has a unit in those of the scene; all else as it is."""
    unit = NONE if scene.variables == "scaled" else TIME
    return in_numbers(value, unit, name)


def in_numbers(value: Any, unit: Dimension, name: str) -> Any:
    """Numbers, nested in lists or not, with text as doubles, in SI where it has a unit; all else as it is.
    """
    if isinstance(value, str):
        return float(in_si(value, unit, name)) if split(value) else value
    if hasattr(value, "dtype") and value.dtype.kind == "U":
        value = value.tolist()
    if not isinstance(value, (list, tuple)) or not any(isinstance(x, (str, list, tuple)) for x in value):
        return value
    return [in_numbers(item, unit, name) for item in value]


def is_one(state: Any) -> bool:
    """Whether it is one start: blocks by name, or one row of numbers."""
    if isinstance(state, Mapping) or state is None:
        return state is not None
    if hasattr(state, "ndim"):
        return bool(state.ndim == 1)
    return not isinstance(state, str) and hasattr(state, "__len__") and bool(len(state)) and not any(
        isinstance(x, Mapping) or (hasattr(x, "__len__") and not isinstance(x, str)) for x in state)


def no_start(case: Case, question: str) -> InputError:
    """The error where a question about a motion has no start."""
    return InputError("state: expected three numbers for a scene; a case without a [motion] needs them too"
                      if case.path == "scene" else
                      f"{case.place}: motion: no angular_velocity or x; {question} needs a start")


def with_start(case: Case, question: str) -> Case:
    """The case itself, if it has a start with all that its scene needs of one."""
    if case.state is None:
        raise no_start(case, question)
    if "gamma" in case.scene.blocks and "gamma" not in case.blocks:
        raise InputError("state: an effect of this scene needs the vertical: give gamma too (six numbers, or "
                         "a dict of blocks)")
    return case


def renamed(question: str, old: str, new: str, value: Any, other: Any) -> Any:
    """The value of an argument given by its former name, with a line of warning."""
    if other is not None:
        raise InputError(f"{question}: {old} and {new} are the same argument: give {new} alone")
    warn(f"{question}: {old} is called {new} now; the former name goes with the next version", FutureWarning,
         stacklevel=3)
    return value
