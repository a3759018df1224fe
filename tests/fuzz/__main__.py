"""`make fuzz`: the case loader under a coverage-guided fuzzer, on bytes and by grammar, half of the time
each.

python -m tests.fuzz [SECONDS] [FOLDER]; what breaks it is kept in FOLDER (default .fuzz) as crash-*,
timeout-* or oom-*, and the exit code is 1. `python -m tests.fuzz replay FILE...` shows again what such a file
does.
"""
import subprocess
import sys
import tempfile
from importlib import import_module
from pathlib import Path

SLOWEST = 10  # s for one file on a busy machine; the largest files allowed load in a tenth of a second
MEMORY = 2048  # MB


def main(seconds=600, folder=".fuzz"):
    folder = Path(folder)
    (folder / "corpus").mkdir(parents=True, exist_ok=True)
    _write_seeds(folder)
    codes = [subprocess.run([sys.executable, "-m", __spec__.name, "one", target, str(folder),
                             str(int(seconds) // 2)]).returncode
             for target in TARGETS]
    found = sorted(p for kind in ("crash", "timeout", "oom") for p in folder.glob(f"{kind}-*"))
    print("\n".join([f"found: {path}" for path in found] or ["nothing found"]))
    sys.exit(1 if found or any(codes) else 0)


def _write_seeds(folder):
    from tests.fuzz.grammar import CASES, TOKENS
    for path in CASES:
        (folder / "corpus" / path.name).write_bytes(path.read_bytes())
    escaped = ("".join(f"\\x{byte:02x}" for byte in token.encode()) for token in TOKENS if len(token) < 60)
    (folder / "words").write_text("".join(f'"{word}"\n' for word in escaped))


def one(target, folder, seconds):
    """Fuzz one target in this process; it ends the process."""
    import atheris
    with atheris.instrument_imports(include=["stabilab", "tomllib"]):
        import_module("tomllib._parser")  # where the standard reader works
        import_module("stabilab.case.read")
    options = [f"-max_total_time={seconds}", f"-timeout={SLOWEST}", f"-rss_limit_mb={MEMORY}",
               f"-artifact_prefix={folder}/",
               "-print_final_stats=1", "-verbosity=0", "-seed=1"]
    if target == "bytes":
        options += ["-max_len=8192", f"-dict={folder}/words", f"{folder}/corpus"]
    with tempfile.TemporaryDirectory() as scratch:
        atheris.Setup([sys.argv[0], *options], TARGETS[target](Path(scratch) / "f.toml"))
        atheris.Fuzz()


def _bytes(path):
    from tests.fuzz.judge import judged
    return lambda data: judged(data, path) and None


def _grammar(path):
    from hypothesis import given, settings

    from tests.fuzz.grammar import mutated_cases, written_cases
    from tests.fuzz.judge import judged

    @settings(database=None, deadline=None)
    @given(written_cases() | mutated_cases())
    def test(raw):
        judged(raw, path)
    return lambda data: test.hypothesis.fuzz_one_input(data) and None


TARGETS = {"bytes": _bytes, "grammar": _grammar}


def replay(*files):
    from tests.fuzz.judge import judged
    with tempfile.TemporaryDirectory() as scratch:
        for file in files:
            print(f"{file}: {judged(Path(file).read_bytes(), Path(scratch) / 'f.toml')!r}"[:2000])


if __name__ == "__main__":
    {"one": one, "replay": replay}.get(sys.argv[1] if sys.argv[1:] else "",
                                       lambda *_: main(*sys.argv[1:]))(*sys.argv[2:])
