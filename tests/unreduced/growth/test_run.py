"""Tests of `unreduced/growth/run.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from stabilab.unreduced.growth.run import search_certificate


def test_rates_beyond_doubles_get_no_certificate_of_a_capture():
    assert search_certificate(-1.0, (1e200, 1e200, 1e200), 1.0)[:2] == ("none", None)
