"""Claims that no formula says: numbers of figures, stability rules, existence. Each module has TESTS: name ->
(residual printed, residual corrected)."""
