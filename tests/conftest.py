"""What all tests share: hypothesis that draws the same examples every time, no picture left open, and the commands run in this process."""
import sys

import pytest
from hypothesis import settings

from stabilab import cli

settings.register_profile("same", derandomize=True, deadline=None)
settings.load_profile("same")


@pytest.fixture(autouse=True)
def no_picture_is_left_open():
    """A picture that one test leaves open is not seen by the next one of its process."""
    yield
    if plt := sys.modules.get("matplotlib.pyplot"):
        plt.close("all")


@pytest.fixture
def stabilab(monkeypatch, capsys):
    """Run a command in this process: (exit code, stdout, stderr)."""
    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["stabilab", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            cli.main()
        captured = capsys.readouterr()
        return left.value.code or 0, captured.out, captured.err
    return run
