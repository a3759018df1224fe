"""The questions a user asks of any scene, and which way answers which scene."""
