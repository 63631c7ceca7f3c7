"""What the gate sees of a robot that may move: armed, at home, the left arm in start."""

from dataclasses import replace

from gestureapp.robot.gate import GateView, Limits
from gestureapp.robot.values import Direction, Pose, Position, Posture, RobotStatus
from gestureapp.robot.workspace import FieldOfOperation

FIELD = FieldOfOperation(1200.0, 500.0, 20.0, ((120.0, 240.0), (-60.0, 60.0), (-90.0, 90.0)), 2.0)
LIMITS = Limits(FIELD, 100.0, 10.0, 1, 0, True, 0.125, 0.2, 0.5)
READY = RobotStatus(0x80 | 0x40 | 0x02, 0x40)
FORWARD = Direction(0, 1, is_rotation=False)
HOME = Position(Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0), Posture(1), 0)
NOW_S = 64.0
TICK_S = 2.0**-40  # exact beside 64 s

VIEW = GateView(
    is_armed=True,
    latch=None,
    is_stopping=False,
    is_releasing=False,
    is_moving=False,
    last_activation_id=6,
    status=READY,
    status_s=NOW_S,
    position=HOME,
    position_s=NOW_S,
    left_s=NOW_S,
    is_left_start=True,
    is_left_stop=False,
    is_link_open=True,
)
REST = replace(VIEW, is_armed=False, is_left_start=False, is_left_stop=True)
