"""The read-only connection test: every line says what was asked and what the controller said."""

from dataclasses import replace

import pytest

from gestureapp.cell.limits import field_of
from gestureapp.cell.snapshot import RobotView, StopTestResult
from gestureapp.config import Settings
from gestureapp.robot.values import Pose, Position, Posture, RobotStatus
from gestureapp.setup.robot_rows import (
    robot_card,
    status_words,
    stop_test_outcome,
    stop_test_view,
)
from gestureapp.setup.site_values import StopTestPhase
from gestureapp.setup.values import Check, Outcome

POSE = Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0)
FIELD = field_of(Settings())
CONNECTED = RobotView(
    True,
    "10.0.0.2:80",
    status=RobotStatus(0xC0, 0x40),
    pose=POSE,
    pose_age_s=0.1,
    position=Position(POSE, Posture(1), 0),
    banner="OK: NX Information Server",
)


def outcomes(view: RobotView, host: str = "10.0.0.2", tool: int = 0) -> dict[str, Outcome]:
    card = robot_card(view, host, 80, tool, FIELD, Outcome())
    return {row.name: row.outcome for row in card.rows}


def test_a_controller_that_answers_everything_passes():
    rows = outcomes(CONNECTED)
    assert {outcome.check for outcome in rows.values()} == {Check.PASSED}
    assert rows["state"].text == "key in play, command remote, servo power on, standing"
    assert rows["position"].text.startswith("X 800.0  Y 0.0  Z 300.0 mm")
    assert rows["alarms"].text == "none"


def test_without_an_address_nothing_is_asked():
    rows = outcomes(RobotView(False, ""), host="")
    assert list(rows) == ["address"]
    assert rows["address"].check is Check.NOT_RUN


def test_without_a_connection_the_reason_stands_in_the_first_line():
    rows = outcomes(RobotView(False, "nobody answers at 10.0.0.2:80: check the cable"))
    assert rows["address"].check is Check.FAILED
    assert "check the cable" in rows["address"].text
    assert {rows[name].check for name in rows if name != "address"} == {Check.NOT_RUN}


def test_alarms_are_named_by_number():
    alarmed = replace(CONNECTED, status=RobotStatus(0xC0, 0x50))
    assert outcomes(alarmed)["alarms"].check is Check.FAILED
    assert "4107" in outcomes(replace(alarmed, alarms=(4107,)))["alarms"].text


def test_a_position_of_another_tool_says_nothing_of_the_field():
    rows = outcomes(CONNECTED, tool=3)
    assert rows["tool"].check is Check.FAILED
    assert rows["field"].check is Check.NOT_RUN


def test_a_tool_outside_the_field_fails_with_the_limit():
    far = replace(POSE, x_mm=1300.0)
    rows = outcomes(replace(CONNECTED, position=Position(far, Posture(1), 0)))
    assert rows["field"].check is Check.FAILED
    assert rows["field"].text


def test_an_old_position_is_not_shown_as_new():
    assert outcomes(replace(CONNECTED, pose_age_s=60.0))["position"].check is Check.NOT_RUN


@pytest.mark.parametrize(
    ("bits", "words"),
    [
        ((0x08, 0), "moving"),
        ((0x20, 0), "key in teach"),
        ((0x40, 0), "key in play"),
        ((0x80, 0), "command remote"),
        ((0, 0x02), "held from the pendant"),
        ((0, 0x04), "held by the external input"),
        ((0, 0x08), "held over the network"),
        ((0, 0x10), "alarm"),
        ((0, 0x20), "error"),
        ((0, 0x40), "servo power on"),
    ],
)
def test_every_status_bit_has_its_words(bits: tuple[int, int], words: str):
    assert words in status_words(RobotStatus(*bits))
    assert words not in status_words(RobotStatus(0, 0))


def test_a_stop_test_is_shown_and_its_measured_end_kept():
    before = Outcome(Check.PASSED, "older", 1.0)
    moving = StopTestResult("moving", "X+", text="Press STOP now.")
    view = stop_test_view(moving, "")
    assert (view.phase, view.sentence) == (StopTestPhase.MOVING, "Press STOP now.")
    assert stop_test_outcome(moving, before) == before
    missed = StopTestResult("done", "X+", text="STOP was not pressed.", wall_s=2.0)
    assert stop_test_outcome(missed, before) == before
    done = StopTestResult("done", "X+", 0.104, 1.3, "Stopped.", 3.0)
    outcome = stop_test_outcome(done, before)
    assert outcome.text == "104 ms from the press to standstill, 1.3 mm run on, X+"
    assert (outcome.check, outcome.wall_s) == (Check.PASSED, 3.0)
    assert stop_test_view(done, "").took_ms == pytest.approx(104)
    assert stop_test_view(None, "left sensor").why_not == "left sensor"
