"""The rail on the left: the places of the application, one word and one icon each."""

from collections.abc import Callable
from enum import Enum

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QAbstractButton, QButtonGroup, QFrame, QVBoxLayout, QWidget

from ui.theme import SMALL_PX, TEXT_PX, colours_of

RAIL_PX = 84
_ENTRY_PX = 84
_NOTE_PX = 52
"""Three lines kept for a note, so that nothing moves when one comes."""
_ICON_PX = 34


class Place(Enum):
    """Where a person can be; the value is the word on the rail."""

    OPERATE = "Operate"
    TRAIN = "Train"
    SETUP = "Setup"


class NavButton(QAbstractButton):
    """An entry of the rail; while it cannot be entered it says why. GUI thread only."""

    def __init__(self, place: Place, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._place = place
        self._note = ""
        self.setObjectName(f"nav{place.value}")
        self.setText(place.value)
        self.setAccessibleName(place.value)
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setFixedSize(RAIL_PX, _ENTRY_PX + _NOTE_PX)

    @property
    def note(self) -> str:
        """Why it cannot be entered now; empty when it can."""
        return self._note

    def show_note(self, note: str) -> None:
        """Say why the place cannot be entered, or take that back with an empty note."""
        if note == self._note:
            return
        self._note = note
        self.setEnabled(not note)
        self.setToolTip(note)
        self.setAccessibleName(f"{self._place.value}: {note}" if note else self._place.value)
        self.update()

    def sizeHint(self) -> QSize:
        """Icon, word and note."""
        return QSize(RAIL_PX, _ENTRY_PX + _NOTE_PX)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw ground, icon, word and note."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        colours = colours_of(self.palette())
        entry = QRectF(0, 0, self.width(), _ENTRY_PX)
        if self.isChecked():
            painter.fillRect(entry, QColor(colours.base))
            painter.fillRect(QRectF(0, 0, 5, _ENTRY_PX), QColor(colours.info))
        if self.hasFocus():
            painter.setPen(QPen(QColor(colours.info), 1, Qt.PenStyle.DotLine))
            painter.drawRect(entry.adjusted(1, 1, -2, -2))
        colour = QColor(colours.text if self.isEnabled() else colours.muted)
        icon = QRectF((self.width() - _ICON_PX) / 2, 12, _ICON_PX, _ICON_PX)
        painter.setPen(QPen(colour, 2.2, c=Qt.PenCapStyle.RoundCap, j=Qt.PenJoinStyle.RoundJoin))
        _ICONS[self._place](painter, icon)
        font = QFont(self.font())
        font.setPixelSize(TEXT_PX + 2)
        font.setBold(True)
        painter.setFont(font)
        word = QRectF(0, 50, self.width(), 26)
        painter.drawText(word, Qt.AlignmentFlag.AlignCenter, self.text())
        if self._note:
            font.setPixelSize(SMALL_PX)
            font.setBold(False)
            painter.setFont(font)
            below = QRectF(3, _ENTRY_PX, self.width() - 6, _NOTE_PX)
            flags = Qt.AlignmentFlag.AlignHCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(below, flags, self._note)
        painter.end()


class NavRail(QFrame):
    """One entry for each place; one of them is always checked. GUI thread only.

    Signals:
        chosen: A person wants to go to this ``Place``.
    """

    chosen = Signal(Place)

    def __init__(self, places: tuple[Place, ...], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("navRail")
        self.setFixedWidth(RAIL_PX + 2)
        self._entries = {place: NavButton(place) for place in places}
        group = QButtonGroup(self)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        for place, entry in self._entries.items():
            group.addButton(entry)
            entry.clicked.connect(self._chooser(place))
            layout.addWidget(entry)
        layout.addStretch(1)
        self.show_place(places[0])

    def show_place(self, place: Place) -> None:
        """Mark where the window is."""
        self._entries[place].setChecked(True)

    def show_note(self, place: Place, note: str) -> None:
        """Say why a place cannot be entered now; an empty note opens it."""
        if place in self._entries:
            self._entries[place].show_note(note)

    def _chooser(self, place: Place) -> Callable[[], None]:
        return lambda: self.chosen.emit(place)


def _draw_robot(painter: QPainter, area: QRectF) -> None:
    """An arm of two links on a foot, with the tool's tip."""
    x, y, s = area.left(), area.top(), area.width()

    def at(u: float, v: float) -> QPointF:
        return QPointF(x + u * s, y + v * s)

    painter.drawLine(at(0.10, 1.0), at(0.60, 1.0))
    painter.drawPolyline([at(0.35, 1.0), at(0.30, 0.42), at(0.78, 0.20), at(0.92, 0.52)])
    for joint in (at(0.30, 0.42), at(0.78, 0.20)):
        painter.drawEllipse(joint, s * 0.07, s * 0.07)


def _draw_hand(painter: QPainter, area: QRectF) -> None:
    """A hand that moves: a fist on a forearm, and the arcs of its beat."""
    x, y, s = area.left(), area.top(), area.width()
    painter.drawPolyline(
        [
            QPointF(x, y + 0.95 * s),
            QPointF(x + 0.36 * s, y + 0.60 * s),
        ]
    )
    painter.drawEllipse(QPointF(x + 0.49 * s, y + 0.47 * s), s * 0.18, s * 0.18)
    for reach in (0.34, 0.52):
        arc = QRectF(x + (0.49 - reach) * s, y + (0.47 - reach) * s, 2 * reach * s, 2 * reach * s)
        painter.drawArc(arc, 5 * 16, 80 * 16)


def _draw_sliders(painter: QPainter, area: QRectF) -> None:
    """Three sliders, each at another place."""
    x, y, s = area.left(), area.top(), area.width()
    for row, place in ((0.15, 0.68), (0.50, 0.30), (0.85, 0.58)):
        knob, middle = s * 0.10, y + row * s
        at = x + place * s
        painter.drawLine(QPointF(x, middle), QPointF(at - knob, middle))
        painter.drawLine(QPointF(at + knob, middle), QPointF(x + s, middle))
        painter.drawEllipse(QPointF(at, middle), knob, knob)


_ICONS: dict[Place, Callable[[QPainter, QRectF], None]] = {
    Place.OPERATE: _draw_robot,
    Place.TRAIN: _draw_hand,
    Place.SETUP: _draw_sliders,
}
