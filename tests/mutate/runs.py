"""Tests run against a fault, in a child process that imports the package afresh."""
import importlib.abc
import importlib.util
import os
import pickle
import resource
import signal
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Answers by methods that share no code with the package: the same for every fault. module -> functions
ORACLES = {"tests.oracles.energy": ("label", "margin", "extremes", "period"),
           "tests.oracles.pairs": ("brink",)}
MEMORY = 8 << 30


class Tests:
    """The tests of some files: as faults are found, those that found most first; the last file last."""

    def __init__(self, files, slowest):
        self.paths = [str(ROOT / "tests" / f"{name}.py") for name in files
                      if (ROOT / "tests" / f"{name}.py").exists()]
        for package in ("numpy", "mpmath", "sympy", "scipy.optimize", "flint", "hypothesis", "pytest",
                        "pytest_benchmark"):
            importlib.import_module(package)
        _, _, self.memory = _run_child(self.paths, {}, None, (), None)
        _, (durations, failing), self.memory = _run_child(self.paths, self.memory, None, (), None)
        if failing:
            print(f"left out, as they fail without any fault: {', '.join(failing)}", flush=True)
        kept = {name: took for name, took in durations.items() if name not in failing and took <= slowest}
        self.names = sorted(kept, key=kept.get)
        self.seconds, self.found = sum(kept.values()), dict.fromkeys(self.names, 0)

    def outcome(self, fault):
        """("killed" or "survived", the first test that failed)."""
        # the last file comes last, so that what it alone sees shows; else those that found most, then the
        # fastest
        order = sorted(self.names, key=lambda name: (Path(self.paths[-1]).name in name, -self.found[name]))
        code, failed, _ = _run_child(self.paths, self.memory, fault, order, 20 + 5 * self.seconds)
        if code == 0:
            return "survived", ""
        name = failed or ("time or memory ran out" if code < 0 else "import or collection")
        if name in self.found:
            self.found[name] += 1
        return "killed", name


def _run_child(paths, memory, fault, order, seconds):
    """(exit code, first failure or the durations, memory). seconds: of processor time."""
    with tempfile.NamedTemporaryFile() as told:
        child = os.fork()
        if not child:
            code = 1
            try:
                os.setsid()
                code = _child(paths, memory, fault, order, seconds, told.name)
            finally:
                os._exit(code)
        _, status = os.waitpid(child, 0)
        code = os.waitstatus_to_exitcode(status)
        data = Path(told.name).read_bytes()
    result, memory = pickle.loads(data) if data else (None, memory)
    return code, result, memory


def _child(paths, memory, fault, order, seconds, told):
    import pytest
    os.chdir(ROOT)
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 1), os.dup2(quiet, 2)
    sys.dont_write_bytecode = bool(fault)  # the tests themselves are compiled once
    if fault:
        resource.setrlimit(resource.RLIMIT_CPU, (int(seconds), int(seconds) + 5))
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        signal.alarm(int(10 * seconds))  # a fault that waits for ever uses no processor time
        sys.meta_path.insert(0, Changed(fault))
    plugin = Plugin(memory, order, told, bool(fault))
    options = ["-q", "-p", "no:cacheprovider", "-m", "not slow", "--benchmark-disable"]
    return int(pytest.main([*options, *(["-x"] if fault else []), *paths], plugins=[plugin]))


class Changed(importlib.abc.MetaPathFinder, importlib.abc.SourceLoader):
    """Imports one module from changed text."""

    def __init__(self, fault):
        self.name, self.fault = "stabilab." + fault.module.replace("/", "."), fault
        self.path = str(ROOT / "stabilab" / f"{fault.module}.py")

    def find_spec(self, name, path=None, target=None):
        return (importlib.util.spec_from_file_location(name, self.path, loader=self) if name == self.name
                else None)

    def get_filename(self, name):
        return self.path

    def get_data(self, path):
        return self.fault.source.encode()


class Plugin:
    """Orders the tests, remembers the oracles' answers, and tells what came of it."""

    def __init__(self, memory, order, told, stop):
        self.memory, self.rank, self.told, self.stop = memory, {name: n for n,
                                                                name in enumerate(order)}, told, stop
        self.durations, self.failing = {}, []

    def pytest_collection_modifyitems(self, items):
        for module, names in ORACLES.items():
            for name in names if module in sys.modules else ():
                self._remember(sys.modules[module], name)
        if self.rank:
            items[:] = sorted((item for item in items if item.nodeid in self.rank),
                              key=lambda item: self.rank[item.nodeid])

    def _remember(self, module, name):
        """Every module that has the function gets one that asks the memory first."""
        real, where = getattr(module, name), f"{module.__name__}.{name}"

        def asked(*arguments, **named):
            try:
                key = where, pickle.dumps((arguments, sorted(named.items())))
            except Exception:  # an argument that cannot be written down
                return real(*arguments, **named)
            if key not in self.memory:
                self.memory[key] = real(*arguments, **named)
            return self.memory[key]
        for other in [m for n, m in sys.modules.items() if n.startswith("tests.")]:
            for label, value in vars(other).copy().items():
                if value is real:
                    setattr(other, label, asked)

    def pytest_runtest_logreport(self, report):
        self.durations[report.nodeid] = self.durations.get(report.nodeid, 0.0) + report.duration
        if report.failed:
            self.failing.append(report.nodeid)
            if self.stop and self.told:
                self._tell(report.nodeid)

    def pytest_sessionfinish(self):
        if not self.stop:
            self._tell((self.durations, self.failing), self.memory)

    def _tell(self, result, memory=None):
        Path(self.told).write_bytes(pickle.dumps((result, memory)))
        self.told = None
