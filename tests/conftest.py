"""What all tests share: hypothesis that draws the same examples every time, and the commands run in this process."""
import sys

import pytest
from hypothesis import settings

from stabilab import cli

settings.register_profile("same", derandomize=True, deadline=None)
settings.load_profile("same")


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
