"""Does a barrier stand ahead? Fate and margin: one state, arrays, tables of barriers."""
