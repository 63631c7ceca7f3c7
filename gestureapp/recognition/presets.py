"""The recipes of training, by name. Known to the window; torch is not."""

from enum import Enum

MIN_TAKES = 5
"""Fewest takes of a gesture worth training from; one of five is held out by the default preset."""


class Preset(Enum):
    """How to train."""

    PAPER = "paper"
    """As the paper: 9-10-12, learning rate 0.25, 100,000 cycles. See ``training.PAPER_RULE``."""
    DEFAULT = "default"
    """The same network, early stopping on held-out takes, the best of several starts."""
