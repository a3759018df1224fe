"""The same questions over a box of uncertain numbers."""
