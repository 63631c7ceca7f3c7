"""Guided training: takes recorded by rhythm or by the left arm, judged, checked, trained, tried."""
