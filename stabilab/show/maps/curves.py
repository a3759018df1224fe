"""A sweep along one axis: a curve for every number, the fate (or how it is known) as the colour behind it."""
from __future__ import annotations

from typing import Any

import numpy as np

from .. import style
from .shades import FLAGS, flag_legend, label, light, looks, own_value, scale_axes, short_label

TOGETHER = (("margin",), ("distance",), ("least", "greatest"), ("period",), ("when_low", "when_high"), ("equilibria", "stable", "unstable", "open"))


def curves(data: Any, plan: Any, kind: str, along: str, size: Any, plt: Any) -> Any:
    """The figure: a panel for each question; of a column other than the fate, the panel that it is in alone."""
    panels = [[name for name in names if name in data] for names in TOGETHER if kind in (*FLAGS, *names)]
    panels = [names for names in panels if names and np.isfinite(np.asarray(data[names[0]], float)).any()] or [[]]
    figure, axes = plt.subplots(len(panels), 1, sharex=True, squeeze=False, layout="constrained", figsize=size or (8, 1.4 + 2.2 * len(panels)))
    x, behind = np.asarray(data[along]), kind if kind in FLAGS else "fate"
    order = np.argsort(x)
    for ax, names in zip(axes[:, 0], panels):
        if behind in data:
            _bands(ax, x[order], np.asarray(data[behind])[order], looks(data, behind))
        _lines(ax, data, x, order, names)
        ax.set_xlim(x.min(), x.max())
        scale_axes(ax, x)
    axes[-1, 0].set_xlabel(label(data, along))
    axes[0, 0].set_title(style.literal(data.attrs.get("title", "")), loc="left", wrap=True)
    own = own_value(plan, next(n for n, axis in enumerate(plan.axes) if axis.key.name == data[along].attrs["long_name"]))
    if own is not None and x.min() <= own <= x.max():
        for ax in axes[:, 0]:
            ax.axvline(own, color=style.BLACK, linewidth=0.8, linestyle=":", label="the case itself")
    _legend(figure, flag_legend(data, behind) if behind in data else [], axes[:, 0])
    return figure


def _bands(ax, x, flags, look):
    """Areas of one flag, each from half way before its first point to half way after its last."""
    edges = np.concatenate([[x[0]], 0.5 * (x[1:] + x[:-1]), [x[-1]]])
    cuts = [0, *(np.flatnonzero(np.diff(flags)) + 1), len(flags)]
    for first, last in zip(cuts, cuts[1:]):
        ax.axvspan(edges[first], edges[last], facecolor=light(look[int(flags[first])][1], 0.22), linewidth=0, zorder=0)


def _lines(ax, data, x, order, names):
    for n, name in enumerate(names):
        values = np.asarray(data[name], float)[order]
        values = np.where(np.isfinite(values), values, np.nan)
        if name != "margin":
            values = _broken(data, order, values)
        if name in ("equilibria", "stable", "unstable", "open"):
            ax.step(x[order], np.where(values < 0, np.nan, values), where="mid", color=style.SERIES[n], linestyle=("-", "--", ":", "-.")[n], label=name)
            ax.yaxis.get_major_locator().set_params(integer=True)
        elif values.ndim == 1:
            ax.plot(x[order], values, color=style.SERIES[n], linestyle=(0, (6, 6)) if n else "-", label=short_label(data, name))  # two may be one line
        else:
            for i, axis in enumerate(data["axis"].attrs.get("names", "axis 1; axis 2; axis 3").split("; ")):
                ax.plot(x[order], values[:, i], color=style.SERIES[i], linestyle="--" if n else "-", label=f"{name}, {axis}")
    if names:
        of = data[names[0]].attrs.get("units", "1")
        told = {"least": "extremes", "when_low": "time to the limit", "equilibria": "number"}.get(names[0], names[0])
        ax.set_ylabel(told if of == "1" else f"{told} ({of})")
    else:
        ax.set_yticks([])


def _broken(data, order, values):
    """The values with a gap where the fate changes: what lies on both sides is no one curve."""
    if "fate" not in data:
        return values
    at = np.flatnonzero(np.diff(np.asarray(data["fate"])[order]))
    ends = np.array(values)
    ends[at[np.isfinite(values.reshape(len(values), -1)[at]).all(axis=1)]] = np.nan
    return ends


def _legend(figure, rows, axes):
    for ax in axes:
        handles, words = ax.get_legend_handles_labels()
        if len(words) > 1 + ("the case itself" in words):
            kept = [(h, w) for h, w in zip(handles, words) if w != "the case itself"]
            ax.legend(*zip(*kept), loc="center left", bbox_to_anchor=(1.0, 0.5))  # beside the panel, whose curves it would cover
        rows += [(h, w) for h, w in zip(handles, words) if w == "the case itself" and w not in [w for _, w in rows]]
    if rows:
        figure.legend(*zip(*rows), loc="outside lower center", ncols=min(5, len(rows)))
