"""The version of the program, apart from the package's table, which knows every room."""
__version__ = "0.1.0"
