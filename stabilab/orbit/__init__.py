"""One degree of freedom: a torque on a principal axis (or none) leaves a particle in a potential."""
