"""The report: its pages on papers and cases."""
