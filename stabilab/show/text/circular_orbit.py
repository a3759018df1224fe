"""Equilibria of a satellite on a circular orbit: as text and as JSON."""
from __future__ import annotations

from ...equilibrium.circular_orbit.result import yaw_pitch_roll
from ...representation import values_of
from .. import limiting
from ..units import DIGITS, SHORT, Units, number, vector
from .attitude import in_file
from .motion import row

ASSUMED = ("a circular orbit about a sphere, wheels whose momentum relative to the body is constant, no "
           "other torque")


def as_dict(case, found) -> dict:
    """The object of `stabilab orbit --json`: SI units, vectors in the frame of the file."""
    result = found.equilibria
    return {"schema": "stabilab.orbit/1", "case": case.name, **values_of(found, "rate period moments"),
            "momentum": in_file(case, found.momentum), **values_of(result, "kind reason"),
            "equilibria": [_object(case, found, one) for one in result.points],
            "families": [_object(case, found, one) | {"family": one.family,
                                                      "axis": one.axis and in_file(case, one.axis)}
                         for one in result.families],
            "momentum_spans": None if found.spans is None else
            [{"low": one.low, "high": one.high, "families" if one.families else "equilibria": one.count,
              "minima": one.minima} for one in found.spans]} | limiting.key(case, found.caveats)


def _object(case, found, one) -> dict:
    frame = _frame(case, one)
    return {**dict(zip(("velocity", "normal", "vertical"), frame)), "yaw_pitch_roll": yaw_pitch_roll(*frame),
            **values_of(one, "linear verdict because minimum eigenvalues frequencies"),
            "per_orbit": [f / found.rate for f in one.frequencies], "potential": one.potential}


def _frame(case, one):
    """The orbital frame in the frame of the file."""
    return tuple(tuple(in_file(case, along)) for along in (one.velocity, one.normal, one.vertical))


def text(case, found, units: Units) -> str:
    """The answer first, then each pair of equilibria, and why."""
    result = found.equilibria
    lines = [f"{case.name}: {_headline(result)}",
             row("orbit", f"rate {units.rate(found.rate)}, period {units.time(found.period)}"),
             row("wheels", f"{units.vector(in_file(case, found.momentum), ('N m s', 1.0))}")]
    for number_, one in enumerate(result.points[::2]):
        lines += _lines(case, found, one, units, f"{2 * number_ + 1} and {2 * number_ + 2}",
                        result.points[2 * number_ + 1])
    for one in result.families:
        lines += [row("family", one.family), *_lines(case, found, one, units, "one of it")]
    for span in found.spans or ():
        kind = "families" if span.families else "equilibria"
        lines.append(row("momentum", f"{number(span.low, DIGITS)} to {number(span.high, DIGITS)} N m s: "
                                     f"{span.count} {kind}, {span.minima} of them stable (Lyapunov)"))
    reasons = dict.fromkeys((one.verdict, one.because) for one in (*result.points, *result.families))
    lines += [f"why: {result.reason}", *(f"  {verdict}: {because}" for verdict, because in reasons),
              f"assumed: {ASSUMED}"]
    return limiting.noted(found.caveats, "\n".join(lines), units)


def _headline(result) -> str:
    if result.kind == "all":
        return "EVERY ATTITUDE IS AN EQUILIBRIUM"
    stable = sum(one.verdict == "stable" for one in result.families)
    families = f"{len(result.families)} FAMILIES OF EQUILIBRIA, {stable} STABLE" if result.families else ""
    if result.families and not result.points:
        return families
    gyroscopic = sum(one.verdict == "undecided" and one.linear == "stable" for one in result.points)
    more = [*([f"{gyroscopic} undecided (gyroscopically stable)"] if gyroscopic else []),
            *([families] if families else [])]
    return ", ".join([f"{len(result.points)} EQUILIBRIA, {result.count('stable')} STABLE", *more])


def _lines(case, found, one, units: Units, name: str, other=None):
    """An attitude (and the other of its pair), its verdict and librations."""
    pair = (yaw_pitch_roll(*_frame(case, each)) for each in (one, other) if each is not None)
    angles = " and ".join(units.vector(each, units.angles)
                          for each in sorted(pair, key=lambda angles: sum(map(abs, angles))))
    word = one.verdict if one.linear != "degenerate" else f"{one.verdict}, degenerate"
    yield row(name, f"{word}: yaw, pitch, roll {angles}")
    if one.verdict == "unstable":
        grows = max(z.real for z in one.eigenvalues)
        yield row("", f"a disturbance grows e-fold in {units.time(1 / grows, SHORT)}")
        return
    _, normal, vertical = map(vector, _frame(case, one))
    yield row("", f"orbit normal {normal}, up {'+-' if other else ''}{vertical} in the body")
    if one.frequencies:
        yield row("", f"librations {units.vector(one.frequencies, units.rates)[1:].replace(')', '')}, "
                      f"{', '.join(number(f / found.rate, DIGITS) for f in one.frequencies)} per orbit")
