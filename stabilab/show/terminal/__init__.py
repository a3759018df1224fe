"""How text comes to a terminal: letters, lines that fit, colours, the help, what the shell completes."""
