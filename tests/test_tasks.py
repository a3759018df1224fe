"""Tasks that several processes share: each is done once, in whatever process, and what fails is told here."""
import pytest

from stabilab import tasks as workers
from stabilab.errors import InputError
from stabilab.tasks import Task


def _tasks(number):
    """Tasks that need next to nothing: a symbol, typeset."""
    return [Task(f"symbol {n}", "show.report.formulas:symbol", (f"omega{n}",), float(n))
            for n in range(number)]


@pytest.mark.parametrize("number", [1, 2])
def test_tasks_answer_in_their_order(tmp_path, number):
    found = workers.done(_tasks(5), tmp_path, lambda words: None, number)
    assert [f"<mi>{n}</mi>" in text for n,
            text in enumerate(found)] == [True] * 5 and list(tmp_path.iterdir()) == []


def test_a_task_that_fails_in_a_helper_fails_here(tmp_path):
    with pytest.raises(InputError, match="nowhere.toml"):
        workers.done([Task("a fault", "papers.report:of_all", (["nowhere.toml"],), 9.0), *_tasks(3)],
                     tmp_path, lambda words: None, 2)


def test_what_a_helper_left_half_done_is_done_here(tmp_path, monkeypatch):
    """A helper that was killed has taken a task and made nothing of it."""
    monkeypatch.setattr(workers, "_taken", lambda tasks, place: [0, 2])
    monkeypatch.setattr(workers, "helpers", lambda *where, **streams: _nobody())
    assert "<mi>1</mi>" in workers.done(_tasks(3), tmp_path, lambda words: None, 2)[1]


class _nobody:
    """No helper at all."""

    def __enter__(self):
        return []

    def __exit__(self, *_):
        return False
