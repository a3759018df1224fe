"""A motion with guaranteed digits, for others to test their integrators against: states, events, period,
extremes."""
