"""The program: `python -m stabilab` and the command `stabilab`."""
import gc
import os
import sys

from . import interrupt, rubbish, streams, threads


def main() -> None:
    """Run a command and end the process with its exit code. Interrupts are taken care of before anything slow
    is imported."""
    rubbish.seldom()
    streams.occupy()
    threads.limit()
    interrupt.arm()
    try:
        _commands()(None if os.environ.get("STABILAB_QUIET") else streams.SILENCE)
    finally:
        interrupt.disarm()
        # the process ends: its last look for rubbish among all that was read in costs a tenth of a small
        # command
        gc.freeze()


def _commands():
    """The commands; where the package that reads the command line is missing, its name ends the program."""
    try:
        from .cli import main as run
        return run
    except ImportError as error:
        from .packages import explained
        text = explained(error)
        if text is None:
            raise
        if sys.stderr:
            print(text, file=sys.stderr)
        sys.exit(text.exit_code)


if __name__ == "__main__":
    main()
