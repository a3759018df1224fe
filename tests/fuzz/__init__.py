"""What may be written into a case file, and what must come of it: a case, or an error that names file and
line."""
