"""Setup: from a box of sensors to a cell that is ready."""
