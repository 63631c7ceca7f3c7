"""Whatever happens in whatever order: no move without permission, and every stop ends."""

from dataclasses import replace

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gestureapp.robot import messages as m
from gestureapp.robot.outputs import ToApp, ToRobot
from gestureapp.robot.values import Caps, Direction, StopReason

TICKS = st.tuples(st.just("run"), st.integers(1, 30))
SAID = st.sampled_from([m.Arm(), m.Arm(), m.Disarm(), m.ServoOn(), m.ServoOff(), m.Bye()])
STOPS = st.tuples(st.just("stop"), st.sampled_from(StopReason))
PROPOSALS = st.tuples(
    st.just("propose"),
    st.integers(1, 5),
    st.builds(Direction, st.sampled_from([0, 1, 2]), st.sampled_from([-1, 1]), st.booleans()),
    st.sampled_from([0.0, 0.0, 0.0, 0.1, 0.2, -0.1]),
)
POSTURES = st.tuples(st.just("posture"), st.sampled_from(["start", "start", "stop", "neither"]))
BEATS = st.tuples(
    st.just("age"),
    st.sampled_from(["left_s", "control_s", "gui_s"]),
    st.sampled_from([0.0, 0.0, 0.1, 0.2, 0.6, -1.0]),
)
SWITCHES = st.tuples(
    st.just("robot"),
    st.sampled_from(["is_mute", "is_deaf", "resumes", "is_connected"]),
    st.booleans(),
)
TIMES = st.tuples(
    st.just("robot"),
    st.sampled_from(["answer_s", "slows_s", "start_s"]),
    st.sampled_from([0.0, 0.02, 0.1, 0.35, 0.9]),
)
REFUSALS = st.tuples(
    st.sampled_from(["refuses", "takes", "ignores"]),
    st.sampled_from(["HOLD", "HOLD 0", "SVON", "IMOV", "RSTATS", "RPOSC", "IOWRITE"]),
)
BITS = st.tuples(st.just("bits"), st.sampled_from([0x08, 0x20, 0x80]), st.sampled_from([0, 2, 16]))
BYTES = st.tuples(
    st.just("bytes"),
    st.sampled_from([b"0000\r\n", b"OK: IMOV\r\n", b"NG: x\r\n", b"\n"]) | st.binary(max_size=9),
)
MOVE = st.just("move")
TESTS = st.tuples(
    st.just("test"),
    st.integers(0, 2),
    st.builds(Caps, st.sampled_from([1.0, 20.0, 500.0]), st.sampled_from([5.0, 20.0, 250.0])),
)
FIRST_TEST = 1000
"""Activations of stop tests, and of what follows one, count from here."""
ACTIONS = st.lists(
    TICKS | TICKS | SAID | STOPS | PROPOSALS | PROPOSALS | POSTURES | BEATS | SWITCHES | TIMES
    | REFUSALS | BITS | BYTES | MOVE | MOVE | TESTS,
    max_size=25,
)  # fmt: skip


def carry_out(cell, action):
    match action:
        case "move":
            carry_out_a_whole_move(cell)
        case "run", n:
            cell.run(n * 0.005)
        case "stop", reason:
            cell.stop(reason)
        case "propose", activation_id, direction, age_s:
            cell.propose(direction, activation_id, cell.now_s - age_s)
        case "posture", posture:
            cell.posture = posture
        case "age", what, age_s:
            setattr(cell, what, age_s)
        case "robot", "is_connected", True:
            cell.is_reachable = True
        case "robot", "is_connected", False:
            cell.is_reachable = False
            cell.cut()
        case "robot", name, value:
            setattr(cell.robot, name, value)
        case _:
            disturb(cell, action)


def disturb(cell, action):
    match action:
        case "test", axis, caps:
            carry_out_a_stop_test(cell, axis, caps)
        case "refuses", name:
            cell.robot.refuses[name] = 2060
        case "takes", name:
            cell.robot.refuses.pop(name, None)
            cell.robot.ignores.discard(name)
        case "ignores", name:
            cell.robot.ignores.add(name)
        case "bits", one, two:
            cell.robot.data_1 ^= one
            cell.robot.data_2 ^= two
        case "bytes", data:
            if cell.is_connected:
                cell.supervisor.robot_bytes(data, cell.now_s)
                cell.collect()
        case message:
            cell.say(message)


def carry_out_a_whole_move(cell):
    """What random actions seldom come to by themselves."""
    cell.left_s = cell.control_s = cell.gui_s = 0.0
    cell.posture = "stop"
    cell.run(0.1)
    cell.say(m.Arm())
    cell.run(0.15)
    cell.posture = "start"
    cell.run(0.06)
    cell.propose()
    cell.run(0.05)


def carry_out_a_stop_test(cell, axis, caps):
    """Armed with the left arm in stop, it stays there and the move is proposed."""
    cell.left_s = cell.control_s = cell.gui_s = 0.0
    cell.posture = "stop"
    cell.run(0.1)
    cell.say(m.Arm())
    cell.run(0.3)
    cell.activation_id = max(cell.activation_id, FIRST_TEST) + 1
    direction = Direction(axis, -1, is_rotation=False)
    cell.say(m.Propose(cell.activation_id, direction, cell.now_s, caps))
    cell.run(0.05)


def check_story(story):
    """Every move had an Arm after the newest latched stop, and an activation of its own.

    A stop test went 20 mm at most, at 20 mm/s at most, and what it was armed for was its one move.
    """
    has_armed, used, n_headers, n_payloads = False, 0, 0, 0
    test_ids = {item.activation_id for item in story if isinstance(item, m.Propose) and item.caps}
    is_tested = False
    for item in story:
        match item:
            case ToApp(m.Armed()):
                has_armed, is_tested = True, False
            case ToApp(m.Disarmed()):
                has_armed = False
            case ToApp(m.StopAsked(reason=reason)) if reason.is_latched:
                has_armed = False
            case ToRobot(data) if data.startswith(b"HOSTCTRL_REQUEST IMOV"):
                n_headers += 1
                assert has_armed
                assert not is_tested
            case ToRobot(data) if data.count(b",") == 16:
                n_payloads += 1
                assert has_armed
                assert n_payloads <= n_headers
            case ToApp(m.CommandSent(activation_id=activation_id)):
                assert activation_id > used
                used = activation_id
                if is_tested := activation_id in test_ids:
                    assert sum(map(abs, item.message.increment.translation_mm)) <= 20.0
                    assert item.message.speed <= 20.0
    sent = [item for item in story if isinstance(item, ToApp)]
    assert n_headers == sum(isinstance(item.message, m.CommandSent) for item in sent)
    arms = sum(isinstance(item, m.Arm) for item in story)
    assert sum(isinstance(item.message, m.Armed) for item in sent) <= arms


def repair(cell):
    """Everything works again, and the application is there."""
    robot = cell.robot
    robot.is_mute = robot.is_deaf = robot.resumes = False
    robot.answer_s = robot.slows_s = robot.start_s = 0.0
    robot.refuses.clear()
    robot.ignores.clear()
    robot.data_1, robot.data_2 = 0xC2, robot.data_2 & 0x48
    cell.left_s = cell.control_s = cell.gui_s = 0.0
    cell.posture, cell.is_reachable = "stop", True


@pytest.mark.filterwarnings("error")
@settings(max_examples=120, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(ACTIONS, st.sampled_from([0, 22010]))
def test_no_order_of_events_moves_the_robot_without_permission_or_leaves_a_stop_open(
    new_cell, limits, actions, supervision_input
):
    cell = new_cell(limits=replace(limits, supervision_input=supervision_input))
    for action in actions:
        carry_out(cell, action)
        for _, data, is_armed, latch in cell.moves() + cell.payloads():
            assert (is_armed, latch) == (True, None), data

    check_story(cell.story)
    repair(cell)
    cell.until(lambda: not cell.supervisor.is_stopping, limit_s=8)
    cell.run(0.1)
    assert not (cell.robot.is_running and not cell.supervisor.has_commanded)
    check_story(cell.story)
