"""Poses, status, proposals, commands, refusals and stop reasons. Values only."""

from dataclasses import dataclass
from enum import Enum


@dataclass(frozen=True, slots=True)
class Pose:
    """Position and orientation of the robot's tool in the robot frame, mm and degrees.

    The robot frame's origin is on the S axis at the height of the L axis; +X forward, +Z up.
    Orientation: turned about Z by rz, then Y by ry, then X by rx (moving axes).
    """

    x_mm: float
    y_mm: float
    z_mm: float
    rx_deg: float
    ry_deg: float
    rz_deg: float

    @property
    def position_mm(self) -> tuple[float, float, float]:
        """x, y, z."""
        return (self.x_mm, self.y_mm, self.z_mm)

    @property
    def rotation_deg(self) -> tuple[float, float, float]:
        """rx, ry, rz."""
        return (self.rx_deg, self.ry_deg, self.rz_deg)


@dataclass(frozen=True, slots=True)
class PoseIncrement:
    """The one relative move of an activation, mm and degrees."""

    dx_mm: float = 0.0
    dy_mm: float = 0.0
    dz_mm: float = 0.0
    drx_deg: float = 0.0
    dry_deg: float = 0.0
    drz_deg: float = 0.0

    @property
    def translation_mm(self) -> tuple[float, float, float]:
        """dx, dy, dz."""
        return (self.dx_mm, self.dy_mm, self.dz_mm)

    @property
    def rotation_deg(self) -> tuple[float, float, float]:
        """drx, dry, drz."""
        return (self.drx_deg, self.dry_deg, self.drz_deg)

    @property
    def is_rotation(self) -> bool:
        """Whether any angle changes."""
        return any(self.rotation_deg)


@dataclass(frozen=True, slots=True)
class Direction:
    """Where a gesture wants the tool to go: along or about one axis of the robot frame.

    Attributes:
        axis: 0, 1 or 2 for X, Y, Z.
        sign: +1 or -1.
        is_rotation: About the axis instead of along it.
    """

    axis: int
    sign: int
    is_rotation: bool

    def __post_init__(self) -> None:
        if self.axis not in (0, 1, 2) or self.sign not in (-1, 1):
            raise ValueError(f"no such direction: axis {self.axis}, sign {self.sign}")

    @property
    def unit(self) -> tuple[float, float, float]:
        """The paper's vector d."""
        return tuple(float(self.sign) if i == self.axis else 0.0 for i in range(3))  # type: ignore[return-value]


@dataclass(frozen=True, slots=True)
class RobotStatus:
    """RSTATS, two bytes. Source: NX100 data transmission manual, p. 76."""

    data_1: int
    data_2: int

    @property
    def is_running(self) -> bool:
        """A job or a direct move is being carried out."""
        return bool(self.data_1 & 0x08)

    @property
    def is_teach(self) -> bool:
        """The pendant key is in TEACH."""
        return bool(self.data_1 & 0x20)

    @property
    def is_play(self) -> bool:
        """Play mode."""
        return bool(self.data_1 & 0x40)

    @property
    def is_remote(self) -> bool:
        """Command remote: moves over the network are taken."""
        return bool(self.data_1 & 0x80)

    @property
    def is_held_by_pendant(self) -> bool:
        """HOLD was pressed on the pendant."""
        return bool(self.data_2 & 0x02)

    @property
    def is_held_externally(self) -> bool:
        """The external hold input is on."""
        return bool(self.data_2 & 0x04)

    @property
    def is_held_by_command(self) -> bool:
        """HOLD 1 came over the network."""
        return bool(self.data_2 & 0x08)

    @property
    def is_held(self) -> bool:
        """Held, whoever did it."""
        return bool(self.data_2 & 0x0E)

    @property
    def has_alarm(self) -> bool:
        """An alarm is present."""
        return bool(self.data_2 & 0x10)

    @property
    def has_error(self) -> bool:
        """An error is present."""
        return bool(self.data_2 & 0x20)

    @property
    def is_servo_on(self) -> bool:
        """Servo power is on."""
        return bool(self.data_2 & 0x40)


@dataclass(frozen=True, slots=True)
class Posture:
    """How the arm holds a pose: RPOSC's Type. Source: NX100 data transmission manual, p. 76."""

    bits: int

    @property
    def is_flip(self) -> bool:
        """The wrist is flipped: R is more than a right angle from zero."""
        return not self.bits & 0x01

    @property
    def is_lower_arm(self) -> bool:
        """The elbow lies below the line from shoulder to wrist."""
        return bool(self.bits & 0x02)

    @property
    def is_back(self) -> bool:
        """The wrist lies behind the S axis."""
        return bool(self.bits & 0x04)

    @property
    def is_r_beyond(self) -> bool:
        """R is 180 degrees or more, either way."""
        return bool(self.bits & 0x08)

    @property
    def is_t_beyond(self) -> bool:
        """T is 180 degrees or more, either way."""
        return bool(self.bits & 0x10)

    @property
    def is_s_beyond(self) -> bool:
        """S is 180 degrees or more, either way."""
        return bool(self.bits & 0x20)


@dataclass(frozen=True, slots=True)
class Position:
    """Where the robot says its tool is: RPOSC.

    Attributes:
        pose: Of the tool centre point.
        posture: How the arm holds it.
        tool: Number of the tool whose point that is.
    """

    pose: Pose
    posture: Posture
    tool: int


class StopReason(Enum):
    """Why the robot was stopped. All but the left arm's own stop are latched."""

    LEFT_ARM = "left arm"
    STOP_PRESSED = "STOP pressed"
    LEFT_SILENT = "left sensor silent"
    RIGHT_LOST = "right sensor lost"
    COMPUTER_STALLED = "computer stood still"
    APPLICATION_STALLED = "application stood still"
    WINDOW_STALE = "window frozen"
    APPLICATION_GONE = "application gone"
    LINK_LOST = "robot link lost"
    ROBOT_ALARM = "robot alarm"
    ROBOT_CHANGED = "robot held or switched elsewhere"
    UNEXPECTED_MOTION = "robot moved without a command"
    CELL_FAULT = "cell fault"
    DISARMED = "disarmed"
    STOP_TEST = "stop test ended"

    @property
    def is_latched(self) -> bool:
        """Whether arming again is needed before anything moves."""
        return self is not StopReason.LEFT_ARM


@dataclass(frozen=True, slots=True)
class Caps:
    """What a stop test narrows a move to, never beyond the gate's own and the site's limits.

    Attributes:
        length_mm: Longest.
        speed_mm_s: Fastest.
    """

    length_mm: float
    speed_mm_s: float


@dataclass(frozen=True, slots=True)
class Refusal:
    """The gate's "no", with the limit it met.

    Attributes:
        reason: Stable word for tests and files, ``not_armed``.
        text: One line for a person.
        asked: What was asked, with its unit.
        limit: What is allowed, with its unit.
    """

    reason: str
    text: str
    asked: str = ""
    limit: str = ""
