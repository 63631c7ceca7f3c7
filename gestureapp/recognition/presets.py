"""The recipes of training, by name. Known to the window; torch is not."""

from enum import Enum

MIN_TAKES = 5
"""Fewest takes of a gesture worth training from; ``small`` holds one of five out."""


class Preset(Enum):
    """How to train."""

    DEFAULT = "default"
    """Networks that follow the movement from its onset, from the shared base model; the default."""
    PAPER = "paper"
    """As the paper: 9-10-12, learning rate 0.25, 100,000 cycles. See ``training.PAPER_RULE``."""
    SMALL = "small"
    """The paper's network, early stopping on held-out takes, the best of several starts."""
