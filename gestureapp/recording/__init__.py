"""Session files: written while the cell runs, read afterwards. Nothing of the engine uses it."""
