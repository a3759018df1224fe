"""`stabilab show` and `example`: the equations of a case and the laws that hold; a case to begin with."""
from __future__ import annotations

from ..case.examples import EXAMPLES, example
from ..case.write import data_of
from ..show.text.scene_text import of_all
from .common.cases import load_cases
from .common.output import tell, write


def show(case):
    """Equations and laws of a case, of every combination where it has a [sweep]."""
    tell(of_all(load_cases([case])))


def examples(name):
    """The list of examples, or the text of one."""
    if name is not None:
        write(example(name).rstrip("\n"))
        return
    rows = [f"  {known:<14}{data_of(example(known))['title']}" for known in EXAMPLES]
    tell("\n".join(["stabilab example NAME > NAME.toml writes one of these, which stabilab classify answers.",
                    "", *rows]))
