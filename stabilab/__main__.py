"""The program: `python -m stabilab` and the command `stabilab`."""
from . import interrupt


def main() -> None:
    """Run a command and end the process with its exit code. Interrupts are taken care of before anything slow is imported."""
    interrupt.arm()
    try:
        from .cli import main as run
        run()
    finally:
        interrupt.disarm()


if __name__ == "__main__":
    main()
