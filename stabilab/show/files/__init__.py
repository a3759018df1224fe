"""What is written beside an answer: manifests, trajectories; and making it again."""
