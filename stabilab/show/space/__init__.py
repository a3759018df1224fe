"""What all views of a motion share: the span of time, and what is drawn in the space of the rates.

In the space of the rates every view draws a box, the separatrix, equilibria (on a curve of these, at places
to look at), a motion with its start and its direction, seen from one place; Matplotlib, VTK and a page only
draw it.

Places are rates in the scene's variables. All of it does without NumPy, as a browser does."""
