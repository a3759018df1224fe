"""What becomes of a body that something takes energy from."""
