"""Published formulas as data, and the checker that says which of them are true."""
