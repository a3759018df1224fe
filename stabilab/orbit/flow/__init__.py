"""The state at any time, by quadrature along the orbit."""
