"""What internal dissipation does to a body that spins freely."""
