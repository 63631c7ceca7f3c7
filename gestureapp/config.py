"""Settings: frozen, typed, with unit suffixes and the reason beside each default.

Nothing below the entry points reads files or the environment; they get these values.
"""

from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Final

SCHEMA_VERSION = 1


YAWS_DEG: Final = (0, 90, 180, -90)
"""Which way the operator may face: a turn about an oblique axis is no single increment in Rx or Ry,
and a push to the front would run along no axis of the robot's."""


class DriveMode(Enum):
    """What ends a move before the edge of the field."""

    HOLD_TO_RUN = "hold_to_run"
    """The robot moves only while the left arm holds the start posture."""
    START_STOP = "start_stop"
    """The paper's: it stops on the stop posture."""


@dataclass(frozen=True, slots=True)
class SensorSettings:
    """One sensor: where it is and what it speaks. Its calibration is kept with the sensor.

    Attributes:
        port: Anything ``serial.serial_for_url`` opens: a device, ``socket://HOST:PORT``,
            ``loop://``.
        protocol: Name of a decoder.
        name: What a person calls the sensor; may be empty.
    """

    port: str = ""
    protocol: str = "csv"
    name: str = ""


@dataclass(frozen=True, slots=True)
class SiteSettings:
    """What the cell's integrator decides.

    Attributes:
        drive_mode: What ends a move. hold_to_run: the robot moves only while the left arm holds the
            start posture. start_stop: it moves until the left arm takes the stop posture.
        trip_level_s: Left sensor silent longer than this stops the robot; 0.05 to 0.3, never off.
        control_limit_s: Control thread silent longer than this stops the robot.
        gui_limit_s: Window frozen longer than this stops the robot: STOP could not be pressed.
        stop_on_right_lost: Whether losing the right sensor stops a running move.
        rate_min_hz: Slowest stream that may be armed.
        rate_max_hz: Fastest stream that may be armed.
        posture_enter_deg: The left arm is in a posture within this angle of it.
        posture_leave_deg: It stays so up to this angle (hysteresis).
        posture_debounce: Samples in a row that a new posture must show.
        stop_seen_s: How long the stop posture must have been seen before arming.
        calibration_days: A sensor calibrated longer ago must be calibrated anew before arming.
        level_check_hours: One whose level was checked longer ago must be checked before arming; 0
            where no such check is wanted.
    """

    drive_mode: DriveMode = DriveMode.HOLD_TO_RUN
    trip_level_s: float = 0.1
    control_limit_s: float = 0.2
    gui_limit_s: float = 0.5
    stop_on_right_lost: bool = True
    rate_min_hz: float = 70.0
    rate_max_hz: float = 230.0
    posture_enter_deg: float = 25.0
    posture_leave_deg: float = 40.0
    posture_debounce: int = 3
    stop_seen_s: float = 0.5
    calibration_days: int = 180
    level_check_hours: float = 12.0


@dataclass(frozen=True, slots=True)
class KeepOutSettings:
    """A box that the tool point stays out of.

    Attributes:
        name: What stands there, as the window calls it.
        low_mm: Its lowest x, y, z in the robot frame.
        high_mm: Its highest.
    """

    name: str
    low_mm: tuple[float, float, float]
    high_mm: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class RobotSettings:
    """The robot, its field of operation and its speeds.

    The field: two spheres around the robot frame's origin (paper, equation 1), a floor, a ceiling,
    the robot's own column, boxes to keep out of, and a range for each angle. It bounds the tool
    point, not the arm's links. The origin is on the S axis at the height of the L axis, some 450 mm
    above the mounting face. The defaults suit an HP6 without a tool: the wrist cannot be farther
    than 1378.5 mm from the origin (150 + 570 + sqrt(155^2 + 640^2), its link lengths), and close to
    the column it folds up.

    Attributes:
        host: Address of the NX100; empty when there is none.
        port: TCP port of its Ethernet server function.
        ext_radius_mm: Outer sphere.
        int_radius_mm: Inner sphere.
        margin_mm: How far before the boundary an increment ends.
        floor_mm: Lowest z of the tool point; the lowest value allowed lies below all it can reach.
        ceiling_mm: Highest z of the tool point; the highest value lies above all it can reach.
        column_radius_mm: The robot's own column, a cylinder round the S axis; 0 for none.
        column_top_mm: z of its upper end: the upright lower arm, the forearm on it, and some more.
        keep_outs: Boxes to keep out of, 8 at most, each {name = "fixture", low_mm = [x, y, z],
            high_mm = [x, y, z]}; those of a later layer are added.
        speed_mm_s: Speed of a translation; at most 250.
        speed_deg_s: Speed of a rotation; at most 30.
        rx_range_deg: Lowest and highest Rx; may pass 180, as a tool that points down reads
            Rx = 180.
        ry_range_deg: Lowest and highest Ry.
        rz_range_deg: Lowest and highest Rz.
        margin_deg: How far before the end of a range a rotation ends.
        frame: Coordinate frame of the increment: 0 base or 1 robot; the field of operation
            is known in no other.
        yaw_deg: Which way the operator faces, seen from the robot's base and turned to the left: 0
            as the robot's +X, 90 as its +Y, 180 towards its -X, -90 as its -Y; nothing between,
            as a rotation about an oblique axis is no single one about X or Y.
        tool: Tool number, 0 to 23; the controller must tell its position for the same one.
        tool_mm: Tool point seen from the flange, as the controller's tool file has it.
        supervision_input: First network input of the byte that is toggled for a ladder on the
            controller, 22010 where the integrator has chosen no other; 0 for no supervision.
        supervision_hz: Toggles a second; 2 to 10. The ladder's timer must allow for 2.5 periods.
    """

    host: str = ""
    port: int = 80
    ext_radius_mm: float = 1200.0
    int_radius_mm: float = 500.0
    margin_mm: float = 20.0
    floor_mm: float = -300.0
    ceiling_mm: float = 1000.0
    column_radius_mm: float = 350.0
    column_top_mm: float = 800.0
    keep_outs: tuple[KeepOutSettings, ...] = ()
    speed_mm_s: float = 100.0
    speed_deg_s: float = 10.0
    rx_range_deg: tuple[float, float] = (120.0, 240.0)
    ry_range_deg: tuple[float, float] = (-60.0, 60.0)
    rz_range_deg: tuple[float, float] = (-90.0, 90.0)
    margin_deg: float = 2.0
    frame: int = 1
    yaw_deg: int = 0
    tool: int = 0
    tool_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    supervision_input: int = 0
    supervision_hz: float = 5.0


@dataclass(frozen=True, slots=True)
class JointSettings:
    """What the HP6's joints may do on the way: ranges, and margins to them and to singular places.

    Angles count from the home position, all pulses 0: lower arm upright, forearm level, flange
    straight ahead of it. S, L, R and T are the published ranges. B is published as -45 to 225: a
    wrist bends alike both ways, so that range is a right angle off our zero, which is 135 either
    way; as -45 to 225 from straight it would fold through the forearm. U is published against the
    horizontal and says nothing about U against the lower arm, where the two parts touch; ours keeps
    to the middle. Compare all six with the pendant's before a real robot moves.

    Attributes:
        s_range_deg: Lowest and highest S, to the left.
        l_range_deg: Lower arm, forwards.
        u_range_deg: Forearm against the lower arm, upwards; 76.4 is stretched.
        r_range_deg: Turn of the forearm.
        b_range_deg: Bend of the wrist, upwards; 0 is straight.
        t_range_deg: Turn of the flange.
        margin_deg: How far from the ends of the ranges an increment ends.
        wrist_margin_deg: How far B stays from 0, where R and T would swing round.
        elbow_margin_deg: How far the elbow stays from stretched and from folded.
        shoulder_margin_mm: How far the wrist centre stays from the S axis.
    """

    s_range_deg: tuple[float, float] = (-170.0, 170.0)
    l_range_deg: tuple[float, float] = (-90.0, 155.0)
    u_range_deg: tuple[float, float] = (-80.0, 80.0)
    r_range_deg: tuple[float, float] = (-180.0, 180.0)
    b_range_deg: tuple[float, float] = (-135.0, 135.0)
    t_range_deg: tuple[float, float] = (-360.0, 360.0)
    margin_deg: float = 10.0
    wrist_margin_deg: float = 10.0
    elbow_margin_deg: float = 15.0
    shoulder_margin_mm: float = 100.0


@dataclass(frozen=True, slots=True)
class PersonSettings:
    """Whose arms these are.

    Attributes:
        name: As shown in the window. A change is used from the next start on.
        model: The person's model file; None when there is none yet. A change is used from the next
            start on.
    """

    name: str = ""
    model: Path | None = None


N_TAKES_RANGE: Final = (5, 200)
"""Good takes of each gesture that may be wanted."""
BEAT_RANGE_S: Final = (1.1, 5.0)
"""A take ends 1.0 s after its beat, and its last sample has to arrive before the next one."""


@dataclass(frozen=True, slots=True)
class TrainingSettings:
    """How takes are recorded.

    Attributes:
        n_takes: Good takes of each gesture that are wanted.
        beat_s: Time between two beats of the rhythm; a take ends 1.0 s after its beat.
    """

    n_takes: int = 30
    beat_s: float = 1.5


@dataclass(frozen=True, slots=True)
class Settings:
    """Everything the cell is started with."""

    left: SensorSettings = field(default_factory=SensorSettings)
    right: SensorSettings = field(default_factory=SensorSettings)
    site: SiteSettings = field(default_factory=SiteSettings)
    robot: RobotSettings = field(default_factory=RobotSettings)
    joints: JointSettings = field(default_factory=JointSettings)
    person: PersonSettings = field(default_factory=PersonSettings)
    training: TrainingSettings = field(default_factory=TrainingSettings)
    is_simulation: bool = False
