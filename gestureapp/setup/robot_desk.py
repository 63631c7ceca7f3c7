"""The robot in setting up: connection test, and the stop test with its last result kept."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from gestureapp.cell.controls import CellControls
from gestureapp.cell.limits import field_of
from gestureapp.cell.snapshot import Snapshot
from gestureapp.errors import RecordingError
from gestureapp.recording.kept_json import read_kept, write_kept
from gestureapp.setup.robot_rows import robot_card, stop_test_outcome, stop_test_view
from gestureapp.setup.site_values import RobotCard, StopTestView
from gestureapp.setup.values import Check, Outcome

_FILE: Final = "stop-test.json"
_KIND: Final = "gestureapp stop test"
_SCHEMA: Final = 1
_BESIDE: Final = ("model", "setup")
"""Blockers that do not stand against a stop test: no gesture is heard in it, and it begins here."""


class RobotDesk:
    """What the window sees of the robot. Owned by the setup thread.

    Args:
        cell: Whose robot.
        data: The data folder.

    Attributes:
        trouble: Why the last stop test is not kept; empty when it is.
    """

    def __init__(self, cell: CellControls, data: Path) -> None:
        self._cell, self._path = cell, data / _FILE
        self._address = ""
        self._kept = Outcome()
        self.trouble = ""

    def look(self, picture: Snapshot) -> tuple[RobotCard, StopTestView]:
        """The robot as last heard, and the stop test; one that was measured is kept."""
        settings = self._cell.settings
        robot = settings.robot
        address = f"{robot.host}:{robot.port}" if robot.host else ""
        if address != self._address:
            self._address, self._kept = address, self._load(address)
        outcome = stop_test_outcome(picture.stop_test, self._kept)
        if outcome != self._kept:
            self._kept = outcome
            self._save(address, outcome)
        why_not = "; ".join(b.text for b in picture.blockers if b.id not in _BESIDE)
        card = robot_card(
            picture.robot, robot.host, robot.port, robot.tool, field_of(settings), outcome
        )
        return card, stop_test_view(picture.stop_test, why_not)

    def _load(self, address: str) -> Outcome:
        """Of this controller; a stop test of another one says nothing."""
        try:
            content = read_kept(self._path, _KIND, _SCHEMA)
        except ValueError as error:
            self._cell.tell(f"{_FILE} {error}: the stop test counts as not done, do it again")
            return Outcome()
        if content is None or content.get("address") != address:
            return Outcome()
        return _outcome_in(content)

    def _save(self, address: str, outcome: Outcome) -> None:
        content = {"address": address, "text": outcome.text, "wall_s": outcome.wall_s}
        try:
            write_kept(self._path, _KIND, _SCHEMA, content)
        except RecordingError as error:
            self.trouble = f"the stop test is not kept: {error}"
        else:
            self.trouble = ""


def _outcome_in(content: Mapping[str, object]) -> Outcome:
    text, wall_s = content.get("text"), content.get("wall_s")
    if not isinstance(text, str) or not isinstance(wall_s, int | float):
        return Outcome()
    return Outcome(Check.PASSED, text, float(wall_s))
