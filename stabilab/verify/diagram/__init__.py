"""A second look at a diagram of equilibria over one number: counting real zeros by trace forms, between and
at all values where these degenerate."""
