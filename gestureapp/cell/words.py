"""The cell's state in a sentence: what to do next, or why nothing moves. Pure."""

from gestureapp.cell.machine_state import MachineState
from gestureapp.cell.snapshot import CellState
from gestureapp.config import DriveMode

_TEST_SENTENCES = {
    CellState.ARMED: "The robot moves in a moment; keep the left arm in the stop posture.",
    CellState.ACTIVATED: "Asking the robot.",
    CellState.MOVING: "Press STOP.",
}


def sentence(s: MachineState, drive_mode: DriveMode) -> str:
    """One sentence for a person, under the one word."""
    is_in_test = s.test and s.state in _TEST_SENTENCES
    said = _in_test(s) if is_in_test else _sentence(s, drive_mode)
    return said[:1].upper() + said[1:]


def _sentence(s: MachineState, drive_mode: DriveMode) -> str:
    match s.state:
        case CellState.NOT_READY:
            count = len(s.blockers)
            before = f"{s.note}. " if s.note else ""
            things = "1 thing stands" if count == 1 else f"{count} things stand"
            return f"{before}{things} against arming." if count else before.strip()
        case CellState.READY:
            return "Arming…" if s.is_arming else s.note or "Hold Arm for one second."
        case CellState.ARMED:
            return _armed(s)
        case CellState.ACTIVATED:
            return f"{s.note}. Asking the robot." if s.is_proposed else "Watching the right arm."
        case CellState.MOVING if drive_mode is DriveMode.HOLD_TO_RUN:
            return f"{s.note}. Move the left arm out of the start posture to stop."
        case CellState.MOVING:
            return f"{s.note}. Bring the left arm to the stop posture to stop."
        case CellState.STOPPING if s.is_stop_unconfirmed:
            return f"{s.note}. The robot has not confirmed that it stands; the stop is repeated."
        case CellState.STOPPING:
            return f"{s.note}. Waiting until the robot is read back to stand."
        case CellState.STOPPED:
            after = "Hold Arm for one second." if s.can_arm else _after_stop(s)
            return f"{s.note}. The robot stands. {after}"


def _in_test(s: MachineState) -> str:
    return f"Stop test along {s.test}. {_TEST_SENTENCES[s.state]}"


def _armed(s: MachineState) -> str:
    before = f"{s.note}. " if s.note else ""
    if not s.is_left_rested:
        return f"{before}Bring the left arm to the stop posture first."
    return f"{before}Take the start posture with the left arm and make a gesture with the right."


def _after_stop(s: MachineState) -> str:
    return "Arming…" if s.is_arming else "Clear what stands against arming, then hold Arm."
