"""Hard cases, one function each: the straightforward formula beside the program's answer and an answer that shares no code with it."""
