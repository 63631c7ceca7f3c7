"""The last five lines of the cell's story, newest on top."""

from PySide6.QtWidgets import QFrame, QGridLayout, QWidget

from gestureapp.cell.snapshot import EventLine
from ui.labels import ElidedLabel, plain
from ui.marks import Level, Mark
from ui.theme import SMALL_PX, TEXT_PX, sized
from ui.words import event_text

SHOWN = 5


class EventList(QFrame):
    """Five fixed lines; an alarm has its red square."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("eventList")
        self._shown: tuple[EventLine, ...] = ()
        title = plain("eventTitle", TEXT_PX, is_wrapped=False)
        title.setText("Last events")
        sized(title, TEXT_PX, is_bold=True)
        layout = QGridLayout(self)
        layout.setContentsMargins(10, 6, 8, 6)
        layout.setHorizontalSpacing(6)
        layout.setVerticalSpacing(2)
        layout.addWidget(title, 0, 0, 1, 2)
        self._lines: list[tuple[Mark, ElidedLabel]] = []
        for i in range(SHOWN):
            mark, line = Mark(11), ElidedLabel()
            line.setObjectName(f"event_{i}")
            sized(line, SMALL_PX)
            layout.addWidget(mark, i + 1, 0)
            layout.addWidget(line, i + 1, 1)
            mark.hide()
            self._lines.append((mark, line))
        layout.setColumnStretch(1, 1)

    def show_events(self, events: tuple[EventLine, ...]) -> None:
        """Show the newest of these; the newest comes last in the argument."""
        newest = events[: -SHOWN - 1 : -1]
        if newest == self._shown:
            return
        self._shown = newest
        for i, (mark, line) in enumerate(self._lines):
            mark.setVisible(i < len(newest))
            text = event_text(newest[i]) if i < len(newest) else ""
            if i < len(newest):
                mark.show_level(Level.ALARM if newest[i].is_alarm else Level.OFF)
            line.setText(text)
            line.setToolTip(text)
            line.setAccessibleName(text)
