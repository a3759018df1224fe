"""The program: `python -m stabilab` and the command `stabilab`."""
import gc

from . import interrupt

# Reading modules makes many objects and no rubbish: with the interpreter's 700 the collector would look through them some
# hundred times before a small command has begun, at a tenth of its time.
OBJECTS_BETWEEN_COLLECTIONS = 50_000


def main() -> None:
    """Run a command and end the process with its exit code. Interrupts are taken care of before anything slow is imported."""
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    interrupt.arm()
    try:
        from .cli import main as run
        run()
    finally:
        interrupt.disarm()


if __name__ == "__main__":
    main()
