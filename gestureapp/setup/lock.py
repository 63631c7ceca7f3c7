"""The site's PIN before settings that bear on motion: kept as a hash, open for ten minutes.

It keeps operators and engineers apart. It defends nothing: whoever can write the settings file can
do without it, and says so wherever it is asked for.
"""

import hashlib
import hmac
import math
import os
from typing import Final

from gestureapp.clock import Clock
from gestureapp.setup.site_values import LockView

OPEN_FOR_S: Final = 600.0
PIN_DIGITS: Final = (4, 12)
N_FREE_TRIES: Final = 2
"""Wrong PINs without a wait: a slip of the finger."""
FIRST_WAIT_S: Final = 5.0
LONGEST_WAIT_S: Final = 300.0

WHAT_FOR: Final = (
    "The PIN keeps operators and engineers apart. It is no protection: whoever can write the "
    "settings file can do without it."
)
NO_PIN: Final = f"No PIN is set: everybody may change everything here. {WHAT_FOR}"
_CLOSED: Final = "Settings that bear on motion are locked: give the PIN."
_DAMAGED: Final = "The PIN in {where} cannot be read: take [lock] out of that file to have none."

_KIND: Final = "scrypt"
_COST, _BLOCK, _PARALLEL = 2**14, 8, 1
"""Some 50 ms and 16 MB a try (RFC 7914); a PIN of few digits is found by trying all the same."""
_SALT_BYTES: Final = 16
_HASH_BYTES: Final = 32


def why_no_pin(pin: str) -> str:
    """What is wrong with a new PIN; empty when nothing is."""
    least, most = PIN_DIGITS
    if pin.isascii() and pin.isdigit() and least <= len(pin) <= most:
        return ""
    return f"A PIN has {least} to {most} digits and nothing else."


def hash_pin(pin: str) -> str:
    """What is kept of a PIN: kind, salt and hash. Takes some 50 ms."""
    salt = os.urandom(_SALT_BYTES)
    return f"{_KIND}${salt.hex()}${_hash(pin, salt).hex()}"


def is_readable(pin_hash: str) -> bool:
    """Whether this is what ``hash_pin`` makes; another never opens."""
    return _parts(pin_hash) is not None


def is_pin(pin: str, pin_hash: str) -> bool:
    """Whether this is the PIN that was hashed; never for a hash that is damaged."""
    parts = _parts(pin_hash)
    if parts is None or why_no_pin(pin):
        return False
    salt, kept = parts
    return hmac.compare_digest(_hash(pin, salt), kept)


def _hash(pin: str, salt: bytes) -> bytes:
    return hashlib.scrypt(
        pin.encode(), salt=salt, n=_COST, r=_BLOCK, p=_PARALLEL, dklen=_HASH_BYTES
    )


def _parts(pin_hash: str) -> tuple[bytes, bytes] | None:
    kind, _, rest = pin_hash.partition("$")
    salt_hex, _, kept_hex = rest.partition("$")
    try:
        salt, kept = bytes.fromhex(salt_hex), bytes.fromhex(kept_hex)
    except ValueError:
        return None
    fits = kind == _KIND and (len(salt), len(kept)) == (_SALT_BYTES, _HASH_BYTES)
    return (salt, kept) if fits else None


class Lock:
    """Whether settings that bear on motion may be changed now. One thread changes it, any looks.

    Args:
        clock: Monotonic seconds.
        pin_hash: Of the PIN; empty when none is set.
        where: The file and line of it, for messages.
    """

    def __init__(self, clock: Clock, pin_hash: str = "", where: str = "") -> None:
        self._clock = clock
        self._hash = pin_hash
        self._open_until_s = -math.inf
        self._n_wrong = 0
        self._wait_until_s = -math.inf
        self._said = ""
        self._where = where

    @property
    def has_pin(self) -> bool:
        """One is set, be it one that cannot be read."""
        return bool(self._hash)

    @property
    def is_open(self) -> bool:
        """It was given less than ten minutes ago, or there is none."""
        return not self._hash or self._clock() < self._open_until_s

    @property
    def view(self) -> LockView:
        """As the window shows it."""
        return LockView(self.has_pin, self.is_open, self._text())

    def open(self, pin: str) -> None:
        """Try a PIN; takes some 50 ms. While a wait runs, nothing is tried."""
        now_s = self._clock()
        if not self._hash or now_s < self._wait_until_s:
            return
        if is_pin(pin, self._hash):
            self._n_wrong, self._said = 0, ""
            self._open_until_s = now_s + OPEN_FOR_S
            return
        self._open_until_s = -math.inf
        self._n_wrong += 1
        self._said = "Wrong PIN."
        doublings = self._n_wrong - N_FREE_TRIES - 1
        if doublings >= 0:
            wait_s = min(FIRST_WAIT_S * 2 ** min(doublings, 10), LONGEST_WAIT_S)
            self._wait_until_s = now_s + wait_s

    def close(self) -> None:
        """Lock; without a PIN nothing is ever locked."""
        self._open_until_s, self._said = -math.inf, ""

    def say(self, text: str) -> None:
        """What else has to be told where the PIN is asked for, until the next try."""
        self._said = text

    def change(self, pin_hash: str, where: str = "") -> None:
        """There is another PIN now, or none; who set it need not give it at once."""
        was_open = self.is_open
        self._hash, self._where, self._n_wrong, self._said = pin_hash, where, 0, ""
        self._wait_until_s = -math.inf
        self._open_until_s = self._clock() + OPEN_FOR_S if was_open else -math.inf

    def _text(self) -> str:
        now_s = self._clock()
        if not self._hash:
            return f"{self._said} {NO_PIN}".lstrip()
        if not is_readable(self._hash):
            return _DAMAGED.format(where=self._where or "the settings file")
        if self.is_open:
            left_min = math.ceil((self._open_until_s - now_s) / 60)
            until = f"Open for {left_min} more minute{'s' if left_min > 1 else ''}."
            return f"{self._said} {until}".lstrip()
        if now_s < self._wait_until_s:
            left_s = math.ceil(self._wait_until_s - now_s)
            return f"{self._said} Try again in {left_s} s.".lstrip()
        return f"{self._said} {_CLOSED}".lstrip()
