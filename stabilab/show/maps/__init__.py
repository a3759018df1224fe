"""Sweeps as data sets, files, tables and pictures."""
