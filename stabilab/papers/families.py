"""Families of motions of the papers, from the case files that come with the package: the motions of one
differ in one number. The papers' figures draw them, and the audit tries on them what the texts say of trends.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from ..case.read import Case, load_all
from ..physics.effects.gyrostat import Gyrostat
from ..physics.scene import Scene
from ..theories.theory import side_by_side
from .table import cases_folder

WAVES = "waves"  # a variant of the liquid's files: with the wheel that the waves of the text need
WHEEL = 20  # kg m^2/s, the middle one of the 15 to 25 of Fig. 3


@lru_cache(maxsize=32)
def sweep(name: str) -> dict:
    """Variant -> case of a case file ("" for a file without a sweep); of the liquid's also `WAVES`."""
    cases = {case.variant: case for case in load_all(cases_folder() / f"{name}.toml")}
    return cases | ({WAVES: with_wheel(cases[""], WHEEL)} if name.startswith("liquid-") else {})


def with_wheel(case: Case, momentum: float) -> Case:
    """The case with another gyrostatic moment about axis 3, N m s."""
    scene: Any = case.scene
    others = (effect for effect in scene.effects if effect.name != "gyrostat")
    return replace(case, scene=Scene(scene.body, Gyrostat((0, 0, momentum)), *others))


@dataclass(frozen=True)
class Span:
    """The times of a paper's figures: `count` of them from 0 to `end`, s; crowd > 1: closer at the start.
    order: of the top's expansion."""

    end: float
    count: int
    crowd: int = 1
    order: int | None = None

    @property
    def times(self) -> np.ndarray:
        return self.end * np.linspace(0.0, 1.0, self.count) ** self.crowd


@lru_cache(maxsize=64)
def compared(file: str, variant: str, span: Span) -> tuple[dict, dict]:
    """(model -> Simulation, the exact one first; model -> why it refuses this motion) of a case."""
    return side_by_side(sweep(file)[variant], span.times, span.order)


@dataclass(frozen=True)
class Family:
    """symbol, unit: of the number that is varied, as Matplotlib sets them; cases: value -> (case file,
    variant of its sweep); rest: what a title says of the other numbers; name: in a caption."""

    symbol: str
    unit: str
    cases: dict
    rest: str = ""
    name: str = ""

    @property
    def members(self) -> list:
        """The cases, in the order of the values."""
        return [sweep(file)[variant] for file, variant in self.cases.values()]

    def runs(self, span: Span) -> list[dict]:
        """model -> Simulation of each case."""
        return [compared(*case, span)[0] for case in self.cases.values()]


KILOGRAM = r"kg m$^2$/s"
LAMBDA, ZETA, TORQUE, CHARGE = (r"$\lambda_3=0.1$ kg m$^2$/s", r"$\zeta=2$ s$^{-1}$", r"$M_3=-6$ N m",
                                r"$e=0.01$ C")


def _charged(symbol, unit, values, variant, rest, name):
    cases = {value: ("charged-sweep", variant.format(n)) for n, value in enumerate(values, 1)}
    return Family(symbol, unit, cases, f", {rest}", f"family of {name}")


def _liquid(symbol, unit, files, rest, name):
    return Family(symbol, unit, {value: (f"liquid-{file}", "") for value, file in files.items()},
                  f": {', '.join(rest)}, $M_1=M_2=0$", name)


def _waves(family):
    """The same with the wheel that waves need."""
    return replace(family, cases={value: (file, WAVES) for value, (file, _) in family.cases.items()},
                   rest=family.rest.replace(LAMBDA, rf"$\lambda_3={WHEEL}$ kg m$^2$/s"))


def _top(axis, pairs, rest):
    cases = {lx if axis == "x" else lz: (f"top-lx{lx}-lz{lz}", "") for lx, lz in pairs}
    return Family(rf"\ell_{axis}", KILOGRAM, cases, f", {rest} {KILOGRAM}", f"l{axis} = 30, 60, 90 kg m²/s")


def _major(kind):
    return Family(r"\lambda_1", KILOGRAM, {value: (f"{kind}-{value}", "") for value in (100, 300, 500)})


FAMILIES: dict[str, dict[str, Family]] = {  # short name of the paper -> name of the family
    "constant-torque": {"figure 8": _major("major-axis"), "figure 12": _major("major-axis-spin3")},
    "charged": {
        "lambda3": _charged(r"\lambda_3", KILOGRAM, (1.3, 1.6, 1.9), "-{}-2-1",
                            "$e=0.003$ C, $M_1=4$ N m", "λ3"),
        "e": _charged("e", "C", (0.001, 0.003, 0.005), "-1-{}-1",
                      r"$\lambda_3=1.3$ kg m$^2$/s, $M_1=4$ N m", "e"),
        "M1": _charged("M_1", "N m", (4.0, 4.5, 5.0), "-1-2-{}", r"$\lambda_3=1.3$ kg m$^2$/s, $e=0.003$ C",
                       "M1")},
    "cavity": {
        "small": _liquid(r"\lambda_3", KILOGRAM, {0.1: "base", 0.15: "lambda3-0_15", 0.2: "lambda3-0_2"},
                         (ZETA, TORQUE, CHARGE), "λ3 = 0.1 to 0.2"),
        "large": _liquid(r"\lambda_3", KILOGRAM, {15: "lambda3-15", 20: "lambda3-20", 25: "lambda3-25"},
                         (ZETA, TORQUE, CHARGE), "λ3 = 15 to 25"),
        "zeta": _liquid(r"\zeta", r"s$^{-1}$", {1.5: "zeta-1_5", 2: "base", 2.5: "zeta-2_5"},
                        (LAMBDA, TORQUE, CHARGE), "family of ζ"),
        "M3": _liquid("M_3", "N m", {-3: "torque-3", -6: "base", -9: "torque-9"}, (LAMBDA, ZETA, CHARGE),
                      "family of M3"),
        "e": _liquid("e", "C", {0.01: "base", 1e3: "charge-1e3", 1e4: "charge-1e4"}, (LAMBDA, ZETA, TORQUE),
                     "family of e")},
    "top": {"lx": _top("x", ((30, 30), (60, 30), (90, 30)), r"$\ell_z=30$"),
            "lz": _top("z", ((30, 30), (30, 60), (30, 90)), r"$\ell_x=30$")}}
FAMILIES["cavity"] |= {f"{name} waves": _waves(FAMILIES["cavity"][name]) for name in ("zeta", "M3", "e")}
# of the figures of each paper, and of the motions that the audit tries
SPANS = {"constant-torque": Span(15.0, 15001), "charged": Span(50.0, 2001),
         "cavity": Span(20.0, 2001, crowd=2), "top": Span(1.3, 2601, order=2)}
