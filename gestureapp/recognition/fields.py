"""Reading values out of parsed JSON; ``ValueError`` says in a line what is wrong with one. Pure."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

LARGEST_COUNT = 10**9


def labels_in(value: object) -> tuple[str, ...]:
    """Names of gestures: at least one, none twice."""
    if not isinstance(value, list) or not value:
        raise ValueError("'labels' is missing")
    if not all(isinstance(label, str) and label for label in value):
        raise ValueError("'labels' must hold texts")
    if len(set(value)) != len(value):
        raise ValueError("'labels' names a gesture twice")
    return tuple(value)


def object_in(content: Mapping[str, object], name: str) -> Mapping[str, object]:
    """The JSON object under this name."""
    value = content.get(name)
    if not isinstance(value, dict):
        raise ValueError(f"'{name}' is missing")
    return value


def text_in(content: Mapping[str, object], name: str) -> str:
    """The text under this name."""
    value = content.get(name)
    if not isinstance(value, str):
        raise ValueError(f"'{name}' must be a text")
    return value


def number_in(content: Mapping[str, object], name: str) -> float:
    """The finite number under this name."""
    value = content.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ValueError(f"'{name}' must be a number")
    try:
        number = float(value)
    except OverflowError as error:
        raise ValueError(f"'{name}' is too large") from error
    if not math.isfinite(number):
        raise ValueError(f"'{name}' is not finite")
    return number


def count_in(content: Mapping[str, object], name: str) -> int:
    """The count under this name: a whole number from 0 to ``LARGEST_COUNT``."""
    number = number_in(content, name)
    if number != int(number) or not 0 <= number <= LARGEST_COUNT:
        raise ValueError(f"'{name}' must be a count")
    return int(number)


def table_in(weights: Mapping[str, object], name: str, ndim: int) -> NDArray[np.float64]:
    """The numbers under this name, in so many dimensions."""
    try:
        table = np.array(weights.get(name))
        if table.ndim != ndim or table.dtype.kind not in "fi":
            raise ValueError(f"'{name}' must be numbers in {ndim} dimensions")
        return table.astype(np.float64)
    except (TypeError, OverflowError) as error:
        raise ValueError(f"'{name}' cannot be used") from error
