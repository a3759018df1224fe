"""What all tests share: hypothesis that draws the same examples every time, no picture left open, and the
commands run in this process."""
import gc
import os
import sys
from collections import Counter

import pytest
from hypothesis import settings

from stabilab import cli
from stabilab.rubbish import OBJECTS_BETWEEN_COLLECTIONS
from stabilab.show import style

gc.disable()  # until all tests are there, which all stay: the collector would look through them again and again
os.environ["STABILAB_QUIET"] = "1"  # whether a command takes longer than a second hangs on the machine
os.environ["MPLBACKEND"] = "Agg"  # no window
settings.register_profile("same", derandomize=True, deadline=None)
settings.load_profile("same")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """One in n, and so that each of n values of another parameter comes up too: the 1st, then the 2nd of the
    next n, and so on. Of the rows that are left every fourth is for the slow tests, the others for the long.
    first(n, m): the first n rows of a test by default, the next m for the slow tests, the others for the long."""
    seen, left = Counter(), Counter()
    for item in items:
        if mark := item.get_closest_marker("one_in"):
            (n,), place = mark.args, seen[item.path, item.originalname]
            seen[item.path, item.originalname] += 1
            if place % n != place // n % n:
                item.add_marker("slow")
                if left[item.path, item.originalname] % 4:
                    item.add_marker("long")
                left[item.path, item.originalname] += 1
        if mark := item.get_closest_marker("first"):
            (quick, slow), place = mark.args, seen[item.path, item.originalname]
            seen[item.path, item.originalname] += 1
            if place >= quick:
                item.add_marker("slow")
            if place >= quick + slow:
                item.add_marker("long")


def pytest_collection_finish():
    """All modules and tests are there and stay: the collector need not look through them again, and comes as
    seldom as in the program itself."""
    gc.freeze()
    gc.set_threshold(OBJECTS_BETWEEN_COLLECTIONS)
    gc.enable()


@pytest.fixture(autouse=True)
def no_picture_is_left_open():
    """A picture that one test leaves open is not seen by the next one of its process."""
    yield
    if plt := sys.modules.get("matplotlib.pyplot"):
        plt.close("all")


@pytest.fixture(autouse=True, scope="session")
def no_title_has_more_than_two_lines():
    """Of any picture that a test writes: the title of the figure, and those of its panels."""
    save = style.save

    def checked(figure, *rest, **more):
        path = save(figure, *rest, **more)
        titles = [figure._suptitle, *(title for ax in figure.axes for title in (ax.title, ax._left_title))]
        for title in filter(None, titles):
            assert title._get_wrapped_text().count("\n") < 2, title.get_text()
        return path
    style.save = checked
    yield
    style.save = save


@pytest.fixture
def undrawn(monkeypatch):
    """A page without its pictures, which take most of its time."""
    monkeypatch.setattr("stabilab.show.report.one_case.pictures", lambda *given: [])


@pytest.fixture
def case_file(tmp_path):
    """Write a case file: case_file(text, name of the case) is its path."""
    def write(text, name="case"):
        path = tmp_path / f"{name}.toml"
        path.write_text(text, encoding="utf-8")
        return path
    return write


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
