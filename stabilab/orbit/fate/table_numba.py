"""The loops of `barrier_heights` compiled by numba: one thread, kept on disk."""
from __future__ import annotations

from functools import lru_cache

from ...numbers.numba_door import compiled_function, wanted
from . import table_kernel as arithmetic

HELPERS = ("angle", "logarithm_of", "logarithm", "cell_position", "height_polynomial", "angle_polynomial",
           "circle_height",
           "force", "terms", "ahead", "trusted", "fold_is_clear", "places", "polar", "positions",
           "looked_up", "raise_best", "keep_off_fold", "circle_margins", "circle_labels",
           "cone", "keep_off_cone_fold", "on_range", "lower_nearest", "middle_root", "parabola_height",
           "exact_sum", "exact_product", "add", "less", "times", "scaled", "over", "fine_place",
           "double_step", "fine_force", "fine_slope", "fine_step",
           "ratio_of", "less_sinh", "fine_margin", "fine_invariant", "guessed", "fine_one", "hyperbola_scale")
LARGE = 1_000_000  # loading numba costs half a second, what NumPy needs for some millions of states
LOADED = 20_000  # once it is loaded


def compiled_loops(n: int, fast: bool | None):
    """{-1: loop for circles, +1: for hyperbolas, 0: for parabolas}, or None where NumPy is to answer for n
    states.

    fast: True always, False never, None for large arrays where numba is installed. InputError: fast=True
    without numba.
    """
    return _loops() if wanted(n, fast, bool(_loops.cache_info().currsize), LARGE, LOADED) else None


@lru_cache(maxsize=1)
def _loops():
    from numba.extending import overload, register_jitable

    @overload(arithmetic.pick)
    def _(condition, yes, no):
        return lambda condition, yes, no: yes if condition else no
    for name in HELPERS:
        register_jitable(getattr(arithmetic, name))
    return {-1: compiled_function(arithmetic.circle_loop), 1: compiled_function(arithmetic.hyperbola_loop),
            0: compiled_function(arithmetic.parabola_loop)}
