"""An arm that makes gestures, and emulators that speak the real protocols: product code."""
