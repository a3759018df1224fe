"""A scene and its equations: body, effects, state, equations derived in symbols, their gate to NumPy."""
