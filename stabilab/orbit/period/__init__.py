"""The time of one turn or libration: the integral of dtheta/W."""
