"""The step Check: look at the takes, find the odd ones, and put them right."""

from collections import deque
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QPushButton,
    QStackedLayout,
    QVBoxLayout,
    QWidget,
)

from gestureapp.guided.check import GestureCheck, check_gesture, distance_g, map_takes
from gestureapp.guided.controls import GuidedControls
from gestureapp.guided.values import GuidedSnapshot
from gestureapp.recording.take_values import Take
from ui.check_gestures import CheckGestures
from ui.labels import plain
from ui.model_words import check_words
from ui.take_actions import TakeActions
from ui.take_curves import SHOWN_AT_ONCE, TakeCurves
from ui.take_list import TakeList
from ui.take_map import TakeMapView
from ui.theme import LARGE_PX, SMALL_PX

_NOTHING = "No takes yet: record some, and they are shown here beside each other."
_NOBODY = "Choose a person first."
_RIGHT_PX = 304


class CheckStep(QWidget):
    """The takes of the person, gesture by gesture and all together. GUI thread only.

    Takes are asked for again only when they have changed. What follows from that is done in jobs of
    a few milliseconds, one a refresh: all at once would hold the window up.

    Args:
        guided: Whose takes; changes are asked of it.
        parent: Qt's.
    """

    def __init__(self, guided: GuidedControls, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("checkStep")
        self._guided = guided
        self._version: tuple[str, int] | None = None
        self._labels: tuple[str, ...] = ()
        self._takes: dict[int, Take] = {}
        self._numbers: dict[int, int] = {}
        self._checks: dict[str, GestureCheck] = {}
        self._unseen: set[str] = set()
        self._jobs: deque[Callable[[], None]] = deque()
        self._held: int | None = None
        self._gestures = CheckGestures()
        self._curves = TakeCurves()
        self._map = TakeMapView()
        self._list = TakeList()
        self._actions = TakeActions(guided)
        self._compare = QPushButton("Compare with…")
        self._compare.setObjectName("compareTakes")
        self._compare.setAccessibleName("Hold the chosen take and compare it with the next one")
        self._compare.setCheckable(True)
        self._hint = plain("compareHint", SMALL_PX + 1)
        self._empty = plain("checkEmpty", LARGE_PX)
        self._empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._lay_out()
        self._gestures.label_chosen.connect(self._show_gesture)
        self._list.chosen_changed.connect(self._show_chosen)
        self._map.take_clicked.connect(self._choose_take)
        self._compare.toggled.connect(self._hold)
        self._actions.add_keys(self)

    def show_snapshot(self, snapshot: GuidedSnapshot) -> None:
        """Show another moment; nothing is done while the step is out of sight."""
        if not self.isVisible():
            return
        self._actions.show_snapshot(snapshot)
        version = (snapshot.person, snapshot.version)
        if version != self._version:
            self._version = version
            self._labels = tuple(each.label for each in snapshot.progress)
            self._reload()
        elif self._jobs:
            self._jobs.popleft()()
        odd = {label: check.n_odd for label, check in self._checks.items()}
        self._gestures.show_progress(snapshot.progress, odd)
        if not self._gestures.label:
            self._gestures.choose(snapshot.label)
        self._show_whether_empty(snapshot)

    @property
    def is_settled(self) -> bool:
        """Everything that is known is in sight."""
        return not self._jobs

    def _reload(self) -> None:
        """Ask for the takes; what is in sight is looked at first, then the map, then the rest."""
        self._takes = {take.id: take for take in self._guided.takes()}
        found = {take.label for take in self._takes.values()}
        self._labels += tuple(sorted(found - set(self._labels)))
        if self._held not in self._takes:
            self._compare.setChecked(False)
        self._unseen = set(self._labels)
        self._jobs = deque([self._look_at_chosen, self._show_curves, self._show_list])
        self._jobs.append(self._lay_out_map)
        self._jobs.extend(partial(self._look_at, label) for label in self._labels)

    def _look_at(self, label: str) -> None:
        if label not in self._unseen:
            return
        self._unseen.remove(label)
        takes = [take for take in self._takes.values() if take.label == label]
        check = self._checks[label] = check_gesture(label, takes)
        self._numbers.update({checked.take.id: checked.number for checked in check.takes})

    def _look_at_chosen(self) -> None:
        self._look_at(self._gestures.label)

    def _show_gesture(self, label: str) -> None:
        self._look_at(label)
        self._show_curves()
        self._show_list()

    def _show_curves(self) -> None:
        check = self._checks.get(self._gestures.label)
        if check is not None:
            self._curves.show_check(check, check_words(check))

    def _show_list(self) -> None:
        check = self._checks.get(self._gestures.label)
        if check is not None:
            self._list.show_check(check)
            self._show_chosen()

    def _lay_out_map(self) -> None:
        labels = self._map.show_map(map_takes(list(self._takes.values())), self._labels)
        drawings = [partial(self._map.draw, label) for label in labels]
        self._jobs.extendleft(reversed([*drawings, self._show_chosen]))

    def _choose_take(self, take_id: int) -> None:
        """A take was clicked on the map, of whatever gesture."""
        take = self._takes.get(take_id)
        if take is None:
            return
        self._gestures.choose(take.label)
        self._list.choose({take_id})
        self._show_chosen()

    def _hold(self, is_held: bool) -> None:
        """Keep the chosen take, to be compared with the one that is chosen next."""
        chosen = self._list.chosen
        self._held = chosen[0].take.id if is_held and chosen else None
        if is_held and self._held is None:
            self._compare.setChecked(False)
        self._show_chosen()

    def _show_chosen(self) -> None:
        chosen = [checked.take for checked in self._list.chosen]
        shown = [take for take in chosen if take.id != self._held]
        if self._held is not None:
            shown.insert(0, self._takes[self._held])
        self._curves.show_chosen(shown)
        ids = tuple(take.id for take in shown[:SHOWN_AT_ONCE])
        self._map.highlight(self._gestures.label, ids)
        self._actions.show_takes(chosen, self._labels)
        self._compare.setEnabled(bool(chosen) or self._held is not None)
        self._hint.setText(self._comparison(shown))

    def _comparison(self, shown: list[Take]) -> str:
        if len(shown) == SHOWN_AT_ONCE:
            one, other = shown
            return (
                f"{self._name(one)} (solid) and {self._name(other)} (dashed) "
                f"are {distance_g(one, other):.2f} g apart."
            )
        if self._held is not None:
            held = self._name(self._takes[self._held])
            return f"{held} is held: choose the other one, in a list or on the map."
        if len(shown) > SHOWN_AT_ONCE:
            return f"{len(shown)} takes chosen; the first two are drawn."
        return ""

    def _name(self, take: Take) -> str:
        """``Take 12 of X+``, numbered as in the list."""
        return f"Take {self._numbers.get(take.id, 0)} of {take.label}"

    def _show_whether_empty(self, snapshot: GuidedSnapshot) -> None:
        self._empty.setText(_NOTHING if snapshot.person else _NOBODY)
        wanted = self._full if self._takes else self._empty
        if self._stack.currentWidget() is not wanted:
            self._stack.setCurrentWidget(wanted)

    def _lay_out(self) -> None:
        middle = QVBoxLayout()
        middle.setSpacing(6)
        middle.addWidget(self._curves, 5)
        middle.addWidget(self._map, 6)
        right = QVBoxLayout()
        right.setSpacing(6)
        right.addWidget(self._list, 1)
        right.addWidget(self._compare)
        right.addWidget(self._hint)
        right.addWidget(self._actions)
        # Two lines are kept, so that nothing jumps.
        self._hint.setMinimumHeight(2 * self._hint.fontMetrics().lineSpacing())
        side = QFrame()
        side.setFixedWidth(_RIGHT_PX)
        side.setLayout(right)
        right.setContentsMargins(0, 0, 0, 0)
        self._full = QWidget()
        row = QHBoxLayout(self._full)
        row.setContentsMargins(8, 6, 8, 6)
        row.setSpacing(10)
        row.addWidget(self._gestures)
        row.addLayout(middle, 1)
        row.addWidget(side)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self._empty)
        self._stack.addWidget(self._full)
