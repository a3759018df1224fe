"""Writes docs/papers.md, all items of the papers, from the record of the audit:
`python docs/making/papers.py`."""
from pathlib import Path

from stabilab.papers import index

PAGE = Path(__file__).parents[1] / "papers.md"

if __name__ == "__main__":
    PAGE.write_text(index.markdown(index.recorded()), encoding="utf-8")
