"""How far models and numerical methods are from the exact motion, and what accuracy costs, as text."""
