"""How motions are carried on to where a certificate holds: step by step in batches, and over many revolutions at once."""
