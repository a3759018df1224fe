"""Public numbers of other tools as data: motions, and what was printed of each (`numbers/*.toml`)."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from ...errors import InputError
from ...physics.effects.constant_torque import ConstantTorque
from ...physics.scene import Body, Scene

FOLDER = Path(__file__).parent / "numbers"
REPOSITORY = "https://github.com/"


@dataclass(frozen=True)
class Wheels:
    """Balanced wheels along the axes: momentum (N m s) at 6000 rpm, speeds (rpm) relative to the body at the
    start, motor torques (N m) until a time (s)."""

    momentum: Fraction
    speed: tuple[Fraction, ...]
    motor: tuple[Fraction, ...]
    until: Fraction


@dataclass(frozen=True)
class Motion:
    """A motion that was run by others. inertia (any unit where no torque acts), torque (3,), rates omega in
    `unit` at the time `begins` (s), attitude by modified Rodrigues parameters sigma, or by the angular
    momentum (against_momentum)."""

    id: str
    file: str
    inertia: tuple[Fraction, ...]
    omega: tuple[Fraction, ...]
    unit: str
    torque: tuple[Fraction, ...]
    sigma: tuple[Fraction, ...]
    begins: Fraction
    against_momentum: bool
    wheels: Wheels | None

    @property
    def scene(self) -> Scene:
        """The body and its torque, without wheels."""
        return Scene(Body(self.inertia), *([ConstantTorque(self.torque)] if any(self.torque) else []))


@dataclass(frozen=True)
class Printed:
    """Values that a tool prints of a quantity of a motion: rows (time, components) as they are printed.
    cause: method and step that the tool seems to use."""

    motion: Motion
    quantity: str
    tool: str
    file: str
    tolerance: Fraction
    relative: bool
    tolerance_is: str
    cause: dict
    values: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Source:
    """A repository at a commit, its licence, what its numbers are, and the numbers."""

    name: str
    title: str
    repository: str
    commit: str
    licence: str
    about: str
    printed: tuple[Printed, ...]

    def url(self, file: str) -> str:
        """Where a file of it can be read."""
        return f"{REPOSITORY}{self.repository}/blob/{self.commit}/{file}"


def sources() -> tuple[str, ...]:
    """Names of the sources on record, in order."""
    return tuple(sorted(path.stem for path in FOLDER.glob("*.toml")))


def source(name: str) -> Source:
    """A source by its name. InputError names the known ones."""
    import tomllib
    if name not in sources():
        raise InputError(f"unknown source {name!r}: known are {', '.join(sources())}")
    data = tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))
    motions = {row["id"]: _motion(row) for row in data.get("motion", ())}
    printed = tuple(_printed(row, motions[row["motion"]]) for row in data.get("set", ()))
    return Source(name, *(data[key] for key in ("title", "repository", "commit", "licence", "about")),
                  printed)


def _motion(row):
    wheels = row.get("wheels")
    if wheels:
        wheels = Wheels(Fraction(wheels["momentum"]), _vector(wheels["speed"]), _vector(wheels["motor"]),
                        Fraction(wheels["until"]))
    zero = ("0", "0", "0")
    return Motion(row["id"], row["file"], _vector(row["inertia"]), _vector(row["omega"]),
                  row.get("unit", "rad/s"), _vector(row.get("torque", zero)),
                  _vector(row.get("sigma", zero)), Fraction(row.get("begins", "0")),
                  row.get("against_momentum", False), wheels)


def _vector(texts):
    return tuple(map(Fraction, texts))


def _printed(row, motion):
    return Printed(motion, row["quantity"], row["tool"], row.get("file", motion.file),
                   Fraction(row["tolerance"]), row.get("relative", False),
                   row["tolerance_is"], row.get("cause", {}), tuple(map(tuple, row["values"])))
