"""The commands of the program: files of them, with their names and options. Each names its function in
`commands`, which loads cases, asks the analysis and shows the answer. The file whose command a line names is
read, and no other."""
from __future__ import annotations

import os
import sys
from functools import cache
from importlib import import_module
from itertools import chain
from typing import Annotated  # typer reads the annotations at run time

import typer

from ..errors import BAD_INPUT, BUG, INTERRUPTED, OK, StabilabError
from ..show.command_groups import GROUPS, Grouped
from ..streams import LOST, OutputLost, guarded
from ..version import __version__

FILES = list(dict.fromkeys(file for file, _ in GROUPS.values()))


def _version(wanted: bool):
    if wanted:
        print(f"stabilab {__version__}", flush=True)
        raise typer.Exit()


def stabilab(
        version: Annotated[bool, typer.Option(
            "--version", callback=_version, is_eager=True, help="Show the version and exit.")] = False):
    """Where a rotating body's equilibria are, which are stable, and whether a motion stays bounded."""


def _without_commands() -> typer.Typer:
    """A program with plain help: rich costs more time than the rest of `stabilab --help`."""
    program = typer.Typer(name="stabilab", cls=Grouped, no_args_is_help=True, rich_markup_mode=None,
                          pretty_exceptions_enable=False,
                          context_settings={"help_option_names": ["-h", "--help"]})
    program.callback()(stabilab)
    return program


def _of_file(file: str):
    return import_module(f"{__name__}.{file}").commands.registered_commands


@cache
def whole() -> typer.Typer:
    """The program with all its commands."""
    program = _without_commands()
    program.registered_commands += chain.from_iterable(map(_of_file, FILES))
    return program


def asked_for(text) -> typer.Typer:
    """The program as far as a line asks for it: of the file whose command begins the line, of all files where
    none does, the commands that the line names as they are, of the others the name and the help.

    Typer evaluates and inspects every option of every command that it is given, which takes longer than to
    import typer. A shell that completes a line names no command in it, and gets them all.
    """
    if any(name.startswith("_") and name.endswith("_COMPLETE") for name in os.environ):
        return whole()
    files = [file for file, names in GROUPS.values() if text[:1] and text[0] in names] or FILES
    needed = _without_commands()
    for command in chain.from_iterable(map(_of_file, files)):
        name = command.name or command.callback.__name__
        if name in text:
            needed.registered_commands.append(command)
        else:
            needed.command(name, help=command.callback.__doc__)(lambda: None)
    return needed


def say(text: str):
    """A message for people to stderr, wrapped to a terminal."""
    from ..show import terminal
    terminal.say(text)


def main(silence: float | None = None) -> None:
    """Run a command and end the process with its exit code; stderr hears of a silence of so many seconds."""
    if hasattr(sys.stdout, "reconfigure"):
        # a terminal or pipe that does not take every letter
        sys.stdout.reconfigure(errors="backslashreplace")
    with guarded(silence):
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
        from ..packages import explained
        text = explained(error)
        return _reported(text) if text else _unexpected(error)
    except OSError as error:
        if error.errno in LOST and not error.filename:  # written past the guard of stdout
            return _reported(OutputLost(error.errno))
        say(f"{error.filename or 'stabilab'}: {error.strerror or error}")
        return BAD_INPUT if error.filename else BUG
    except Exception as error:
        return _unexpected(error)


def _reported(error: StabilabError) -> int:
    if str(error):
        say(str(error))
    return error.exit_code


def _unexpected(error: Exception) -> int:
    if os.environ.get("STABILAB_DEBUG") == "1":
        import traceback
        traceback.print_exc()
    else:
        say(f"stabilab failed unexpectedly: {type(error).__name__}: {error}\n"
             "This is a fault of the program. Set STABILAB_DEBUG=1 to see where it happened.")
    return BUG
