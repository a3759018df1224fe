"""A search for wrong answers: `make hunt`."""
