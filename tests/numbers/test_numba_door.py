"""The door of numba: what is kept on disk, and where there is no disk."""
from __future__ import annotations

from stabilab.numbers import numba_door
from stabilab.orbit.separatrix import circle_kernel
from stabilab.orbit.separatrix.compiled import hyperbola_kernel


def test_where_no_folder_is_writable_a_module_compiles_without_a_cache(monkeypatch):
    asked = []

    def compiled(module, inlined, cache, *names):
        asked.append(cache)
        if cache:
            raise RuntimeError("cannot cache function: no locator available")
        return {"orbits": "kernel"}
    monkeypatch.setattr(numba_door, "_compiled", compiled)
    assert numba_door.compiled(numba_door, ()) == {"orbits": "kernel"} and asked == [True, False]


def test_of_modules_taken_together_the_last_ones_names_serve_the_functions_of_all():
    """The search for a crossing stands in the kernel of circles and asks, with the names of hyperbolas, for heights on these."""
    names = numba_door.plain_together((circle_kernel, hyperbola_kernel))
    g, saddle = (1.0, 3.0, 0.5, 1.0), (0.25, -0.5)
    assert names["rise"](g, *saddle, 0.3) == hyperbola_kernel.rise(g, *saddle, 0.3) != circle_kernel.rise(g, *saddle, 0.3)
    assert names["crossing"].__globals__["rise"] is names["rise"] and circle_kernel.crossing.__globals__["rise"] is circle_kernel.rise
