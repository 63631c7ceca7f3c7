"""The emulated arm's geometry: a MOTOMAN HP6's wrist centre, joints and pulses. Pure.

Robot frame: origin on the S axis at the height of the L axis, +X forward, +Y left, +Z up, mm. Joint
angles in degrees, all zero with the lower arm upright and the forearm level; L positive forwards, U
and B positive upwards, S, R and T right-handed about their axes' outward direction.

Source of the lengths: published kinematic models of the HP6, checked against its reach. The pulses
per degree of an HP6 are published nowhere that we found; ours are inventions inside the range other
Motomans have (450 to 2400), so RPOSJ of the emulator is consistent with its pose but does not carry
over to a real robot.
"""

import math

from gestureapp.robot.values import Pose

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]
Joints = tuple[float, float, float, float, float, float]

SHOULDER_OUT_MM = 150.0
LOWER_ARM_MM = 570.0
ELBOW_UP_MM = 155.0
FOREARM_MM = 640.0
FLANGE_MM = 95.0
"""Wrist centre to flange, along the flange's own Z."""

ELBOW_TO_WRIST_MM = math.hypot(ELBOW_UP_MM, FOREARM_MM)
REACH_MM = SHOULDER_OUT_MM + LOWER_ARM_MM + ELBOW_TO_WRIST_MM
"""1378.5: no wrist centre is farther than this from the origin."""

PULSES_PER_DEG: Joints = (1341.0, 1341.0, 1341.0, 1000.0, 1000.0, 622.0)
IDENTITY: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))

_HOME_TOOL: Matrix = ((0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0))
"""Tool axes in the forearm's frame (along, left, up) with R, B and T at zero."""


def rotation(rx_deg: float, ry_deg: float, rz_deg: float) -> Matrix:
    """Give Rz * Ry * Rx. Source: DX100 easy-offline manual p. 53."""
    return times(times(_about_z(rz_deg), _about_y(ry_deg)), _about_x(rx_deg))


def angles(matrix: Matrix) -> Vector:
    """Give Rx, Ry, Rz in degrees of a rotation matrix; Ry within +-90, Rx = 0 where Ry is +-90."""
    ry = math.atan2(-matrix[2][0], math.hypot(matrix[0][0], matrix[1][0]))
    if math.hypot(matrix[0][0], matrix[1][0]) < 1e-9:
        rz = math.atan2(-matrix[0][1], matrix[1][1])
        return (0.0, math.degrees(ry), math.degrees(rz))
    rx = math.atan2(matrix[2][1], matrix[2][2])
    rz = math.atan2(matrix[1][0], matrix[0][0])
    return (math.degrees(rx), math.degrees(ry), math.degrees(rz))


def times(a: Matrix, b: Matrix) -> Matrix:
    """Multiply two 3 x 3 matrices."""
    return (_row(a, b, 0), _row(a, b, 1), _row(a, b, 2))


def turned(matrix: Matrix, v: Vector) -> Vector:
    """Multiply a matrix and a column vector."""
    return (_dot(matrix[0], v), _dot(matrix[1], v), _dot(matrix[2], v))


def transposed(m: Matrix) -> Matrix:
    """Give the inverse of a rotation."""
    return (
        (m[0][0], m[1][0], m[2][0]),
        (m[0][1], m[1][1], m[2][1]),
        (m[0][2], m[1][2], m[2][2]),
    )


def normal_deg(angle_deg: float) -> float:
    """Bring an angle into (-180, 180], as a controller shows it."""
    turned_deg = math.fmod(angle_deg, 360.0)
    if turned_deg > 180.0:
        return turned_deg - 360.0
    return turned_deg + 360.0 if turned_deg <= -180.0 else turned_deg


def wrist_mm(pose: Pose, tool_mm: Vector = (0.0, 0.0, 0.0)) -> Vector:
    """Give the wrist centre of a tool pose, mm in the robot frame.

    Args:
        pose: Of the tool centre point.
        tool_mm: Tool centre point seen from the flange.
    """
    arm = (tool_mm[0], tool_mm[1], tool_mm[2] + FLANGE_MM)
    offset = turned(rotation(*pose.rotation_deg), arm)
    return (pose.x_mm - offset[0], pose.y_mm - offset[1], pose.z_mm - offset[2])


def joints_deg(pose: Pose, tool_mm: Vector = (0.0, 0.0, 0.0)) -> Joints:
    """Give S, L, U, R, B, T of a tool pose: arm in front, elbow up, wrist not flipped.

    Note:
        Where the arm does not reach, the elbow is drawn straight (or folded) towards the wrist.
    """
    wrist = wrist_mm(pose, tool_mm)
    s = math.atan2(wrist[1], wrist[0])
    out, up = math.hypot(wrist[0], wrist[1]) - SHOULDER_OUT_MM, wrist[2]
    distance = max(math.hypot(out, up), 1e-6)
    squares = LOWER_ARM_MM**2 + distance**2 - ELBOW_TO_WRIST_MM**2
    cosine = max(-1.0, min(1.0, squares / (2.0 * LOWER_ARM_MM * distance)))
    lower = math.pi / 2.0 - (math.atan2(up, out) + math.acos(cosine))
    elbow = (LOWER_ARM_MM * math.sin(lower), LOWER_ARM_MM * math.cos(lower))
    slope = math.atan2(up - elbow[1], out - elbow[0]) - math.atan2(ELBOW_UP_MM, FOREARM_MM)
    forearm = _forearm(math.degrees(s), math.degrees(slope))
    hand = times(transposed(forearm), rotation(*pose.rotation_deg))
    r, b, t = _wrist_joints(times(hand, transposed(_HOME_TOOL)))
    upper = normal_deg(math.degrees(slope + lower))
    return (math.degrees(s), normal_deg(math.degrees(lower)), upper, r, b, t)


def tool_pose(joints: Joints, tool_mm: Vector = (0.0, 0.0, 0.0)) -> Pose:
    """Give the tool pose of six joint angles in degrees: the inverse of `joints_deg`."""
    s, lower, upper, r, b, t = joints
    slope = math.radians(upper - lower)
    out = SHOULDER_OUT_MM + LOWER_ARM_MM * math.sin(math.radians(lower))
    out += FOREARM_MM * math.cos(slope) - ELBOW_UP_MM * math.sin(slope)
    up = LOWER_ARM_MM * math.cos(math.radians(lower))
    up += FOREARM_MM * math.sin(slope) + ELBOW_UP_MM * math.cos(slope)
    hand = times(times(_about_x(r), _about_y(-b)), times(_about_x(t), _HOME_TOOL))
    tool = times(_forearm(s, upper - lower), hand)
    offset = turned(tool, (tool_mm[0], tool_mm[1], tool_mm[2] + FLANGE_MM))
    x, y = out * math.cos(math.radians(s)), out * math.sin(math.radians(s))
    return Pose(x + offset[0], y + offset[1], up + offset[2], *angles(tool))


def pulses(pose: Pose, tool_mm: Vector = (0.0, 0.0, 0.0)) -> tuple[int, ...]:
    """Give the six encoder readings of a tool pose, in pulses."""
    joints = joints_deg(pose, tool_mm)
    return tuple(round(j * per_deg) for j, per_deg in zip(joints, PULSES_PER_DEG, strict=True))


def _forearm(s_deg: float, slope_deg: float) -> Matrix:
    """Give the axes along the forearm, left and up, as columns in the robot frame."""
    return times(_about_z(s_deg), _about_y(-slope_deg))


def _wrist_joints(m: Matrix) -> Vector:
    """Split Rx(R) * Ry(-B) * Rx(T) into R, B, T with R within +-90 degrees."""
    bend = math.atan2(math.hypot(m[0][1], m[0][2]), m[0][0])
    if math.sin(bend) < 1e-9:
        return (0.0, -math.degrees(bend), math.degrees(math.atan2(m[2][1], m[1][1])))
    r, t = math.atan2(m[1][0], -m[2][0]), math.atan2(m[0][1], m[0][2])
    if abs(r) > math.pi / 2.0:
        r, bend, t = r + math.pi, -bend, t + math.pi
    degrees = [normal_deg(math.degrees(angle)) for angle in (r, -bend, t)]
    return (degrees[0], degrees[1], degrees[2])


def _about_x(angle_deg: float) -> Matrix:
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return ((1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c))


def _about_y(angle_deg: float) -> Matrix:
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return ((c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c))


def _about_z(angle_deg: float) -> Matrix:
    c, s = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    return ((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0))


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _row(a: Matrix, b: Matrix, i: int) -> Vector:
    columns = transposed(b)
    return (_dot(a[i], columns[0]), _dot(a[i], columns[1]), _dot(a[i], columns[2]))
