"""A diagram over two numbers: the answer in a line, a row for each number of equilibria, cusps; JSON and CSV
of its curves."""
from __future__ import annotations

from typing import Any

from ....caveat import cell, key
from ....maps.bifurcation.equations import BORDERS
from ....maps.bifurcation.family import ENDLESS, Piece
from ....maps.bifurcation.plane import Plane, rows
from ... import limiting
from ...files import comma
from ...text import frame
from ...text.answers import as_json
from ...units import units_of
from .words import NAMES, SCHEMA, axis, number


def answer(found: Plane) -> str:
    """"0, 2 or 4 equilibria over torque[3] and momentum[1]; fold curves; 1 cusp at (..., ...)"."""
    first, second = found.family.spans
    counts = sorted({piece.count for _, piece in _cells(found)})
    things = ("changes of stability" if found.kind == BORDERS else "equilibria" if counts != [1]
              else "equilibrium")
    some = _or(["no" if c == 0 and len(counts) == 1 else "curves of" if c == ENDLESS else str(c)
                for c in counts])
    told = [f"{some} {things} over {first.label} and {second.label}"]
    kinds = sorted({kind for strip in found.strips for arc in strip.arcs for kind in arc.kinds}
                   | {kind for wall in found.walls for kind in wall.kinds})
    if kinds:
        told.append("curves: " + ", ".join(NAMES[kind] for kind in kinds))
    if found.cusps:
        places = " and ".join(f"({number(cusp.at[0])}, {number(cusp.at[1])})" for cusp in found.cusps)
        told.append(f"{'cusp' if len(found.cusps) == 1 else f'{len(found.cusps)} cusps'} at {places}")
    return "; ".join(told)


def _or(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"


def _cells(found: Plane) -> list[tuple[float, Piece]]:
    """(p, piece of the diagram over q there) of every cell."""
    return [(float(strip.sample), piece) for strip in found.strips for piece in strip.line.pieces]


def text(found: Plane) -> str:
    """The answer, what is counted, an example for each number of equilibria, the cusps."""
    units = units_of(found.family.case)
    first, second = found.family.spans
    lines = [f"{found.family.case.name}: {answer(found)}",
             *(f"  {units.axes.sentence(words)}" for words in (found.what, *found.notes)),
             *limiting.lines(found.family.case.caveats, units)]
    of = [f"{span.label}{'' if span.shown_unit == '1' else f' ({span.shown_unit})'}"
          for span in (first, second)]
    border = found.kind == BORDERS
    table = [["changes" if border else "equilibria", *([] if border else ["stable"]), "such as at", of[0],
              of[1]]]
    largest: dict[int, tuple[float, float, Piece]] = {}
    for strip in found.strips:
        for piece in strip.line.pieces:
            size = (strip.high - strip.low) * (piece.high - piece.low)
            if size > largest.get(piece.count, (-1.0,))[0]:
                largest[piece.count] = (size, float(strip.sample), piece)
    for count, (_, p, piece) in sorted(largest.items()):
        stable = sum(state.verdict == "stable" for state in piece.states)
        table.append([str(count), *([] if border else [str(stable)]), "", number(p),
                      number(float(piece.sample))])
    for cusp in found.cusps:
        where = units.vector(cusp.state, units.rates) if cusp.state else "no one state"
        table.append(["cusp", *([] if border else [""]), where, number(cusp.at[0]), number(cusp.at[1])])
    wide = [max(len(row[n]) for row in table) for n in range(len(table[0]))]
    lines += [("  " + "  ".join(f"{cell:>{size}}" for cell, size in zip(row, wide))).rstrip()
              for row in table]
    return "\n".join([*lines, *frame.note(found.family.case)])


def curve_points(found: Plane) -> list[tuple[str, int, int, float, float]]:
    """(kind, strip, arc, p, q) of points of all curves; of walls their two ends."""
    out = []
    for n, strip in enumerate(found.strips):
        values, arcs = rows(found, strip)
        for k, (arc, row) in enumerate(zip(strip.arcs, arcs)):
            out += [(arc.kinds[0], n + 1, k + 1, p, q) for p, q in zip(values, row)]
    for k, wall in enumerate(found.walls):
        out += [(wall.kinds[0], 0, k + 1, wall.value, q) for q in (wall.low, wall.high)]
    return out


def csv(found: Plane) -> str:
    """A line for each point of each curve, then the cusps."""
    names = [span.key.name + ("" if span.shown_unit == "1" else f" ({span.shown_unit})")
             for span in found.family.spans]
    head: list[Any] = ["kind", "strip", "arc", *names]
    told = cell(found.family.case.caveats)
    return comma.lines([[*head, "caveats"],
                        *([*row, told]
                          for row in (*curve_points(found),
                                      *(("cusp", None, None, *cusp.at) for cusp in found.cusps)))])


def json(found: Plane) -> str:
    """Curves as polynomials, strips with their cells, cusps."""
    case = found.family.case
    return as_json({"schema": SCHEMA, "case": case.name, "variables": case.variables, "answer": answer(found),
                    "kind": found.kind, "what": found.what,
                    "axes": [axis(span) for span in found.family.spans],
                    "curves": [[{"powers": [int(n) for n in powers[2:]], "coefficient": str(c)} for powers,
                                c in sorted(F.to_dict().items())]
                               for F in found.curves],
                    "strips": [{"low": strip.low, "high": strip.high, "sample": str(strip.sample),
                                "cells": [{"low": piece.low, "high": piece.high,
                                           "equilibria": None if piece.count == ENDLESS else piece.count,
                                           "stable": sum(s.verdict == "stable" for s in piece.states)}
                                          for piece in strip.line.pieces],
                                "arcs": [{"kinds": list(arc.kinds), "curve": arc.curve, "root": arc.root,
                                          "value": event.value}
                                         for arc, event in zip(strip.arcs, strip.line.events)]}
                               for strip in found.strips],
                    "walls": [{"value": wall.value, "low": wall.low, "high": wall.high,
                               "kinds": list(wall.kinds)} for wall in found.walls],
                    "cusps": [{"at": list(cusp.at), "state": list(cusp.state),
                               "polynomial": [str(c) for c in cusp.polynomial], "root": cusp.root}
                              for cusp in found.cusps], "notes": list(found.notes)} | key(case.caveats)
                   | frame.key(case))
