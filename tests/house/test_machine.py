"""The cache folder of each platform, by its rules, and what a machine is called."""
import platform
import sys
from pathlib import Path

import pytest

from stabilab import processes as machine
from stabilab.cache import cache_folder


@pytest.mark.parametrize("system, local, wanted",
                         [("darwin", None, ("home", "Library", "Caches", "stabilab")),
                                                   ("win32", None,
                                                    ("home", "AppData", "Local", "stabilab", "Cache")),
                                                   ("win32", "local", ("local", "stabilab", "Cache")),
                                                   ("linux", "local", ("home", ".cache", "stabilab"))])
@pytest.mark.parametrize("given",
                         [None, "", "relative/folder"])  # the XDG rule: relative paths are to be ignored
def test_each_platform_has_its_cache_folder(system, local, wanted, given, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "platform", system)
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "home")
    for name, value in (("XDG_CACHE_HOME", given), ("LOCALAPPDATA", local and str(tmp_path / local))):
        monkeypatch.delenv(name, raising=False) if value is None else monkeypatch.setenv(name, value)
    assert cache_folder() == tmp_path.joinpath(*wanted)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "given"))
    assert cache_folder() == tmp_path / "given" / "stabilab"


def test_a_machine_without_a_list_of_processors_is_called_by_its_platform(monkeypatch):
    def missing(self, **_):
        raise FileNotFoundError(self)
    named = machine.machine()
    monkeypatch.setattr(Path, "read_text", missing)
    monkeypatch.setattr(platform, "processor", lambda: "")
    bare = machine.machine()
    assert bare == named | {"processor": platform.machine()}
    monkeypatch.setattr(Path, "read_text", lambda self,
                        **_: "flags\t: fpu\nmodel name\t: Some CPU: fast\nmodel name\t: other\n")
    assert machine.machine()["processor"] == "Some CPU: fast"
    monkeypatch.setattr(Path, "read_text", lambda self, **_: "Hardware\t: none of these lines\n")
    assert machine.machine()["processor"] == platform.machine()


def test_a_library_that_is_missing_is_named_so(monkeypatch):
    import importlib.metadata as metadata
    real = metadata.version

    def version(name):
        if name == "heyoka":
            raise metadata.PackageNotFoundError(name)
        return real(name)
    before = machine.versions()
    monkeypatch.setattr(metadata, "version", version)
    assert machine.versions() == before | {"heyoka": "not installed"} and before["numpy"][0].isdigit()
