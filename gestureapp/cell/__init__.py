"""The cell: a pure state machine, the thread that drives it, and the link to the guardian."""
