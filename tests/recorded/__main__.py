"""Records what the commands say of all cases, or says where they say something else now.

python -m tests.recorded [RECORD ...]: what differs from each record; exit code 1 where anything does.
python -m tests.recorded --write [RECORD ...]: records anew what differs by more than its tolerance; `git diff`
is then what users see of a change.
"""
import sys
import tempfile
from pathlib import Path

from .answers import ALL, RELATIVE, USUAL, differences, now, record, recorded


def main(arguments: list[str]) -> int:
    write, names = "--write" in arguments, [a for a in arguments if a != "--write"] or ALL
    differ = 0
    for name in names:
        with tempfile.TemporaryDirectory() as folder:
            found = now(name, Path(folder))
        if write:
            print(f"{name}: {len(record(name, found))} files written")
            continue
        lines = differences(recorded(name), found, RELATIVE.get(name, USUAL))
        differ += len(lines)
        print(f"{name}: {len(lines)} differences", *lines, sep="\n  ")
    return int(differ > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
