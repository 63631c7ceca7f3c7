"""Setting up at one moment: everything the window polls. Frozen."""

from dataclasses import dataclass, field

from gestureapp.settings_check import SettingsFinding
from gestureapp.setup.site_values import LockView, RobotCard, StopTestView
from gestureapp.setup.values import (
    CalibrationView,
    FindingView,
    LevelView,
    LinkTestView,
    PortChoice,
    PosturesView,
    SensorCard,
    ShakeView,
)


@dataclass(frozen=True, slots=True)
class SetupSnapshot:
    """Setting up, at one moment.

    Attributes:
        t_s: When, monotonic clock.
        ports: Of this machine, newest look.
        left: The left arm's sensor.
        right: The right arm's.
        robot: The robot.
        finding: Looking for sensors.
        shake: Assigning by shaking.
        link_test: The last or present one.
        calibration: The last or present one.
        level: The last or present one.
        postures: The chosen person's.
        stop_test: The last or present one.
        lock: The PIN.
        findings: What is wrong in the settings files.
        trouble: What keeps all of this from working; empty when nothing does.
    """

    t_s: float
    left: SensorCard
    right: SensorCard
    robot: RobotCard = field(default_factory=RobotCard)
    ports: tuple[PortChoice, ...] = ()
    finding: FindingView = field(default_factory=FindingView)
    shake: ShakeView = field(default_factory=ShakeView)
    link_test: LinkTestView = field(default_factory=LinkTestView)
    calibration: CalibrationView = field(default_factory=CalibrationView)
    level: LevelView = field(default_factory=LevelView)
    postures: PosturesView = field(default_factory=PosturesView)
    stop_test: StopTestView = field(default_factory=StopTestView)
    lock: LockView = field(default_factory=LockView)
    findings: tuple[SettingsFinding, ...] = ()
    trouble: str = ""
