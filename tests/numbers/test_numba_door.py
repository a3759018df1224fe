"""The door of numba: what is kept on disk, and where there is no disk."""
from __future__ import annotations

from stabilab.numbers import numba_door


def test_where_no_folder_is_writable_a_module_compiles_without_a_cache(monkeypatch):
    asked = []

    def compiled(module, inlined, cache, *names):
        asked.append(cache)
        if cache:
            raise RuntimeError("cannot cache function: no locator available")
        return {"orbits": "kernel"}
    monkeypatch.setattr(numba_door, "_compiled", compiled)
    assert numba_door.compiled(numba_door, ()) == {"orbits": "kernel"} and asked == [True, False]
