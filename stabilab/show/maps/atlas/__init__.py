"""An atlas in words, as a picture, as a page that answers a pointer, and as files."""
