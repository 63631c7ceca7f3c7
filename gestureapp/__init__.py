"""The engine: sensing, recognition, cell logic and robot link. Knows no window."""

__version__ = "0.1.0"
