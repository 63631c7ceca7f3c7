"""The NX100 codec: exact request bytes, every form of answer, any split, any rubbish."""

import ast
import itertools
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.robot import nx100
from gestureapp.robot.nx100 import Alarms, Done, Failure, LineSplitter, Request, Unreadable
from gestureapp.robot.values import Pose, PoseIncrement, Position, Posture, RobotStatus

COMMANDS = ("RSTATS", "RPOSC", "RALARM", "IMOV", "HOLD", "SVON")


@pytest.mark.parametrize(
    ("request_", "header", "payload"),
    [
        (nx100.READ_STATUS, b"HOSTCTRL_REQUEST RSTATS 0\r\n", b""),
        (nx100.READ_ALARMS, b"HOSTCTRL_REQUEST RALARM 0\r\n", b""),
        (nx100.read_pose(), b"HOSTCTRL_REQUEST RPOSC 4\r\n", b"1,0\r"),
        (nx100.read_pose(12), b"HOSTCTRL_REQUEST RPOSC 5\r\n", b"12,0\r"),
        (nx100.HOLD_ON, b"HOSTCTRL_REQUEST HOLD 2\r\n", b"1\r"),
        (nx100.HOLD_OFF, b"HOSTCTRL_REQUEST HOLD 2\r\n", b"0\r"),
        (nx100.SERVO_ON, b"HOSTCTRL_REQUEST SVON 2\r\n", b"1\r"),
        (nx100.SERVO_OFF, b"HOSTCTRL_REQUEST SVON 2\r\n", b"0\r"),
    ],
)
def test_a_request_has_the_documented_bytes(request_, header, payload):
    assert (request_.header, request_.payload) == (header, payload)


def test_five_millimetres_up_are_the_worked_example():
    request = nx100.move_increment(PoseIncrement(dz_mm=5.0), 20.0, frame=1, tool=0)

    assert request.header == b"HOSTCTRL_REQUEST IMOV 58\r\n"
    assert request.payload == b"0,20.0,1,0.000,0.000,5.000,0.00,0.00,0.00,0,0,0,0,0,0,0,0\r"


def test_a_turn_goes_out_in_degrees_a_second_and_never_shows_minus_zero():
    increment = PoseIncrement(dx_mm=-0.0, drz_deg=-12.34)

    data = nx100.move_increment(increment, 9.0, frame=2, tool=3).data

    assert data == "1,9.0,2,0.000,0.000,0.000,0.00,0.00,-12.34,0,3,0,0,0,0,0,0"


@pytest.mark.parametrize(("asked", "sent"), [(99.96, "99.9"), (0.19, "0.1"), (249.99, "249.9")])
def test_the_speed_on_the_wire_is_never_above_the_one_that_was_let_through(asked, sent):
    data = nx100.move_increment(PoseIncrement(dx_mm=10.0), asked, frame=1, tool=0).data

    assert data.split(",")[1] == sent


@given(st.integers(1, 2500))
def test_a_speed_of_one_decimal_is_sent_as_it_is(tenths):
    data = nx100.move_increment(PoseIncrement(dx_mm=10.0), tenths / 10, frame=1, tool=0).data

    assert float(data.split(",")[1]) == tenths / 10


@given(
    st.lists(st.integers(-2_500_000, 2_500_000), min_size=3, max_size=3),
    st.lists(st.integers(-36_000, 36_000), min_size=3, max_size=3),
)
def test_an_increment_of_the_wires_own_decimals_goes_over_it_unchanged(thousandths, hundredths):
    increment = PoseIncrement(*(n / 1000 for n in thousandths), *(n / 100 for n in hundredths))

    request = nx100.move_increment(increment, 10.0, frame=1, tool=0)

    fields = request.data.split(",")
    assert len(fields) == 17
    assert tuple(map(float, fields[3:9])) == (*increment.translation_mm, *increment.rotation_deg)
    assert int(request.header.split()[-1]) == len(request.payload)


def test_only_the_path_stop_is_a_hold_and_requests_print_themselves():
    assert nx100.HOLD_ON.is_hold
    assert not nx100.HOLD_OFF.is_hold
    assert (str(nx100.HOLD_ON), str(nx100.READ_STATUS)) == ("HOLD 1", "RSTATS")


STREAMS = st.lists(
    st.sampled_from(
        [b"OK: HOLD\r\n", b"0000\r\n", b"194,64\r", b"\r\n", b"\n", b"\r", b"ERROR: x(2010).\r\n"]
    )
    | st.binary(max_size=12),
    max_size=12,
).map(b"".join)


@given(STREAMS, st.lists(st.integers(0, 200), max_size=12))
def test_any_split_of_the_stream_gives_the_same_lines(stream, cuts):
    whole, pieces = LineSplitter(), LineSplitter()
    edges = sorted({0, len(stream), *(cut for cut in cuts if cut < len(stream))})

    expected = whole.feed(stream)
    lines = [line for a, b in itertools.pairwise(edges) for line in pieces.feed(stream[a:b])]

    assert lines == expected
    assert pieces.rest == whole.rest


def test_the_lf_of_a_line_may_come_with_the_next_one():
    lines = LineSplitter()

    assert lines.feed(b"0000\r") == [b"0000"]
    assert lines.feed(b"\nOK: HOLD\r\n") == [b"OK: HOLD"]
    assert lines.rest == b""


def test_a_line_is_overlong_only_beyond_the_limit():
    lines = LineSplitter()
    lines.feed(b"x" * nx100.MAX_LINE)
    assert not lines.is_overlong
    lines.feed(b"x")
    assert lines.is_overlong


@pytest.mark.parametrize(
    ("line", "is_banner"),
    [
        ("OK: NX Information Server( 1.16).", True),
        ("OK: DX Information Server( 1.07) Keep-Alive:-1.", True),
        ("OK: YR Information Server(Ver 1.10).", True),
        ("OK: NX Information Server", True),
        ("OK: NXX Information Server( 1.16).", False),
        ("OK: NX Information Servers", False),
        ("NG: NX Information Server( 1.16).", False),
        (" OK: NX Information Server( 1.16).", False),
        ("", False),
    ],
)
def test_a_banner_is_known_by_its_prefix_only(line, is_banner):
    assert nx100.is_banner(line) is is_banner


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("ERROR: IMOV is not successful(2010).", 2010),
        ("ERROR:[IMOV] is not successful(2100).", 2100),
        ("ERROR: IMOV is not successful(1111)", 1111),
        ("NG: no such command", None),
        ("ERROR: what(12345)(2070).", 2070),
        ("ERROR", None),
        ("2060", 2060),
        ("0102", 102),
    ],
)
def test_every_form_of_failure_is_read_with_its_code(line, code):
    failure = nx100.parse_failure(line)

    assert failure == Failure(code, line)
    assert nx100.parse_answer(nx100.HOLD_ON, line) == failure


@pytest.mark.parametrize("line", ["0000", "OK: HOLD", "20100", "201", "194,64", "error: x", ""])
def test_what_is_no_failure_is_not_taken_for_one(line):
    assert nx100.parse_failure(line) is None


def test_a_failure_speaks_in_words_where_its_code_is_known():
    assert Failure(2050, "x").words == "held by command (2050)"
    assert Failure(9999, "ERROR: odd(9999).").words == "ERROR: odd(9999)."
    assert Failure(None, "NG: busy").words == "NG: busy"


LAST = Position(Pose(1, 2, 3, 4, 5, 6), Posture(63), 23)


@pytest.mark.parametrize(
    ("request_", "line", "answer"),
    [
        (nx100.HOLD_ON, "0000", Done()),
        (nx100.READ_STATUS, "194,64", RobotStatus(194, 64)),
        (nx100.READ_STATUS, " 202 , 8 ", RobotStatus(202, 8)),
        (nx100.READ_STATUS, "0,255", RobotStatus(0, 255)),
        (
            nx100.read_pose(),
            "612.340,-55.020,101.700,179.98,-0.11,92.40,5,3",
            Position(Pose(612.34, -55.02, 101.7, 179.98, -0.11, 92.4), Posture(5), 3),
        ),
        (nx100.read_pose(), "1,2,3,4,5,6,63,23,7,8,9,10,11,12", LAST),
        (
            nx100.read_pose(),
            "+1.,.5,-0,4,5,6,0,0",
            Position(Pose(1, 0.5, 0, 4, 5, 6), Posture(0), 0),
        ),
        (nx100.READ_ALARMS, "0,0,0,0,0,0,0,0,0,0", Alarms(((0, 0),) * 5)),
        (
            nx100.READ_ALARMS,
            "0,0,4416,3,1050,0,0,0,0,0",
            Alarms(((0, 0), (4416, 3), (1050, 0), (0, 0), (0, 0))),
        ),
    ],
)
def test_an_answer_is_read_for_what_it_says(request_, line, answer):
    assert nx100.parse_answer(request_, line) == answer


def test_alarms_give_the_codes_that_are_present():
    assert Alarms(((0, 0), (4416, 3), (1050, 0))).codes == (4416, 1050)


@pytest.mark.parametrize(
    ("request_", "line"),
    [
        (nx100.HOLD_ON, ""),
        (nx100.HOLD_ON, "000"),
        (nx100.HOLD_ON, "00000"),
        (nx100.HOLD_ON, "0000 "),
        (nx100.HOLD_ON, "194,64"),
        (nx100.READ_STATUS, "0000"),
        (nx100.READ_STATUS, "194"),
        (nx100.READ_STATUS, "194,64,0"),
        (nx100.READ_STATUS, "256,0"),
        (nx100.READ_STATUS, "194,-1"),
        (nx100.READ_STATUS, "194,64.5"),
        (nx100.READ_STATUS, "194,"),
        (nx100.READ_STATUS, "0x1,0"),
        (nx100.READ_STATUS, "1e2,0"),
        (nx100.READ_STATUS, "nan,0"),
        (nx100.read_pose(), "1,2,3,4,5,6,0"),
        (nx100.read_pose(), "1,2,3,4,5,6,0,0,0"),
        (nx100.read_pose(), "1,2,3,4,5,inf,0,0"),
        (nx100.read_pose(), "1,2,3,4,5,6,64,0"),
        (nx100.read_pose(), "1,2,3,4,5,6,-1,0"),
        (nx100.read_pose(), "1,2,3,4,5,6,0.5,0"),
        (nx100.read_pose(), "1,2,3,4,5,6,0,24"),
        (nx100.read_pose(), "1,2,3,4,5,6,0,-1"),
        (nx100.read_pose(), "1000000.1,2,3,4,5,6,0,0"),
        (nx100.read_pose(), "9" * 400 + ",2,3,4,5,6,0,0"),
        (nx100.READ_ALARMS, "0,0,0,0,0,0,0,0,0"),
        (nx100.READ_ALARMS, "0,0,0,0,0,0,0,0,0,0.5"),
    ],
)
def test_a_malformed_line_gives_no_value(request_, line):
    answer = nx100.parse_answer(request_, line)

    assert isinstance(answer, Unreadable)
    assert answer.text == line
    assert answer.expected


@given(st.sampled_from(COMMANDS), st.text(alphabet=st.characters(max_codepoint=127), max_size=80))
def test_no_rubbish_raises_and_what_is_read_was_there(name, line):
    answer = nx100.parse_answer(Request(name), line)

    match answer:
        case Done():
            assert line == "0000"
        case RobotStatus(a, b):
            assert [float(f) for f in line.split(",")] == [a, b]
            assert 0 <= a <= 255
            assert 0 <= b <= 255
        case Position(pose, posture, tool):
            values = (*pose.position_mm, *pose.rotation_deg, posture.bits, tool)
            assert all(math.isfinite(v) for v in values)
            assert [float(f) for f in line.split(",")[:8]] == list(values)
        case Alarms():
            assert [float(f) for f in line.split(",")] == [n for p in answer.pairs for n in p]
        case Failure():
            assert line.startswith(("ERROR", "NG")) or (len(line) == 4 and line.isdigit())


@given(st.sampled_from(COMMANDS), st.lists(st.integers(0, 300), max_size=15))
def test_numbers_are_a_status_or_alarms_only_in_the_documented_count(name, numbers):
    line = ",".join(map(str, numbers))

    answer = nx100.parse_answer(Request(name), line)

    is_status = name == "RSTATS" and len(numbers) == 2 and max(numbers) <= 255
    assert isinstance(answer, RobotStatus) is is_status
    assert isinstance(answer, Alarms) is (name == "RALARM" and len(numbers) == 10)
    is_position = name == "RPOSC" and len(numbers) in (8, 14)
    is_position = is_position and numbers[6] <= 63 and numbers[7] <= 23
    assert isinstance(answer, Position) is is_position


@pytest.mark.parametrize(
    ("data_1", "data_2", "names"),
    [
        (0x08, 0, {"is_running"}),
        (0x20, 0, {"is_teach"}),
        (0x40, 0, {"is_play"}),
        (0x80, 0, {"is_remote"}),
        (0x17, 0x81, set()),
        (0, 0x02, {"is_held", "is_held_by_pendant"}),
        (0, 0x04, {"is_held", "is_held_externally"}),
        (0, 0x08, {"is_held", "is_held_by_command"}),
        (0, 0x10, {"has_alarm"}),
        (0, 0x20, {"has_error"}),
        (0, 0x40, {"is_servo_on"}),
    ],
)
def test_every_bit_of_the_status_means_what_the_manual_says(data_1, data_2, names):
    status = RobotStatus(data_1, data_2)
    questions = [name for name in dir(status) if name.startswith(("is_", "has_"))]

    assert {name for name in questions if getattr(status, name)} == names


FOLDER = Path(nx100.__file__).parent
SHELL = {"guardian", "guardian_log", "lock", "clock"}
PURE = sorted({path.stem for path in FOLDER.glob("*.py")} - SHELL)
IMPURE = {"socket", "serial", "threading", "subprocess", "select", "selectors", "time", "os"}


@pytest.mark.parametrize("name", PURE)
def test_the_thinking_half_imports_no_clock_no_socket_no_thread(name):
    tree = ast.parse((FOLDER / f"{name}.py").read_text("utf-8"))
    imported = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            imported |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            imported.add((node.module or "").split(".")[0])

    assert not imported & IMPURE
