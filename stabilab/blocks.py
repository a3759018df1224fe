"""The blocks a state may consist of, in their order: the angular velocity always, the others when something needs them."""
from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Block:
    """A part of the state: the names of its components, their unit, and what it is in words."""

    name: str
    components: tuple[str, ...]
    unit: str
    words: str


BLOCKS = {block.name: block for block in (
    Block("omega", ("omega1", "omega2", "omega3"), "rad/s", "angular velocity, body frame"),
    Block("gamma", ("gamma1", "gamma2", "gamma3"), "", "unit vector fixed in space, seen from the body"),
    Block("attitude", ("q0", "q1", "q2", "q3"), "", "quaternion from body to space"),
    Block("velocity", ("v1", "v2", "v3"), "m/s", "velocity, inertial frame"),
    Block("position", ("x1", "x2", "x3"), "m", "position, inertial frame"))}
ORDER = tuple(BLOCKS)
BRINGS = {"position": ("velocity", "attitude"), "velocity": ("attitude",)}  # what a block cannot do without


def ordered(names) -> tuple[str, ...]:
    """The blocks of these names with all they bring along, in order; omega is always there."""
    wanted = {"omega", *names}
    for name in tuple(wanted):
        wanted |= set(BRINGS.get(name, ()))
    return tuple(name for name in ORDER if name in wanted)


def slices(names) -> dict[str, slice]:
    """Where each block stands in the state."""
    out, start = {}, 0
    for name in names:
        size = len(BLOCKS[name].components)
        out[name] = slice(start, start + size)
        start += size
    return out
