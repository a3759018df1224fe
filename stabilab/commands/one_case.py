"""`stabilab show`: the equations of a case and the laws that hold; `example`: a case to begin with; `import`:
another program's spacecraft as a case."""
from __future__ import annotations

from ..case.foreign import import_42, import_basilisk
from ..case.foreign.imported import case_text, faults_of
from ..case.source import EXAMPLES, command_of, source_text
from ..case.source import example as text_of
from ..case.write import data_of
from ..errors import InputError, printable
from ..files import write_text
from ..show.text.scene import of_all
from .common.cases import load_cases
from .common.output import say, tell, write


def show(case):
    """Equations and laws of a case, of every combination where it has a [sweep]."""
    tell(of_all(load_cases([case])))


def example(name):
    """The list of examples, or the text of one."""
    if name is not None:
        write(text_of(name).rstrip("\n"))
        return
    rows = [f"  {known:<14}{command_of(known):<10}{data_of(text_of(known))['title']}" for known in EXAMPLES]
    tell("\n".join(["stabilab example NAME > NAME.toml writes one of these, for stabilab COMMAND NAME.toml.",
                    "", f"  {'NAME':<14}COMMAND", *rows]))


def import_(file, out, stuck, body=None):
    """Write the case, name what has no counterpart, and refuse what has faults yet."""
    given = source_text(file)
    if import_42.is_one(given):
        craft = import_42.spacecraft(given, file, body)
    elif body is None:
        craft = import_basilisk.spacecraft(given, file)
    else:
        raise InputError(
            f"--body counts the bodies of a NASA 42 spacecraft file, and {printable(str(file))} is none")
    text = case_text(craft, file, stuck or ())
    if out:
        say(f"written: {write_text(out, text)}")
    else:
        write(text)
    for words in craft.said:
        say(f"{printable(str(file))}: {printable(words)}")
    for words in craft.omitted:
        say(f"{printable(str(file))}: no counterpart: {printable(words)}")
    faults = faults_of(text, out or file)
    if faults:
        raise InputError("\n".join(("the case has faults yet:", *faults)))
