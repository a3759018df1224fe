"""The papers on record, and the recorded verdict of each of their rows: read once for all tests."""
from stabilab.papers import index

ROWS = index.recorded()
PAPERS = {paper.name: paper for paper, _ in ROWS}
RECORDED = {paper.name: {found.row.equation: found.verdict for found in group} for paper, group in ROWS}
