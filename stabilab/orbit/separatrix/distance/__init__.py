"""How far a state is from the separatrix: charts of its branches, branch and bound over them, a lower bound
and a witness."""
