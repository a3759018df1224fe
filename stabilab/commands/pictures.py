"""Commands that draw: `stabilab surface`, `plot`, `chaos` and `explore`, a case to look at."""
from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import typer

from ..answers.caveats import answered, of_case
from ..answers.chaos import Order, row_of
from ..answers.chaos import chaos as ask_chaos
from ..case.read import blamed_on, load, load_any, special
from ..errors import Kind, RenderingUnavailable, printable, without
from ..show import endings, limiting
from ..show.maps import chaos as chaos_shown
from ..show.maps import picture
from ..show.maps import to_file as map_files
from ..show.plot import to_file
from ..show.plot.subject import subject
from ..show.surface import text as surface_text
from ..show.surface import write_all
from ..show.terminal import lettered, say, tell
from ..show.text import headline
from ..show.units import units_of
from .common import load_cases, time_asked, units_asked
from .runner import View, collected, judge, run, show
from .writing import hold_laws, write

SURFACE = View(text=lambda case, summary, units: "", data=lambda case, summary: summary, between="\n",
               law=lambda case, summary: headline.of_case(case), steady=True)
CHAOS = View(text=chaos_shown.text, data=chaos_shown.as_dict, csv=chaos_shown.CSV, swept=chaos_shown.swept,
             between="\n", law=lambda case, result: headline.of_case(case),
             open=lambda result: int(result.labels) == Order.UNDECIDED,
             drawn=lambda case, result, units, path: chaos_shown.write(case, result, path))

AN_EXAMPLE = Path(__file__).parents[1] / "cases" / "thruster-stuck-major-axis.toml"


def surface(case, out, json, strict):
    """Write the separatrix of a case; the summary first, then what kept a picture from being drawn."""
    loaded, unavailable = load_cases([case]), None
    systems = units_asked(loaded, None)
    try:
        summaries = write_all(loaded, out, arguments=sys.argv[1:])
    except RenderingUnavailable as error:
        if not hasattr(error, "summaries"):
            raise
        summaries, unavailable = error.summaries, error
    view = replace(SURFACE, text=lambda entry, summary, units: surface_text(summary, out))
    rows = collected(view, loaded, systems, [(summary,) for summary in summaries])
    show(view, rows, json)
    for item, summary in zip(loaded, summaries if json else ()):
        if not summary["sheets"]:
            say(f"{item.name}: no surface to write: {summary['reason']}")
    if unavailable:
        raise unavailable
    judge(view, rows, strict)


def plot(case, kind, out, size, dpi, until, neighbours, units, strict, axis=None):
    """Draw a case, or the map of a sweep's file."""
    if case.suffix.lower() == ".nc":
        redraw = map_files.redrawn if map_files.is_atlas(case) else picture.write
        target = out or Path(f"{printable(case.stem)}.png")
        write(str(redraw(case, target, kind, to_file.inches(size), dpi, units)))
        return
    if special(case):
        _plot_special(case, kind, out, to_file.inches(size), dpi, until, units, axis)
        return
    loaded, drawn = load_cases([case], motion=kind != "equilibria"), []
    units_asked(loaded, units)  # says what is wrong with them
    target = out or Path(to_file.default_name(printable(case.stem), kind))
    for item in loaded:
        with blamed_on(item):
            end = time_asked(until, item, "until")
            drawn.append(to_file.write_all(item, endings.labelled(target, item), kind, to_file.inches(size),
                                           dpi, units, end, neighbours, axis=axis))
    laws = [headline.of_case(entry) for entry in loaded]
    for item, held, paths in zip(loaded, laws, drawn):
        for line in limiting.beside(_unless_drawn(of_case(item), kind), units_of(item, units)):
            tell(line)
        if held is not None:
            tell(lettered(held.words))
        write("\n".join(map(str, paths)))
    hold_laws(strict, laws, loaded)


def _unless_drawn(caveats, kind):
    """The caveats of a picture: of draws of the uncertain numbers it is not one of their middles."""
    return (caveats if kind != "histogram"
            else without(caveats, Kind.UNCERTAIN, Kind.TOLERANCE, Kind.DISTRIBUTION))


def _plot_special(case, kind, out, size, dpi, until, units, axis):
    """Draw a burn, or a satellite on a circular orbit."""
    built = load_any(case)
    craft = built.craft
    units_asked([craft], units)
    target = out or Path(to_file.default_name(printable(case.stem), kind))
    with blamed_on(craft):
        end = time_asked(until, craft, "until")
        item = subject(built, span=end)
        paths = to_file.write_all(item, target, kind, size, dpi, units, axis=axis)
    for line in limiting.beside(_unless_drawn(item.caveats, kind), units_of(craft, units)):
        tell(line)
    write("\n".join(map(str, paths)))


def chaos(cases, until, out, csv, json, strict):
    """Say of each motion whether it is regular, and draw what that looks like."""
    loaded = load_cases(cases, motion=True)
    run(CHAOS, loaded, lambda case: answered(
        ask_chaos(case.scene, row_of(case.scene, case.state, case.blocks), time_asked(until, case, "until")),
        case), out=out, json=json, csv=csv, strict=strict)


def explore(case, port, browser, static, pyodide):
    """Serve a case as a page, or write the page as a folder."""
    if pyodide is not None and static is None:
        raise typer.BadParameter("--pyodide belongs to --static")
    item = load(case or AN_EXAMPLE)
    load_cases([case or AN_EXAMPLE])  # says what is wrong with its [sweep]
    if static is not None:
        from ..show.explore.serve import write as write_folder
        write(str(write_folder(item, static, pyodide)))
        return
    from ..show.explore.serve import serve

    def announce(address: str) -> None:
        say("Ctrl-C ends it.")
        write(address)
    serve(item, port, browser, announce)
