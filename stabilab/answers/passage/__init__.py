"""The first time at which a quantity reaches a limit: what was asked, and one file for each way to the
answer."""
