"""Answers about a motion: its outcome, its extremes and period, when it reaches a limit."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from .options import (
    CaseFile,
    CaseFiles,
    Csv,
    Digits,
    Draws,
    Follow,
    Json,
    Prove,
    Seed,
    Si,
    Strict,
    StrictFate,
    Tilt,
    UnitsOption,
    Why,
    Workers,
    flag,
    opens,
    option,
)

commands = typer.Typer()


@commands.command()
@opens("classify.classify")
def classify(
        cases: CaseFiles, json: Json = False,
        strict: Annotated[bool, flag("--strict",
            "Exit with 3 where the stability of an equilibrium or an outcome is undecided, or an "
            "approximate law does not hold.")] = False,
        certify: Annotated[bool, flag("--certify",
            "Prove the answer with exact numbers and interval arithmetic, and write a certificate that "
            "`stabilab verify` checks.")] = False,
        out: Annotated[Path, option("FILE.json", "File of the certificate.")] = Path("certificate.json"),
        follow: Follow = None, tilt: Tilt = None, units: UnitsOption = None, why: Why = False):
    """Find equilibria, their stability, and the motion's outcome.

    Example: stabilab classify cases/minor-axis-100.toml --json
    """


@commands.command()
@opens("classify.answer", question="fate")
def fate(
        cases: CaseFiles, json: Json = False, digits: Digits = None, strict: Strict = False,
        follow: Follow = None, tilt: Tilt = None, certify: Prove = False,
        samples: Draws = None, seed: Seed = 1, workers: Workers = None,
        units: UnitsOption = None, why: Why = False):
    """Say whether each motion stays bounded or spins up.

    Also how far it is from the separatrix. Digits are those of that distance in energy; the outcome itself
    is decided exactly.

    Example: stabilab fate cases/minor-axis-100.toml --digits 30
    """


@commands.command()
@opens("classify.answer", question="extremes")
def extremes(
        cases: CaseFiles,
        angles: Annotated[bool, flag("--angles",
            "Also find the angles of the axes x, y, z to the angular momentum and to their own directions at "
            "the start.")] = False,
        samples: Draws = None, seed: Seed = 1, workers: Workers = None,
        json: Json = False, csv: Csv = False, digits: Digits = None, strict: Strict = False,
        follow: Follow = None, units: UnitsOption = None, why: Why = False):
    """Find the least and greatest rates of each motion.

    Example: stabilab extremes cases/minor-axis-*.toml --csv
    """


@commands.command()
@opens("classify.answer", question="period")
def period(
        cases: CaseFiles, json: Json = False, digits: Digits = None, strict: Strict = False,
        units: UnitsOption = None, why: Why = False):
    """Find the period of each motion that repeats.

    Example: stabilab period cases/minor-axis-100.toml --digits 30
    """


@commands.command()
@opens("classify.attitude")
def attitude(
        cases: CaseFiles, json: Json = False,
        digits: Annotated[int | None, option(
            "N", "Write the periods with N digits (1 to 10000); exit with 5 where not reached.")] = None,
        strict: StrictFate = False, units: UnitsOption = None):
    """Find rotation and precession periods, and the turn after one.

    Example: stabilab attitude cases/torque-free-body.toml
    """


@commands.command()
@opens("stuck.when")
def when(
        cases: CaseFiles,
        rate: Annotated[str | None, option(
            "RATE", 'Limit of |ω|: "30 deg/s". Default: that of [limits].')] = None,
        below: Annotated[str | None, option(
            "RATE", 'Rate to which |ω| falls: "5 deg/s", less than that of the start.')] = None,
        component: Annotated[str | None, option("AXIS=RATE",
            "Limit of the absolute value of one rate: \"z = 30 deg/s\"; x, y, z are axes of the file, "
            "1, 2, 3 principal axes.")] = None,
        energy: Annotated[str | None, option("ENERGY", 'Limit of the kinetic energy: "5 J".')] = None,
        tilt: Annotated[str | None, option("AXIS=ANGLE",
            'Limit of the angle between a body axis and its direction at the start: "z = 20 deg".')] = None,
        nutation: Annotated[str | None, option("AXIS=ANGLE",
            'Limit of the angle between a body axis and the angular momentum: "z = 10 deg".')] = None,
        nutation_below: Annotated[str | None, option("AXIS=ANGLE",
            'Angle to which that falls: "z = 5 deg", less than that of the start.')] = None,
        until: Annotated[str | None, option("TIME", 'Search up to this time only: "10 min".')] = None,
        digits: Annotated[int | None, option(
            "N", "Write the time with N digits (1 to 10000), where a formula gives them.")] = None,
        samples: Draws = None, seed: Seed = 1, workers: Workers = None,
        units: UnitsOption = None, si: Si = False, json: Json = False, csv: Csv = False,
        strict: Annotated[bool, flag("--strict",
            "Exit with 3 where the time is not known or an approximate law does not hold.")] = False):
    """Say when each motion first reaches a limit.

    The answer is two times between which the limit is first reached, or that it is never reached.

    Example: stabilab when cases/cubesat-3u.toml --rate "30 deg/s"
    """


@commands.command()
@opens("stuck.stuck")
def stuck(
        case: CaseFile,
        all_thrusters: Annotated[bool, flag("--all-thrusters",
            "Answer for each thruster alone, stuck or not; the one that reaches the limit first comes "
            "first.")] = False,
        samples: Draws = None, seed: Seed = 1, workers: Workers = None,
        units: UnitsOption = None, si: Si = False, why: Why = False,
        out: Annotated[Path | None, option("FILE.png|.svg|.pdf", "Draw the rates against time.")] = None,
        json: Json = False, csv: Csv = False, strict: StrictFate = False):
    """Say what a stuck thruster does, how soon, and what helps.

    Outcome, axis of spin-up, time to the limit of [limits], the smallest change that changes the outcome,
    wheel momenta that keep the motion bounded, and other thrusters that help.

    Example: stabilab stuck cases/upper-stage.toml
    """


@commands.command()
@opens("stuck.burn")
def burn(
        case: CaseFile,
        stop: Annotated[str | None, option(
            "TIME", 'Close all thrusters at this time: "12 s". Default: as the file says.')] = None,
        below: Annotated[str | None, option(
            "RATE", 'Find the latest closing time that keeps |ω| below this for ever: "30 deg/s".')] = None,
        samples: Draws = None, seed: Seed = 1, workers: Workers = None,
        units: UnitsOption = None, json: Json = False, strict: StrictFate = False):
    """Give the motion after a burn, and the latest closing time.

    For thrusters with start, stop, pulses or propellant in the file: rates at closing, the free motion
    afterwards and its largest rate.

    Example: stabilab burn cases/burns/stage.toml --stop "12 s" --below "20 deg/s"
    """


@commands.command(name="flat-spin")
@opens("stuck.flat_spin")
def flat_spin(
        case: CaseFile,
        within: Annotated[str, option(
            "ANGLE", "Nutation angle about the minor axis at which the passage begins, and about the major "
            "axis at which it ends; with wheels, from where it ends.")] = "5 deg",
        momentum: Annotated[str | None, option(
            "MOMENTUM", 'All rotations at this angular momentum instead, wheels included: "100 N m s"; also '
            "of a body that loses nothing.")] = None,
        units: UnitsOption = None, json: Json = False,
        strict: Annotated[bool, flag("--strict", "Exit with 3 where the outcome is undecided.")] = False):
    """Say when a spin that loses energy tumbles, and how it ends.

    For a free body with a damper or a liquid: the final direction and rate, the time at which the separatrix
    is crossed, and the changes of the initial state that change the final direction. With wheels: all
    rotations at its angular momentum, which attract, where it ends, and from which wheel speed one is left.

    Example: stabilab flat-spin cases/explorer-1-damped.toml
    """


@commands.command()
@opens("stuck.orbit")
def orbit(
        case: CaseFile,
        up_to: Annotated[str | None, option("MOMENTUM",
            'Also count equilibria as the momentum of the wheels grows to this: "2 N m s".')] = None,
        out: Annotated[Path | None, option(
            "FILE.png|.svg|.pdf", "With --up-to: draw them over that momentum.")] = None,
        units: UnitsOption = None, json: Json = False, strict: StrictFate = False):
    """Find all equilibria of a satellite on a circular orbit.

    For a file with [circular_orbit]: equilibrium attitudes in the orbital frame under the gravity gradient,
    with their stability and librations.

    Example: stabilab orbit cases/orbits/boom.toml --up-to "12 N m s"
    """


@commands.command()
@opens("pictures.chaos")
def chaos(
        cases: CaseFiles,
        until: Annotated[str | None, option(
            "TIME", "How long each motion is followed; default: a thousand turns.")] = None,
        out: Annotated[Path | None, option(
            "FILE.png|.svg|.pdf", "Draw the Poincaré section and MEGNO over its plane.")] = None,
        csv: Annotated[bool, flag("--csv", "CSV on stdout: MEGNO over time.")] = False,
        json: Json = False,
        strict: Annotated[bool, flag("--strict", "Exit with 3 where this is undecided.")] = False):
    """Say whether each motion is regular or chaotic.

    Decided by the growth of a small change of the initial state (MEGNO), which the variational equations
    give, up to a time; nothing is proved.

    Example: stabilab chaos cases/minor-axis-100.toml
    """
