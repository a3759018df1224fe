"""Rows of which doubles lose digits to the shift of their orbit's centre, in twofold numbers."""
