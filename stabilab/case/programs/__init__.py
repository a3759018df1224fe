"""Files of other programs as cases: one file each, and what several of them share."""
