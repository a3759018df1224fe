"""What accuracy costs, shown as text."""
