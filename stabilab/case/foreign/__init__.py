"""Other programs' spacecraft, read and written as a case."""
