"""The look: Fusion with our own greys, light or dark as the system asks.

Colour is kept for what needs a person: amber for attention, red for an alarm, blue for what is
selected or under way. Widgets ask ``colours_of(self.palette())`` when they paint, so a change of
scheme needs nothing but a new palette. GUI thread only.
"""

from dataclasses import dataclass

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QColor, QFont, QPalette
from PySide6.QtWidgets import QApplication, QWidget

STYLE = "fusion"
SMALL_PX = 12
"""Notes and units."""
TEXT_PX = 13
"""Everything read at the desk."""
LARGE_PX = 16
"""What a person is asked to do."""


@dataclass(frozen=True, slots=True)
class Colours:
    """One scheme, as ``#rrggbb``.

    Attributes:
        window: Behind everything.
        panel: Behind a group of things.
        base: Behind plots and lists.
        text: What is read.
        muted: What is read second.
        line: Frames, axes, marks.
        button: A button at rest.
        attention: Amber: something wants a person soon.
        alarm: Red: something wants a person now.
        on_alarm: Text on red.
        info: Blue: selected, or under way.
        axes: Curves of x, y and z; they differ in dash and label too.
    """

    window: str
    panel: str
    base: str
    text: str
    muted: str
    line: str
    button: str
    attention: str
    alarm: str
    on_alarm: str
    info: str
    axes: tuple[str, str, str]


LIGHT = Colours(
    window="#dfe1e3",
    panel="#ebecee",
    base="#f8f8f8",
    text="#17191b",
    muted="#54595e",
    line="#a9aeb3",
    button="#d3d6d9",
    attention="#a85f00",
    alarm="#b3140c",
    on_alarm="#ffffff",
    info="#0b5aa6",
    # Okabe and Ito's blue, vermilion and green: told apart with the common colour blindnesses.
    axes=("#0072b2", "#c04a00", "#00805a"),
)

DARK = Colours(
    window="#1f2224",
    panel="#292d30",
    base="#17191b",
    text="#e6e8ea",
    muted="#a4abb1",
    line="#565c62",
    button="#3a3f44",
    attention="#ffb428",
    alarm="#e5382e",
    on_alarm="#ffffff",
    info="#6db5f5",
    axes=("#56b4e9", "#f08a3c", "#3ecf9a"),
)

AXIS_NAMES = ("x", "y", "z")
AXIS_DASHES = (Qt.PenStyle.SolidLine, Qt.PenStyle.DashLine, Qt.PenStyle.DotLine)
"""The second mark of each axis, for whoever cannot tell the colours apart."""


RADIO_STYLE = """
QRadioButton::indicator {
    width: 12px; height: 12px; border-radius: 8px;
    border: 2px solid palette(window-text); background: palette(base);
}
QRadioButton::indicator:disabled { border-color: palette(mid); }
QRadioButton::indicator:checked {
    background: qradialgradient(cx: 0.5, cy: 0.5, radius: 0.5, fx: 0.5, fy: 0.5,
        stop: 0 palette(highlight), stop: 0.6 palette(highlight),
        stop: 0.7 palette(base), stop: 1 palette(base));
}
"""
"""Fusion draws the ring darker than the window, which in the dark scheme cannot be seen."""


def colours_of(palette: QPalette) -> Colours:
    """The scheme a palette belongs to."""
    return DARK if palette.color(QPalette.ColorRole.Window).lightness() < 128 else LIGHT


def attention_palette(widget: QWidget) -> QPalette:
    """Of a bar that wants a person soon, in the scheme of its window."""
    colours = colours_of(widget.window().palette())
    palette = QPalette(widget.palette())
    palette.setColor(QPalette.ColorRole.Window, QColor(colours.attention))
    palette.setColor(QPalette.ColorRole.WindowText, QColor(colours.base))
    return palette


def palette_of(colours: Colours) -> QPalette:
    """Qt's palette in one scheme."""
    roles = QPalette.ColorRole
    palette = QPalette()
    for role, value in (
        (roles.Window, colours.window),
        (roles.Base, colours.base),
        (roles.AlternateBase, colours.panel),
        (roles.Button, colours.button),
        (roles.Text, colours.text),
        (roles.WindowText, colours.text),
        (roles.ButtonText, colours.text),
        (roles.BrightText, colours.on_alarm),
        (roles.PlaceholderText, colours.muted),
        (roles.ToolTipBase, colours.base),
        (roles.ToolTipText, colours.text),
        (roles.Highlight, colours.info),
        (roles.HighlightedText, colours.base),
        (roles.Link, colours.info),
        (roles.Accent, colours.info),
        (roles.Light, colours.base),
        (roles.Midlight, colours.panel),
        (roles.Mid, colours.line),
        (roles.Dark, colours.line),
    ):
        palette.setColor(role, QColor(value))
    for role in (roles.Text, roles.WindowText, roles.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, role, mixed(colours.muted, colours.panel))
    return palette


def mixed(colour: str, other: str, share: float = 0.6) -> QColor:
    """A colour made of ``share`` of the first and the rest of the other."""
    first, second = QColor(colour), QColor(other)
    return QColor.fromRgbF(
        first.redF() * share + second.redF() * (1 - share),
        first.greenF() * share + second.greenF() * (1 - share),
        first.blueF() * share + second.blueF() * (1 - share),
    )


def sized(widget: QWidget, size_px: int, is_bold: bool = False) -> None:
    """Give a widget a font of this height, in device-independent pixels."""
    font = QFont(widget.font())
    font.setPixelSize(size_px)
    font.setBold(is_bold)
    widget.setFont(font)


class Theme(QObject):
    """Keeps the application in the system's colour scheme; owned by the application."""

    def __init__(self, app: QApplication) -> None:
        super().__init__(app)
        self._app = app
        if app.style().name() != STYLE:  # a second change would replace a style in use
            app.setStyle(STYLE)
        font = QFont(app.font())
        font.setPixelSize(TEXT_PX)
        app.setFont(font)
        hints = app.styleHints()
        hints.colorSchemeChanged.connect(self.apply)
        self.apply(hints.colorScheme())

    def apply(self, scheme: Qt.ColorScheme) -> None:
        """Take a scheme; an unknown one is light."""
        self._app.setPalette(palette_of(DARK if scheme is Qt.ColorScheme.Dark else LIGHT))
