"""Run the comparisons and write RESULTS.md beside this file."""
from pathlib import Path

from .suite import machine, run_all


def _ratio(value: float) -> str:
    """Three digits, as one reads them: 3,590 and not 3.59e+03."""
    return f"{float(f'{value:.3g}'):,.0f}" if value >= 1000 else f"{value:.3g}"


def main():
    rows, seconds = run_all()
    lines = ["# Speed, side by side", "",
             "How long stabilab takes beside what a careful user would write with heyoka, SciPy or VTK: a "
             "ratio of 10 says "
             "that stabilab needs a tenth of the time, one below 1 that it is slower.", "",
             f"Made by `make bench` in {seconds:.0f} s on {machine()}. Ratios are medians of seven rounds in "
             f"which both took turns; "
             "in brackets their range.", "",
             "| what | stabilab | the other | ratio | wanted | error |",
             "| --- | --- | --- | --- | --- | --- |"]
    for row in rows:
        low, high = row.spread
        wanted = _ratio(row.wanted) if row.wanted else ""
        note = f"; {row.note}" if row.note else ""
        lines.append(
            f"| {row.name} | {row.ours} | {row.theirs} | {_ratio(row.ratio)} ({_ratio(low)} to "
            f"{_ratio(high)}) | {wanted} | {row.error}{note} |")
    text = "\n".join(lines) + "\n"
    Path(__file__).with_name("RESULTS.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
