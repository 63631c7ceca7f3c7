"""The emulated NX100's variables: bytes, integers, reals, strings; LOADV writes, SAVEV reads. Pure.

Positions (types 4 to 6) are not held here and get the code of data that cannot be loaded. Source
for types and ranges: other clients' notes on LOADV and SAVEV; for reals' decimals there is none.
"""

from gestureapp.simulation.nx100_values import Code

NUMBER_MAX = 99
STRING_MAX_CHARS = 16
_BYTE, _INTEGER, _DOUBLE, _REAL, _STRING = 0, 1, 2, 3, 7
_RANGES = {_BYTE: (0, 255), _INTEGER: (-(2**15), 2**15 - 1), _DOUBLE: (-(2**31), 2**31 - 1)}
_POSITIONS = (4, 5, 6)


class Variables:
    """Every variable is 0, or empty, until it is written. Owned by the controller."""

    def __init__(self) -> None:
        self._values: dict[tuple[int, int], str] = {}

    def load(self, kind: int, number: int, word: str) -> Code:
        """LOADV: write one, or say why not."""
        if (code := _why_not(kind, number)) is not Code.OK:
            return code
        written = _written(kind, word)
        if isinstance(written, Code):
            return written
        self._values[kind, number] = written
        return Code.OK

    def save(self, kind: int, number: int) -> Code | str:
        """SAVEV: read one, or say why not."""
        if (code := _why_not(kind, number)) is not Code.OK:
            return code
        nothing = {_REAL: "0.000", _STRING: ""}.get(kind, "0")
        return self._values.get((kind, number), nothing)


def _why_not(kind: int, number: int) -> Code:
    if kind in _POSITIONS:
        return Code.NOT_LOADABLE
    is_known = kind in (*_RANGES, _REAL, _STRING) and 0 <= number <= NUMBER_MAX
    return Code.OK if is_known else Code.OPERAND_VALUE


def _written(kind: int, word: str) -> str | Code:
    if kind == _STRING:
        return word if len(word) <= STRING_MAX_CHARS else Code.OPERAND_LENGTH
    try:
        number = float(word) if kind == _REAL else int(word)
    except ValueError:
        return Code.OPERAND_VALUE
    if kind == _REAL:
        return f"{number:.3f}" if abs(number) < 1e38 else Code.DATA_RANGE
    low, high = _RANGES[kind]
    return str(number) if low <= number <= high else Code.DATA_RANGE
