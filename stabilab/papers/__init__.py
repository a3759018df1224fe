"""Papers: the audit of printed formulas, other tools' numbers, tables, figures and the report on all of them.
"""
