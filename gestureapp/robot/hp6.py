"""The arm's own geometry: a MOTOMAN HP6's wrist centre, joints and postures. Pure.

Robot frame: origin on the S axis at the height of the L axis, +X forward, +Y left, +Z up, mm. Joint
angles in degrees, all zero with the lower arm upright, the forearm level and the flange straight
ahead of it; L positive forwards, U and B positive upwards, S, R and T right-handed about their
axes' outward direction. U is measured against the lower arm: the forearm's slope is U - L.

Source of the lengths: published kinematic models of the HP6, checked against its reach. The zeros
are those of all pulses 0 in these models: wrist centre at (790, 0, 725), flange at (885, 0, 725).
"""

import math
from dataclasses import dataclass

from gestureapp.robot.values import Pose, Posture

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

STRETCHED_DEG = 90.0 - math.degrees(math.atan2(ELBOW_UP_MM, FOREARM_MM))
"""76.4: U at which shoulder, elbow and wrist centre lie on one line; beyond it the elbow is low."""

RIGHT_ANGLE_DEG = 90.0
_NO_BEND = 1e-9
_FOREARM_RISE = math.atan2(ELBOW_UP_MM, FOREARM_MM)
"""How much steeper elbow to wrist centre is than the forearm itself."""
_HOME_TOOL: Matrix = ((0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (1.0, 0.0, 0.0))
"""Tool axes in the forearm's frame (along, left, up) with R, B and T at zero."""


@dataclass(frozen=True, slots=True)
class Branch:
    """Which of the eight ways to hold a pose: it stays what it is until a singular place is passed.

    Attributes:
        is_back: The wrist centre lies behind the S axis, seen from where S looks.
        is_beyond: U is beyond the stretched elbow.
        is_bent_up: B is above zero.
    """

    is_back: bool
    is_beyond: bool
    is_bent_up: bool


NO_FLIP = Posture(1)
"""The usual one: arm in front, elbow up, R within a right angle."""


def rotation(rx_deg: float, ry_deg: float, rz_deg: float) -> Matrix:
    """Give Rz * Ry * Rx. Source: DX100 easy-offline manual p. 53."""
    rx, ry, rz = math.radians(rx_deg), math.radians(ry_deg), math.radians(rz_deg)
    cx, sx, cy, sy = math.cos(rx), math.sin(rx), math.cos(ry), math.sin(ry)
    cz, sz = math.cos(rz), math.sin(rz)
    return (
        (cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx),
        (sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx),
        (-sy, cy * sx, cy * cx),
    )


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


def wrist_of(position_mm: Vector, tool: Matrix, tool_mm: Vector) -> Vector:
    """Give the wrist centre, mm in the robot frame.

    Args:
        position_mm: Tool centre point.
        tool: Its axes, as columns in the robot frame.
        tool_mm: Tool centre point seen from the flange.
    """
    offset = turned(tool, (tool_mm[0], tool_mm[1], tool_mm[2] + FLANGE_MM))
    return (position_mm[0] - offset[0], position_mm[1] - offset[1], position_mm[2] - offset[2])


def wrist_mm(pose: Pose, tool_mm: Vector = (0.0, 0.0, 0.0)) -> Vector:
    """Give the wrist centre of a tool pose; as `wrist_of`."""
    return wrist_of(pose.position_mm, rotation(*pose.rotation_deg), tool_mm)


def joints_deg(pose: Pose, tool_mm: Vector = (0.0, 0.0, 0.0), posture: Posture = NO_FLIP) -> Joints:
    """Give S, L, U, R, B, T of a tool pose held in a posture: the inverse of `tool_pose`.

    Note:
        Where the arm does not reach, the elbow is drawn straight (or folded) towards the wrist.
        With B at zero only the sum of R and T is known: R is taken as zero.
    """
    tool = rotation(*pose.rotation_deg)
    wrist = wrist_of(pose.position_mm, tool, tool_mm)
    is_beyond = posture.is_lower_arm is not posture.is_back
    down = solve(wrist, tool, Branch(posture.is_back, is_beyond, is_bent_up=False))
    is_wanted = (abs(down[3]) > RIGHT_ANGLE_DEG) is posture.is_flip
    s, lower, upper, r, b, t = down if is_wanted else _bent_other_way(down)
    return (
        _beyond(s) if posture.is_s_beyond else s,
        lower,
        upper,
        _beyond(r) if posture.is_r_beyond else r,
        b,
        _beyond(t) if posture.is_t_beyond else t,
    )


def solve(wrist: Vector, tool: Matrix, branch: Branch) -> Joints:
    """Give the joints, each within +-180 degrees, that hold wrist centre and tool axes in a branch.

    Args:
        wrist: Wrist centre, mm in the robot frame.
        tool: The tool's axes, as columns in the robot frame.
        branch: Which of the eight solutions.

    Note:
        Where the arm does not reach, as `joints_deg`.
    """
    sign = -1.0 if branch.is_back else 1.0
    s = math.atan2(sign * wrist[1], sign * wrist[0])
    out, up = sign * math.hypot(wrist[0], wrist[1]) - SHOULDER_OUT_MM, wrist[2]
    squares = out * out + up * up - LOWER_ARM_MM**2 - ELBOW_TO_WRIST_MM**2
    cosine = max(-1.0, min(1.0, squares / (2.0 * LOWER_ARM_MM * ELBOW_TO_WRIST_MM)))
    kink = math.acos(cosine) if branch.is_beyond else -math.acos(cosine)
    # The lower arm's own direction: the wrist's, less what the forearm turns it by.
    ahead = LOWER_ARM_MM + ELBOW_TO_WRIST_MM * math.cos(kink)
    lower = math.atan2(up, out) - math.atan2(ELBOW_TO_WRIST_MM * math.sin(kink), ahead)
    slope = lower + kink - _FOREARM_RISE
    r, b, t = _wrist_joints(tool, s, slope)
    if branch.is_bent_up:
        r, b, t = r + math.pi, -b, t + math.pi
    return (
        math.degrees(s),
        normal_deg(90.0 - math.degrees(lower)),
        normal_deg(math.degrees(kink) + STRETCHED_DEG),
        normal_deg(math.degrees(r)),
        math.degrees(b),
        normal_deg(math.degrees(t)),
    )


def branch_of(joints: Joints) -> Branch:
    """Give the branch of joint angles in degrees."""
    is_beyond = normal_deg(joints[2] - STRETCHED_DEG) > 0.0
    return Branch(_wrist_out_up(joints)[0] < 0.0, is_beyond, normal_deg(joints[4]) > 0.0)


def posture_of(joints: Joints) -> Posture:
    """Give Type of joint angles in degrees.

    Source: NX100 data transmission manual, p. 76. What flip and lower arm mean beyond their names
    is our reading: no flip is R within a right angle of zero; the arm is an upper arm when the
    elbow lies above the line from shoulder to wrist, which behind the S axis is the other bend.
    """
    s, _, _, r, _, t = joints
    branch = branch_of(joints)
    is_flip = abs(normal_deg(r)) > RIGHT_ANGLE_DEG
    bits = (
        not is_flip,
        branch.is_beyond is not branch.is_back,
        branch.is_back,
        _is_beyond(r),
        _is_beyond(t),
        _is_beyond(s),
    )
    return Posture(sum(1 << i for i, is_on in enumerate(bits) if is_on))


def tool_pose(joints: Joints, tool_mm: Vector = (0.0, 0.0, 0.0)) -> Pose:
    """Give the tool pose of six joint angles in degrees: the inverse of `joints_deg`."""
    s, lower, upper, r, b, t = joints
    out, up = _wrist_out_up(joints)
    hand = times(times(_about_x(r), _about_y(-b)), times(_about_x(t), _HOME_TOOL))
    tool = times(_forearm(s, upper - lower), hand)
    offset = turned(tool, (tool_mm[0], tool_mm[1], tool_mm[2] + FLANGE_MM))
    x, y = out * math.cos(math.radians(s)), out * math.sin(math.radians(s))
    return Pose(x + offset[0], y + offset[1], up + offset[2], *angles(tool))


def _wrist_out_up(joints: Joints) -> tuple[float, float]:
    """Give how far the wrist centre lies out from the S axis, and how high, in the arm's plane."""
    slope, lower = math.radians(joints[2] - joints[1]), math.radians(joints[1])
    out = SHOULDER_OUT_MM + LOWER_ARM_MM * math.sin(lower)
    out += FOREARM_MM * math.cos(slope) - ELBOW_UP_MM * math.sin(slope)
    up = LOWER_ARM_MM * math.cos(lower)
    return out, up + FOREARM_MM * math.sin(slope) + ELBOW_UP_MM * math.cos(slope)


def _forearm(s_deg: float, slope_deg: float) -> Matrix:
    """Give the axes along the forearm, left and up, as columns in the robot frame."""
    return times(_about_z(s_deg), _about_y(-slope_deg))


def _wrist_joints(tool: Matrix, s: float, slope: float) -> Vector:
    """Split the tool's turn against the forearm, Rx(R) * Ry(-B) * Rx(T), with B zero or below.

    Radians throughout.
    """
    (xx, yx, zx), (xy, yy, zy), (xz, yz, zz) = tool
    cs, ss, cu, su = math.cos(s), math.sin(s), math.cos(slope), math.sin(slope)
    z_across = zx * cs + zy * ss  # along the arm's own plane, level
    z_along = z_across * cu + zz * su
    z_left = zy * cs - zx * ss
    z_up = zz * cu - z_across * su
    x_along = (xx * cs + xy * ss) * cu + xz * su
    y_along = (yx * cs + yy * ss) * cu + yz * su
    bend = math.atan2(math.hypot(z_left, z_up), z_along)
    if math.sin(bend) < _NO_BEND:
        return (0.0, -bend, math.atan2(xx * ss - xy * cs, yx * ss - yy * cs))
    return (math.atan2(z_left, -z_up), -bend, math.atan2(-y_along, x_along))


def _bent_other_way(joints: Joints) -> Joints:
    s, lower, upper, r, b, t = joints
    return (s, lower, upper, normal_deg(r + 180.0), -b, normal_deg(t + 180.0))


def _beyond(angle_deg: float) -> float:
    """Give the same direction, a turn away: beyond +-180 degrees."""
    return angle_deg - 360.0 if angle_deg > 0.0 else angle_deg + 360.0


def _is_beyond(angle_deg: float) -> bool:
    return not -180.0 < angle_deg <= 180.0


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
