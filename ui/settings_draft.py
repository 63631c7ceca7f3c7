"""Settings being edited in the window: what was typed, what is wrong with it, not used yet."""

from collections.abc import Iterable, Mapping
from typing import Final

from PySide6.QtCore import QObject, Signal

from gestureapp.setup.controls import SetupControls
from gestureapp.setup.site_values import SettingRow
from ui.background import Background
from ui.setting_values import NEEDS_PIN, NotReadable, caption_of, in_words, typed_value, value_text

APPLIED: Final = "Applied. What bears on motion is used once nothing may move."
APPLYING: Final = "Being applied\u2026"
_SHOWN: Final = 3
"""Names told of changes; more are counted."""


class SettingsDraft(QObject):
    """What was typed over some settings. GUI thread only; owned by the page that shows them.

    Attributes:
        rows: The settings as they are used, by dotted name, in the order of the file.
        wrong: What is wrong with what was typed, by name, with what is allowed.
        is_judged: ``wrong`` belongs to what was typed last.
        said: What came of the last ``apply``; empty once something is typed.

    Signals:
        changed: Rows, texts or what is wrong with them are others than before.
    """

    changed = Signal()

    def __init__(self, controls: SetupControls, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._controls = controls
        self.rows: dict[str, SettingRow] = {}
        self.wrong: Mapping[str, str] = {}
        self.is_judged = True
        self.said = ""
        self._background = Background("settings draft", self)
        self._background.on_error(self._give_up)
        self._texts: dict[str, str] = {}

    def refresh(self) -> None:
        """Ask for the settings anew; what was typed stays."""
        rows = {row.name: row for row in self._controls.settings()}
        if rows == self.rows:
            return
        self.rows = rows
        self._texts = {
            name: text
            for name, text in self._texts.items()
            if name in rows and text != value_text(rows[name])
        }
        self._judge()

    def text(self, name: str) -> str:
        """What was typed, or the value as it is used."""
        return self._texts.get(name, value_text(self.rows[name]))

    def edit(self, name: str, text: str) -> None:
        """Somebody typed this."""
        if text == self.text(name):
            return
        if text == value_text(self.rows[name]):
            self._texts.pop(name, None)
        else:
            self._texts[name] = text
        self.said = ""
        self._judge()

    def undo(self) -> None:
        """Forget everything typed."""
        self._texts.clear()
        self.said = ""
        self._judge()

    def apply(self) -> None:
        """Change the settings, all or none of them."""
        if not self.can_apply:
            return
        self.said = APPLYING
        values = self.values()
        self._background.run(lambda: self._controls.change_settings(values), self._applied)
        self.changed.emit()

    @property
    def names(self) -> tuple[str, ...]:
        """Of the settings typed over."""
        return tuple(self._texts)

    @property
    def is_locked(self) -> bool:
        """Something typed over cannot be changed before the PIN is given."""
        return any(self.rows[name].is_locked for name in self._texts)

    @property
    def can_apply(self) -> bool:
        """Something was typed, and nothing is known to be wrong with it."""
        is_waiting = not self.is_judged or self.said == APPLYING
        return bool(self._texts) and not self.wrong and not self.is_locked and not is_waiting

    @property
    def sentence(self) -> str:
        """What was typed and not applied, or what came of applying it; one line."""
        if not self._texts:
            return self.said or "Nothing is changed."
        if self.said:
            return self.said
        told = _told(self._texts)
        if self.is_locked:
            return f"{NEEDS_PIN} Not applied: {told}."
        if self.wrong:
            first = next(iter(self.wrong))
            return f"Cannot be applied. {caption_of(first)}: {in_words(self.wrong[first])}"
        return f"Not applied yet: {told}."

    def values(self) -> dict[str, object]:
        """What was typed, as a settings file would hold it; what cannot be read is left out."""
        return self._read()[0]

    def usable_values(self) -> dict[str, object]:
        """The same without what is wrong: for a picture of what would be."""
        return {name: value for name, value in self.values().items() if name not in self.wrong}

    def _read(self) -> tuple[dict[str, object], dict[str, str]]:
        values: dict[str, object] = {}
        wrong: dict[str, str] = {}
        for name, text in self._texts.items():
            try:
                values[name] = typed_value(self.rows[name], text)
            except NotReadable as error:
                wrong[name] = str(error)
        return values, wrong

    def _judge(self) -> None:
        """Have what was typed judged; until then what was wrong before counts as wrong."""
        values, unreadable = self._read()
        self.is_judged = not values
        before = {name: text for name, text in self.wrong.items() if name in values}
        self.wrong = {**before, **unreadable}
        if values and not self._background.is_busy:
            check = self._controls.check_settings
            self._background.run(lambda: check(values), lambda wrong: self._judged(values, wrong))
        self.changed.emit()

    def _judged(self, asked: Mapping[str, object], wrong: Mapping[str, str]) -> None:
        values, unreadable = self._read()
        if asked != values:
            self._judge()  # something else was typed meanwhile
            return
        self.is_judged = True
        self.wrong = {**wrong, **unreadable}
        self.changed.emit()

    def _applied(self, wrong: Mapping[str, str]) -> None:
        if wrong:
            self.said, self.wrong = "", wrong
            self.changed.emit()
            return
        self._texts.clear()
        self.said = APPLIED
        self.wrong, self.rows = {}, {}
        self.refresh()

    def _give_up(self, text: str) -> None:
        self.is_judged = False
        self.said = f"The settings cannot be changed now: {text}"
        self.changed.emit()


def _told(names: Iterable[str]) -> str:
    captions = [caption_of(name) for name in names]
    more = f" and {len(captions) - _SHOWN} more" if len(captions) > _SHOWN else ""
    return ", ".join(captions[:_SHOWN]) + more
