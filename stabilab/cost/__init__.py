"""What accuracy, number of states, digits, closeness to a separatrix and each effect cost, measured."""
