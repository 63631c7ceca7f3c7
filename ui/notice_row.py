"""The row kept free for bars, so that no button moves when one comes or goes."""

from PySide6.QtWidgets import QGridLayout, QSizePolicy, QWidget

ROW_PX = 42


class NoticeRow(QWidget):
    """Bars on top of each other, each over the whole row: the last one covers the others."""

    def __init__(self, *bars: QWidget, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("noticeRow")
        self.setFixedHeight(ROW_PX)
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for bar in bars:
            # What a bar asks for must change neither the row nor the window's least size.
            bar.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Ignored)
            layout.addWidget(bar, 0, 0)
            bar.raise_()
