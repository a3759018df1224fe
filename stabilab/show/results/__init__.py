"""Results as they show themselves: in a line, in a notebook, as data sets and tables."""
