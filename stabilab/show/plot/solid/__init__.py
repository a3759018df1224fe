"""What three-dimensional plots are made of: the box, the momentum sphere, the cylinder of a torque on an axis."""
