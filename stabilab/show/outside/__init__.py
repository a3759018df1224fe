"""Our numbers beside those of other tools, and our numbers for others to test theirs against."""
