"""The strip on top: mode, arms, robot, person, model, recording, each as shape + word + number."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from gestureapp.cell.snapshot import Snapshot
from ui.labels import ElidedLabel
from ui.marks import Level, Mark
from ui.theme import SMALL_PX, TEXT_PX, sized
from ui.words import Chip, mode_chip, robot_chip, stream_chip, strip_line, supervision_chip


class ChipView(QWidget):
    """One place of the strip: what it is about, and below it the mark with the word."""

    def __init__(self, name: str, title: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self._title = title
        self._mark = Mark(14)
        caption = ElidedLabel(title)
        sized(caption, SMALL_PX)
        self._value = ElidedLabel()
        self._value.setObjectName(f"{name}Value")
        sized(self._value, TEXT_PX + 1, is_bold=True)
        self._value.setTextFormat(Qt.TextFormat.PlainText)
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setHorizontalSpacing(6)
        layout.setVerticalSpacing(1)
        layout.addWidget(caption, 0, 0, 1, 2)
        layout.addWidget(self._mark, 1, 0)
        layout.addWidget(self._value, 1, 1)
        layout.setColumnStretch(1, 1)

    @property
    def text(self) -> str:
        """The word and number shown."""
        return self._value.text()

    @property
    def level(self) -> Level:
        """The mark shown."""
        return self._mark.level

    def show_chip(self, chip: Chip) -> None:
        """Show another value."""
        self._mark.show_level(chip.level)
        if chip.text != self._value.text():
            self._value.setText(chip.text)
            self.setToolTip(chip.text)
            self.setAccessibleName(f"{self._title}: {chip.text}")


class StatusStrip(QFrame):
    """Never hidden; the line below the chips says in plain text what is wrong with a device."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("statusStrip")
        self._mode = ChipView("modeChip", "Mode")
        self._left = ChipView("leftChip", "Left arm")
        self._right = ChipView("rightChip", "Right arm")
        self._robot = ChipView("robotChip", "Robot")
        self._supervision = ChipView("supervisionChip", "Controller supervision")
        self._person = ChipView("personChip", "Person")
        self._model = ChipView("modelChip", "Model")
        self._recording = ChipView("recordingChip", "Recording")
        self._line = ElidedLabel()
        self._line.setObjectName("stripLine")
        self._line.setTextFormat(Qt.TextFormat.PlainText)
        sized(self._line, SMALL_PX + 1)
        row = QHBoxLayout()
        row.setSpacing(14)
        for chip, share in (
            (self._mode, 13),
            (self._left, 13),
            (self._right, 13),
            (self._robot, 14),
            (self._supervision, 15),
            (self._person, 15),
            (self._model, 20),
            (self._recording, 22),
        ):
            row.addWidget(chip, share)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(12, 5, 12, 4)
        layout.setSpacing(3)
        layout.addLayout(row)
        layout.addWidget(self._line)

    def show_snapshot(self, snapshot: Snapshot) -> None:
        """Show another moment."""
        self._mode.show_chip(mode_chip(snapshot.is_simulation))
        self._left.show_chip(stream_chip(snapshot.left, snapshot.trip_level_s))
        self._right.show_chip(stream_chip(snapshot.right, snapshot.trip_level_s))
        self._robot.show_chip(robot_chip(snapshot.robot))
        self._supervision.show_chip(supervision_chip(snapshot.robot))
        self._person.show_chip(
            Chip(Level.OK if snapshot.person else Level.OFF, snapshot.person or "nobody")
        )
        self._model.show_chip(
            Chip(Level.OK if snapshot.model else Level.OFF, snapshot.model or "none")
        )
        self._recording.show_chip(
            Chip(Level.OK, snapshot.recording.file)
            if snapshot.recording.is_on
            else Chip(Level.ATTENTION, "not recorded")
        )
        line = strip_line(snapshot)
        if line != self._line.text():
            self._line.setText(line)
