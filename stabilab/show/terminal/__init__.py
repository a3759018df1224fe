"""What a person at a terminal sees: its width, colours and letters, groups of commands, completion, progress.
"""
