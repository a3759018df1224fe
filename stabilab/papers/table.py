"""Amer et al. 2024: their data, Tables 1 to 4, and one more of the integrals.

The data are the paper's body, momentum wheels, torques and starts. The tables are recomputed, in five
formats: terminal text, CSV, Markdown, LaTeX, HTML.

Tables 2 to 4 set beside the truth what follows from the printed integrals (`printed_integrals`); a table that
the paper has not gives the integrals of all its motions, and the equilibria beside them (`integrals`)."""
from __future__ import annotations

import html
import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from ..answers.digits import ask
from ..answers.motion import motion
from ..case.read import Case, load
from ..equilibrium.torque_table import torque_table
from ..errors import InputError
from ..physics.body import Body
from ..physics.coefficients import to_scaled, torque_from_mu
from ..physics.effects.constant_torque import ConstantTorque
from ..physics.effects.gyrostat import Gyrostat
from ..physics.scene import ScaledGyrostat, Scene
from ..show import style
from ..show.data import csv_lines
from .integrals import Integrals, integrals
from .printed_integrals import FAMILIES, printed_extremes, printed_integrals

if TYPE_CHECKING:
    from ..orbit.separatrix.homoclinic import Branch

# --- The data
PAPER = "Amer et al. 2024, Sci. Rep."
INERTIA = (2000, 1500, 1000)            # kg m^2
LAMBDAS = (100, 300, 500)               # kg m^2/s, along axis 1
TORQUE = {"major": (1, 0, 0), "middle": (0, 1, 0), "minor": (0, 0, 1)}
START_MINOR = (2.5, 4.0, 0.1)           # Figs 2-7, Table 2
START_MIDDLE = (1.7, 1.1, -0.2)         # Figs 16-17, Table 3
START_PLANE = (2.5, 1.3, 2.5)           # Table 4
START_MAJOR = (4.5, 1.8, 3.4)           # Figs 8-11
START_CAPTURED = (0.0, -1.0, 5.0)       # Figs 12-15
SPAN = (0.0, 15.0)                      # tau


def printed_scene(axis: str, lambda1: float) -> ScaledGyrostat:
    """The paper's scaled system with the torque along the "major", "middle" or "minor" axis (u = 1)."""
    return to_scaled(physical(axis, lambda1), mu=TORQUE[axis])[0]


def physical(axis: str, lambda1: float) -> Scene:
    """The same system in physical variables."""
    body = Body(INERTIA)
    return Scene(body, Gyrostat((lambda1, 0, 0)), ConstantTorque(torque_from_mu(body, TORQUE[axis])))


# of Fig. 4 in the text: lambda1 -> (left and right saddle, left and right centre), alpha
FIG4 = {100: ((0.0, 6.2), (-3.0, 3.3)), 300: ((0.19, 6.15), (-3.1, 3.29)), 500: ((0.32, 5.8), (-3.13, 3.28))}


def saddle(radius: float, turn: float = 0.0):
    """alpha of the saddle before a turn as printed below (25): sin alpha = -2/F^2."""
    return turn - np.arcsin(2 / radius**2)


def folds(c: float) -> list[float]:
    """x2 of the two points of the minor axis at which saddle and centre merge, c = b - a."""
    return [h.real for h in np.roots([1, 0, 0, -c, -1]) if abs(h.imag) < 1e-12]


def fold_radii(c: float) -> list[float]:
    """Radii of the circles about (-a, 0) through them, rising: the least carries the first equilibrium."""
    return sorted(float(np.sqrt(h * h + h**6)) for h in folds(c))


def circle(radius: float, centre: float = 0.0, count: int = 361) -> tuple[np.ndarray, np.ndarray]:
    """(x1, x2) of a circle about (centre, 0)."""
    turn = np.linspace(0, 2 * np.pi, count)
    return centre + radius * np.sin(turn), radius * np.cos(turn)


def side(branch: Branch) -> str:
    """The paper's name of a surface of the minor axis: the left loop of the phase plane has alpha in (-2 pi,
    0), where x1 + a < 0 about its centre."""
    return "left" if float(np.asarray(branch.centre)[-1, 0]) < 0 else "right"


def equilibria(axis: str, scene: ScaledGyrostat, heights: np.ndarray):
    """(x1, h, whether stable) along both branches of the true equilibria of a torque on the "minor" axis, h =
    x2 and x1 + b = -1/h, or on the "middle" one, h = x3 and x1 + a = 1/h; heights: sizes of h."""
    for h in (heights, -heights):
        x1, sign = (-scene.b - 1 / h, -1) if axis == "minor" else (-scene.a + 1 / h, 1)
        yield x1, h, (x1 + scene.a) * (x1 + scene.b) + sign * h * h > 0


def draw_equilibria(ax, x1, h, stable) -> None:
    """A branch of `equilibria`, stable and unstable parts, in a plane or in space."""
    for kind, mask in (("stable", stable), ("unstable", ~stable)):
        line = np.where(mask, x1, np.nan), np.where(mask, h, np.nan), 0 * h
        ax.plot(*line[:3 if ax.name == "3d" else 2], **style.MEANING[kind])


def drift(runs) -> float:
    """The largest drift of the laws of the motion along the runs."""
    return max(d for run in runs for d in run.invariant_drift.values())


def name_space(ax, zoom=0.92, order=(1, 2, 3)):
    """Labels of the three axes of a 3-D picture, close to it and not clipped; `order`: components along its
    axes."""
    from matplotlib.ticker import MaxNLocator
    for setter, component, pad in zip((ax.set_xlabel, ax.set_ylabel, ax.set_zlabel), order, (-2, -2, -4)):
        setter(f"$x_{component}$", labelpad=pad, rotation=0)
    ax.tick_params(pad=-1, labelsize=8)
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.set_rotate_label(False)  # upright from every side
        axis.set_major_locator(MaxNLocator(5))
        axis.set_pane_color((1, 1, 1, 0))  # white would cover a label of the panel before
    ax.patch.set_visible(False)
    ax.set_box_aspect(None, zoom=zoom)


# --- Tables
DECIMALS = 20  # of periods and extremes, from balls: the double next to each is the right one
SHOWN_DIGITS = 6  # in the readable formats; the CSV holds every double in full


@dataclass(frozen=True)
class Table:
    """A table: number in the paper, title, caption, header and rows; cells are strings, ints, floats or None.
    """

    number: int
    title: str
    caption: str
    header: tuple[str, ...]
    rows: tuple[tuple, ...]
    wide: bool = False  # cells hold sentences

    @property
    def stem(self) -> str:
        return f"table-{self.number}"


def cell(value) -> str:
    """A cell for people: six significant digits, words for infinities, a dash for nothing."""
    if value is None:
        return "–"
    if isinstance(value, float):
        if math.isinf(value):
            return "unbounded" if value > 0 else "-unbounded"
        return f"{value:.{SHOWN_DIGITS}g}"
    return str(value)


# -- what the tables say


TORQUE_COLUMNS = {"wheel": "gyrostat", "torque signs": "mu", "equilibria": "number", "form": "form",
                  "condition": "condition", "characteristic polynomial": "polynomial", "spectrum": "spectrum",
                  "linear": "linear", "nonlinear": "nonlinear"}
_SIGNS = {"mu1": "μ1", "mu2": "μ2", "mu3": "μ3", "!=": "≠", "+-": "±", "-+": "∓", " - ": " − ", "= -": "= −",
          "(-": "(−", "sqrt": "√",
          "^2": "²", "^3": "³", "^4": "⁴", "<=": "≤", ">=": "≥"}
# b-a, and before a number, a letter or a bracket; not within a word
_MINUS = re.compile(r"(?<=\bb)-(?=a\b)|(?<![^ (,/|])-(?=[\wμ(])")


def torque_signs() -> Table:
    """Table 1: every combination of torque signs, with the wheel (a != b) and without its effect (a = b)."""
    scene = printed_scene("minor", 100)
    signs: dict[tuple, list[str]] = {}  # rows that differ in the signs alone are one
    for pair in ((scene.a, scene.b), (scene.a, scene.a)):
        for row in torque_table(*pair):
            wheel, torque, *rest = (_signs(getattr(row, field)) for field in TORQUE_COLUMNS.values())
            signs.setdefault((wheel, *rest), []).append(str(torque))
    rows = [(wheel, ", ".join(torques), *rest) for (wheel, *rest), torques in signs.items()]
    return Table(1, "Equilibria and their stability under every constant torque",
                 "All sign combinations of the torque (μ1, μ2, μ3). The paper grants eight equilibria "
                 "whenever μ1 μ2 μ3 ≥ 0; there are never more than two isolated ones, and curves only for a "
                 "torque along one axis or none.", tuple(TORQUE_COLUMNS),
                 tuple(rows),
                 wide=True)


def _signs(value) -> str | None:
    """Words with the usual mathematical signs; None for the dash that stands for nothing."""
    if isinstance(value, tuple):
        return f"({', '.join(value)})".replace("-", "−")
    if value == "-":
        return None
    for plain, sign in _SIGNS.items():
        value = value.replace(plain, sign)
    return _MINUS.sub("−", value)


EXTREMES_HEADER = ("case", "λ1", "a", "b", "x1(0)", "x2(0)", "x3(0)", "fate", "period", "x1 min", "x1 max",
                   "x2 min", "x2 max", "x3 min", "x3 max")
EXTREMES = {
    2: (("minor-axis",), "Extremes, torque on the minor axis, from x(0) = (2.5, 4, 0.1)",
        "Extremes over all time. The rows as printed are worked out from (18) and (30), on which the "
        "paper's own table rests: x1² + x2² = F² is not constant, (x1 + a)² + x2² is. Difference: as printed "
        "less true."),
    3: (("middle-axis",), "Extremes, torque on the middle axis, from x(0) = (1.7, 1.1, −0.2)",
        "Extremes over all time. The paper's own table rests on x1² − x3² = 2N, which is not constant "
        "((x1 + b)² − x3² is), and on (71), whose artanh ends before x2 returns to zero: as printed there "
        "are no extremes."),
    4: (("middle-axis-equal", "middle-axis-plane"),
        "Extremes, torque on the middle axis, from x(0) = (2.5, 1.3, 2.5)",
        "The paper takes x1(0) = x3(0) for an invariant plane. It is none unless b = 0: the first rows show "
        "what the state really does, x1 and x3 part at once, beside what follows from the printed (79). The "
        "last three rows show the case that was meant, x1 + b = x3. Difference: as printed less true."),
}
# table -> its last columns: the integrals of a motion
INTEGRALS = {2: ("F", "G1"), 3: ("N", "G2"), 4: ("N", "G2", "G3")}
MOTIONS = 5  # number of the table that the paper has not
MOTIONS_TITLE = "Integrals and equilibria of every motion (not in the paper)"
MOTIONS_HEADER = ("case", "λ1", "x1(0)", "x2(0)", "x3(0)", "fate", "F", "N", "G1", "G2", "G3",
                  "on separatrix", "centre x1", "centre x2", "centre x3", "eigenvalue ±i", "saddle x1",
                  "saddle x2", "saddle x3", "eigenvalue ±")
MOTIONS_CAPTION = (
    "By the true equations. Minor axis: F² = (x1 + a)² + x2² and G1 = 2 x3² + x2² − (x1 + a)² − "
    "4(b − a)(x1 + a) − 4 atan2(x1 + a, x2). Middle axis: 2N = (x1 + b)² − x3² and G2 = 2 x2² + (x1 + b)² + "
    "x3² − 4(b − a)(x1 + b) − 4 artanh(x3/(x1 + b)); on the plane x1 + b = x3: G3 = (x2² + x3²)/2 − "
    "(b − a) x3 − ln|x3|. On separatrix: the same integral at the saddle; a motion below it is bounded. "
    "Centre: the equilibrium that the motion turns about, with eigenvalues 0 and ±i times the number; "
    "saddle: that which decides, with eigenvalues 0 and ± the number. A wheel along the torque (major axis) "
    "leaves no equilibrium and no such integral.")
# family of cases, in the order of the figures
MOTION_FAMILIES = ("minor-axis", "major-axis", "major-axis-spin3", "middle-axis", "middle-axis-equal",
                   "middle-axis-plane")


def cases_folder() -> Path:
    """The folder of the papers' case files: they come with the package. Raises InputError where they are not
    found."""
    package = Path(__file__).resolve().parents[1]
    # the first is a link, which some systems do not unpack
    for folder in (package / "cases", package.parent / "cases"):
        if (folder / "minor-axis-100.toml").is_file():
            return folder.resolve()
    raise InputError(
        f"the papers' case files (minor-axis-100.toml and so on) are not in {package / 'cases'}: install "
        f"stabilab anew")


def case_files(stems=("*",)) -> list[str]:
    """The papers' case files (of these stems), as paths from here where they lie below, else whole."""
    paths = [path for stem in stems for path in sorted(cases_folder().glob(f"{stem}.toml"))]
    return [os.path.relpath(p) if p.resolve().is_relative_to(Path.cwd()) else os.fspath(p) for p in paths]


def extremes_table(number: int) -> Table:
    """Table 2, 3 or 4: extremes of every component over all time, from the case files."""
    families, title, caption = EXTREMES[number]
    rows = [row for family in families for lam in LAMBDAS
            for row in _with_printed(family, _extremes_row(case_file(family, lam), lam, INTEGRALS[number]),
                                     INTEGRALS[number])]
    return Table(number, title, caption, EXTREMES_HEADER + INTEGRALS[number], tuple(rows))


def case_file(family: str, lam: int) -> Path:
    """The case file of a family at one lambda1."""
    return cases_folder() / f"{family}-{lam}.toml"


def _with_printed(family: str, row: tuple, columns: tuple[str, ...]) -> list[tuple]:
    """The row, and for a family whose formulas the paper prints what these give and the difference. columns:
    of the integrals."""
    if family not in FAMILIES:
        return [row]
    _, lam, a, b, *start = row[:7]
    result = printed_extremes(family, start, a, b)
    invariant, energy = printed_integrals(family, start, a, b)
    # (79) is of a plane, G3
    constants = [invariant, *[None] * (len(columns) - 2), energy]
    values = [None] * 6 if result is None else [v for pair in result for v in pair]
    as_printed = ("as printed", lam, a, b, *start, None, None, *values, *constants)
    apart = [None if printed is None or true is None else printed - true
             for printed, true in zip(values + constants, row[9:])]
    return [row, as_printed, ("difference", *[None] * 8, *apart)]


def _extremes_row(path, lam, columns):
    case = load(path)
    result = motion(case.scene, case.start, case.span, exact=case.exact_state)
    period, extremes = (ask(name, case.scene, case.start, DECIMALS, case.span, result,
                            case.exact_state).decimals for name in ("period", "extremes"))
    return (case.name, lam, case.scene.a, case.scene.b, *case.state, result.fate.word, float(period),
            *(float(v) for pair in extremes for v in pair), *_named(integrals(case, result), columns))


def _named(result: Integrals, columns: Sequence[str]) -> list[float | None]:
    """F, N, G1, G2, G3 by these names, None where the motion has none."""
    return [getattr(result, name) if name in "FN" else result.G.get(name) for name in columns]


def motions_table() -> Table:
    """Table 5, which the paper has not: integrals of every motion, the equilibria beside it, eigenvalues."""
    return Table(MOTIONS, MOTIONS_TITLE, MOTIONS_CAPTION, MOTIONS_HEADER,
                 tuple(_motion_row(load(case_file(family, lam)), lam)
                       for family in MOTION_FAMILIES for lam in LAMBDAS))


def _motion_row(case: Case, lam: int) -> tuple:
    answer = motion(case)
    result = integrals(case, answer)
    places = [v for item in (result.centre, result.saddle)
              for v in ((None,) * 4 if item is None else (*item.at, item.eigenvalue))]
    return (case.name, lam, *map(float, case.state), answer.fate.word,
            *_named(result, ("F", "N", "G1", "G2", "G3")), result.on_separatrix, *places)


def tables(tell: Callable[[int, int, str], None] | None = None) -> tuple[Table, ...]:
    """Tables 1-4 and that of the integrals, computed now. tell(done, count, words): before each."""
    built = []
    for done, number in enumerate(numbers := (1, *EXTREMES, MOTIONS)):
        if tell:
            tell(done, len(numbers), f"table {number}")
        built.append(torque_signs() if number == 1 else motions_table() if number == MOTIONS
                     else extremes_table(number))
    return tuple(built)


# -- formats


def text(table: Table, width: int = 160) -> str:
    """Aligned columns for a terminal; a table of sentences becomes one block a row."""
    rows = [[cell(v) for v in row] for row in table.rows]
    lines = [f"Table {table.number}. {table.title}", ""]
    if table.wide:
        for row in rows:
            lines += [f"  {name}: {value}" for name, value in zip(table.header, row) if value != "–"] + [""]
    else:
        widths = [max(len(row[i]) for row in [list(table.header), *rows]) for i in range(len(table.header))]
        for row in [list(table.header), *rows]:
            lines.append("  ".join(v.rjust(w) for v, w in zip(row, widths)).rstrip())
    return "\n".join([*lines, "", *_wrapped(table.caption, width), ""])


def _wrapped(phrase, width):
    import textwrap
    return textwrap.wrap(phrase, min(width, 100))


def comma_separated(table: Table) -> str:
    """CSV: numbers with 17 significant digits, "inf" where unbounded, an empty cell for nothing."""
    return csv_lines([table.header, *table.rows])


def markdown(table: Table) -> str:
    """A pipe table under its title."""
    line = lambda cells: "| " + " | ".join(c.replace("\\", "\\\\").replace("|", "\\|").replace("\n", " ")
                                           for c in cells) + " |"
    rows = [line(table.header), "|" + " --- |" * len(table.header),
            *(line([cell(v) for v in row]) for row in table.rows)]
    return "\n".join([f"**Table {table.number}.** {table.title}", "", *rows, "", table.caption, ""])


_LATEX = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{",
          "}": r"\}",
          "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": "$<$", ">": "$>$", "|": "$|$",
          "λ": r"$\lambda$", "μ": r"$\mu$", "ω": r"$\omega$", "σ": r"$\sigma$", "ζ": r"$\zeta$",
          "α": r"$\alpha$",
          "τ": r"$\tau$", "²": "$^2$", "³": "$^3$", "⁴": "$^4$", "≥": r"$\ge$", "≤": r"$\le$", "≠": r"$\ne$",
          "±": r"$\pm$", "∓": r"$\mp$",
          "−": "$-$", "–": "--", "√": r"$\surd$", "×": r"$\times$", "·": r"$\cdot$", "∞": r"$\infty$",
          "′": "$'$",
          "₁": "$_1$", "₂": "$_2$", "₃": "$_3$", "⟂": r"$\perp$", "Δ": r"$\Delta$"}


_INDEXED = re.compile(r"\b([xλμ])(\d)")


def latex_escape(phrase: str) -> str:
    """Words that LaTeX sets as they stand, x1 and λ1 with their indices."""
    parts = _INDEXED.split(phrase)  # text, letter, index, text, ...
    built = []
    for text, letter, index in zip(parts[::3], [*parts[1::3], ""], [*parts[2::3], ""]):
        built.append("".join(_LATEX.get(sign, sign) for sign in text))
        if letter:
            built.append(f"${_LATEX.get(letter, letter).strip('$')}_{index}$")
    return "".join(built)


def latex(table: Table) -> str:
    """A booktabs tabular inside a table float; needs \\usepackage{booktabs} (and tabularx for Table 1)."""
    columns = "".join("X" if table.wide else ("l" if _is_text(table, i) else "r")
                      for i in range(len(table.header)))
    begin, end = ((rf"\begin{{tabularx}}{{\linewidth}}{{{columns}}}", r"\end{tabularx}") if table.wide else
                  (rf"\begin{{tabular}}{{{columns}}}", r"\end{tabular}"))
    line = lambda cells: " & ".join(latex_escape(c) for c in cells) + r" \\"
    return "\n".join([r"\begin{table}", r"\centering\footnotesize",
                      rf"\caption{{{latex_escape(table.title)}. {latex_escape(table.caption)}}}", begin,
                      r"\toprule",
                      line(table.header), r"\midrule", *(line([cell(v) for v in row]) for row in table.rows),
                      r"\bottomrule", end, r"\end{table}", ""])


def _is_text(table: Table, column: int):
    return any(isinstance(row[column], str) for row in table.rows)


def html_fragment(table: Table, links: Mapping[str, str] = MappingProxyType({})) -> str:
    """A <table> with everything escaped. links: cell -> the page that it leads to."""
    kinds = ["sentence" if table.wide else "words" if _is_text(table, n) else "number"
             for n in range(len(table.header))]
    head = "".join(f'<th scope="col" class="{kind}">{html.escape(h)}</th>'
                   for kind, h in zip(kinds, table.header))
    body = "\n".join("<tr>" + "".join(f'<td class="{kind}">{_linked(v, links)}</td>'
                                      for kind, v in zip(kinds, row)) + "</tr>" for row in table.rows)
    return (f'<table id="table-{table.number}">\n<caption>Table {table.number}. '
            f'{html.escape(table.title)}</caption>\n'
            f"<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table>\n<p "
            f"class=\"note\">{html.escape(table.caption)}</p>\n")


def _linked(value, links: Mapping[str, str]) -> str:
    phrase = html.escape(_signed(value))
    return f'<a href="{html.escape(links[value])}">{phrase}</a>' if value in links else phrase


def _signed(value: str) -> str:
    """A cell with the minus of a book before a number."""
    return cell(value) if isinstance(value, str) else cell(value).replace("-", "−")


def html_page(table: Table) -> str:
    """The fragment as a page of its own."""
    style = ("body{font:14px sans-serif;margin:1em}div{overflow-x:auto}table{border-collapse:collapse}"
             "caption{text-align:left;font-weight:600}"
             "td,th{padding:.25em .6em;border-bottom:1px solid #ccc;text-align:right;vertical-align:top}"
             ".words,.sentence{text-align:left}.words{white-space:nowrap}.sentence{min-width:4.5em}"
             "@media(max-width:36rem){td.sentence:nth-child(n+4){min-width:13em}}")
    return ('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            '<link rel="icon" href="data:,">'
            f"<title>Table {table.number}. {html.escape(table.title)}</title>\n<style>{style}</style>"
            f"</head>\n<body>\n<div>{html_fragment(table)}</div></body></html>\n")


# what tables() reads
STEMS = tuple(f"{family}-{lam}" for family in MOTION_FAMILIES for lam in LAMBDAS)
TOLERANCES = {"equilibria and verdicts": "exact",
              "extremes and periods": "roots of the rates and of the reduced potential in balls, "
                                      "rounded once"}
FORMATS = {"txt": text, "csv": comma_separated, "md": markdown, "tex": latex, "html": html_page}


def write_tables(out, tell: Callable[[int, int, str], None] | None = None) -> list[Path]:
    """Write the tables into the folder `out`, one file a format (see FORMATS). tell: as of `tables`. Returns
    the paths."""
    written = []
    for table in tables(tell):
        for name, built in FORMATS.items():
            path = Path(out) / f"{table.stem}.{name}"
            with style.whole_file(path) as waiting:
                waiting.write_text(built(table), encoding="utf-8")
            written.append(path)
    return written
