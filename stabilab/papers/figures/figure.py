"""One figure of a paper: its number, what it shows, what the paper printed, and how to draw it."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...show.terminal.letters import written


@dataclass(frozen=True)
class Figure:
    """One figure: draw(plt) -> matplotlib figure, or a list of those over which it is divided; words: the
    caption, exact: how exact the curves are, each a text or a function that forms it from what is drawn;
    paper: the short name under which the command knows it, "" for the constant-torque paper; lines: a
    function that gives the figure's lines (panels.Row, columns) where it sets printed curves beside the exact
    motion, of which `difference` tells how far they part; added: the paper has no such figure, and its number
    comes after the paper's last."""

    number: int
    title: str
    words: str | Callable[[], str]
    draw: Callable
    exact: str | Callable[[], str]
    paper: str = ""
    lines: Callable | None = None
    added: bool = False

    @property
    def caption(self) -> str:
        return written(self.words() if callable(self.words) else self.words)

    @property
    def tolerance(self) -> str:
        return self.exact() if callable(self.exact) else self.exact

    @property
    def file(self) -> str:
        return f"{self.paper or 'figure'}-{self.number:02d}.png"

    def pictures(self, plt) -> dict:
        """File name -> matplotlib figure: figure-NN.png, and figure-NN-2.png, ... where it is divided."""
        drawn = self.draw(plt)
        parts = drawn if isinstance(drawn, list) else [drawn]
        return {self.file.replace(".", f"-{n}." if n > 1 else "."): part for n, part in enumerate(parts, 1)}

    @property
    def command(self) -> str:
        return f"stabilab figures{f' --paper {self.paper}' if self.paper else ''} {self.number} --out figures"


def listed(values, form="{:.3g}") -> str:
    """Numbers in words: "1.2, 3.4 and 5.6"."""
    words = [form.format(v) for v in values]
    return f"{', '.join(words[:-1])} and {words[-1]}" if len(words) > 1 else "".join(words)
