"""What a thruster that is stuck open does to the spacecraft of a case, and what helps against it."""
