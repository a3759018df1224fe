"""What each command does: it loads its cases, asks the analysis, and shows the answer. `cli` declares their
names and options and opens the one that is asked for, so that a file here imports at its head all that its
command uses."""
