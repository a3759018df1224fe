"""The blocks a state may consist of, in their order: the angular velocity always, the others when something needs them."""
from __future__ import annotations

from collections.abc import Iterable

from ..record import record


@record
class Block:
    """A part of the state: the names of its components, their unit, and what it is in words."""

    name: str
    components: tuple[str, ...]
    unit: str
    words: str


BLOCKS = {block.name: block for block in (
    Block("omega", ("omega1", "omega2", "omega3"), "rad/s", "angular velocity, body frame"),
    Block("gamma", ("gamma1", "gamma2", "gamma3"), "", "unit vector fixed in space, body frame"),
    Block("attitude", ("q0", "q1", "q2", "q3"), "", "quaternion from body to space"),
    Block("velocity", ("v1", "v2", "v3"), "m/s", "velocity, inertial frame"),
    Block("position", ("x1", "x2", "x3"), "m", "position, inertial frame"))}
ORDER = tuple(BLOCKS)
# what a run may show: the blocks, and what is formed from them
PARTS = BLOCKS | {part.name: part for part in (
    Block("x", ("x1", "x2", "x3"), "", "angular velocity, body frame, scaled"),
    Block("angles", ("psi", "phi", "theta"), "rad", "psi, phi, theta of the 3-1-2 sequence, continuous"),
    Block("quaternion", ("qx", "qy", "qz", "qw"), "", "attitude as a unit quaternion, scalar last: turns components along the axes of the rates to "
          "inertial ones"),
    Block("euler", ("precession psi", "nutation theta", "rotation phi"), "rad", "classical Euler angles of the vertical, continuous"),
    Block("momentum", ("H1", "H2", "H3"), "kg m^2/s", "angular momentum, inertial frame"),
    Block("amplitude", ("amplitude",), "rad/s", "amplitude of the transverse rate"),
    Block("spin", ("spin",), "rad/s", "averaged rate about axis 3"),
    Block("phase", ("phase",), "rad", "phase of the transverse rate"))}
BRINGS = {"position": ("velocity", "attitude"), "velocity": ("attitude",)}  # what a block cannot do without


def ordered(names: Iterable[str]) -> tuple[str, ...]:
    """The blocks of these names with all they bring along, in order; omega is always there."""
    wanted = {"omega", *names}
    for name in tuple(wanted):
        wanted |= set(BRINGS.get(name, ()))
    return tuple(name for name in ORDER if name in wanted)


def slices(names: Iterable[str]) -> dict[str, slice]:
    """Where each block stands in the state."""
    out, start = {}, 0
    for name in names:
        size = len(BLOCKS[name].components)
        out[name] = slice(start, start + size)
        start += size
    return out
