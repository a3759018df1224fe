"""What a machine is called."""
import platform
from pathlib import Path

from stabilab import processes as machine


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
