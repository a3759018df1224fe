"""Hard cases, one function each: the plain formula beside the program's answer and one that shares no code
with it."""
