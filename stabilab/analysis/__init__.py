"""Questions that a user asks of a scene; each file answers one and never draws."""
