"""What several commands do alike: read cases and times, ask for a motion, write to stdout and stderr, tell a
sweep as a table."""
