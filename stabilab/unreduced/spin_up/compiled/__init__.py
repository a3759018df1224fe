"""The certificate about the fixed centre as loops over dense tables, which numba compiles."""
