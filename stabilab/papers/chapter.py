"""A paper's chapter of the report: its data, its figures, the time at which its models depart from the
exact motion, and a variant that makes sense.

Every number in it is computed while the report is written."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..case.read import Case
from ..errors import StabilabError
from ..physics.equations import derive
from ..physics.scene import PARTS
from ..show import narrow, style
from ..show.report.html import picture
from ..show.terminal import written
from ..show.text import cost as cost_text
from ..show.text.cost import so_many
from ..show.text.scene import PRODUCTS
from ..show.units import SI, parameter_unit
from ..theories.theory import compare, side_by_side
from .families import FAMILIES, sweep
from .figures import catalogue, panels
from .figures.figure import links, words

FOLDER = "figures/"  # of a report


@dataclass(frozen=True)
class Chapter:
    """paper: short name as of `figures`; about: what the paper does and where it stands; compared: (case
    file, variant) of the motions whose errors are listed; end: s; sensible: case file of the variant;
    sensible_end: s; note: what makes it sensible; parts: of the state to draw, over `window`, s; short: name
    in the navigation; weight: s of one core."""

    paper: str
    title: str
    about: str
    compared: tuple
    end: float
    sensible: str
    sensible_end: float
    note: str
    parts: tuple
    window: float
    short: str
    weight: float


TIMES = 401  # times at which models are set beside the exact motion
_SWEEP = "charged-sweep"
CHAPTERS = (
    Chapter("charged", "A charged, nearly axisymmetric body",
            "A spinning body with a gyrostatic moment, a charge in a magnetic field, and a torque and a "
            "thrust fixed in it: angular velocity, 3-1-2 angles, angular momentum, velocity and displacement "
            "in closed form, for small angles psi and phi. Euler's equations give two different rates a and "
            "b; equation (8) keeps one. The corrected closed form keeps both.",
            tuple((_SWEEP, v) for v in ("-1-2-1", "-3-2-1", "-1-3-1", "-1-2-3")), 50.0,
            "charged-body-small-torque", 50.0, "the torque is so small that the tilt stays small for ever",
            ("omega", "angles", "position"), 50.0,
            "Charged body", 25.0),
    Chapter("cavity", "A body with a cavity of viscous liquid",
            "A nearly spherical body with a gyrostatic moment, a charge, a resisting medium, a constant "
            "torque and a liquid so viscous that it follows the body at once. The paper averages over the "
            "turn about axis 3 and takes the first terms of a Taylor series of the averaged equations. No "
            "figure states all of its data; what is missing is completed as the titles of the figures say. "
            "They give zeta and M3 as the paper does, whose equations hold them times eps^2 = 0.01: 2 1/s "
            "stands for 0.02 1/s, -6 N m for -0.06 N m.",
            tuple((f"liquid-{name}", "")
                  for name in ("base", "lambda3-0_2", "lambda3-15", "lambda3-25", "zeta-2_5", "torque-9",
                                                      "charge-1e3", "charge-1e4")), 20.0,
            "liquid-sensible", 20000.0,
            "the cavity fits into the body, and the liquid is slow and viscous enough for its "
            "law", ("omega",), 3000.0, "Liquid cavity", 14.0),
    Chapter("top", "A fast top in a Newtonian field",
            "A body about a fixed point, nearly Lagrange's top, under its weight, the gradient of a "
            "Newtonian field and a gyrostatic moment (l_x, 0, l_z), expanded in 1/r0 for a fast spin. The "
            "corrected expansion keeps C* = C + l_z/r0, the permanent tilt by l_x and the frequency.",
            tuple((f"top-lx{a}-lz{b}", "") for a, b in ((30, 30), (90, 30), (30, 90))), 1.3,
            "top-fast", 2.0, "it spins fast, delta1 and delta2 are of order one, and gamma0'' is not near 0",
            ("omega", "gamma"), 0.15, "Fast top", 11.0),
)


def section(name: str, folder: Path) -> dict:
    """The chapter on a paper: plain data, its figures drawn into `folder`/figures."""
    chapter = next(chapter for chapter in CHAPTERS if chapter.paper == name)
    built = {"id": chapter.paper, "title": chapter.title, "paper": catalogue.PAPERS[chapter.paper],
            "about": written(chapter.about), "problem": "",
            "compared": [], "sensible": None, "parameters": "", "end": chapter.end,
            "figures": [drawn(row, folder) for row in catalogue.of_paper(chapter.paper)]}
    try:
        built["parameters"] = _parameters(sweep(chapter.compared[0][0])[chapter.compared[0][1]])
        names = links(*FAMILIES[chapter.paper].values())
        built["compared"] = [row | {"case": names.get(case, row["case"])} for case in chapter.compared
                            for row in _errors(sweep(case[0])[case[1]], chapter.end)]
        built["sensible"] = _sensible(chapter, folder)
    except StabilabError as error:  # no such case yet, or a motion that cannot be run: the chapter says so
        built["problem"] = str(error)
    return built


def drawn(row, folder: Path) -> dict:
    """What a page says of a figure, whose pictures are drawn into `folder`/figures; rows, claims: of the
    audit, see `index.of_figure`; cases: of `index.cases_of`."""
    path, *more = catalogue.write([row.number], folder / FOLDER, paper_name=row.paper or None,
                                     telephone=True)
    return picture(path, narrow.beside(path), FOLDER, id=f"{row.paper or 'figure'}-{row.number}",
                   number=row.number, title=row.title, caption=row.caption, tolerance=row.tolerance,
                   differences=words(row), command=row.command, rows=(), claims=(), cases=(),
                   more=[FOLDER + part.name for part in more])


def _parameters(case: Case):
    """Parameters and start of a case in words, with their units."""
    values = ", ".join(f"{PRODUCTS.get(name, name)} = {float(value):.6g} {parameter_unit(name)}".rstrip()
                       for name, value in derive(case.scene).parameters.items())
    starts = {"omega": case.state, **case.blocks}
    return written(f"{values}; at t = 0: "
                   + ", ".join(
                       f"{name} = ({', '.join(f'{v:.6g}' for v in row)}) "
                       f"{PARTS[name].unit if name in PARTS else ''}".rstrip()
                       for name, row in starts.items()))


def _errors(case, end, result=None):
    """A row per model and part of the state: first times of 1 % and 10 %, and the largest error."""
    result = result or compare(case, np.linspace(0.0, end, TIMES))
    rows = [{"case": case.name, "model": panels.MODEL_LABELS[d.model], "part": written(d.part),
             "one": _time(d.first[0.01]), "ten": _time(d.first[0.1]),
             "largest": so_many(d.largest / d.scale if d.scale else d.largest, 2)} for d in result.departures]
    return rows + [{"case": case.name, "model": panels.MODEL_LABELS[name], "part": "", "one": "no answer",
                    "ten": written(why), "largest": ""}
                   for name, why in result.refused.items()]


def _time(value):
    return "never" if value is None else f"{so_many(value, 3)} s".replace("e-0", "e−")


def _sensible(chapter, folder):
    """The variant: its errors and its picture."""
    case = sweep(chapter.sensible)[""]
    result = compare(case, np.linspace(0.0, chapter.sensible_end, TIMES))
    runs, _ = side_by_side(case, np.linspace(0.0, chapter.window, 1001))
    with style.drawing() as plt:
        paths = narrow.save_both(cost_text.picture(plt, case, runs, chapter.parts, units=SI),
                                 folder / FOLDER / f"{chapter.paper}-sensible.png")
    return picture(*paths, FOLDER, case=case.name, title=written(case.title), why=written(chapter.note),
                   end=chapter.sensible_end, rows=_errors(case, None, result), parameters=_parameters(case),
                   path=f"cases/{case.name}.toml")
