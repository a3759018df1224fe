"""Where the rates of a gyrostat under a constant torque vanish, and whether that is stable."""
