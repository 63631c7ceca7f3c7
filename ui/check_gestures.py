"""The gestures with how many takes each has, how alike they are, and how many are odd."""

from collections.abc import Mapping

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QAbstractItemView, QListWidget, QListWidgetItem, QWidget

from gestureapp.guided.values import GestureProgress, Quality


class CheckGestures(QListWidget):
    """Two lines a gesture; one is chosen.

    Signals:
        label_chosen: Another gesture is chosen by a person.
    """

    label_chosen = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("checkGestures")
        self.setAccessibleName("Gestures and how alike their takes are")
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setFixedWidth(150)
        self._shown: list[tuple[str, str]] = []
        self.currentRowChanged.connect(self._tell)

    @property
    def label(self) -> str:
        """The chosen gesture, or empty."""
        row = self.currentRow()
        return self._shown[row][0] if 0 <= row < len(self._shown) else ""

    def show_progress(self, progress: tuple[GestureProgress, ...], odd: Mapping[str, int]) -> None:
        """Show other counts.

        Args:
            progress: Of every gesture, in the set's order.
            odd: How many takes are odd, of the gestures that were looked at.
        """
        lines = [(each.label, _line(each, odd.get(each.label, 0))) for each in progress]
        if lines == self._shown:
            return
        chosen = self.label
        has_changed = [label for label, _ in lines] != [label for label, _ in self._shown]
        self.blockSignals(True)
        if has_changed:
            self.clear()
            self.addItems([text for _, text in lines])
        self._shown = lines
        for row, (_, text) in enumerate(lines):
            item = self.item(row)
            if isinstance(item, QListWidgetItem):
                item.setText(text)
        if has_changed:
            self.choose(chosen)
        self.blockSignals(False)

    def choose(self, label: str) -> None:
        """Choose a gesture; the first one when there is no such."""
        labels = [each for each, _ in self._shown]
        if labels:
            self.setCurrentRow(labels.index(label) if label in labels else 0)

    def _tell(self, row: int) -> None:
        if row >= 0:
            self.label_chosen.emit(self.label)


def _line(each: GestureProgress, n_odd: int) -> str:
    odd = f", {n_odd} odd" if n_odd else ""
    mark = "▲ " if each.quality is Quality.POOR else ""
    return f"{each.label}   {each.good} of {each.wanted}{odd}\n{mark}{each.quality.value}"
