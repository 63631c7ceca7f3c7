"""What was done against what was heard: counts and shares, readable for twelve gestures."""

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QHelpEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from gestureapp.guided.trying import NOT_RECOGNISED
from gestureapp.recognition.evaluation import Evaluation
from ui.model_words import share_words
from ui.theme import SMALL_PX, TEXT_PX, Colours, colours_of, mixed

ROWS = "you did"
COLUMNS = "system heard"
_TITLE_PX = 20
_HEAD_PX = 20
_ROW_NAME_PX = 44
_LEAST_CELL = (33, 20)
_PERCENT_FROM_PX = 25
"""Cells at least this high have room for count and per cent below each other."""
_LARGEST_PX = 20
_LAST_SHARE = 1.85
"""The last column is wider than the others, for its name."""
_FAINTEST = 0.12
"""Share of the colour in a cell that is nearly empty, so that a single take is still seen."""


class ConfusionMatrix(QWidget):
    """A row for each gesture that was done, a column for each that was heard, and one for none.

    A cell's colour says what it means (blue right, amber wrong, grey not recognised) and its
    strength the share of the row; its place and its number say the same. GUI thread only.
    """

    def __init__(self, name: str = "confusionMatrix", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self._evaluation: Evaluation | None = None
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.show_evaluation(None)

    @property
    def evaluation(self) -> Evaluation | None:
        """What is shown."""
        return self._evaluation

    def show_evaluation(self, evaluation: Evaluation | None) -> None:
        """Show other counts; None shows that there are none."""
        if evaluation is self._evaluation and evaluation is not None:
            return
        self._evaluation = evaluation
        self.setAccessibleName(f"Confusion matrix: rows {ROWS}, columns {COLUMNS}")
        self.setAccessibleDescription(spoken(evaluation))
        self.updateGeometry()
        self.update()

    def cell_text(self, row: int, column: int) -> tuple[str, str]:
        """Count and share of the row; a cell nobody is in has neither."""
        if self._evaluation is None:
            return "", ""
        counts = self._evaluation.confusion[row]
        count, total = int(counts[column]), int(counts.sum())
        return (f"{count}", f"{100 * count / total:.0f} %") if count else ("", "")

    def sizeHint(self) -> QSize:
        """Room for count and share in every cell."""
        return self._size_with(_LEAST_CELL[0] + 8, _PERCENT_FROM_PX + 4)

    def minimumSizeHint(self) -> QSize:
        """Room for the counts."""
        return self._size_with(*_LEAST_CELL)

    def event(self, event: QEvent) -> bool:
        """Say in words what a cell means, where the mouse rests."""
        if event.type() is QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            text = self._words_at(QPointF(event.pos()))
            if text:
                QToolTip.showText(event.globalPos(), text, self)
            else:
                QToolTip.hideText()
            return True
        return super().event(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw titles, names and cells."""
        painter = QPainter(self)
        colours = colours_of(self.palette())
        if self._evaluation is None:
            painter.setPen(QColor(colours.muted))
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, "nothing heard yet")
        else:
            self._draw_titles(painter, colours)
            self._draw_names(painter, colours, self._evaluation.labels)
            for row in range(len(self._evaluation.labels)):
                for column in range(len(self._evaluation.labels) + 1):
                    self._draw_cell(painter, colours, row, column)
        painter.end()

    def _draw_titles(self, painter: QPainter, colours: Colours) -> None:
        painter.setFont(self._font(TEXT_PX, is_bold=True))
        painter.setPen(QColor(colours.text))
        area = self._cells()
        top = QRectF(area.left(), 0, area.width(), _TITLE_PX)
        painter.drawText(top, Qt.AlignmentFlag.AlignCenter, f"{COLUMNS} →")
        painter.save()
        painter.translate(0, area.bottom())
        painter.rotate(-90)
        side = QRectF(0, 0, area.height(), _TITLE_PX)
        painter.drawText(side, Qt.AlignmentFlag.AlignCenter, f"← {ROWS}")
        painter.restore()

    def _draw_names(self, painter: QPainter, colours: Colours, labels: tuple[str, ...]) -> None:
        painter.setFont(self._font(TEXT_PX))
        painter.setPen(QColor(colours.text))
        area = self._cells()
        for i, label in enumerate(labels):
            cell = self._cell(i, i)
            row = QRectF(_TITLE_PX, cell.top(), _ROW_NAME_PX - 6, cell.height())
            right = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight
            painter.drawText(row, right, label)
            head = QRectF(cell.left(), area.top() - _HEAD_PX, cell.width(), _HEAD_PX)
            painter.drawText(head, Qt.AlignmentFlag.AlignCenter, label)
        last = self._cell(0, len(labels))
        head = QRectF(last.left() - 4, area.top() - _HEAD_PX - 14, last.width() + 8, _HEAD_PX + 14)
        painter.setFont(self._font(SMALL_PX))
        painter.drawText(head, Qt.AlignmentFlag.AlignCenter, NOT_RECOGNISED.replace(" ", "\n"))

    def _draw_cell(self, painter: QPainter, colours: Colours, row: int, column: int) -> None:
        assert self._evaluation is not None
        counts = self._evaluation.confusion[row]
        count, total = int(counts[column]), int(counts.sum())
        cell = self._cell(row, column).adjusted(0.5, 0.5, -0.5, -0.5)
        is_right, is_none = row == column, column == len(self._evaluation.labels)
        meaning = colours.info if is_right else colours.muted if is_none else colours.attention
        shade = QColor(colours.base)
        if count:
            shade = mixed(meaning, colours.base, _FAINTEST + (1 - _FAINTEST) * count / total)
        painter.fillRect(cell, shade)
        if is_right:
            painter.setPen(QColor(colours.line))
            painter.drawRect(cell)
        text, percent = self.cell_text(row, column)
        if not text:
            return
        painter.setPen(readable_on(shade))
        size = self._number_px()
        painter.setFont(self._font(size, is_bold=True))
        if cell.height() < _PERCENT_FROM_PX:
            painter.drawText(cell, Qt.AlignmentFlag.AlignCenter, text)
            return
        half = cell.height() / 2
        upper = QRectF(cell.left(), cell.top() + 1, cell.width(), half)
        lower = QRectF(cell.left() - 4, cell.top() + half - 1, cell.width() + 8, half)
        painter.drawText(upper, Qt.AlignmentFlag.AlignCenter, text)
        painter.setFont(self._font(size - 2))
        painter.drawText(lower, Qt.AlignmentFlag.AlignCenter, percent)

    def _number_px(self) -> int:
        """As large as the narrow cells have room for, the same in all."""
        cell = self._cell(0, 0)
        fitting = min(0.42 * cell.height(), cell.width() / 3.2)
        return round(max(TEXT_PX, min(_LARGEST_PX, fitting)))

    def _cells(self) -> QRectF:
        """Where the cells are."""
        left, top = _TITLE_PX + _ROW_NAME_PX, _TITLE_PX + _HEAD_PX
        return QRectF(left, top, max(1, self.width() - left - 2), max(1, self.height() - top - 2))

    def _cell(self, row: int, column: int) -> QRectF:
        area = self._cells()
        n = self._n_labels()
        width, height = area.width() / (n + _LAST_SHARE), area.height() / max(1, n)
        across = width * (_LAST_SHARE if column == n else 1)
        return QRectF(area.left() + column * width, area.top() + row * height, across, height)

    def _words_at(self, place: QPointF) -> str:
        n = self._n_labels()
        for row in range(n):
            for column in range(n + 1):
                if self._cell(row, column).contains(place):
                    return self._cell_words(row, column)
        return ""

    def _cell_words(self, row: int, column: int) -> str:
        assert self._evaluation is not None
        labels = self._evaluation.labels
        counts = self._evaluation.confusion[row]
        share = share_words(int(counts[column]), int(counts.sum()))
        if column == len(labels):
            return f"{ROWS} {labels[row]}, {NOT_RECOGNISED}: {share}"
        return f"{ROWS} {labels[row]}, {COLUMNS} {labels[column]}: {share}"

    def _n_labels(self) -> int:
        return len(self._evaluation.labels) if self._evaluation is not None else 0

    def _size_with(self, width: int, height: int) -> QSize:
        n = max(6, self._n_labels())
        across = _TITLE_PX + _ROW_NAME_PX + round((n + _LAST_SHARE) * width) + 2
        return QSize(across, _TITLE_PX + _HEAD_PX + n * height + 2)

    def _font(self, size_px: int, is_bold: bool = False) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(size_px)
        font.setBold(is_bold)
        return font


def spoken(evaluation: Evaluation | None) -> str:
    """The whole matrix in words, a sentence for each gesture that was done."""
    if evaluation is None:
        return "nothing heard yet"
    sentences = []
    for row, label in enumerate(evaluation.labels):
        counts = evaluation.confusion[row]
        total = int(counts.sum())
        if not total:
            continue
        parts = [f"{int(counts[row])} of {total} recognised"]
        parts += [
            f"{int(counts[column])} heard as {other}"
            for column, other in enumerate(evaluation.labels)
            if column != row and counts[column]
        ]
        if counts[-1]:
            parts.append(f"{int(counts[-1])} {NOT_RECOGNISED}")
        sentences.append(f"{label}: {', '.join(parts)}.")
    return " ".join(sentences) or "nothing heard yet"


def readable_on(shade: QColor) -> QColor:
    """Black or white, whichever stands out more. Source: WCAG 2.2, relative luminance."""
    luminance = sum(
        weight * _linear(part)
        for weight, part in zip(
            (0.2126, 0.7152, 0.0722),
            (shade.redF(), shade.greenF(), shade.blueF()),
            strict=True,
        )
    )
    on_white, on_black = 1.05 / (luminance + 0.05), (luminance + 0.05) / 0.05
    return QColor("#ffffff") if on_white > on_black else QColor("#000000")


def _linear(part: float) -> float:
    return part / 12.92 if part <= 0.04045 else float(((part + 0.055) / 1.055) ** 2.4)
