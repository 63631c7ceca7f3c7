"""Small parts of the setup's steps: buttons, figures with captions, an outcome with its mark."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QAbstractButton,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from gestureapp.setup.values import Check, Outcome
from ui.labels import plain
from ui.marks import Level, Mark
from ui.theme import LARGE_PX, SMALL_PX, TEXT_PX, sized

BUTTON_PX = 40


def push(name: str, text: str, spoken: str = "", size_px: int = TEXT_PX + 1) -> QPushButton:
    """A button that keeps the focus where it is when the mouse presses it.

    Args:
        name: objectName.
        text: What stands on it.
        spoken: Its accessible name, when the text alone does not say it.
        size_px: Letter height.
    """
    button = QPushButton(text)
    button.setObjectName(name)
    button.setAccessibleName(spoken or text)
    button.setAutoDefault(False)
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    button.setMinimumHeight(BUTTON_PX)
    sized(button, size_px)
    return button


def enable(button: QAbstractButton, can_be_pressed: bool) -> None:
    """Open or close a button; one that has the keyboard gives it to its panel, not to a neighbour.

    Else Space would press whatever Qt hands the focus to.
    """
    panel = button.parentWidget()
    if button.hasFocus() and not can_be_pressed and panel is not None:
        panel.setFocus()
    button.setEnabled(can_be_pressed)


def say(label: QLabel, text: str) -> None:
    """Show another text; an empty one keeps the label's room."""
    if label.text() != text:
        label.setText(text)


class Figure(QWidget):
    """A number in large letters under what it is."""

    def __init__(self, name: str, caption: str, size_px: int = LARGE_PX) -> None:
        super().__init__()
        above = plain(f"{name}Caption", SMALL_PX, is_wrapped=False)
        above.setText(caption)
        self._caption = caption
        self._value = plain(name, size_px, is_wrapped=False)
        sized(self._value, size_px, is_bold=True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(above)
        layout.addWidget(self._value)

    def show_value(self, text: str) -> None:
        """Show another value with its unit."""
        if text != self._value.text():
            self._value.setText(text)
            self._value.setAccessibleName(f"{self._caption}: {text}")


class OutcomeLine(QWidget):
    """How a test ended: its mark, the word, and what was found."""

    def __init__(self, name: str, size_px: int = LARGE_PX) -> None:
        super().__init__()
        self._mark = Mark(size_px)
        self._text = plain(name, size_px)
        self._text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(10)
        layout.addWidget(self._mark)
        layout.addWidget(self._text, 1)

    def show_outcome(self, outcome: Outcome, before: str = "", above: str = "") -> None:
        """Show how it ended.

        Args:
            outcome: The test's.
            before: What is said while it has not been run.
            above: What stands in large letters already; it is not said twice.
        """
        self._mark.show_level(check_level(outcome.check))
        found = "" if outcome.text == above else outcome.text
        text = f"{outcome.check.value}: {found}" if found else outcome.check.value
        if outcome.check is Check.NOT_RUN and before:
            text = before
        say(self._text, text)


def check_level(check: Check) -> Level:
    """The mark of a test's end."""
    return {
        Check.NOT_RUN: Level.OFF,
        Check.RUNNING: Level.BUSY,
        Check.PASSED: Level.OK,
        Check.FAILED: Level.ATTENTION,
    }[check]
