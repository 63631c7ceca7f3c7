"""The virtual operator: buttons and keys that move the emulated arms. Only in simulation."""

from collections.abc import Callable
from functools import partial
from typing import Protocol

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from gestureapp.gestures import GESTURES
from gestureapp.guided.values import GuidedSnapshot
from gestureapp.sensing.values import Side
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.simulation.prompts import NOTHING, Prompt
from ui.labels import ElidedLabel, plain
from ui.prompts import prompt_of
from ui.setup_follower import SetupFollower, wish_of
from ui.theme import SMALL_PX, TEXT_PX, sized

HOW = "Both arms together: the left one takes the start posture as the right one moves"
FOLLOW_TIP = (
    "While guided training asks for gestures, the arms make them, with the timing of the person "
    "who wears the sensors; about one take in fifteen is done wrong on purpose. While setup asks "
    "for positions or postures, they are taken. Moving an arm by hand ends it."
)
GESTURE_KEYS = {
    "X+": "Up",
    "X-": "Down",
    "Y+": "Left",
    "Y-": "Right",
    "Z+": "PgUp",
    "Z-": "PgDown",
    "RX+": "Ctrl+Right",
    "RX-": "Ctrl+Left",
    "RY+": "Ctrl+Up",
    "RY-": "Ctrl+Down",
    "RZ+": "Ctrl+PgUp",
    "RZ-": "Ctrl+PgDown",
}
"""Never Esc, Pause or Space: the first two stop, the third presses whatever has the focus."""
_KEY_SIGNS = {"Up": "\u2191", "Down": "\u2193", "Left": "\u2190", "Right": "\u2192"}


class VirtualOperator(Protocol):
    """Moves the emulated arms. No call blocks."""

    def left_start(self) -> None:
        """The left arm takes the start posture."""

    def left_stop(self) -> None:
        """The left arm takes the stop posture."""

    def gesture(self, label: str) -> None:
        """Both arms together: the left one takes the start posture as the right one makes it."""

    def right_rest(self) -> None:
        """The right arm goes back to rest."""

    def follow(self, prompt: Prompt) -> None:
        """Do what a person is asked to do; called at every refresh while prompts are followed."""

    def lay(self, side: Side, position: str) -> None:
        """A sensor is taken off its arm and laid down, ``z-up`` and so on; then worn again."""

    def silence_left(self) -> None:
        """The left sensor sends nothing any more."""

    def restore_sensors(self) -> None:
        """Both sensors send as they should."""

    def describe(self) -> str:
        """What the arms are doing, in one line."""


class VirtualOperatorPanel(QFrame):
    """One button and one key for everything the emulated arms can do. GUI thread only."""

    def __init__(self, operator: VirtualOperator, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("virtualOperatorPanel")
        self._operator = operator
        self._setup_follower = SetupFollower(operator)
        self._follow = self._button("followPrompts", "", "follow prompts", "T", self._toggled)
        self._follow.setCheckable(True)
        self._follow.setToolTip(FOLLOW_TIP)
        title = plain("virtualOperatorTitle", TEXT_PX, is_wrapped=False)
        title.setText("Virtual operator")
        sized(title, TEXT_PX, is_bold=True)
        how = ElidedLabel(HOW)
        how.setObjectName("virtualOperatorHow")
        sized(how, SMALL_PX)
        self._doing = ElidedLabel()
        self._doing.setObjectName("virtualOperatorDoing")
        sized(self._doing, SMALL_PX)
        head = QHBoxLayout()
        head.setSpacing(14)
        head.addWidget(title)
        head.addWidget(how, 3)
        head.addWidget(self._doing, 2)
        grid = QGridLayout()
        grid.setSpacing(4)
        for column in range(1, 7):
            grid.setColumnStretch(column, 1)
        self._add_buttons(grid)
        grid.addWidget(self._follow, 1, 1 + len(GESTURES) // 2)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(10, 4, 10, 6)
        layout.setSpacing(4)
        layout.addLayout(head)
        layout.addLayout(grid)

    @property
    def is_following(self) -> bool:
        """Whether the arms do what training asks for."""
        return self._follow.isChecked()

    def refresh(
        self, guided: GuidedSnapshot | None = None, setup: SetupSnapshot | None = None
    ) -> None:
        """Show what the arms are doing now, and let them do what is asked for.

        Args:
            guided: What training shows; None while it is not to be seen.
            setup: What setting up shows; None while it is not to be seen.
        """
        if self.is_following:
            self._setup_follower.follow(setup)
            if wish_of(setup) is None:
                self._operator.follow(NOTHING if guided is None else prompt_of(guided))
        doing = self._operator.describe()
        if doing != self._doing.text():
            self._doing.setText(doing)

    def _add_buttons(self, grid: QGridLayout) -> None:
        operator = self._operator
        last = 1 + len(GESTURES) // 2
        for name, text, key, row, column, act in (
            ("leftStart", "left arm: START", "S", 0, 0, self._by_hand(operator.left_start)),
            ("leftStop", "left arm: STOP", "A", 1, 0, self._by_hand(operator.left_stop)),
            ("rightRest", "right arm: rest", "D", 0, last, self._by_hand(operator.right_rest)),
            ("silenceLeft", "silence left", "F", 0, last + 1, operator.silence_left),
            ("restoreSensors", "restore sensors", "G", 1, last + 1, operator.restore_sensors),
        ):
            grid.addWidget(self._button(name, "", text, key, act), row, column)
        for i, gesture in enumerate(GESTURES):
            label = gesture.label
            button = self._button(
                f"gesture_{label}",
                label,
                gesture.words,
                GESTURE_KEYS[label],
                self._by_hand(partial(operator.gesture, label)),
            )
            grid.addWidget(button, i // 6, 1 + i % 6)

    def _by_hand(self, act: Callable[[], None]) -> Callable[[], None]:
        """Who moves an arm by hand has taken it from the prompts."""

        def acted() -> None:
            if self.is_following:
                self._follow.click()
            act()

        return acted

    def _toggled(self) -> None:
        if not self.is_following:
            self._operator.follow(NOTHING)

    def _button(
        self, name: str, label: str, words: str, key: str, act: Callable[[], None]
    ) -> QPushButton:
        sequence = QKeySequence(key)
        head = f"{label}   [{_short(key)}]".strip()
        button = QPushButton(f"{head}\n{words}")
        button.setObjectName(name)
        button.setAccessibleName(f"{label} {words}, key {key}".strip())
        button.setAutoDefault(False)
        # Each has a key of its own; with the focus, a Space still held from arming would press one.
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        sized(button, SMALL_PX - 1)
        # The style's own margins are wider than nine columns allow on a small screen.
        button.setMinimumWidth(button.fontMetrics().horizontalAdvance(words) + 10)
        button.clicked.connect(lambda: act())
        shortcut = QShortcut(sequence, self, context=Qt.ShortcutContext.WindowShortcut)
        shortcut.setAutoRepeat(False)
        shortcut.activated.connect(button.click)
        return button


def _short(key: str) -> str:
    return "+".join(_KEY_SIGNS.get(part, part) for part in key.split("+"))
