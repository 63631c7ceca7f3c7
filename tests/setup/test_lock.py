"""The PIN: what opens it, for how long, and how long somebody who guesses has to wait."""

from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.setup.lock import (
    LONGEST_WAIT_S,
    OPEN_FOR_S,
    Lock,
    hash_pin,
    is_pin,
    is_readable,
    why_no_pin,
)

PIN = "2718"
HASH = hash_pin(PIN)


class ManualClock:
    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


def test_without_a_pin_everything_is_open_and_says_so():
    lock = Lock(ManualClock())
    lock.close()
    assert (lock.view.has_pin, lock.view.is_open) == (False, True)
    assert lock.view.text.startswith("No PIN is set: everybody may change everything here.")
    assert "whoever can write the settings file can do without it" in lock.view.text


def test_the_pin_opens_for_ten_minutes():
    clock = ManualClock()
    lock = Lock(clock, HASH)
    assert not lock.is_open
    lock.open(PIN)
    assert lock.view.text.startswith("Open for 10 more minutes.")
    clock.now_s += OPEN_FOR_S - 1
    assert lock.is_open
    assert lock.view.text.startswith("Open for 1 more minute.")
    clock.now_s += 1
    assert not lock.is_open


def test_whoever_leaves_can_lock_at_once():
    lock = Lock(ManualClock(), HASH)
    lock.open(PIN)
    lock.close()
    assert not lock.is_open


def test_each_wrong_pin_after_the_second_waits_longer_and_the_right_one_waits_too():
    clock = ManualClock()
    lock = Lock(clock, HASH)
    lock.open("0000")
    lock.open("0001")
    assert lock.view.text.startswith("Wrong PIN.")
    assert "Try again" not in lock.view.text
    waits = []
    for _ in range(9):
        lock.open("0002")
        waits.append(int(lock.view.text.split()[-2]))
        lock.open(PIN)
        assert not lock.is_open, "a try while the wait runs does not count"
        clock.now_s += waits[-1]
    assert waits == [5, 10, 20, 40, 80, 160, 300, 300, LONGEST_WAIT_S]
    lock.open(PIN)
    assert lock.is_open


def test_a_wrong_pin_closes_what_was_open():
    lock = Lock(ManualClock(), HASH)
    lock.open(PIN)
    lock.open("0000")
    assert not lock.is_open


def test_the_same_pin_is_kept_differently_each_time():
    assert hash_pin(PIN) != HASH
    assert PIN not in HASH.replace("$", " ").split()


@settings(max_examples=20, deadline=None)
@given(st.text("0123456789", min_size=4, max_size=12))
def test_only_the_pin_itself_opens(pin: str):
    assert why_no_pin(pin) == ""
    assert is_pin(pin, HASH) is (pin == PIN)


@given(st.text(max_size=20))
def test_a_pin_is_four_to_twelve_digits(text: str):
    is_fine = 4 <= len(text) <= 12 and set(text) <= set("0123456789")
    assert (why_no_pin(text) == "") is is_fine


@settings(deadline=None)
@given(st.text(max_size=120) | st.integers(0, len(HASH) - 1).map(lambda n: HASH[:n]))
def test_a_hash_that_is_damaged_opens_to_nobody(damaged: str):
    assert not is_readable(damaged)
    assert not is_pin(PIN, damaged)
