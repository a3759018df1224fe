"""The charged, nearly axisymmetric body."""
