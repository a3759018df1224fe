"""Cases to begin with, by what a thing is: each is a file that the package brings."""
from __future__ import annotations

import os

from ..errors import InputError, printable
from .source import source_text
from .table import did_you_mean

# name -> its file in cases/; that of a folder there is for one question, the only one that it answers
EXAMPLES = {"phone": "phone", "t-handle": "t-handle", "top": "toy-top", "cubesat": "cubesat-3u",
            "comsat": "geostationary-22n", "upper-stage": "upper-stage", "station": "space-station",
            "explorer-1": "explorer-1", "toutatis": "toutatis", "charged-body": "charged-body",
            "tank": "liquid-sensible", "stage": "burns/stage", "boom": "orbits/boom"}
QUESTIONS = {"burns": "burn", "orbits": "orbit"}  # folder -> its command
FOLDER = os.path.join(os.path.dirname(os.path.dirname(__file__)), "cases")


def example(name: str) -> str:
    """The text of the case of this name. Raises InputError for a name that there is not."""
    if name not in EXAMPLES:
        raise InputError(
            f"example {printable(name)[:60]}: there is none of this name{did_you_mean(name, EXAMPLES)}")
    return source_text(os.path.join(FOLDER, f"{EXAMPLES[name]}.toml"))


def command_of(name: str) -> str:
    """The command that answers an example."""
    return QUESTIONS.get(EXAMPLES[name].rpartition("/")[0], "classify")
