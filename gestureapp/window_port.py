"""What the engine may ask of a window it knows nothing about: to be shown, and to be pressed."""

from collections.abc import Callable
from typing import Protocol

from gestureapp.running import RunningCell


class WindowHands(Protocol):
    """Presses what a person would press, as events of the window's own queue. Any thread."""

    def press_stop(self) -> float:
        """Press STOP with the mouse. Returns when the event was posted, monotonic seconds."""

    def press_stop_key(self) -> float:
        """Press Esc in the window that has the keyboard. Returns when the event was posted."""

    def open_dialog(self, text: str) -> None:
        """Open a modal dialog before the window, as a message that waits for an answer."""

    def close_dialog(self) -> None:
        """Close that dialog again; nothing when there is none."""

    def call(self, work: Callable[[], None]) -> None:
        """Have the window's own thread do something between two events."""

    def close(self) -> None:
        """Close the window."""


Driver = Callable[[WindowHands], None]
"""Runs in a thread of its own while the window is open, and uses it as a person would."""


class OpenWindow(Protocol):
    """Shows a running cell until the window is closed."""

    def __call__(
        self, running: RunningCell, exit_after_s: float | None, driver: Driver | None = None
    ) -> int:
        """Show it; the exit code."""
