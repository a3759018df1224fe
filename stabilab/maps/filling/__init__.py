"""What fills the columns of a sweep: a module for each kind of answer, loaded where that is asked.

Each has `of_many(plan, case, states)` for the states (n, 3) of one scene, and `of_one(plan, case)` for scenes
without arrays, whose states are answered one by one; None where there are none. What they find is read by the
rows of `maps.columns`."""
