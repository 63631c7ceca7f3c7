"""The right arm's samples to a gesture, or to an honest "not recognised"."""
