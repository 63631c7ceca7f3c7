"""Session files: written while the cell runs, read afterwards. Uses the engine, is used by none of it."""
