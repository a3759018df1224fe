"""Charts of the sheets of a separatrix: two parameters, the points and bounds of their second derivatives."""
