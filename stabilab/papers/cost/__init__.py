"""What cost depends on, measured."""
