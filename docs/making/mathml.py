"""Formulas as MathML, which browsers draw themselves: MathJax would fetch a megabyte from the network at every page, and LaTeX pictures need LaTeX."""
from __future__ import annotations

from docutils import nodes
from latex2mathml.converter import convert


def setup(app) -> None:
    """Make it the renderer of formulas, by the name "mathml"."""
    app.add_html_math_renderer("mathml", inline_renderers=(_inline, None), block_renderers=(_block, None))


def _inline(page, node) -> None:
    page.body.append(f'<span class="math">{convert(node.astext())}</span>')
    raise nodes.SkipNode


def _block(page, node) -> None:
    page.body.append(f'<div class="math" role="math" tabindex="0">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode
