"""Where a sensor is and what it speaks: a list of ports that takes any other one typed in."""

from typing import Final

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QComboBox, QGridLayout, QSizePolicy, QWidget

from gestureapp.sensing.values import Side
from gestureapp.setup.values import PortChoice, SensorCard
from ui.labels import ElidedLabel, plain
from ui.setup_words import port_text
from ui.theme import SMALL_PX, TEXT_PX, sized

TAKEN_WITHIN_MS: Final = 1500
"""A wish that is taken is in the picture by then; what was not must not look as if it were."""
_NOWHERE = "type a port or choose one"


class PortChooser(QWidget):
    """Port and protocol of one sensor. GUI thread only.

    Signals:
        chosen: The person wants this port (``str``) with this protocol (``str``).
    """

    chosen = Signal(str, str)

    def __init__(
        self, side: Side, protocols: tuple[tuple[str, str], ...], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        name = side.value
        self._card: SensorCard | None = None
        self._ports: tuple[PortChoice, ...] = ()
        self._asked: tuple[str, str] | None = None
        """Since the last moment shown: Qt hands one Enter to the line twice."""
        self._patience = QTimer(self, singleShot=True, interval=TAKEN_WITHIN_MS)
        self._patience.timeout.connect(self._show_as_it_is)
        self._wish = ""
        self._port = _QuietCombo(f"{name}Port", f"Port of the {name} arm's sensor")
        self._port.setEditable(True)
        self._port.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self._protocol = _QuietCombo(f"{name}Protocol", f"Protocol of the {name} arm's sensor")
        for word, about in protocols:
            self._protocol.addItem(word, word)
            self._protocol.setItemData(
                self._protocol.count() - 1, about, Qt.ItemDataRole.ToolTipRole
            )
        self._about = ElidedLabel()
        self._about.setObjectName(f"{name}PortAbout")
        sized(self._about, SMALL_PX)
        self._abouts = dict(protocols)
        self._lay_out(name)
        self._connect()

    def show_card(self, card: SensorCard, ports: tuple[PortChoice, ...]) -> None:
        """Show what is chosen, and what could be; what a person is typing stays."""
        if ports != self._ports and not self._port.view().isVisible():
            self._ports = ports
            self._fill()
            self._show_port(card.port)
        if self._card is None or card.port != self._card.port:
            self._show_port(card.port)
        if self._card is None or card.protocol != self._card.protocol:
            self._protocol.setCurrentIndex(self._protocol.findData(card.protocol))
        self._card, self._asked = card, None
        trouble = next((each.trouble for each in ports if each.url == card.port), "")
        about = f"Port: {trouble}" if trouble else self._abouts.get(card.protocol, "")
        if about != self._about.text():
            self._about.setText(about)
            self._about.setToolTip(about)

    def _fill(self) -> None:
        self._port.clear()
        for port in self._ports:
            self._port.addItem(port_text(port), port.url)

    def _show_port(self, url: str) -> None:
        index = self._port.findData(url)
        self._port.setCurrentIndex(index)
        self._port.setEditText(url if index < 0 else self._port.itemText(index))

    def _show_as_it_is(self) -> None:
        """Take back what was wished for and not taken; what is typed since stays."""
        if self._card is None:
            return
        if self._port.currentText() == self._wish:
            self._show_port(self._card.port)
        self._protocol.setCurrentIndex(self._protocol.findData(self._card.protocol))

    def _take_item(self, index: int) -> None:
        self._choose(self._port.itemData(index))

    def _take_typed(self) -> None:
        text = self._port.currentText().strip()
        if text and self._port.findText(text) < 0:
            self._choose(text)

    def _take_protocol(self, index: int) -> None:
        if self._card is not None and self._card.port:
            self._choose(self._card.port)

    def _choose(self, port: str) -> None:
        wish = (port, self._protocol.currentData())
        is_so = self._card is not None and wish == (self._card.port, self._card.protocol)
        if not is_so and wish != self._asked:
            self._asked = wish
            self._wish = self._port.currentText()
            self._patience.start()
            self.chosen.emit(*wish)

    def _connect(self) -> None:
        self._port.activated.connect(self._take_item)
        line = self._port.lineEdit()
        if line is not None:
            line.setPlaceholderText(_NOWHERE)
            line.returnPressed.connect(self._take_typed)
        self._protocol.activated.connect(self._take_protocol)

    def _lay_out(self, name: str) -> None:
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setHorizontalSpacing(8)
        layout.setVerticalSpacing(1)
        layout.setColumnStretch(0, 5)
        layout.setColumnStretch(1, 3)
        for column, (title, combo) in enumerate(
            (("Port", self._port), ("Protocol", self._protocol))
        ):
            caption = plain(f"{name}{title}Caption", SMALL_PX, is_wrapped=False)
            caption.setText(title)
            layout.addWidget(caption, 0, column)
            layout.addWidget(combo, 1, column)
        layout.addWidget(self._about, 2, 0, 1, 2)


class _QuietCombo(QComboBox):
    """The wheel scrolls the page and changes nothing; long names are cut, not the card."""

    def __init__(self, name: str, spoken: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAccessibleName(spoken)
        self.setMinimumContentsLength(8)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMinimumHeight(30)
        sized(self, TEXT_PX + 1)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Leave it to the page."""
        event.ignore()
