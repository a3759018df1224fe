"""The body as it turns: its attitude over time, as an animation or a page."""
