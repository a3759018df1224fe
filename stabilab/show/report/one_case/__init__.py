"""The page of one case: its verdict, margins, pictures, equilibria, sensitivity and equations."""
