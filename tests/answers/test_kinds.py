"""Tests of `answers/kinds.py`."""
from __future__ import annotations

from importlib import import_module

import pytest

from stabilab.answers.kinds import KINDS


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_scene_answers_every_question(kind):
    """A name that a module only passes on is one that a tool may take for unused."""
    one, many = (import_module(f"stabilab.{place}") for place in (KINDS[kind].one, KINDS[kind].many))
    assert callable(one.motion)
    assert all(callable(getattr(many, question, None)) for question in ("fates", "extremes", "periods"))
