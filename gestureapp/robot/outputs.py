"""What the supervisor wants done. Values only."""

from dataclasses import dataclass

from gestureapp.robot import messages as m


@dataclass(frozen=True, slots=True)
class ToRobot:
    """Bytes for the controller."""

    data: bytes


@dataclass(frozen=True, slots=True)
class DropRobot:
    """Close the socket and open a new one."""

    reason: str


@dataclass(frozen=True, slots=True)
class ToApp:
    """A message for the application."""

    message: m.FromGuardian


Output = ToRobot | DropRobot | ToApp
