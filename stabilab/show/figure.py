"""One figure of a paper: its number, what it shows, what the paper printed, and how to draw it."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Callable


@dataclass(frozen=True)
class Figure:
    """One figure: draw(plt) -> matplotlib figure; tolerance says how exact its curves are; paper: the short name under
    which the command knows it, "" for the constant-torque paper."""

    number: int
    title: str
    caption: str
    draw: Callable
    tolerance: str
    paper: str = ""

    @property
    def file(self) -> str:
        return f"{self.paper or 'figure'}-{self.number:02d}.png"

    @property
    def command(self) -> str:
        return f"stabilab figures{f' --paper {self.paper}' if self.paper else ''} {self.number} --out figures"
