"""The commands: each loads its cases, asks the analysis, and shows the answer. Data to stdout, messages to stderr."""
from __future__ import annotations

import os
import sys
from functools import partial
from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from .errors import BAD_INPUT, BUG, INTERRUPTED, OK, UNDECIDED, InputError, RenderingUnavailable, StabilabError, ToleranceNotMet, printable
from .show.terminal import completion
from .show.terminal.groups import Grouped
from .streams import LOST, OutputLost, guarded


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
        from .version import __version__
        _print(f"stabilab {__version__}")
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
    from .show.text.scene_text import text
    _show("\n\n".join(text(one) for one in _load([case])))


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
    from .show.text import answers, law
    loaded = _load(cases)
    systems = _systems(loaded, units)
    if certify:
        from .show.text import certification
        certification.checked(out)
        if len(cases) != 1:
            raise InputError(f"--certify: expected one case, got {len(cases)}; certify them one by one")
    answered = [(case, _equilibria(case), _tilted(case, _motion(case, follow=follow, proof=certify), tilt) if case.state else None)
                for case in _each(loaded)]
    boxes, shown = _over_boxes(loaded, "equilibria", "fate")
    laws = [law.worst(found.validity, motion and motion.validity) for _, found, motion in answered]
    if json:
        _print(answers.as_json([answers.classification(*answer) | law.key(held) | shown.as_dict(box)
                                for answer, held, box in zip(answered, laws, boxes)]))
    else:
        from .show.terminal import classification
        texts = [lambda n=n: classification.text(*answered[n], systems[n], why) for n in range(len(answered))]
        _tell_all(loaded, texts, laws, [shown.text(box) for box in boxes], why, "\n\n", _swept_motions([m for *_, m in answered], systems))
    certified = all([_certified(case, out) for case in loaded]) if certify else True
    undecided = any(answers.undecided(found, motion) for _, found, motion in answered) or any(map(shown.undecided, boxes))
    if strict and (not certified or undecided or law.beyond(*laws)):
        raise typer.Exit(UNDECIDED)


@app.command()
def verify(certificate: Annotated[Path, typer.Argument(metavar="CERTIFICATE", help="A certificate.json of classify --certify.",
                                                       show_default=False, autocompletion=completion.certificates)],
           case: Annotated[Path | None, typer.Option(metavar="CASE.toml", help="The case it must be of: exit with 5 where scene or "
                                                        "state differ.")] = None, json: Json = False,
           strict: Annotated[bool, typer.Option("--strict", help="Exit with 3 where a claim could not be checked.")] = False):
    """Check a certificate with separate code.

    Shares only python-flint with the analysis. Exits with 5 where a claim is wrong.

    Example: stabilab verify certificate.json --case cases/minor-axis-100.toml
    """
    from .show.text import answers, certification
    from .verify import verify as check
    from .verify.about import about, line
    from .verify.form import read
    from .verify.numbers import Malformed
    cases = _load([case]) if case else []
    try:
        claims = read(certificate)
        found = check(claims)
    except (Malformed, UnicodeDecodeError) as error:
        raise InputError(f"{certificate}: {error}; expected a certificate of stabilab classify --certify") from None
    told = about(claims)
    _either(json, lambda: answers.as_json(certification.as_dict(found, told)), lambda: certification.text(found, line(told)))
    if found.status == "refuted":
        raise ToleranceNotMet(f"{certificate}: a claim is wrong")
    if cases:
        _about_one_of(cases, told, certificate)
    if strict and found.status != "proved":
        raise typer.Exit(UNDECIDED)


@app.command()
def audit(paper: Annotated[str | None, typer.Argument(metavar="[PAPER]", help="A paper on record or a file of claims, .toml; default: all papers.",
                                                      show_default=False, autocompletion=completion.audited)] = None,
          equation: Annotated[str | None, typer.Option(metavar="N", help="One equation or claim, as 17 or text-8a.")] = None, json: Json = False,
          out: Annotated[Path | None, typer.Option("--html", metavar="FILE.html", help="Write a page with the formulas typeset.")] = None):
    """Hold published formulas against the equations of motion.

    Each row: holds, holds only under a condition, wrong (with what is right), definition, or not checkable.

    Example: stabilab audit constant-torque-gyrostat --equation 17
    """
    from .show.progress import counted
    from .show.text import answers
    from .show.text import audit as shown
    from .theories.audit import audited
    with counted() as tell:
        findings = audited(paper, equation, tell)
    if out is not None:
        from .show.report.audit_page import page
        _say(f"written: {page(findings, out)}")
    _either(json, lambda: answers.as_json(shown.as_dict(findings)), lambda: shown.text(findings))


@app.command()
def validate(source: Annotated[str | None, typer.Argument(metavar="[SOURCE]", help="nesc, basilisk, orekit or 42; default: all.", show_default=False,
                                                      autocompletion=completion.sources)] = None,
             json: Json = False,
             out: Annotated[Path | None, typer.Option("--html", metavar="FILE.html", help="Write a page with the table.")] = None):
    """Hold other tools' published numbers against ours.

    Ours with proved digits, theirs, the difference, and its cause. Exits with 5 where a difference is not explained.

    Example: stabilab validate nesc
    """
    from .show.outside import validation as shown
    from .show.progress import counted
    from .show.text import answers
    from .theories.validation import validated
    with counted() as tell:
        found = validated(source, tell)
    if out is not None:
        _say(f"written: {shown.page(found, out)}")
    _either(json, lambda: answers.as_json(shown.as_dict(found)), lambda: shown.text(found))
    if apart := shown.unexplained(found):
        raise ToleranceNotMet("\n".join(apart))


@app.command()
def extremes(cases: CaseFiles, json: Json = False,
             csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout instead of text.")] = False, digits: Digits = None,
             strict: Strict = False, follow: Follow = None, units: UnitsOption = None, why: Why = False):
    """Find the least and greatest rates of each motion.

    Example: stabilab extremes cases/minor-axis-*.toml --csv
    """
    if json and csv:
        raise typer.BadParameter("choose one of --json and --csv")
    _tell("extremes", cases, digits, json, strict, csv, follow, units=units, why=why)


@app.command()
def fate(cases: CaseFiles, json: Json = False, digits: Digits = None, strict: Strict = False, follow: Follow = None, tilt: Tilt = None,
         certify: Prove = False, units: UnitsOption = None, why: Why = False):
    """Say what becomes of each motion, and by how much.

    Digits are those of the margin in energy; the label itself is certain.

    Example: stabilab fate cases/minor-axis-100.toml --digits 30
    """
    _tell("fate", cases, digits, json, strict, follow=follow, tilt=tilt, proof=certify, units=units, why=why)


@app.command()
def period(cases: CaseFiles, json: Json = False, digits: Digits = None, strict: Strict = False, units: UnitsOption = None, why: Why = False):
    """Find the period of each motion that repeats.

    Example: stabilab period cases/minor-axis-100.toml --digits 30
    """
    _tell("period", cases, digits, json, strict, units=units, why=why)


@app.command()
def simulate(case: CaseFile,
             at: Annotated[str | None, typer.Option(metavar="T1,T2,...", help="Times; the state is at 0. "
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
    from .show.files import trajectory_files
    loaded = _load([case], motion=True)
    systems = _systems(loaded, units)
    if out:
        trajectory_files.checked(out)
    runs = [(one, *_followed(one, _times(one, at), model, method, rtol, order, digits)) for one in _each(loaded)]
    if angles:
        runs = [(one, _with_angles(one, run, model, order), reached) for one, run, reached in runs]
    if out:
        _write_each(out, [(one, partial(trajectory_files.write, one, run)) for one, run, _ in runs])
    if json:
        _print_json(loaded, [_run_as_dict(*followed) for followed in runs])
    elif not out:
        from .show.terminal import page
        page.tell("\n\n".join(_run_as_text(*followed, digits, system, page.width()) for followed, system in zip(runs, systems)))
    else:
        _say_laws(run.validity for _, run, _ in runs)
        _say_digits(runs)
    _judge_runs(runs, digits)
    _strictly(strict, (run.validity for _, run, _ in runs))


@app.command()
def reference(case: CaseFile,
              at: Annotated[str | None, typer.Option(metavar="T1,T2,...", help="Times from 0 on. Default: 201 times over the span of the case.")] = None,
              digits: Annotated[int, typer.Option(metavar="N", help="Digits (1 to 50) of every state.")] = 30,
              out: Annotated[Path | None, typer.Option(metavar="FILE.csv|.json", help="Write to a file.")] = None, json: Json = False):
    """Write a motion with guaranteed digits, to test integrators.

    States, zeros and extremes, period, with versions, case and command: CSV, or JSON. Exits with 5 where digits are not reached.

    Example: stabilab reference cases/minor-axis-100.toml --digits 30 --out minor-axis-100.csv
    """
    from .case.read import blamed_on
    from .show.outside import reference as shown
    from .show.text import answers
    loaded, made = _load([case], motion=True), []
    if out:
        shown.checked(out)
    for one in loaded:
        with blamed_on(one):
            made.append((one, *shown.as_dict(one, _exact_times(one, at), digits, sys.argv[1:])))
    if out:
        _write_each(out, [(one, partial(shown.write, found)) for one, found, _ in made])
    else:
        _print(answers.as_json([found for _, found, _ in made] if len(made) > 1 else made[0][1]) if json
               else "".join(shown.csv(found) for _, found, _ in made).rstrip("\n"))
    _all_reached(short for one in made for short in shown.missing(*one))


@app.command()
def compare(case: CaseFile,
            order: Annotated[int | None, typer.Option(min=1, help="Order of the lindstedt expansion.")] = None,
            out: Annotated[Path | None, typer.Option(metavar="FILE.csv", help="Write the errors over time.")] = None,
            json: Json = False, strict: Strict = False):
    """Set the analytic models of a case beside its exact motion.

    Error over time, and when it first reaches 1 % and 10 %.

    Example: stabilab compare cases/charged-body.toml
    """
    from .show.text import comparison, law
    loaded = _load([case], motion=True)
    if out:
        comparison.checked(out)
    compared = [(one, _compared(one, order)) for one in _each(loaded)]
    if out:
        _write_each(out, [(one, partial(comparison.write, one, found)) for one, found in compared])
    if json:
        _print_json(loaded, [comparison.as_dict(one, found) | law.key(found.validity) for one, found in compared])
    else:
        _show("\n\n".join(law.first(found.validity, comparison.text(one, found)) for one, found in compared))
    _strictly(strict, (found.validity for _, found in compared))


@app.command()
def precision(case: CaseFile, json: Json = False,
              csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout instead of text.")] = False,
              out: Annotated[Path | None, typer.Option(metavar="FILE.png|.svg|.pdf|.csv", help="Write the picture or the points.")] = None,
              until: Annotated[float | None, typer.Option(metavar="T", help="End of the span; default: the case's own.")] = None,
              quick: Annotated[bool, typer.Option("--quick", help="Few settings: seconds instead of a minute.")] = False,
              strict: Strict = False):
    """Measure what accuracy costs: every method, error and time.

    Judged by a Taylor series in many digits that knows its own error.

    Example: stabilab precision cases/minor-axis-100.toml --quick
    """
    if json and csv:
        raise typer.BadParameter("choose one of --json and --csv")
    from .answers.digits.front import keep
    from .cost.accuracy import precision as measure
    from .show.text import law
    from .show.text import precision as shown
    if out:
        shown.checked(out)
    loaded = _load([case], motion=True)
    measured = [measure(one, "quick" if quick else "full", until) for one in _each(loaded)]
    for found in measured:
        keep(found)
    if out:
        _write_each(out, [(found.case, partial(shown.write, found)) for found in measured])
    if json:
        _print_json(loaded, [shown.as_dict(found) | law.key(found.validity) for found in measured])
    elif csv:
        _say_laws(found.validity for found in measured)
        _print(shown.csv(*measured))
    else:
        _show("\n\n".join(law.first(found.validity, shown.text(found)) for found in measured))
    _all_reached((found.case, found.reference.reason) for found in measured if not found.questions)
    _strictly(strict, (found.validity for found in measured))


@app.command()
def surface(case: CaseFile, out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the files.")] = ...,  # type: ignore[assignment]  # typer: must be given
            strict: Strict = False):
    """Write the separatrix surfaces as meshes and a picture.

    Files: .vtp, .glb, .stl, .png; a summary goes to stdout (JSON). Where there is no separatrix, it says why, and no
    file is written.

    Example: stabilab surface cases/minor-axis-100.toml --out surfaces
    """
    from .show.surface.write import write_all
    from .show.text import law
    loaded, unavailable = _load([case]), None
    laws = [law.of_case(one) for one in loaded]
    try:
        summaries = write_all(loaded, out, arguments=sys.argv[1:])
    except RenderingUnavailable as error:
        if not hasattr(error, "summaries"):
            raise
        summaries, unavailable = error.summaries, error
    _print_json(loaded, [summary | law.key(held) for summary, held in zip(summaries, laws)])
    for one, summary in zip(loaded, summaries):
        if not summary["sheets"]:
            _say(f"{one.name}: no surface to write: {summary['reason']}")
    if unavailable:
        raise unavailable
    _strictly(strict, laws)


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
    from .case.read import blamed_on
    from .show.files import endings
    from .show.plot.to_file import default_name, inches, write
    from .show.text import law
    if case.suffix.lower() == ".nc":
        from .show.maps import picture
        from .show.maps.atlas import to_file
        if to_file.is_atlas(case):
            _print(str(to_file.redrawn(case, out or Path(f"{printable(case.stem)}.png"), kind, inches(size), dpi, units)))
            return
        _print(str(picture.write(case, out or Path(f"{printable(case.stem)}.png"), kind, inches(size), dpi)))
        return
    loaded, drawn = _load([case], motion=kind != "equilibria"), []
    _systems(loaded, units)  # says what is wrong with them
    target = out or Path(default_name(printable(case.stem), kind))
    for one in loaded:
        with blamed_on(one):
            end = _time(until, one, "until")
            drawn.append(write(one, endings.labelled(target, one), kind, inches(size), dpi, units, end, neighbours))
    laws = [law.of_case(one) for one in loaded]
    _print("\n".join(words for held, path in zip(laws, drawn) for words in (held and held.words, str(path)) if words))
    _strictly(strict, laws)


@app.command()
def sweep(case: CaseFile,
          vary: Annotated[list[str] | None, typer.Option(metavar="KEY=VALUES", help='A number that varies: "torque[3]=0:0.1:101", '
                                                         '"motion.angular_velocity[1]=-30:30:61 deg/s", "speed=1:1000:31:log rpm", "torque[1]=0, 1, 2". Up to '
                                                         'four.')] = None,
          samples: Annotated[int | None, typer.Option(metavar="N", help="Random points over the uncertainties that the case states.")] = None,
          seed: Annotated[int, typer.Option(metavar="S", help="Of the random points.")] = 1,
          answer: Annotated[str | None, typer.Option(metavar="A,B,...", help="fate, level, reason, margin, distance, extremes, period, when, equilibria, "
                                                     "verdict. Default: fate,level,margin.")] = None,
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
    if json and csv:
        raise typer.BadParameter("choose one of --json and --csv")
    from .maps.plan import planned, split_keys
    from .maps.run import run
    from .show.maps import words
    plan = planned(case, split_keys(vary or []), samples, seed, answer, follow, rate=rate, component=component, energy=energy, tilt=tilt, until=until)
    if out:
        from .show.maps import dataset
        dataset.checked(out)
    with run(plan, out, workers, scheduler) as found:
        if out:
            _say(f"written: {dataset.write(dataset.dataset(found), out)}")
    if json or csv:
        _print(words.json(found) if json else words.csv(found))
    else:
        _show(words.text(found))
    if strict and words.undecided(found):
        raise typer.Exit(UNDECIDED)


@app.command()
def bifurcation(case: CaseFile,
                vary: Annotated[list[str] | None, typer.Option(metavar="KEY=FROM:TO", help='A number that varies: "torque[3]=0:0.5", '
                                                               '"wheels.pitch.speed=-3000:3000 rpm". One or two.')] = None,
                curve: Annotated[bool, typer.Option("--curve", help="Of a torque on a principal axis: where stability changes along the whole curve of "
                                                                    "equilibria, whatever the motion.")] = False,
                out: Annotated[Path | None, typer.Option(metavar="FILE.png", help="Draw it: .png, .svg or .pdf.")] = None,
                csv: Annotated[bool, typer.Option("--csv", help="CSV on stdout: points of all branches.")] = False, json: Json = False):
    """Find where equilibria appear and vanish.

    Exactly, over the range of one number or two: folds and what else there is are roots of discriminants, none is missed.

    Example: stabilab bifurcation cases/wheel-and-thruster.toml --vary "torque[3]=0:2000"
    """
    if json and csv:
        raise typer.BadParameter("choose one of --json and --csv")
    from .maps.bifurcation.ask import bifurcation as ask
    from .maps.bifurcation.result import Diagram
    from .maps.plan import split_keys
    from .show.files import endings
    from .show.maps.bifurcation import plane_words, words
    if out:
        endings.file(out, endings.PICTURES)
    found = ask(case, split_keys(vary or []), curve)
    if out:
        from .show.maps.bifurcation import picture, plane_picture
        _say(f"written: {(picture if isinstance(found, Diagram) else plane_picture).write(found, out)}")
    told = words if isinstance(found, Diagram) else plane_words
    if json or csv:
        _print(told.json(found) if json else told.csv(found))
    else:
        _show(told.text(found))


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
    if json and csv:
        raise typer.BadParameter("choose one of --json and --csv")
    from .maps.basins.ask import basins
    from .maps.plan import split_keys
    from .show.maps.basins import words
    from .show.maps.basins.write import checked, write
    targets = checked(out or [])
    with basins(case, split_keys(vary or []), depth, targets.data, workers, scheduler, follow) as found:
        for path in targets.paths:
            _say(f"written: {write(found, path)}")
    if json or csv:
        _print(words.json(found) if json else words.csv(found))
    else:
        _show(words.text(found))
    if strict and words.undecided(found):
        raise typer.Exit(UNDECIDED)


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
    if json and csv:
        raise typer.BadParameter("choose one of --json and --csv")
    from .maps.atlas.asked import asked
    from .maps.atlas.run import drawn
    from .show.maps.atlas import to_file, words
    from .show.units import units_of
    plan = asked(case, torque, wheel, level, refine, certify, follow, rate=rate, component=component, energy=energy, tilt=tilt, until=until)
    system, targets = units_of(plan.case, units), to_file.checked(out or [])
    with drawn(plan, targets[0] if targets else None, workers, scheduler) as found:
        for target in targets:
            _say(f"written: {to_file.write(found, target, system)}")
    if json or csv:
        _print(words.json(found, system) if json else words.csv(found))
    else:
        _show(words.text(found, system))
    if strict and words.undecided(found):
        raise typer.Exit(UNDECIDED)


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
    from .case.read import load
    one = load(case or Path(__file__).parent / "cases" / "thruster-stuck-major-axis.toml")
    if static is not None:
        from .show.explore.static import write
        _print(str(write(one, static, pyodide)))
        return
    if pyodide is not None:
        raise typer.BadParameter("--pyodide belongs to --static")
    from .show.explore.serve import serve

    def tell(address: str) -> None:
        _say("Ctrl-C ends it.")
        _print(address)
    serve(one, port, browser, tell)


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
    if json and csv:
        raise typer.BadParameter("choose one of --json and --csv")
    from .answers.time_to import time_of_case
    from .case.limit_options import stated_limit
    from .case.read import blamed_on
    from .show.text import answers, law
    from .show.text import when as shown
    loaded, answered = _load(cases, motion=True), []
    systems = _systems(loaded, "si" if si else units)
    for case in _each(loaded):
        limit = stated_limit(case, rate, component, energy, tilt, until)
        with blamed_on(case):
            answered.append((case, limit, time_of_case(case, limit.ask, limit.until)))
    if json:
        _print(answers.as_json([shown.as_dict(*one) | law.key(one[2].validity) for one in answered]))
    elif csv:
        _say_laws(found.validity for *_, found in answered)
        _print(shown.csv(answered))
    else:
        texts = [lambda n=n: shown.text(*answered[n], systems[n]) for n in range(len(answered))]
        _tell_all(loaded, texts, [found.validity for *_, found in answered], [""] * len(loaded), False, "\n",
                  lambda of: shown.swept([answered[n] for n in of], systems[of[0]]))
    if strict and any(shown.unknown(found) for *_, found in answered):
        raise typer.Exit(UNDECIDED)
    _strictly(strict, (found.validity for *_, found in answered))


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
    if json and csv:
        raise typer.BadParameter("choose one of --json and --csv")
    from .answers.stuck.ask import stuck as ask
    from .case.read import blamed_on
    from .show.progress import told
    from .show.text import stuck as shown
    loaded, answers = _load([case], motion=True), []
    systems = _systems(loaded, "si" if si else units)
    if out:
        from .show.files import endings
        endings.file(out, endings.PICTURES)
    with told() as tell:
        for one in loaded:
            with blamed_on(one):
                answers.append(ask(one, all_thrusters, tell))
    if out:
        from .show.stuck_picture import draw
        _write_each(out, [(one, partial(draw, one, found, units=system)) for one, found, system in zip(loaded, answers, systems)])
    if json:
        _print_json(loaded, list(map(shown.as_dict, answers)))
    elif csv:
        _print(shown.csv(answers))
    else:
        texts = [lambda n=n: shown.text(loaded[n], answers[n], systems[n]) for n in range(len(loaded))]
        _tell_all(loaded, texts, [None] * len(loaded), [""] * len(loaded), all_thrusters or why, "\n\n",
                  lambda of: shown.swept([answers[n] for n in of], systems[of[0]]))
    if strict and any(row.fate == "undecided" for found in answers for row in found.rows):
        raise typer.Exit(UNDECIDED)


@app.command()
def tables(out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the files.")] = ...):  # type: ignore[assignment]  # typer: must be given
    """Write Tables 1-4 of the constant-torque paper.

    Formats: text, CSV, Markdown, LaTeX, HTML.

    Example: stabilab tables --out tables
    """
    from .show.files import manifest
    from .show.progress import counted
    from .show.text import table
    with manifest.written(out, sys.argv[1:], table.case_files(table.STEMS), table.TOLERANCES) as folder:
        with counted() as tell:
            made = table.write_tables(folder, tell=tell)
    _print_paths([out / path.relative_to(folder) for path in made], out)


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
    from .show.figures import catalogue as drawn
    from .show.files import manifest
    from .show.text import table
    rows = drawn.chosen(numbers, paper)
    with manifest.written(out, sys.argv[1:], table.case_files(), {row.file: row.tolerance for row in rows}) as folder:
        made = drawn.write(numbers, folder, paper_name=paper)
    _print_paths([out / path.relative_to(folder) for path in made], out)


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
    from .show.report.report import write
    beyond: list[str] = []
    made = write(_load(cases or []), out, arguments=sys.argv[1:], papers=papers, precision=precision, certify=certify, workers=workers, beyond=beyond)
    _print("\n".join([*beyond, str(made)]))
    if strict and beyond:
        raise typer.Exit(UNDECIDED)


@app.command()
def rerun(manifest: Annotated[Path, typer.Argument(metavar="MANIFEST", help="A manifest.json, or the folder that holds it.",
                                                   show_default=False, autocompletion=completion.certificates)],
          out: Annotated[Path | None, typer.Option(metavar="DIR", help="Keep the new files in an empty folder.")] = None):
    """Repeat what made a folder and compare every byte.

    Exits with 2 where inputs are missing or changed, with 5 where a file differs.

    Example: stabilab rerun report/manifest.json
    """
    from .show.files.rerun import rerun as repeat
    *lines, verdict = repeat(manifest, out)
    _show("\n".join([verdict, *lines]))


@app.command(name="import")
def import_(file: Annotated[Path, typer.Argument(metavar="FILE", help="A NASA 42 spacecraft file, or JSON or a Python dictionary with "
                                                                      "Basilisk's names.", show_default=False)],
            out: Annotated[Path | None, typer.Option(metavar="FILE.toml", help="Write the case to a file.")] = None,
            stuck: Annotated[list[str] | None, typer.Option(metavar="NAME", help="A thruster that is stuck open; may be repeated.")] = None):
    """Write another program's spacecraft as a case.

    What has no counterpart in a case is listed on stderr. Exits with 2 where the case still has faults.

    Example: stabilab import SC_Simple.txt --out simple.toml
    """
    from .case import import_42, import_basilisk
    from .case.imported import case_text, faults_of
    from .case.source import source_text
    from .files import whole_file
    given = source_text(file)
    craft = (import_42 if import_42.is_one(given) else import_basilisk).spacecraft(given, file)
    text = case_text(craft, file, stuck or ())
    if out:
        with whole_file(out) as waiting:
            waiting.write_text(text, encoding="utf-8")
        _say(f"written: {out}")
    else:
        _print(text)
    for words in craft.omitted:
        _say(f"{printable(str(file))}: no counterpart: {printable(words)}")
    faults = faults_of(text, out or file)
    if faults:
        raise InputError("\n".join(("the case has faults yet:", *faults)))


@app.command()
def doctor():
    """Say what is installed and whether pictures can be drawn.

    Example: stabilab doctor
    """
    from .show.text.doctor import text
    _show(text())


def _load(paths, motion: bool = False) -> list:
    """All cases, of a file with [sweep] every combination; the faults of all files at once. motion: each must state one."""
    from .case.read import load_all
    cases, faults = [], []
    for path in paths:
        try:
            cases.extend(load_all(path))
        except InputError as error:
            faults.append(str(error))
    faults += dict.fromkeys(f"{case.path}: motion: expected x or angular_velocity in [motion]; this command needs a state"
                            for case in cases if motion and case.state is None)
    if faults:
        raise InputError("\n".join(faults))
    return cases


def _over_boxes(cases, *questions):
    """(what uncertain numbers do to the verdicts of each case, None where it has none; the module that shows it)."""
    from .show.text import uncertain as shown
    if not questions or not any(case.uncertain for case in cases):
        return [None] * len(cases), shown
    from .answers.uncertain.verdicts import uncertain
    return [uncertain(case, questions) for case in cases], shown


def _equilibria(case):
    from .answers.equilibria import equilibria
    from .case.read import blamed_on
    with blamed_on(case):
        return equilibria(case.scene)


def _certified(case, out) -> bool:
    """Write the certificate of one case; whether all of it could be certified."""
    from .answers.certificate import certificate
    from .case.read import blamed_on
    from .show.files.endings import labelled
    from .show.text import certification
    with blamed_on(case):
        made = certificate(case.scene, case.exact_state)
    _say(f"written: {certification.write(made, labelled(out, case))}\n{certification.summary(made)}")
    return not made["uncertified"]


def _motion(case, brief=False, follow=None, proof=False):
    from .answers.motion import motion
    from .case.read import blamed_on
    from .streams import Progress
    long = _time(follow, case)
    with blamed_on(case), Progress() as progress:
        words = lambda t, steps, left: progress(f"{printable(case.name)}: followed to {t:.4g} {case.scene.time_unit}, {steps} steps")
        return motion(case.scene, case.start, case.span, brief, case.exact_state, long, words if progress.wanted else None, proof)


def _tilted(case, motion, angle: str | None):
    """The motion with what a tilt of its torque does, where that is asked for or the case states what it takes: a second of work otherwise saved."""
    stated = case.limits is not None or any(thruster.stuck and thruster.misalignment for thruster in case.thrusters)
    if angle is None and not stated:
        return motion
    from .answers.tilt import with_tilt
    from .case.limit_options import stated_angle
    from .case.read import blamed_on
    with blamed_on(case):
        return with_tilt(case, motion, None if angle is None else stated_angle(angle, "tilt"))


def _time(text: str | None, case, option: str = "follow") -> float | None:
    """A time of the command line: a number in the time of the case, or one with a unit where that is s."""
    if text is None:
        return None
    from .case.units import NONE, TIME, quantity
    try:
        return float(quantity(text, NONE if case.variables == "scaled" else TIME)[0])
    except InputError as error:
        raise InputError(f"--{option}: {error}") from None


def _about_one_of(cases, told, certificate):
    """Exit with 5 where a certificate is of none of the cases."""
    from .answers.certificate import subject
    from .verify.about import differences
    apart = [(case, differences(told, subject(case.scene, case.exact_state))) for case in cases]
    if all(differing for _, differing in apart):
        raise ToleranceNotMet("\n".join(f"{printable(str(certificate))}: of another case than {case.place}: {words}"
                                        for case, differing in apart for words in differing))


def _strictly(strict, validities):
    """Exit with 3 where strict and an approximate law does not hold."""
    from .show.text import law
    if strict and law.beyond(*validities):
        raise typer.Exit(UNDECIDED)


def _say_digits(runs):
    """What the check of a run showed, where that is less than the aim and the states go to a file."""
    for case, _, reached in runs:
        if reached and not reached.enough:
            _say(f"{case.place}: checked to {reached.digits:.1f} digits: {reached.because}")


def _say_laws(validities):
    """How far approximate laws hold, beside a table that has no place for it."""
    for validity in validities:
        if validity is not None:
            _say(validity.words)


def _tell(question, paths, digits, json, strict, csv=False, follow=None, tilt=None, proof=False, units=None, why=False):
    """Answer a question for every case and say how many digits of it are known."""
    from .show.text import answers, law
    from .show.text import digits as shown
    loaded = _load(paths, motion=True)
    systems = _systems(loaded, units)
    answered = [(case, found, _told(question, case, found, digits)) for case in _each(loaded)
                for plain in [_motion(case, brief=question == "extremes", follow=follow, proof=proof)]
                for found in [_tilted(case, plain, tilt) if question == "fate" else plain]]
    boxes, over = _over_boxes([case for case, *_ in answered], *(["fate"] if question == "fate" else []))
    if json:
        _print(answers.as_json([getattr(shown, question)(*answer) | law.key(answer[1].validity) | over.as_dict(box)
                                for answer, box in zip(answered, boxes)]))
    elif csv:
        _say_laws(motion.validity for _, motion, _ in answered)
        _print(shown.extremes_csv(answered))
    else:
        from .show.terminal import questions
        told = getattr(questions, question)
        texts = [lambda n=n: told(*answered[n], systems[n], digits is not None, digits is not None or not answered[n][2].enough, why)
                 for n in range(len(answered))]
        motions = [motion for _, motion, _ in answered]
        table = _swept_extremes(loaded, motions, systems) if question == "extremes" else _swept_motions(motions, systems)
        _tell_all(loaded, texts, [m.validity for m in motions], [over.text(box) for box in boxes], why or digits is not None, "\n", table)
    missing = [(case, told) for case, _, told in answered if not told.enough and digits is not None]
    if missing:
        from .answers.digits.checked import short
        _all_reached((case, f"{question}: {short(told)}") for case, told in missing)
    if strict and any(motion.fate.word == "undecided" for _, motion, _ in answered):
        raise typer.Exit(UNDECIDED)
    _strictly(strict, (motion.validity for _, motion, _ in answered))


def _told(question, case, motion, digits):
    """The answer with its digits; where none were asked for and a formula bounds its own error, that is the check."""
    from .answers.digits.checked import DEFAULT, by_bound
    found = by_bound(question, motion) if digits is None else None
    if found is None:
        from .answers.digits.ask import ask
        from .case.read import blamed_on
        with blamed_on(case):
            found = ask(question, case.scene, case.start, DEFAULT if digits is None else digits, case.span, motion, case.exact_state,
                        **({"aim": True} if digits is None else {}))
    return found


def _followed(case, times, model, method, rtol, order, digits):
    """(the motion, what the check of its digits showed or None)."""
    from .case.read import blamed_on
    with blamed_on(case):
        return _run_or_best(case, times, model, method, rtol, order, digits)


def _run_or_best(case, times, model, method, rtol, order, digits):
    chosen = model != "exact" or method or rtol or order
    if digits is None and chosen:
        from .theories.follow import follow
        return follow(case, times, model, method, rtol, order), None
    if chosen:
        raise InputError("--digits chooses method and tolerance of the exact motion itself: give it without --model, --method, "
                         "--rtol and --order")
    from .answers.digits.checked import DEFAULT
    from .answers.digits.run import best_reached
    reached = best_reached(case, times, DEFAULT if digits is None else digits, measured=digits is not None, aim=digits is None)
    return reached.run, reached


def _run_as_dict(case, run, reached) -> dict:
    from .show.text import answers, law
    told = reached and {"asked": reached.asked, "reached": reached.digits, "because": reached.because}
    return answers.simulation(case, run) | {"digits": told} | {"theory": _theory(case, run)} | law.key(run.validity)


def _run_as_text(case, run, reached, digits, units, width) -> str:
    from .show.terminal.run import text
    from .show.text import law
    checked = "checked to " if digits is None else ""
    last = f"\n# {checked}{reached.digits:.1f} digits: {reached.because}" if reached else ""
    told = "".join(f"\n# {line}" for line in _theory(case, run, words=True))
    return law.first(run.validity, text(case, run, units, digits is not None, width) + last + told)


def _theory(case, run, words=False):
    """What the theory of an analytic model says, as rows or lines; nothing of an exact run."""
    if run.model == "exact":
        return []
    from .theories.theory import lines, theory
    found = theory(case, model=run.model)
    return lines(found) if words else found


def _with_angles(case, run, model, order):
    from .case.read import blamed_on
    from .theories.top.run_angles import with_euler_angles
    with blamed_on(case):
        return with_euler_angles(case, run, model, order)


def _judge_runs(runs, digits):
    """Exit with 5 where a run stopped, the digits asked for were not reached, or no digit was where nobody asked for any."""
    _all_reached((case, run.reason) for case, run, _ in runs if run.status != "reached")
    short = [(case, reached) for case, _, reached in runs if reached and not reached.enough and (digits is not None or reached.digits < 1)]
    if short:
        from .answers.digits.run import missed
        raise ToleranceNotMet("\n".join(missed(*row) for row in short))


def _compared(case, order):
    """The models of a case beside its exact motion."""
    from .case.read import blamed_on
    from .theories.comparison import compare as set_side_by_side
    from .theories.follow import models_of
    if case.span is None:
        raise InputError(f"{case.place}: motion: no span; compare needs span = [0, T] in [motion]")
    if models_of(case.scene) == ("exact",):
        raise InputError(f"{case.place}: no analytic model applies to this scene; there is nothing to compare")
    with blamed_on(case):
        return set_side_by_side(case, order=order)


def _all_reached(short):
    """Exit with 5 where (case, why) says that an answer falls short."""
    lines = [f"{case.place}: {why}" for case, why in short]
    if lines:
        raise ToleranceNotMet("\n".join(lines))


def _times(case, at: str | None) -> list[float]:
    """The times asked for, in order; without any, 201 over the span of the case."""
    if at is None:
        if case.span is None:
            raise InputError(f"{case.path}: motion: no span; give --at T1,T2,... or span (or tau) in [motion]")
        start, end = case.span
        return [start + (end - start) * i / 200 for i in range(200)] + [end]
    from .numbers.exact import exact
    try:
        return sorted({float(exact(word.strip())) for word in at.split(",")})
    except InputError as error:
        raise InputError(f"--at: {error}") from None


def _exact_times(case, at: str | None) -> list:
    """The times asked for as rationals, as they are written; without any, 201 over the span of the case."""
    from fractions import Fraction
    if at is None and case.span is not None:
        start, end = (Fraction(repr(t)) for t in case.span)
        return [start + (end - start) * i / 200 for i in range(201)]
    _times(case, at)  # says what is wrong with them
    return sorted({Fraction("".join(word.split())) for word in (at or "").split(",")})


def _each(cases):
    """The cases, told one by one to a terminal where they take their time."""
    if len(cases) < 2:
        return cases
    from .show.progress import each
    return each(cases, lambda case: printable(case.name))


def _systems(cases, asked: str | None) -> list:
    """The units in which each case is told."""
    from .show.units import units_of
    return [units_of(case, asked) for case in cases]


def _tell_all(cases, texts, laws, boxes, full, between, swept):
    """Text of every case to stdout; the combinations of a [sweep] as one table, unless all is asked for in full. texts: functions, a case each;
    swept(indices): (answer in a line, columns, rows) of a table."""
    from .show.terminal import page
    from .show.text import law
    if full or not any(case.variant for case in cases):
        page.tell(between.join(law.first(held, text()) + box for text, held, box in zip(texts, laws, boxes)))
        return
    from .show.terminal import sweep
    told = []
    for of in sweep.groups(cases):
        words = sweep.text([cases[n] for n in of], *swept(of)) if cases[of[0]].variant else texts[of[0]]()
        told.append(law.first(law.worst(*(laws[n] for n in of)), words) + "".join(boxes[n] for n in of))
    page.tell("\n\n".join(told))


def _swept_motions(motions, systems):
    """How `_tell_all` tells the motions of a sweep."""
    from .show.terminal import sweep

    def table(of):
        chosen = [motions[n] for n in of]
        if None in chosen:
            return f"{sum(m is None for m in chosen)} of them state no motion", [], [[] for _ in of]
        return sweep.fates(chosen, systems[of[0]]), *sweep.of_motions(chosen, systems[of[0]])
    return table


def _swept_extremes(cases, motions, systems):
    """How `_tell_all` tells the extremes of a sweep."""
    from .show.terminal import sweep

    def table(of):
        chosen = [motions[n] for n in of]
        return sweep.fates(chosen, systems[of[0]]), *sweep.of_extremes(chosen, cases[of[0]].scene.components, systems[of[0]])
    return table


def _print(text: str):
    """Text to stdout."""
    sys.stdout.write(text.rstrip("\n") + "\n")
    sys.stdout.flush()


def _show(text: str):
    """Text for people to stdout."""
    from .show.terminal.page import tell
    tell(text)


def _either(json: bool, data, words):
    """JSON to stdout, or text for people."""
    if json:
        _print(data())
    else:
        _show(words())


def _print_json(cases, rows):
    """An object for a case, a list of them for the combinations of a [sweep]."""
    from .show.text import answers
    _print(answers.as_json(rows if any(case.variant for case in cases) else rows[0]))


def _write_each(out, writers):
    """Let write(path) of every (case, write) make its file; each is named."""
    from .show.files.endings import labelled
    for case, write in writers:
        _say(f"written: {write(labelled(out, case))}")


def _print_paths(paths, otherwise):
    """The files a command wrote, one a line."""
    _print("\n".join(map(str, paths)) if isinstance(paths, (list, tuple)) else str(paths or otherwise))


def _say(text: str):
    print(text, file=sys.stderr)


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
