"""What the settings say, as the field of operation and the guardian's limits. Pure."""

from gestureapp.config import DriveMode, JointSettings, Settings
from gestureapp.errors import ConfigError
from gestureapp.robot.arm import ArmLimits
from gestureapp.robot.gate import Limits
from gestureapp.robot.obstacles import Column, KeepOut
from gestureapp.robot.workspace import FieldOfOperation
from gestureapp.sensing.posture import PostureDetector
from gestureapp.settings_check import why_not_simulated


def field_of(settings: Settings) -> FieldOfOperation:
    """The field of operation that the settings describe."""
    robot = settings.robot
    column = Column(robot.column_radius_mm, robot.column_top_mm) if robot.column_radius_mm else None
    return FieldOfOperation(
        ext_radius_mm=robot.ext_radius_mm,
        int_radius_mm=robot.int_radius_mm,
        margin_mm=robot.margin_mm,
        ranges_deg=(robot.rx_range_deg, robot.ry_range_deg, robot.rz_range_deg),
        margin_deg=robot.margin_deg,
        floor_mm=robot.floor_mm,
        ceiling_mm=robot.ceiling_mm,
        column=column,
        keep_outs=tuple(KeepOut(box.name, box.low_mm, box.high_mm) for box in robot.keep_outs),
        arm=_arm_limits_of(settings.joints, robot.tool_mm),
    )


def _arm_limits_of(joints: JointSettings, tool_mm: tuple[float, float, float]) -> ArmLimits:
    return ArmLimits(
        tool_mm=tool_mm,
        ranges_deg=(
            joints.s_range_deg,
            joints.l_range_deg,
            joints.u_range_deg,
            joints.r_range_deg,
            joints.b_range_deg,
            joints.t_range_deg,
        ),
        joint_margin_deg=joints.margin_deg,
        wrist_margin_deg=joints.wrist_margin_deg,
        elbow_margin_deg=joints.elbow_margin_deg,
        shoulder_margin_mm=joints.shoulder_margin_mm,
    )


def limits_of(settings: Settings) -> Limits:
    """What the guardian is given at its start."""
    robot, site = settings.robot, settings.site
    return Limits(
        field=field_of(settings),
        speed_mm_s=robot.speed_mm_s,
        speed_deg_s=robot.speed_deg_s,
        frame=robot.frame,
        tool=robot.tool,
        is_hold_to_run=site.drive_mode is DriveMode.HOLD_TO_RUN,
        trip_level_s=site.trip_level_s,
        control_limit_s=site.control_limit_s,
        gui_limit_s=site.gui_limit_s,
        supervision_input=robot.supervision_input,
        supervision_hz=robot.supervision_hz,
    )


def checked_limits(settings: Settings) -> Limits:
    """The same, of settings that nobody has looked at yet.

    Raises:
        ConfigError: the settings contradict each other or a limit that nobody may leave.
    """
    site = settings.site
    if wrong := why_not_simulated(settings):
        raise ConfigError("robot.host", settings.robot.host, wrong)
    try:
        PostureDetector(site.posture_enter_deg, site.posture_leave_deg, site.posture_debounce)
        return limits_of(settings)
    except ValueError as error:
        raise ConfigError("robot and site settings", "as given", str(error)) from error
