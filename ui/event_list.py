"""The last five lines of the cell's story, newest on top."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QWidget

from gestureapp.cell.snapshot import EventLine
from ui.labels import plain
from ui.marks import Level, Mark
from ui.theme import SMALL_PX, TEXT_PX, sized
from ui.words import time_text

SHOWN = 5


class EventList(QFrame):
    """Time and text of each event, the text in full; an alarm has its red square."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("eventList")
        self._shown: tuple[EventLine, ...] = ()
        self._lines: list[tuple[Mark, QLabel, QLabel]] = []
        title = plain("eventTitle", TEXT_PX, is_wrapped=False)
        title.setText("Last events")
        sized(title, TEXT_PX, is_bold=True)
        layout = QGridLayout(self)
        layout.setContentsMargins(10, 6, 8, 6)
        layout.setHorizontalSpacing(6)
        layout.setVerticalSpacing(2)
        layout.setColumnStretch(2, 1)
        layout.addWidget(title, 0, 0, 1, 3)
        top = Qt.AlignmentFlag.AlignTop
        for i in range(SHOWN):
            mark = Mark(12)
            when = plain(f"eventTime_{i}", SMALL_PX, is_wrapped=False)
            what = plain(f"event_{i}", SMALL_PX)
            for column, widget in enumerate((mark, when)):
                layout.addWidget(widget, i + 1, column, top)
            what.setAlignment(top)
            layout.addWidget(what, i + 1, 2)
            mark.hide()
            self._lines.append((mark, when, what))
        layout.setRowStretch(SHOWN + 1, 1)

    def show_events(self, events: tuple[EventLine, ...]) -> None:
        """Show the newest of these; the newest comes last in the argument."""
        newest = events[: -SHOWN - 1 : -1]
        if newest == self._shown:
            return
        self._shown = newest
        for i, (mark, when, what) in enumerate(self._lines):
            mark.setVisible(i < len(newest))
            if i >= len(newest):
                when.clear()
                what.clear()
                continue
            mark.show_level(Level.ALARM if newest[i].is_alarm else Level.OFF)
            when.setText(time_text(newest[i]))
            what.setText(newest[i].text)
            what.setAccessibleName(f"{when.text()} {newest[i].text}")
