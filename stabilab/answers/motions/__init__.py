"""What becomes of motions: the starts of a question, one case, arrays of starts, the result."""
