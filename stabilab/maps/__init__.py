"""Many cases at once: the questions of `answers` over ranges of a case's numbers."""
