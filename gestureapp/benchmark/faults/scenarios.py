"""The faults: one table for the tests and for the benchmark."""

import os
import signal
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from gestureapp.benchmark.driven import training_beside
from gestureapp.benchmark.faults.rig import Rig
from gestureapp.benchmark.faults.scenario import Expected, Scenario
from gestureapp.cell.control import TICK_S as CONTROL_TICK_S
from gestureapp.cell.guardian_keeper import SILENT_TICKS
from gestureapp.clock import monotonic
from gestureapp.config import SiteSettings
from gestureapp.errors import WorkerError
from gestureapp.recording.session_reader import read_session
from gestureapp.sensing.values import Side

SITE = SiteSettings()
TRIP_MS = 1000 * SITE.trip_level_s
GUI_MS = 1000 * SITE.gui_limit_s
ANSWER_MS = 20
"""The longest wait for the answer that is outstanding, and the bytes of HOLD."""
ROUND_MS = 30
"""A round of the control thread and of the guardian beyond that."""
LOCKED_S = 0.6
BLOCKED_S = 5.0
ASLEEP_S = 2.0
"""Longer, and the robot would reach the end of its way meanwhile."""
TOLD_S = 3.0
"""A stop that the robot has not confirmed is told 1.0 s after it was asked for."""
DISK_WAIT_S = 6.0
_STALLED = ("application stood still",)
_LAST = "from the last good sample sent"
_TRIP = f"trip level, {TRIP_MS:.0f} ms"
_CELL_TRIP = f"the control thread, at the trip level, {TRIP_MS:.0f} ms"


@dataclass(frozen=True, slots=True)
class SensorFault:
    """What can be wrong with a sensor, and what is told of it."""

    kind: str
    words: str
    told: tuple[str, ...]
    detection: str = ""
    limit_ms: float = TRIP_MS

    def told_of(self, side: Side) -> tuple[str, ...]:
        """What is told when it is this sensor's."""
        return tuple(f"{side.value} sensor{text}" for text in self.told)


SILENT = SensorFault("silent", "silent", (": no data", " silent"))
SENSOR_FAULTS = (
    SILENT,
    SensorFault("frozen", "frozen on one value", (": frozen on one value", " silent")),
    SensorFault("garbage", "sends garbage", (": unreadable data", " silent")),
    SensorFault(
        "jump", "clock jumps", (": running number jumped",), "its running number", ROUND_MS
    ),
    SensorFault("unplugged", "unplugged", (": connection to",), "its connection ends", 10),
)


# The application.


def _kill(rig: Rig) -> float:
    return rig.application.signal(signal.SIGKILL)


def _pause(rig: Rig) -> float:
    begun_s = rig.application.signal(signal.SIGSTOP)
    rig.until_log(lambda: rig.log.end_after(begun_s), 2.0)
    rig.application.signal(signal.SIGCONT)  # asked only now: meanwhile it can tell nothing
    return begun_s


def _block_window(rig: Rig) -> float:
    return _time(rig.application.ask("block_window", seconds=BLOCKED_S))


def _break_control(rig: Rig) -> float:
    return _time(rig.application.ask("break_thread", name="control"))


def _hold_lock(rig: Rig) -> float:
    rig.application.ask("hold_lock", seconds=LOCKED_S)
    return _time({"t_s": rig.now["lock_s"]})


def _silence_and_hold_lock(rig: Rig) -> float:
    begun_s = rig.fault(Side.LEFT, "silent")
    rig.application.ask("hold_lock", seconds=LOCKED_S)
    return begun_s


def _open_dialog(rig: Rig) -> None:
    rig.application.ask("open_dialog")
    if rig.now["state"] != "MOVING":
        raise WorkerError("application", "stopped before the fault; try again")


def _press_before_dialog(rig: Rig) -> float:
    _open_dialog(rig)
    return _time(rig.application.ask("press_key"))


def _silence_before_dialog(rig: Rig) -> float:
    _open_dialog(rig)
    return rig.fault(Side.LEFT, "silent")


def _close_dialog(rig: Rig) -> None:
    rig.application.ask("close_dialog")


def _train_beside(rig: Rig) -> None:
    from gestureapp.recognition.takes import save_takes
    from gestureapp.simulation.takes import make_takes

    folder = Path(rig.beside.enter_context(tempfile.TemporaryDirectory()))
    takes = folder / "takes.npz"
    save_takes(takes, make_takes(1, 30, 7))
    rig.beside.enter_context(training_beside(takes))
    rig.move()


def _press_stop(rig: Rig) -> float:
    return _time(rig.application.ask("press_stop"))


# The sensors.


def _sensor(side: Side, kind: str) -> Callable[[Rig], float]:
    return lambda rig: rig.fault(side, kind)


def _while_collecting(kind: str) -> Callable[[Rig], float]:
    """The fault comes as the left arm is seen in start, before the window of the gesture."""

    def begin(rig: Rig) -> float:
        raised_s = monotonic() + 0.1
        start = {"do": "take", "posture": "start", "at_s": raised_s}
        rig.sensors[Side.LEFT].ask(start)
        time.sleep(max(0.0, raised_s + rig.timing.start_seen_s - 0.01 - monotonic()))
        return rig.fault(Side.RIGHT, kind)

    return begin


def _arm_at_rest(rig: Rig) -> None:
    """Armed, nothing moves, and the hold is released."""
    rig.arm()
    rig.until_log(lambda: not rig.log.is_moving, 2.0)


# The robot's line.


def _cut(rig: Rig) -> float:
    return rig.robot_fault("drop")


def _slow(rig: Rig) -> float:
    return rig.robot_fault("slow", ms=500)


def _dead_line(kind: str) -> Callable[[Rig], float]:
    """Nothing can stop a robot that hears nothing: it is told, and HOLD is the first it hears."""

    def begin(rig: Rig) -> float:
        rig.robot_fault(kind)
        if not rig.wait(lambda s: s["is_stop_unconfirmed"], TOLD_S):
            raise WorkerError("application", "does not tell that the stop is not confirmed")
        return rig.robot_fault("none")

    return begin


# The guardian.


def _kill_guardian(rig: Rig) -> float:
    return _signal(rig.application.guardian_pid, signal.SIGKILL)


def _pause_guardian(rig: Rig) -> float:
    return _signal(rig.application.guardian_pid, signal.SIGSTOP)


def _holds_first(rig: Rig, begun_s: float) -> list[str]:
    """A guardian that follows another one, on a connection of its own, asks for nothing before."""
    before = max(r.connection for r in rig.log.requests if r.last_s < begun_s)
    first = next((r.name for r in rig.log.requests if r.connection > before), "nothing")
    return [] if first == "HOLD" else [f"the new guardian asks for {first} first"]


def _signal(pid: int, number: signal.Signals) -> float:
    begun_s = monotonic()
    os.kill(pid, number)
    return begun_s


def _suspend(rig: Rig) -> float:
    """The controller is another machine, and goes on while this one stands still."""
    pids = (rig.application.pid, rig.application.guardian_pid)
    for pid in pids:
        _signal(pid, signal.SIGSTOP)
    time.sleep(ASLEEP_S)
    awake_s = monotonic()
    for pid in pids:
        _signal(pid, signal.SIGCONT)
    return awake_s


# The disk.


def _fill_disk_and_press(rig: Rig) -> float:
    rig.application.limit_files(rig.newest_session.stat().st_size)
    if not rig.wait(lambda s: "not recording" in str(s["recording"]).lower(), DISK_WAIT_S):
        raise WorkerError("application", f"does not tell of the disk: {rig.now['recording']}")
    return _press_stop(rig)


def _empty_disk(rig: Rig) -> None:
    rig.application.limit_files(None)


def _is_record_whole(rig: Rig, _: float) -> list[str]:
    """With room on the disk again, the next file continues where the last confirmed one ends."""
    _empty_disk(rig)
    if not rig.wait(lambda s: s["is_recording"], DISK_WAIT_S):
        return [f"not recorded again: {rig.now['recording']}"]
    files = sorted((rig.folder / "sessions").glob("*.mcap"), key=lambda f: f.stat().st_mtime_ns)
    before, after = (read_session(file) for file in files[-2:])
    gap_s = after.start_wall_s - before.end_wall_s
    return [f"{gap_s:.1f} s are in neither file"] if gap_s > 0.1 else []


def _sensor_scenarios() -> Iterator[Scenario]:
    for side in Side:
        round_ms = 0 if side is Side.LEFT else ROUND_MS
        by = _TRIP if side is Side.LEFT else _CELL_TRIP
        for fault in SENSOR_FAULTS:
            yield Scenario(
                f"{side.value}-{fault.kind}",
                f"{side.value} sensor {fault.words}",
                fault.detection or by,
                fault.limit_ms + ANSWER_MS + round_ms,
                _sensor(side, fault.kind),
                fault.told_of(side),
                counted=_LAST,
            )
    for fault in SENSOR_FAULTS:
        yield Scenario(
            f"collecting-{fault.kind}",
            f"right sensor {fault.words} while its samples are collected",
            fault.detection or _CELL_TRIP,
            fault.limit_ms + ANSWER_MS + ROUND_MS,
            _while_collecting(fault.kind),
            fault.told_of(Side.RIGHT),
            prepare=_arm_at_rest,
            expected=Expected.MOVES_NOT,
            counted=_LAST,
        )


SCENARIOS = (
    Scenario(
        "kill", "application killed (kill -9)", "its connections end", ANSWER_MS, _kill,
        ("application gone",), screen="", mend=Rig.end_application,
    ),
    Scenario(
        "pause", "application stopped (SIGSTOP)", _TRIP, TRIP_MS + ANSWER_MS, _pause,
        _STALLED,
    ),
    Scenario(
        "window", f"window's thread blocked {BLOCKED_S:.0f} s", f"window limit, {GUI_MS:.0f} ms",
        GUI_MS + 50, _block_window, ("window frozen",),
        mend=lambda rig: rig.application.ask("free_window"),
    ),
    Scenario(
        "control", "control thread raises", "its end is reported", ANSWER_MS + ROUND_MS,
        _break_control, ("the control thread has ended by an error",), screen="STOPPING",
        mend=Rig.end_application,
    ),
    Scenario(
        "lock", f"interpreter lock held {LOCKED_S} s by a C call", _TRIP, TRIP_MS + ANSWER_MS,
        _hold_lock, _STALLED,
    ),
    Scenario(
        "lock-silent", f"left sensor silent, and the interpreter lock held {LOCKED_S} s", _TRIP,
        TRIP_MS + ANSWER_MS, _silence_and_hold_lock,
        (*SILENT.told_of(Side.LEFT), *_STALLED),
        counted=_LAST,
    ),
    *_sensor_scenarios(),
    Scenario(
        "suspend", f"computer asleep {ASLEEP_S:.0f} s: application and guardian stand still",
        "the time that has passed, at the trip level", ANSWER_MS + ROUND_MS, _suspend,
        ("stood still",), counted="from the wake-up",
    ),
    Scenario(
        "cut", "robot link cut (RST)", "the connection ends", 100, _cut, ("reset", "closed"),
    ),
    Scenario(
        "slow", "robot answers 500 ms late", "no answer within 300 ms", 1600, _slow,
        ("no answer to",), told_within_s=10.0,
    ),
    Scenario(
        "black-hole", "robot link black-holed (no answer)",
        "no answer within 300 ms; told after 1.0 s as not confirmed", 1700, _dead_line("silent"),
        ("no answer to",), counted="from when the link is back",
    ),
    Scenario(
        "ng", "robot says NG to everything", "its refusal; told after 1.0 s as not confirmed",
        200, _dead_line("ng"), ("refused",), counted="from when it takes requests again",
    ),
    Scenario(
        "disk", "disk full; STOP pressed", "STOP, by mouse", ANSWER_MS, _fill_disk_and_press,
        ("stop was pressed",), mend=_empty_disk, verify=_is_record_whole,
    ),
    Scenario(
        "dialog", "modal dialog open; STOP pressed", "STOP, by Esc", ANSWER_MS,
        _press_before_dialog, ("stop was pressed",), mend=_close_dialog,
    ),
    Scenario(
        "dialog-silent", "modal dialog open; left sensor silent", _TRIP, TRIP_MS + ANSWER_MS,
        _silence_before_dialog, SILENT.told_of(Side.LEFT), mend=_close_dialog,
        counted=_LAST,
    ),
    Scenario(
        "training", "a training beside; STOP pressed", "STOP, by mouse", ANSWER_MS, _press_stop,
        ("stop was pressed",), prepare=_train_beside,
    ),
    Scenario(
        "guardian-kill", "guardian killed", "its connections end; another one holds first",
        300 + ANSWER_MS, _kill_guardian, ("guardian process has ended",), verify=_holds_first,
    ),
    Scenario(
        "guardian-pause", "guardian stopped (SIGSTOP)",
        f"silent for {SILENT_TICKS * CONTROL_TICK_S:.1f} s; another one holds first",
        1000 * SILENT_TICKS * CONTROL_TICK_S + 100, _pause_guardian,
        ("guardian process is silent",), verify=_holds_first,
    ),
)  # fmt: skip


def _time(answer: dict[str, object]) -> float:
    return float(str(answer["t_s"]))
