"""Regular or chaotic motion in words and as a picture."""
