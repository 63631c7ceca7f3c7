"""The read-only connection test of the robot, line by line. Pure."""

from collections.abc import Iterator
from typing import Final

from gestureapp.cell.snapshot import RobotView, StopTestResult
from gestureapp.robot.gate import find_foreign_tool
from gestureapp.robot.values import Position, RobotStatus
from gestureapp.robot.workspace import FieldOfOperation, find_outside
from gestureapp.setup.site_values import RobotCard, RobotRow, StopTestPhase, StopTestView
from gestureapp.setup.values import Check, Outcome

_FRESH_S: Final = 2.0
"""A position is asked for several times a second; an older one is not what is."""


def robot_card(
    view: RobotView, host: str, port: int, tool: int, field: FieldOfOperation, test: Outcome
) -> RobotCard:
    """The robot for the window.

    Args:
        view: As last heard.
        host: Its address as set; empty when there is none.
        port: Its port.
        tool: Number of the tool as set.
        field: Where the tool may go.
        test: The last stop test.
    """
    address = f"{host}:{port}" if host else ""
    rows = tuple(_rows(view, address, tool, field))
    return RobotCard(address, view.is_connected, view.text, rows, test)


def _rows(view: RobotView, address: str, tool: int, field: FieldOfOperation) -> Iterator[RobotRow]:
    if not address:
        yield RobotRow("address", Outcome(Check.NOT_RUN, "no address is set: type the robot's"))
        return
    check = Check.PASSED if view.is_connected else Check.FAILED
    yield RobotRow("address", Outcome(check, address if view.is_connected else view.text))
    if not view.is_connected:
        for name in ("answer", "state", "alarms", "position", "tool", "field"):
            yield RobotRow(name, Outcome(text="not asked, as there is no connection"))
        return
    yield RobotRow("answer", _heard(view.banner))
    yield RobotRow("state", _state(view.status))
    yield RobotRow("alarms", _alarms(view))
    yield from _place(view, tool, field)


def _place(view: RobotView, tool: int, field: FieldOfOperation) -> Iterator[RobotRow]:
    position = view.position
    if position is None or view.pose_age_s > _FRESH_S:
        for name in ("position", "tool", "field"):
            yield RobotRow(name, Outcome(text="waiting for the position"))
        return
    yield RobotRow("position", Outcome(Check.PASSED, position_words(position)))
    foreign = find_foreign_tool(position, tool)
    if foreign is not None:
        yield RobotRow("tool", Outcome(Check.FAILED, foreign.text))
        yield RobotRow("field", Outcome(text="not known for another tool"))
        return
    yield RobotRow("tool", Outcome(Check.PASSED, f"tool {position.tool}, as set"))
    outside = find_outside(position, field)
    if outside is not None:
        yield RobotRow("field", Outcome(Check.FAILED, outside.text))
    else:
        yield RobotRow("field", Outcome(Check.PASSED, "the tool is inside the field of operation"))


def _heard(banner: str) -> Outcome:
    return Outcome(Check.PASSED, banner) if banner else Outcome(text="waiting for an answer")


def _state(status: RobotStatus | None) -> Outcome:
    if status is None:
        return Outcome(text="waiting for the state")
    return Outcome(Check.PASSED, ", ".join(status_words(status)))


def status_words(status: RobotStatus) -> tuple[str, ...]:
    """Every bit of RSTATS that is set, in words, and what it means that some are not."""
    mode = "teach" if status.is_teach else "play" if status.is_play else "neither teach nor play"
    said = [
        f"key in {mode}" if status.is_teach or status.is_play else mode,
        "command remote" if status.is_remote else "not in command remote",
        "servo power on" if status.is_servo_on else "servo power off",
        "moving" if status.is_running else "standing",
    ]
    told = (
        (status.is_held_by_pendant, "held from the pendant"),
        (status.is_held_externally, "held by the external input"),
        (status.is_held_by_command, "held over the network"),
        (status.has_alarm, "alarm"),
        (status.has_error, "error"),
    )
    return (*said, *(words for is_set, words in told if is_set))


def _alarms(view: RobotView) -> Outcome:
    if view.status is None:
        return Outcome(text="waiting for the state")
    if view.alarms:
        codes = ", ".join(str(code) for code in view.alarms)
        return Outcome(Check.FAILED, f"{codes}: see the controller's manual, clear on the pendant")
    if view.status.has_alarm or view.status.has_error:
        return Outcome(Check.FAILED, "there is one, its number has not come yet")
    return Outcome(Check.PASSED, "none")


def position_words(position: Position) -> str:
    """A position for a person: place, then angles."""
    pose = position.pose
    x, y, z = (f"{value:.1f}" for value in pose.position_mm)
    rx, ry, rz = (f"{value:.1f}" for value in pose.rotation_deg)
    return f"X {x}  Y {y}  Z {z} mm, Rx {rx}  Ry {ry}  Rz {rz} degrees"


def stop_test_view(test: StopTestResult | None, why_not: str) -> StopTestView:
    """The stop test for the window.

    Args:
        test: The last or present one.
        why_not: What stands against beginning one.
    """
    if test is None:
        return StopTestView(why_not=why_not)
    return StopTestView(
        phase=StopTestPhase(test.phase),
        sentence=test.text,
        why_not=why_not,
        took_ms=test.took_s * 1000.0,
        ran_on_mm=test.ran_on_mm,
    )


def stop_test_outcome(test: StopTestResult | None, before: Outcome) -> Outcome:
    """The last measured stop test, or the one before when this one is not measured."""
    if test is None or StopTestPhase(test.phase) is not StopTestPhase.DONE or not test.wall_s:
        return before
    if not test.is_measured:
        return before
    figures = f"{test.took_s * 1000:.0f} ms from the press to standstill"
    text = f"{figures}, {test.ran_on_mm:.1f} mm run on, {test.label}"
    return Outcome(Check.PASSED, text, test.wall_s)
