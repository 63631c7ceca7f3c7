"""An arm that makes gestures, and emulators that speak the real protocols. Product code, not test code."""
