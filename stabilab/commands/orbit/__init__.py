"""Commands on a satellite in orbit."""
