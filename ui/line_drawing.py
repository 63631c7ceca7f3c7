"""Line drawings kept as SVG files, in the colour of the theme's text."""

from pathlib import Path

from PySide6.QtCore import QByteArray, QRectF
from PySide6.QtGui import QColor, QPainter
from PySide6.QtSvg import QSvgRenderer

import gestureapp

FOLDER = Path(gestureapp.__file__).resolve().parent.parent / "resources" / "calibration"
_THEIR_COLOUR = "currentColor"


class LineDrawing:
    """One drawing; read once for each colour. GUI thread only.

    Args:
        name: Of the file in ``FOLDER``, without its ending.
    """

    def __init__(self, name: str) -> None:
        self._path = FOLDER / f"{name}.svg"
        self._colour = ""
        self._renderer = QSvgRenderer()

    def paint(self, painter: QPainter, area: QRectF, colour: QColor) -> None:
        """Draw it as large as fits into the middle of an area; nothing where the file is not."""
        if colour.name() != self._colour:
            self._colour = colour.name()
            self._load()
        size = self._renderer.viewBoxF().size()
        if not self._renderer.isValid() or size.isEmpty():
            return
        scale = min(area.width() / size.width(), area.height() / size.height())
        room = QRectF(0, 0, scale * size.width(), scale * size.height())
        room.moveCenter(area.center())
        self._renderer.render(painter, room)

    def _load(self) -> None:
        try:
            text = self._path.read_text(encoding="utf-8")
        except OSError:  # a damaged installation: words and frames still say what to do
            return
        self._renderer.load(QByteArray(text.replace(_THEIR_COLOUR, self._colour).encode()))
