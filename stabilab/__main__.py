"""python -m stabilab"""
from .cli import main

main()
