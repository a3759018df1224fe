"""A sweep over random samples: how the numbers spread, or, beside other axes, what share of the samples spins up."""
from __future__ import annotations

from typing import Any

import numpy as np

from ...errors import InputError
from ...orbit.result import Fate
from .. import style
from .labels import SAMPLE
from .shades import FATES, label, light, scale_axes, short_label

BINS = 60


def spread(data: Any, plan: Any, kind: str, moving: list[str], size: Any, plt: Any) -> Any:
    """The figure: histograms of samples alone, shares of fates along one axis, the share that spins up along two."""
    if not moving:
        return _histograms(data, plan, kind, size, plt)
    if "fate" not in data:
        raise InputError("plot: shares of samples need the fate: ask for it with --answer fate")
    return (_shares if len(moving) == 1 else _share_map)(data, moving, size, plt)


def _histograms(data, plan, kind, size, plt):
    names = [name for name in ("margin", "distance", "period", "when_low") if name in data and np.isfinite(data[name]).any()]
    names = [kind] if kind in names else names
    if not names:
        raise InputError("plot: these samples have no finite number to draw: ask for --answer margin, distance, period or when")
    figure, axes = plt.subplots(len(names), 1, squeeze=False, layout="constrained", figsize=size or (8, 1.2 + 2.6 * len(names)))
    for ax, name in zip(axes[:, 0], names):
        values = np.asarray(data[name])
        finite = np.isfinite(values)
        edges = np.histogram_bin_edges(values[finite], BINS)
        for fate, (words, colour) in FATES.items():
            of = finite & (np.asarray(data["fate"]) == fate) if "fate" in data else finite
            if of.any():
                told = f"{words}: {of.sum():,}" if "fate" in data else None
                ax.hist(values[of], edges, facecolor=light(colour), edgecolor=colour, linewidth=0.6, label=told)
            if "fate" not in data:
                break
        ax.set_xlabel(short_label(data, name))
        ax.set_ylabel("samples")
        if "fate" in data:
            ax.legend(loc="best")
    axes[0, 0].set_title(f"{style.literal(data.attrs.get('title', ''))}: {data.sizes[SAMPLE]:,} samples", loc="left", wrap=True)
    return figure


def _shares(data, moving, size, plt):
    figure, ax = plt.subplots(layout="constrained", figsize=size or (8, 4.5))
    x, fates = np.asarray(data[moving[0]]), np.asarray(data["fate"].transpose(moving[0], SAMPLE))
    base = np.zeros(len(x))
    for fate, (words, colour) in FATES.items():
        share = 100 * (fates == fate).mean(axis=1)
        if share.any():
            ax.fill_between(x, base, base + share, facecolor=light(colour), edgecolor=colour, linewidth=0.6, label=words)
            base = base + share
    ax.set_xlim(x.min(), x.max())
    ax.set_ylim(0, 100)
    scale_axes(ax, x)
    ax.set_xlabel(label(data, moving[0]))
    ax.set_ylabel(f"share of {data.sizes[SAMPLE]:,} samples (%)")
    ax.set_title(style.literal(data.attrs.get("title", "")), loc="left", wrap=True)
    figure.legend(loc="outside lower center", ncols=4)
    return figure


def _share_map(data, moving, size, plt):
    if len(moving) > 2:
        raise InputError("plot: samples beside three axes have no picture; choose a place along one in Python: xarray.open_dataset(...).isel(...)")
    figure, ax = plt.subplots(layout="constrained", figsize=size or (7.2, 6.0))
    x, y = (np.asarray(data[name]) for name in moving)
    share = 100 * (np.asarray(data["fate"].transpose(*moving, SAMPLE)) == Fate.SPIN_UP).mean(axis=-1)
    drawn = ax.pcolormesh(x, y, share.T, shading="nearest", cmap="cividis", vmin=0, vmax=100, rasterized=True)
    ax.grid(False)
    ax.contour(x, y, share.T, levels=[5, 50, 95], colors=style.BLACK, linewidths=(0.6, 1.2, 0.6)) if min(share.shape) > 1 else None
    figure.colorbar(drawn, label=f"share of {data.sizes[SAMPLE]:,} samples that spins up (%); lines at 5, 50 and 95 %")
    scale_axes(ax, x, y)
    ax.set_xlabel(label(data, moving[0]))
    ax.set_ylabel(label(data, moving[1]))
    ax.set_title(style.literal(data.attrs.get("title", "")), loc="left", wrap=True)
    return figure
