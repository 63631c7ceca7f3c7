"""Everything that stands against arming, each with its remedy; one line when nothing does."""

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QScrollArea, QSizePolicy, QVBoxLayout, QWidget

from gestureapp.cell.snapshot import Blocker
from ui.labels import plain
from ui.marks import Level, Mark
from ui.theme import SMALL_PX, TEXT_PX, sized


class BlockerRow(QWidget):
    """One blocker: what is wrong, and below it what to do."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._shown: Blocker | None = None
        mark = Mark(13)
        mark.show_level(Level.ATTENTION)
        self._text = plain("blockerText", TEXT_PX)
        sized(self._text, TEXT_PX, is_bold=True)
        self._remedy = plain("blockerRemedy", SMALL_PX + 1)
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 4, 5)
        layout.setHorizontalSpacing(8)
        layout.setVerticalSpacing(1)
        layout.setColumnStretch(1, 1)
        layout.addWidget(mark, 0, 0, Qt.AlignmentFlag.AlignTop)
        layout.addWidget(self._text, 0, 1)
        layout.addWidget(self._remedy, 1, 1)

    @property
    def text(self) -> str:
        """What is shown as wrong."""
        return self._text.text()

    @property
    def remedy(self) -> str:
        """What is shown as remedy."""
        return self._remedy.text()

    def show_blocker(self, blocker: Blocker) -> None:
        """Show another one."""
        if blocker == self._shown:
            return
        self._shown = blocker
        self.setObjectName(f"blocker_{blocker.id}")
        self.setAccessibleName(f"{blocker.text}. {blocker.remedy}")
        self._text.setText(blocker.text)
        self._remedy.setText(blocker.remedy)


class BlockerList(QFrame):
    """Scrolls when there are more than fit. Rows are kept, as the measured values change often."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("blockerList")
        self._shown: tuple[Blocker, ...] | None = None
        self._rows: list[BlockerRow] = []
        self._title = plain("blockerTitle", TEXT_PX, is_wrapped=False)
        sized(self._title, TEXT_PX, is_bold=True)
        self._area = QScrollArea()
        self._area.setObjectName("blockerArea")
        self._area.setAccessibleName("What stands against arming")
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        content = QWidget()
        self._column = QVBoxLayout(content)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(0)
        self._column.addStretch(1)
        self._area.setWidget(content)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(10, 6, 6, 6)
        layout.setSpacing(4)
        layout.addWidget(self._title)
        layout.addWidget(self._area, 1)
        self.show_blockers(())

    @property
    def rows(self) -> tuple[BlockerRow, ...]:
        """The rows in sight, first to last."""
        return tuple(self._rows[: len(self._shown or ())])

    def show_blockers(self, blockers: tuple[Blocker, ...]) -> None:
        """Show another list."""
        if blockers == self._shown:
            return
        n = len(blockers)
        if self._shown is None or len(self._shown) != n:
            self._make_room(n)
        self._shown = blockers
        for row, blocker in zip(self._rows, blockers, strict=False):
            row.show_blocker(blocker)

    def _make_room(self, n: int) -> None:
        while len(self._rows) < n:
            row = BlockerRow()
            self._column.insertWidget(len(self._rows), row)
            self._rows.append(row)
        for i, row in enumerate(self._rows):
            row.setVisible(i < n)
        self._title.setText(
            f"Stands against arming ({n})" if n else "Nothing stands against arming"
        )
        self._area.setVisible(bool(n))
        vertical = QSizePolicy.Policy.Expanding if n else QSizePolicy.Policy.Fixed
        self.setSizePolicy(QSizePolicy.Policy.Preferred, vertical)
