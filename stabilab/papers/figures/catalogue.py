"""The figures of the papers, one row each: number, title, caption with what the paper printed, and how to
draw it."""
from __future__ import annotations

from functools import partial
from pathlib import Path

from ...errors import InputError
from ...show import narrow, style
from ...theories.printed.claims import figures_of
from ...version import __version__
from .. import table
from . import cavity, charged, top
from . import major_axis as major
from . import middle_axis as middle
from . import minor_axis as minor
from .figure import GRID_POINTS, Figure, model_figure, words

_LEVEL = "curves: level sets of the exact potential, in doubles"
_LAW = ("x2² + x3² − 2(b−a)x1 falls by exactly 2(b−a)τ, so no motion is bounded and there is no equilibrium, "
        "stable or not; the paper prints an equilibrium hyperbola X2 X3 = −1")


def _run(start, plane=None):
    return major.projection(start, plane) if plane else major.space(start)


def _released():
    return major.releases(table.START_CAPTURED)


_STARTED, _CAPTURED = (partial(major.exactness, start) for start in (table.START_MAJOR, table.START_CAPTURED))


FIGURES = (
    model_figure("minor-axis-100"),
    Figure(2, "Trajectories for a torque on the minor axis",
           lambda: "Level curves of x²/2 + A² cos α − 4A(b−a) sin(α/2) − 2α on the true circle (x1+a)² + x2² "
                   f"= A² with A = {minor.circle():.4f}. The paper draws F = 4.72 from x1² + x2² = F², which "
                   f"is not constant, and −4Fb in place of −4A(b−a). {minor.departure()}", minor.trajectories,
           f"{_LEVEL}; grey lines: traced on a 700 x 500 grid"),
    Figure(3, "Left and right separatrices",
           lambda: "Each saddle has one loop; triangles mark where a loop crosses the axis "
           "upright. Outside the loops every motion comes from the right, turns back and spins up to the "
           f"right. {minor.departure()}",
           minor.left_right, _LEVEL),
    Figure(4, "Effect of the momentum wheel on the separatrices",
           lambda: "True saddles and centres against the positions printed in the text (upright strokes). "
                   f"With growing λ1 the left saddle moves left (α = {minor.left_saddles()}), not right.",
           minor.wheel_effect, _LEVEL),
    Figure(5, "Separatrix surfaces, minor axis",
           lambda: "Inside each of the two surfaces every motion is periodic about its "
           "centre; outside it spins up about axis 3. The surfaces open out of a fold, each at its own "
           f"radius; the paper's equation (31) holds for λ1 = 0 only. {minor.surface_departure()}",
           minor.surfaces, minor.exactness),
    Figure(6, "Contour map of the separatrix surfaces",
           lambda: "The folds lie on two circles of different radius about (−a, 0), "
           "one on either side of the printed √2 about the origin; the curve (x1+a)(x1+b) = x2² parts stable "
           f"from unstable equilibria, not the line x1 + x2 = 0. {minor.fourth_departure()}",
           minor.contour_map, minor.map_exactness),
    Figure(7, "Typical stable motions, minor axis",
           lambda: "Periodic motions on arcs of circles about (−a, 0), 0.6 of the way up "
           "to the separatrix, and the paper's own start. The paper says that a motion on the separatrix "
           "settles on the equilibrium of the fold; it settles on the saddle of its own circle. "
           f"{minor.circle_departure()}", minor.stable_motions, minor.runs_exactness),
    Figure(8, "Major axis from (4.5, 1.8, 3.4)",
           lambda: f"Spin-up about axis 1. {_LAW}. The paper's τ is not in seconds: "
           f"t = {major.second():.4g} τ s.", _run(table.START_MAJOR), _STARTED),
    Figure(9, "Major axis from (4.5, 1.8, 3.4): x1, x3",
           lambda: f"The amplitudes of x3 are {major.amplitudes(table.START_MAJOR, 2)}; "
           "the paper says that they grow to 6 at λ1 = 500.", _run(table.START_MAJOR, "13"), _STARTED),
    Figure(10, "Major axis from (4.5, 1.8, 3.4): x2, x3",
           lambda: "The ring hardly changes with λ1: |x2| stays within "
           f"{major.amplitudes(table.START_MAJOR, 1)}; the paper says [−4, 4], [−4.2, 4], [−4.5, 4].",
           _run(table.START_MAJOR, "23"),
           _STARTED),
    Figure(11, "Major axis from (4.5, 1.8, 3.4): x1, x2",
           "The caption in print names x2 and x3 again; x1 and x2 are meant.",
           _run(table.START_MAJOR, "12"), _STARTED),
    Figure(12, "Major axis from (0, −1, 5)",
           lambda: "A long capture about axis 3, then spin-up about axis 1. "
           f"{_released()} The paper calls λ1 = 100 stable because its run ends at 15.",
           _run(table.START_CAPTURED), _CAPTURED),
    Figure(13, "Major axis from (0, −1, 5): x1, x3", _released, _run(table.START_CAPTURED, "13"), _CAPTURED),
    Figure(14, "Major axis from (0, −1, 5): x2, x3", _released, _run(table.START_CAPTURED, "23"), _CAPTURED),
    Figure(15, "Major axis from (0, −1, 5): x1, x2", _released, _run(table.START_CAPTURED, "12"), _CAPTURED),
    Figure(16, "Middle axis: no separatrix for the paper's data",
           lambda: f"For |b−a| < {middle.CUSP:.4f} there is no saddle: every motion is periodic but those on "
                   "the plane x1 + b = −x3, which spin up. The paper draws separatrices and three regions. "
                   f"At λ1 = {middle.LAMBDA_BEYOND} a figure-eight separatrix does exist (right): every "
                   "saddle has two loops, and all of them together are the surfaces. "
                   f"{middle.path_departure()}", middle.surfaces, middle.exactness),
    Figure(17, "Middle axis: projection on (x1, x3)",
           lambda: "All equilibria are stable for the paper's data, on both sides of the "
           f"printed line x1 = x3; that line is no invariant plane, x1 + b = x3 is. At λ1 = "
           f"{middle.LAMBDA_BEYOND} the stretch between the two "
           f"folds is unstable. {middle.level_departure()}", middle.projections,
           "closed forms; motions: level sets of the exact potential; fourth surface as printed: traced on a "
           f"grid of {GRID_POINTS} x {GRID_POINTS}"),
    Figure(18, "Without a wheel: λ1 = 0 (not in the paper)", major.words, major.draw,
           f"{_LEVEL}; printed: its formulas", added=True),
)
NUMBERS = tuple(f.number for f in FIGURES)


FIRST = "constant-torque"  # the paper that numbers without a name belong to
PAPERS = {FIRST: table.PAPER, "charged": charged.PAPER, "cavity": cavity.PAPER,
          "top": top.PAPER}


def of_paper(name: str) -> tuple[Figure, ...]:
    """All figures of a paper by any of its names (`claims.named`). Raises InputError for others, and for one
    without figures."""
    short = name if name in PAPERS else figures_of(name)
    if not short:
        raise InputError(f"paper: {name!r} has no figures; these have: {', '.join(PAPERS)}")
    others = {"charged": charged, "cavity": cavity, "top": top}
    return others[short].FIGURES if short in others else FIGURES


def figure(number: int, paper_name: str = FIRST) -> Figure:
    """The row of figure `number` of a paper; InputError where the paper's figure is not on record."""
    rows = of_paper(paper_name)
    for row in rows:
        if row.number == number:
            return row
    raise InputError(f"figure {number}: expected one of {rows[0].number} to {rows[-1].number}")


def chosen(numbers=None, paper_name: str | None = None) -> list[Figure]:
    """Without numbers: all of the paper, without a paper all of all; numbers without a paper are those of the
    constant-torque paper. Raises InputError for what does not exist."""
    if numbers:
        return [figure(n, paper_name or FIRST) for n in numbers]
    return [row for name in ([paper_name] if paper_name else PAPERS) for row in of_paper(name)]


def write(numbers=None, out="figures", progress=None, paper_name: str | None = None,
          telephone: bool = False) -> list[Path]:
    """Draw figures into the folder `out`: figure-NN.png (charged-NN.png, ... for the other papers), of more
    than six panels also figure-NN-2.png, ..., and beside it a text with the caption, command, version and
    tolerance; which: see `chosen`. progress(words) is called before each. telephone: also
    the first picture of each as a telephone shows it (`show.narrow`). Returns the pictures' paths, but for
    these."""
    return [path for row in chosen(numbers, paper_name)
            for path in _write(row, Path(out), progress, telephone)]


def _write(row, out, progress, telephone):
    if progress:
        progress(f"figure {row.number}{f' ({row.paper})' if row.paper else ''}")
    with style.drawing() as plt:
        pictures = row.pictures(plt)
        colours = style.PAGE if telephone else 256
        paths = [style.save(drawn, out / name, colours=colours) for name, drawn in pictures.items()]
        if telephone:
            narrow.save(pictures[row.file], narrow.beside(out / row.file))
    apart = [f"printed curve against exact motion, largest difference at equal times: {line}"
             for line in words(row)]
    with style.whole_file(paths[0].with_suffix(".txt")) as waiting:
        waiting.write_text("\n".join([f"Figure {row.number} of {PAPERS[row.paper or FIRST]}: "
                                      f"{row.title}\n\n{row.caption}\n", f"made by: {row.command}",
                                      f"stabilab {__version__}", f"tolerance: {row.tolerance}", *apart, ""]),
                           encoding="utf-8")
    return paths
