"""The commands and their options. Each opens one door, to its file in `commands`, which loads cases, asks the analysis and shows the answer."""
from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from .errors import BAD_INPUT, BUG, INTERRUPTED, OK, StabilabError
from .show.terminal import completion
from .show.terminal.groups import Grouped
from .streams import LOST, OutputLost, guarded
from .version import __version__


def _without_commands() -> typer.Typer:
    """A program with plain help: rich costs more time than the rest of `stabilab --help`."""
    return typer.Typer(name="stabilab", cls=Grouped, no_args_is_help=True, rich_markup_mode=None, pretty_exceptions_enable=False,
                       context_settings={"help_option_names": ["-h", "--help"]})


app = _without_commands()

CaseFile = Annotated[Path, typer.Argument(metavar="CASE", help="A case file (TOML).", show_default=False, autocompletion=completion.cases)]
CaseFiles = Annotated[list[Path], typer.Argument(metavar="CASE...", help="Case files (TOML).", show_default=False, autocompletion=completion.cases)]
Json = Annotated[bool, typer.Option("--json", help="JSON on stdout instead of text.")]
Digits = Annotated[int | None, typer.Option(metavar="N", help="Reach N digits (1 to 50) the cheapest way and check them; "
                                                                 "exit 5 where they are not reached. Without it 10 are the aim.")]
Follow = Annotated[str | None, typer.Option(metavar="T", help="How long to follow a motion that only a run with a certificate decides (torque "
                                                             "off the principal axes), with a unit or in the time of the case. Default: a second of work.")]
Prove = Annotated[bool, typer.Option("--certify", help="Enclose the way of a motion that has to be followed, so that its fate is proved; classify --certify "
                                                        "writes the proof down.")]
Tilt = Annotated[str | None, typer.Option(metavar="ANGLE", help="What a tilt of the torque by up to so much, \"1 deg\", does to a motion that a torque on an "
                                                               "axis keeps bounded. By itself where the case states a misalignment or [limits].")]
UnitsOption = Annotated[str | None, typer.Option("--units", metavar="deg|si", autocompletion=completion.units,
                                                 help="deg/s and min, or rad/s and s, in text. Default: [output] units of the case, else deg.")]
Si = Annotated[bool, typer.Option("--si", hidden=True, help="The same as --units si.")]
Why = Annotated[bool, typer.Option("--why", "-v", help="With proofs, derivations and algebra.")]
Strict = Annotated[bool, typer.Option("--strict", help="Exit with 3 where a fate is undecided or an approximate law does not hold "
                                                       "along the motion.")]


def _version(wanted: bool):
    if wanted:
        print(f"stabilab {__version__}", flush=True)
        raise typer.Exit()


@app.callback()
def stabilab(version: Annotated[bool, typer.Option("--version", callback=_version, is_eager=True,
                                                   help="Show the version and exit.")] = False):
    """Where a rotating body's equilibria are, which are stable, and whether a motion stays bounded."""


@app.command()
def show(case: CaseFile):
    """Show the equations of motion and the laws that hold.

    Text and LaTeX; the laws are those of this very scene.

    Example: stabilab show cases/minor-axis-100.toml
    """
    from .commands.show import show as answer
    answer(case)


@app.command()
def classify(cases: CaseFiles, json: Json = False, strict: Annotated[bool, typer.Option(
        "--strict", help="Exit with 3 where a verdict or a fate is undecided or an approximate law does not hold.")] = False,
             certify: Annotated[bool, typer.Option("--certify", help="Prove the answer in exact numbers and balls, and write it as a "
                                                                     "certificate that `stabilab verify` checks.")] = False,
             out: Annotated[Path, typer.Option(metavar="FILE.json", help="Where the certificate goes.")] = Path("certificate.json"),
             follow: Follow = None, tilt: Tilt = None, units: UnitsOption = None, why: Why = False):
    """Find the equilibria, their stability, and the motion's fate.

    Example: stabilab classify cases/minor-axis-100.toml --json
    """
    from .commands.classify import classify as answer
    answer(cases, json, strict, certify, out, follow, tilt, units, why)


@app.command()
def verify(certificate: Annotated[Path, typer.Argument(metavar="CERTIFICATE", help="A certificate.json of classify --certify or bifurcation --certify.",
                                                       show_default=False, autocompletion=completion.certificates)],
           case: Annotated[Path | None, typer.Option(metavar="CASE.toml", help="The case it must be of: exit with 5 where scene or "
                                                        "state differ.")] = None, json: Json = False,
           strict: Annotated[bool, typer.Option("--strict", help="Exit with 3 where a claim could not be checked.")] = False):
    """Check a certificate with separate code.

    Shares only python-flint with the analysis. Exits with 5 where a claim is wrong.

    Example: stabilab verify certificate.json --case cases/minor-axis-100.toml
    """
    from .commands.verify import verify as answer
    answer(certificate, case, json, strict)


@app.command()
def audit(paper: Annotated[str | None, typer.Argument(metavar="[PAPER]", help="A paper on record or a file of claims, .toml; default: all papers.",
                                                      show_default=False, autocompletion=completion.audited)] = None,
          equation: Annotated[str | None, typer.Option(metavar="N", help="One equation or claim, as 17 or text-8a.")] = None, json: Json = False,
          out: Annotated[Path | None, typer.Option("--html", metavar="FILE.html", help="Write a page with the formulas typeset.")] = None):
    """Hold published formulas against the equations of motion.

    Each row: holds, holds only under a condition, wrong (with what is right), definition, or not checkable.

    Example: stabilab audit constant-torque-gyrostat --equation 17
    """
    from .commands.papers import audit as answer
    answer(paper, equation, json, out)


@app.command()
def validate(source: Annotated[str | None, typer.Argument(metavar="[SOURCE]", help="nesc, basilisk, orekit or 42; default: all.", show_default=False,
                                                      autocompletion=completion.sources)] = None,
             json: Json = False,
             out: Annotated[Path | None, typer.Option("--html", metavar="FILE.html", help="Write a page with the table.")] = None):
    """Hold other tools' published numbers against ours.

    Ours with proved digits, theirs, the difference, and its cause. Exits with 5 where a difference is not explained.

    Example: stabilab validate nesc
    """
    from .commands.papers import validate as answer
    answer(source, json, out)


def _either_json_or_csv(json: bool, csv: bool):
    if json and csv:
        raise typer.BadParameter("choose one of --json and --csv")


@app.command()
def extremes(cases: CaseFiles, json: Json = False,
             csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout instead of text.")] = False, digits: Digits = None,
             strict: Strict = False, follow: Follow = None, units: UnitsOption = None, why: Why = False):
    """Find the least and greatest rates of each motion.

    Example: stabilab extremes cases/minor-axis-*.toml --csv
    """
    _either_json_or_csv(json, csv)
    from .commands.questions import answer
    answer("extremes", cases, digits, json, strict, csv, follow, units=units, why=why)


@app.command()
def fate(cases: CaseFiles, json: Json = False, digits: Digits = None, strict: Strict = False, follow: Follow = None, tilt: Tilt = None,
         certify: Prove = False, units: UnitsOption = None, why: Why = False):
    """Say what becomes of each motion, and by how much.

    Digits are those of the margin in energy; the label itself is certain.

    Example: stabilab fate cases/minor-axis-100.toml --digits 30
    """
    from .commands.questions import answer
    answer("fate", cases, digits, json, strict, follow=follow, tilt=tilt, proof=certify, units=units, why=why)


@app.command()
def period(cases: CaseFiles, json: Json = False, digits: Digits = None, strict: Strict = False, units: UnitsOption = None, why: Why = False):
    """Find the period of each motion that repeats.

    Example: stabilab period cases/minor-axis-100.toml --digits 30
    """
    from .commands.questions import answer
    answer("period", cases, digits, json, strict, units=units, why=why)


@app.command()
def simulate(case: CaseFile,
             at: Annotated[str | None, typer.Option(metavar="T1,T2,...", help="Times, with a unit (\"2 min\") or in that of the case; the state is at 0. "
                                                       "Default: 201 times over the span of the case.")] = None,
             model: Annotated[str, typer.Option(autocompletion=completion.models,
                                                help="exact, or an analytic solution that applies: linear, corrected, printed, "
                                                     "averaged1, averaged2, lindstedt.")] = "exact",
             order: Annotated[int | None, typer.Option(min=1, help="Order of the lindstedt expansion.")] = None,
             method: Annotated[str | None, typer.Option(autocompletion=completion.methods, help="taylor (default), a method of SciPy's solve_ivp by name, or "
                                                                "reduced (any time at one cost); for the exact model.")] = None,
             rtol: Annotated[float | None, typer.Option(help="Relative tolerance; default: the method's own.")] = None,
             digits: Annotated[int | None, typer.Option(metavar="N", help="Reach N digits (1 to 15) the cheapest way, check "
                                                           "them, or exit with 5. Without it 10 are the aim, unless "
                                                           "--model, --method or --rtol is given.")] = None,
             angles: Annotated[bool, typer.Option("--angles", help="Euler angles psi, theta, phi of the vertical, too.")] = False,
             out: Annotated[Path | None, typer.Option(metavar="FILE.nc|.csv", help="Write the states to a file.")] = None,
             json: Json = False, strict: Strict = False, units: UnitsOption = None):
    """Follow a motion in time.

    Says how far the run departs from the laws of motion; with --model also what the theory says of the motion.

    Example: stabilab simulate cases/major-axis-100.toml --at 0,5,10,15 --json
    """
    from .commands.simulate import simulate as answer
    answer(case, at, model, order, method, rtol, digits, angles, out, json, strict, units)


@app.command()
def reference(case: CaseFile,
              at: Annotated[str | None, typer.Option(metavar="T1,T2,...", help="Times from 0 on, with a unit or in that of the case. "
                                                                                   "Default: 201 times over the span.")] = None,
              digits: Annotated[int, typer.Option(metavar="N", help="Digits (1 to 50) of every state.")] = 30,
              out: Annotated[Path | None, typer.Option(metavar="FILE.csv|.json", help="Write to a file.")] = None, json: Json = False):
    """Write a motion with guaranteed digits, to test integrators.

    States, zeros and extremes, period, with versions, case and command: CSV, or JSON. Exits with 5 where digits are not reached.

    Example: stabilab reference cases/minor-axis-100.toml --digits 30 --out minor-axis-100.csv
    """
    from .commands.simulate import reference as answer
    answer(case, at, digits, out, json)


@app.command()
def compare(case: CaseFile,
            order: Annotated[int | None, typer.Option(min=1, help="Order of the lindstedt expansion.")] = None,
            out: Annotated[Path | None, typer.Option(metavar="FILE.csv", help="Write the errors over time.")] = None,
            json: Json = False, strict: Strict = False):
    """Set the analytic models of a case beside its exact motion.

    Error over time, and when it first reaches 1 % and 10 %.

    Example: stabilab compare cases/charged-body.toml
    """
    from .commands.accuracy import compare as answer
    answer(case, order, out, json, strict)


@app.command()
def precision(case: CaseFile, json: Json = False,
              csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout instead of text.")] = False,
              out: Annotated[Path | None, typer.Option(metavar="FILE.png|.svg|.pdf|.csv", help="Write the picture or the points.")] = None,
              until: Annotated[str | None, typer.Option(metavar="TIME", help="End of the span: \"10 min\"; default: the case's own.")] = None,
              quick: Annotated[bool, typer.Option("--quick", help="Few settings: seconds instead of a minute.")] = False,
              strict: Strict = False):
    """Measure what accuracy costs: every method, error and time.

    Judged by a Taylor series in many digits that knows its own error.

    Example: stabilab precision cases/minor-axis-100.toml --quick
    """
    _either_json_or_csv(json, csv)
    from .commands.accuracy import precision as answer
    answer(case, json, csv, out, until, quick, strict)


@app.command()
def surface(case: CaseFile, out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the files.")] = ...,  # type: ignore[assignment]  # typer: must be given
            json: Json = False, strict: Strict = False):
    """Write the separatrix surfaces as meshes and a picture.

    Files: .vtp, .glb, .stl, .png, and a summary, .json. Where there is no separatrix, it says why, and no file is written.

    Example: stabilab surface cases/minor-axis-100.toml --out surfaces
    """
    from .commands.pictures import surface as answer
    answer(case, out, json, strict)


@app.command()
def plot(case: CaseFile,
         kind: Annotated[str | None, typer.Option(metavar="KIND", autocompletion=completion.kinds,
                                                  help="time, phase, sphere, space, section, equilibria, budget, state or attitude (moves). "
                                                                       "Default: the one that says most of the case.")] = None,
         out: Annotated[Path | None, typer.Option(metavar="FILE.png|.svg|.pdf", help="Picture to write; default: CASE.png in the current "
                                                  "folder. Of an attitude .html, .gif or .mp4.")] = None,
         size: Annotated[str | None, typer.Option(metavar="WxH", help='Width and height in inches: "8x5".')] = None,
         dpi: Annotated[float | None, typer.Option(metavar="N", help="Dots an inch of a .png; default: 110.")] = None,
         until: Annotated[str | None, typer.Option(metavar="TIME", help='Draw up to this time: "10 min".')] = None,
         neighbours: Annotated[int, typer.Option(metavar="N", help="Of a section: so many motions beside this one.")] = 0,
         units: UnitsOption = None, strict: Strict = False):
    """Draw a case: rates over time, phase plane, separatrix, more.

    Of a FILE.nc of stabilab sweep it draws the map; --kind is then a column.
    The same case gives the same bytes. What a case has no plot of is refused, with the kinds that it has.

    Example: stabilab plot cases/middle-axis-double-well.toml --kind time --out double-well.svg
    """
    from .commands.pictures import plot as answer
    answer(case, kind, out, size, dpi, until, neighbours, units, strict)


@app.command()
def sweep(case: CaseFile,
          vary: Annotated[list[str] | None, typer.Option(metavar="KEY=VALUES", help='A number that varies: "torque[3]=0:0.1:101", '
                                                         '"motion.angular_velocity[1]=-30:30:61 deg/s", "speed=1:1000:31:log rpm", "torque[1]=0, 1, 2". Up to '
                                                         'four.')] = None,
          samples: Annotated[int | None, typer.Option(metavar="N", help="Random points over the uncertainties that the case states.")] = None,
          seed: Annotated[int, typer.Option(metavar="S", help="Of the random points.")] = 1,
          answer: Annotated[str | None, typer.Option(metavar="A,B,...", help="fate, level, reason, island, margin, distance, extremes, period, when, "
                                                     "equilibria, verdict, chaos. Default: fate,level,margin.")] = None,
          out: Annotated[Path | None, typer.Option(metavar="FILE.nc", help="Write NetCDF. What is finished outlives a killed run: the same command goes "
                                                   "on.")] = None,
          workers: Annotated[int | None, typer.Option(metavar="N", help="Processes that share the work; default: one a core where that pays.")] = None,
          scheduler: Annotated[str | None, typer.Option(metavar="tcp://...", help="Let the workers of this Dask scheduler do it (extra cluster).")] = None,
          rate: Annotated[str | None, typer.Option(metavar="RATE", help="Limits of the answer when, as of stabilab when.")] = None,
          component: Annotated[str | None, typer.Option(metavar="AXIS=RATE", hidden=True)] = None,
          energy: Annotated[str | None, typer.Option(metavar="ENERGY", hidden=True)] = None,
          tilt: Annotated[str | None, typer.Option(metavar="AXIS=ANGLE", hidden=True)] = None,
          until: Annotated[str | None, typer.Option(metavar="TIME", hidden=True)] = None,
          follow: Follow = None,
          csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout: a line for each point.")] = False, json: Json = False,
          strict: Annotated[bool, typer.Option("--strict", help="Exit with 3 where a fate is undecided.")] = False):
    """Answer a case over ranges of its numbers.

    A map of fates, margins, extremes, equilibria, by short names of the numbers where these are unique.

    Example: stabilab sweep cases/minor-axis-100.toml --vary "x[1]=-4:4:101" --vary "x[3]=-3:3:101" --out map.nc
    """
    _either_json_or_csv(json, csv)
    from .commands.maps import sweep as run
    limits = {"rate": rate, "component": component, "energy": energy, "tilt": tilt, "until": until}
    run(case, vary, samples, seed, answer, follow, limits, out, workers, scheduler, csv, json, strict)


@app.command()
def chaos(cases: CaseFiles,
          until: Annotated[str | None, typer.Option(metavar="TIME", help="How long each motion is followed; default: a thousand turns.")] = None,
          out: Annotated[Path | None, typer.Option(metavar="FILE.png|.svg|.pdf", help="Draw the Poincaré section and MEGNO over its plane.")] = None,
          csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout: MEGNO over time.")] = False, json: Json = False,
          strict: Annotated[bool, typer.Option("--strict", help="Exit with 3 where it stays undecided.")] = False):
    """Say whether each motion is regular or chaotic.

    By how a small change of the start grows (MEGNO), from variational equations of the case's own; seen up to a time, not proved.

    Example: stabilab chaos cases/minor-axis-100.toml
    """
    _either_json_or_csv(json, csv)
    from .commands.pictures import chaos as answer
    answer(cases, until, out, csv, json, strict)


@app.command()
def bifurcation(case: CaseFile,
                vary: Annotated[list[str] | None, typer.Option(metavar="KEY=FROM:TO", help='A number that varies: "torque[3]=0:0.5", '
                                                               '"wheels.pitch.speed=-3000:3000 rpm". One or two.')] = None,
                curve: Annotated[bool, typer.Option("--curve", help="Of a torque on a principal axis: where stability changes along the whole curve of "
                                                                    "equilibria, whatever the motion.")] = False,
                out: Annotated[Path | None, typer.Option(metavar="FILE.png", help="Draw it: .png, .svg or .pdf.")] = None,
                certify: Annotated[Path | None, typer.Option(metavar="FILE.json", help="Of one number: write a certificate of every value and count, which "
                                                             "`stabilab verify` checks by other algebra.")] = None,
                csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout: points of all branches.")] = False, json: Json = False):
    """Find where equilibria appear and vanish.

    Exactly, over the range of one number or two: folds and what else there is are roots of discriminants, none is missed.

    Example: stabilab bifurcation cases/wheel-and-thruster.toml --vary "torque[3]=0:2000"
    """
    _either_json_or_csv(json, csv)
    from .commands.maps import bifurcation as answer
    answer(case, vary, curve, out, certify, csv, json)


@app.command()
def basin(case: CaseFile,
          vary: Annotated[list[str] | None, typer.Option(metavar="KEY=FROM:TO[:N]", help='A rate of the initial state and its range: "x[1]=-4:4", '
                                                         '"angular_velocity[3]=-30:30:33 deg/s" for 33 points of the coarse grid. Two of them.')] = None,
          depth: Annotated[int, typer.Option(metavar="K", help="How often a cell is halved whose corners have different fates.")] = 5,
          out: Annotated[list[Path] | None, typer.Option(metavar="FILE.png|.svg|.pdf|.nc", help="Draw, or write NetCDF, whose parts outlive a killed run; may "
                                                         "be repeated.")] = None,
          workers: Annotated[int | None, typer.Option(metavar="N", help="Processes that share the work; default: one a core where that pays.")] = None,
          scheduler: Annotated[str | None, typer.Option(metavar="tcp://...", help="Let the workers of this Dask scheduler do it (extra cluster).")] = None,
          follow: Follow = None,
          csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout: a line for each cell.")] = False, json: Json = False,
          strict: Annotated[bool, typer.Option("--strict", help="Exit with 3 where a fate is undecided.")] = False):
    """Show which initial states spin up, and how rough the edge is.

    A plane of states in cells that get smaller towards the boundary between fates; shares, the exact separatrix, box dimension.

    Example: stabilab basin cases/minor-axis-100.toml --vary "x[1]=-4:4" --vary "x[3]=-3:3" --out basin.png
    """
    _either_json_or_csv(json, csv)
    from .commands.maps import basin as answer
    answer(case, vary, depth, out, workers, scheduler, follow, csv, json, strict)


@app.command()
def atlas(case: CaseFile,
          torque: Annotated[str | None, typer.Option(metavar="SIZE", help='Size of the torque: "1 N m". Default: that of the case.')] = None,
          wheel: Annotated[str | None, typer.Option(metavar="[AXIS=]VALUES", help='Wheel momenta beside each of which all directions are asked: "0:2:5" along '
                                                    'the wheel of the case, "z=-2:2:5" (x, y, z of the file, or 1, 2, 3). Default: as in the case.')] = None,
          level: Annotated[int, typer.Option(metavar="N", help="8 times 4^N cells of equal area at first.")] = 3,
          refine: Annotated[int, typer.Option(metavar="N", help="How often cells along a boundary are cut in four.")] = 2,
          rate: Annotated[str | None, typer.Option(metavar="RATE", help="Limit whose time is asked, as of stabilab when; default: that of [limits].")] = None,
          component: Annotated[str | None, typer.Option(metavar="AXIS=RATE", hidden=True)] = None,
          energy: Annotated[str | None, typer.Option(metavar="ENERGY", hidden=True)] = None,
          tilt: Annotated[str | None, typer.Option(metavar="AXIS=ANGLE", hidden=True)] = None,
          until: Annotated[str | None, typer.Option(metavar="TIME", hidden=True)] = None,
          no_time: Annotated[bool, typer.Option("--no-time", help="Leave out the time to a limit, which takes most of the work.")] = False,
          certify: Annotated[bool, typer.Option("--certify", help="Prove fates and times where that succeeds, whatever it takes.")] = False,
          out: Annotated[list[Path] | None, typer.Option(metavar="FILE.nc|.png|.svg|.pdf|.html", help="Write cells, a picture or a page that answers the "
                                                         "pointer; may be given again. What is finished outlives a killed run.")] = None,
          workers: Annotated[int | None, typer.Option(metavar="N", help="Processes that share the work; default: one a core where that pays.")] = None,
          scheduler: Annotated[str | None, typer.Option(metavar="tcp://...", help="Let the workers of this Dask scheduler do it (extra cluster).")] = None,
          follow: Follow = None, units: UnitsOption = None,
          csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout: a line for each cell.")] = False, json: Json = False,
          strict: Annotated[bool, typer.Option("--strict", help="Exit with 3 where a fate is undecided.")] = False):
    """Map all directions of a torque: fates, axes, times.

    Cells of equal area on the sphere, smaller ones along the boundaries; principal axes and thrusters stand on it as points.

    Example: stabilab atlas cases/cubesat-3u.toml --out atlas.png
    """
    _either_json_or_csv(json, csv)
    from .commands.maps import atlas as answer
    limits = {"rate": rate, "component": component, "energy": energy, "tilt": tilt, "until": until}
    answer(case, torque, wheel, level, refine, certify, follow, not no_time, limits, out, workers, scheduler, units, csv, json, strict)


@app.command()
def explore(case: Annotated[Path | None, typer.Argument(metavar="[CASE]", help="A case file (TOML). Default: one that stabilab brings.", show_default=False,
                                                           autocompletion=completion.cases)] = None,
            port: Annotated[int, typer.Option(metavar="N", min=0, max=65535, help="Port of this machine; 0: a free one.")] = 0,
            browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page, or only print its address.")] = True,
            static: Annotated[Path | None, typer.Option(metavar="DIR", help="Write the page as a folder for any web server: "
                                                                           "Python answers in the browser.")] = None,
            pyodide: Annotated[Path | None, typer.Option(metavar="DIR", help="With --static: a folder with Pyodide and python-flint's wheel, to be "
                                                                            "copied in. Without: loaded from where they are published.")] = None):
    """Move a case by hand: sliders, and the verdict follows.

    Separatrix, equilibria, motion, phase plane and rates over time; the verdict changes as you drag. The page is served to this machine alone, under an
    address with a random token, until Ctrl-C.

    Example: stabilab explore cases/thruster-stuck-major-axis.toml --no-browser
    """
    if pyodide is not None and static is None:
        raise typer.BadParameter("--pyodide belongs to --static")
    from .commands.pictures import explore as answer
    answer(case, port, browser, static, pyodide)


@app.command()
def when(cases: CaseFiles,
         rate: Annotated[str | None, typer.Option(metavar="RATE", help='Of |omega|: "30 deg/s". Default: the limit of [limits].')] = None,
         component: Annotated[str | None, typer.Option(metavar="AXIS=RATE", help='Of one component\'s size: "z = 30 deg/s"; x, y, z of the file, '
                                                                                 '1, 2, 3 for principal axes.')] = None,
         energy: Annotated[str | None, typer.Option(metavar="ENERGY", help='Of the kinetic energy: "5 J".')] = None,
         tilt: Annotated[str | None, typer.Option(metavar="AXIS=ANGLE", help='Of the angle between a body axis and its direction at the start: '
                                                                             '"z = 20 deg".')] = None,
         until: Annotated[str | None, typer.Option(metavar="TIME", help='Search no further than this: "10 min".')] = None,
         units: UnitsOption = None, si: Si = False,
         json: Json = False, csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout instead of text.")] = False,
         strict: Annotated[bool, typer.Option("--strict", help="Exit with 3 where the time is not known or an approximate law does not hold.")] = False):
    """Say when each motion first reaches a limit.

    Enclosed between two times, by roots and not by sampling, or never.

    Example: stabilab when cases/cubesat-3u.toml --rate "30 deg/s"
    """
    _either_json_or_csv(json, csv)
    from .commands.when import when as answer
    limits = {"rate": rate, "component": component, "energy": energy, "tilt": tilt, "until": until}
    answer(cases, limits, "si" if si else units, json, csv, strict)


@app.command()
def stuck(case: CaseFile,
          all_thrusters: Annotated[bool, typer.Option("--all-thrusters", help="Each thruster alone, stuck or not; the one that reaches "
                                                                              "the limit first in front.")] = False,
          units: UnitsOption = None, si: Si = False, why: Why = False,
          out: Annotated[Path | None, typer.Option(metavar="FILE.png|.svg|.pdf", help="Draw the rates against time.")] = None,
          json: Json = False, csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout instead of text.")] = False,
          strict: Annotated[bool, typer.Option("--strict", help="Exit with 3 where a fate is undecided.")] = False):
    """Say what a thruster stuck open does, how soon, what helps.

    Fate, axis, time to the limit of [limits], margins; wheel momenta that keep the motion bounded, thrusters that help.

    Example: stabilab stuck cases/upper-stage.toml
    """
    _either_json_or_csv(json, csv)
    from .commands.stuck import stuck as answer
    answer(case, all_thrusters, "si" if si else units, why, out, json, csv, strict)


@app.command()
def tables(out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the files.")] = ...):  # type: ignore[assignment]  # typer: must be given
    """Write Tables 1-4 of the constant-torque paper.

    Formats: text, CSV, Markdown, LaTeX, HTML.

    Example: stabilab tables --out tables
    """
    from .commands.papers import tables as answer
    answer(out)


@app.command()
def figures(numbers: Annotated[list[int] | None, typer.Argument(
                metavar="[N...]", help="Figure numbers of one paper; none: all.", show_default=False)] = None,
            paper: Annotated[str | None, typer.Option(metavar="NAME", autocompletion=completion.papers,
                                                      help="constant-torque, charged, cavity or top. Default: "
                                                         "constant-torque where numbers are given, else all.")] = None,
            out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the pictures.")] = Path("figures")):
    """Draw the figures of the papers.

    Each picture gets a text file: caption, command, version, tolerance.

    Example: stabilab figures --paper charged 2 8 --out figures
    """
    from .commands.papers import figures as answer
    answer(numbers, paper, out)


@app.command()
def report(cases: Annotated[list[Path] | None, typer.Argument(
               metavar="[CASE...]", help="Case files; none: everything that stabilab brings.", show_default=False,
               autocompletion=completion.cases)] = None,
           out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the report.")] = Path("report"),
           papers: Annotated[bool, typer.Option("--papers", help="The papers' tables and figures, the audit of their formulas and other "
                                                                 "tools' numbers as well: minutes.")] = False,
           precision: Annotated[bool, typer.Option("--precision", help="What accuracy costs, too.")] = False,
           certify: Annotated[bool, typer.Option("--certify", help="A certificate of each case, checked, too.")] = False,
           workers: Annotated[int | None, typer.Option(metavar="N", min=1, help="Processes that share the work; default: one a core.")] = None,
           strict: Strict = False):
    """Write a report on your cases: web pages.

    Verdict, margins, rates over time, phase plane, separatrix, equilibria, what would change the fate, equations. The folder needs
    no network: open its index.html.

    Example: stabilab report cases/minor-axis-100.toml --out report
    """
    from .commands.report import report as answer
    answer(cases, out, papers, precision, certify, workers, strict)


@app.command()
def rerun(manifest: Annotated[Path, typer.Argument(metavar="MANIFEST", help="A manifest.json, or the folder that holds it.",
                                                   show_default=False, autocompletion=completion.certificates)],
          out: Annotated[Path | None, typer.Option(metavar="DIR", help="Keep the new files in an empty folder.")] = None):
    """Repeat what made a folder and compare every byte.

    Exits with 2 where inputs are missing or changed, with 5 where a file differs.

    Example: stabilab rerun report/manifest.json
    """
    from .commands.report import rerun as answer
    answer(manifest, out)


@app.command(name="import")
def import_(file: Annotated[Path, typer.Argument(metavar="FILE", help="A NASA 42 spacecraft file, or JSON or a Python dictionary with "
                                                                      "Basilisk's names.", show_default=False)],
            out: Annotated[Path | None, typer.Option(metavar="FILE.toml", help="Write the case to a file.")] = None,
            stuck: Annotated[list[str] | None, typer.Option(metavar="NAME", help="A thruster that is stuck open; may be repeated.")] = None):
    """Write another program's spacecraft as a case.

    What has no counterpart in a case is listed on stderr. Exits with 2 where the case still has faults.

    Example: stabilab import SC_Simple.txt --out simple.toml
    """
    from .commands.foreign import import_ as answer
    answer(file, out, stuck)


@app.command()
def doctor():
    """Say what is installed and whether pictures can be drawn.

    Example: stabilab doctor
    """
    from .commands.doctor import doctor as answer
    answer()


def _say(text: str):
    """A message for people to stderr, wrapped to a terminal."""
    from .show.terminal.page import say
    say(text)


def asked_for(words) -> typer.Typer:
    """The commands as far as a line asks for them: those it names as they are, of all others the name and the help.

    Typer evaluates and inspects every option of every command that it is given, which takes longer than to import typer. A shell that
    completes a line names no command in it, and gets them all.
    """
    if any(name.startswith("_") and name.endswith("_COMPLETE") for name in os.environ):
        return app
    needed = _without_commands()
    needed.registered_callback = app.registered_callback
    for command in app.registered_commands:
        name = command.name or command.callback.__name__
        if name in words:
            needed.registered_commands.append(command)
        else:
            needed.command(name, help=command.callback.__doc__)(lambda: None)
    return needed


def main() -> None:
    """Run a command and end the process with its exit code."""
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")  # a terminal or pipe that does not take every letter
    with guarded():
        sys.exit(_run())


def _run() -> int:
    try:
        asked_for(sys.argv[1:])()
        return OK
    except StabilabError as error:
        return _reported(error)
    except KeyboardInterrupt:
        return INTERRUPTED
    except ImportError as error:
        from .packages import explained
        words = explained(error)
        return _reported(words) if words else _unexpected(error)
    except OSError as error:
        if error.errno in LOST and not error.filename:  # written past the guard of stdout
            return _reported(OutputLost(error.errno))
        _say(f"{error.filename or 'stabilab'}: {error.strerror or error}")
        return BAD_INPUT if error.filename else BUG
    except Exception as error:
        return _unexpected(error)


def _reported(error: StabilabError) -> int:
    if str(error):
        _say(str(error))
    return error.exit_code


def _unexpected(error: Exception) -> int:
    if os.environ.get("STABILAB_DEBUG") == "1":
        import traceback
        traceback.print_exc()
    else:
        _say(f"stabilab failed unexpectedly: {type(error).__name__}: {error}\n"
             "This is a fault of the program. Set STABILAB_DEBUG=1 to see where it happened.")
    return BUG
