"""The same questions to a number of digits, checked."""
