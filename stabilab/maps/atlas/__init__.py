"""All directions of a torque at once: equal-area cells of the sphere, what becomes of the motion in each, and
finer cells where that changes."""
