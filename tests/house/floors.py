"""The lowest versions that pyproject.toml admits, as constraints for pip: `python -m tests.house.floors` (see
`make floors`).

What these packages ask for in their turn is left to pip, which takes the newest: so an old package that no
longer works beside them is found too.
"""
import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
EXTRAS = ("data", "test")  # what `make test` installs


def floors() -> dict[str, str]:
    """Package -> lowest version, of everything that is installed for the tests. Raises ValueError where one
    states none."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    found = {}
    for line in [*project["dependencies"],
                 *(row for extra in EXTRAS for row in project["optional-dependencies"][extra])]:
        match = re.match(r"([\w.-]+)>=([\w.]+)", line)
        if match is None:
            raise ValueError(f"{line}: expected NAME>=VERSION")
        found[match[1]] = match[2]
    return found


if __name__ == "__main__":
    print("\n".join(f"{name}=={version}" for name, version in floors().items()))
