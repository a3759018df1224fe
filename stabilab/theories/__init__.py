"""Analytic theories of a case, and what papers print of them."""
