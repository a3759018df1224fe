"""Pages of the documentation that are made from what the repository holds: reference, cases, notebooks.
docs/conf.py calls them before Sphinx reads."""
