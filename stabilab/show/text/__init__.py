"""What each question answers: as text in the units of engineers, as JSON and as CSV."""
