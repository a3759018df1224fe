"""Basins in words, as a data set, as a file and as a picture."""
