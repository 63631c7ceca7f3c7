"""Has a running cell use changed settings."""

from typing import Final

from gestureapp.cell.controls import CellControls
from gestureapp.config import Settings
from gestureapp.sensing.values import Side

_TABLES: Final = ("site", "robot", "joints", "training")
"""Sensors have a call of their own; whose arms these are holds from the next start on."""


class SettingsUse:
    """Has a cell use changed settings, each by the call that it has for them. Any one thread.

    Args:
        cell: That uses them.
        settings: As it was started with.
    """

    def __init__(self, cell: CellControls, settings: Settings) -> None:
        self._cell, self._before = cell, settings

    def __call__(self, settings: Settings) -> None:
        """Use these, as soon as nothing may move.

        Raises:
            ConfigError: they contradict each other; nothing is changed then.
        """
        before, self._before = self._before, settings
        if settings.left != before.left:
            self._cell.use_sensor(Side.LEFT, settings.left)
        if settings.right != before.right:
            self._cell.use_sensor(Side.RIGHT, settings.right)
        if any(getattr(settings, table) != getattr(before, table) for table in _TABLES):
            self._cell.use_settings(settings)
