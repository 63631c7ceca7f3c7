"""A fault tried on a moving robot: how it is brought about, and what has to come of it."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

from gestureapp.benchmark.faults.rig import Rig, until
from gestureapp.clock import monotonic
from gestureapp.recording.session_reader import read_session

BUSY_S = 1.0
"""The robot stands within this after the aim for HOLD, on a busy machine too: it needs 0.1 s."""
TOLD_WITHIN_S = 2.0
"""From standstill until it has been read back and the window says why."""
SYNCED_S = 1.0
"""A session file lacks no more than this at its end."""
SYNC_WAIT_S = 2.0


class Expected(Enum):
    """What the robot does about a fault."""

    STANDS = "stands"
    MOVES_NOT = "moves not"
    """It stood when the fault came, and no increment is sent."""


@dataclass(frozen=True, slots=True)
class Scenario:
    """One fault.

    Attributes:
        name: One word for the command line.
        words: The fault, for a person.
        detection: By what it is noticed, with the limit that applies.
        aim_ms: The whole HOLD is at the controller within this from when the fault began.
        begin: Brings the fault about; returns when it began, monotonic seconds.
        told: The screen says one of these, in small letters; for an application that was killed,
            the guardian's log does.
        mend: Ends what ``Rig.arm`` does not.
        prepare: What has to be so before.
        expected: What the robot does.
        screen: The state on the screen afterwards; empty when there is no screen any more.
        counted: From when the times run, where that is not the fault's own beginning.
        verify: What else has to be so after the robot stands, given when the fault began; returns
            what is not.
        told_within_s: From standstill until the screen says STOPPED and why.
    """

    name: str
    words: str
    detection: str
    aim_ms: float
    begin: Callable[[Rig], float]
    told: tuple[str, ...]
    mend: Callable[[Rig], object] = lambda rig: None
    prepare: Callable[[Rig], None] = Rig.move
    expected: Expected = Expected.STANDS
    screen: str = "STOPPED"
    counted: str = ""
    verify: Callable[[Rig, float], list[str]] = lambda rig, begun_s: []
    told_within_s: float = TOLD_WITHIN_S


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of one trial.

    Attributes:
        hold_ms: From the fault to the last byte of the first HOLD; None without one.
        stand_ms: From the fault to standstill in the emulated controller; None without one.
        told: What the screen said, or the guardian's log.
        problems: What was not as it has to be; empty when all was.
    """

    hold_ms: float | None
    stand_ms: float | None
    told: str
    problems: tuple[str, ...]


def try_fault(rig: Rig, scenario: Scenario) -> Outcome:
    """Bring a fault about and see what comes of it; the robot moves again afterwards.

    Args:
        rig: Where it is tried.
        scenario: The fault.

    Raises:
        WorkerError: it could not be tried.
    """
    scenario.prepare(rig)
    n_logged = len(_guardian_log(rig))
    begun_s = scenario.begin(rig)
    problems = _motion_problems(rig, scenario, begun_s)
    if scenario.screen:
        told = _told_on_screen(rig, scenario, problems)
    else:
        rig.end_application()
        told = _guardian_log(rig)[n_logged:].decode("utf-8", "replace")
    if not any(words in told.lower() for words in scenario.told):
        problems.append(f"told {told!r}, not {' or '.join(map(repr, scenario.told))}")
    problems += scenario.verify(rig, begun_s)  # a full disk is emptied by it
    problems += _session_problems(rig, begun_s, is_over=not scenario.screen)
    rig.log.read()
    hold, end_s = rig.log.first("HOLD", "1", begun_s), rig.log.end_after(begun_s)
    if scenario.expected is Expected.MOVES_NOT:
        moved = [r for r in rig.log.requests if r.name == "IMOV" and r.last_s > begun_s]
        problems += [f"{len(moved)} increments were sent"] if moved else []
    scenario.mend(rig)
    rig.beside.close()
    rig.move()  # the recovery; and the beginning of the next
    return Outcome(
        None if hold is None else 1000.0 * (hold.last_s - begun_s),
        None if end_s is None else 1000.0 * (end_s - begun_s),
        told,
        tuple(problems),
    )


def _motion_problems(rig: Rig, scenario: Scenario, begun_s: float) -> list[str]:
    """Waits until the robot stands; whether it did in time."""
    if scenario.expected is Expected.MOVES_NOT:
        return []
    limit_s = scenario.aim_ms / 1000.0 + BUSY_S
    if rig.until_log(lambda: rig.log.end_after(begun_s), begun_s + limit_s - monotonic()):
        return []
    return [f"the robot does not stand after {limit_s:.1f} s"]


def _guardian_log(rig: Rig) -> bytes:
    file = rig.folder / "guardian.log"
    return file.read_bytes() if file.exists() else b""


def _told_on_screen(rig: Rig, scenario: Scenario, problems: list[str]) -> str:
    """The sentence under the state; a state that says stopped was read back."""
    if not rig.wait(lambda s: s["state"] == scenario.screen, scenario.told_within_s):
        problems.append(f"the screen says {rig.now['state']}, not {scenario.screen}")
    now = rig.now
    if now["is_stop_unconfirmed"] is (scenario.screen == "STOPPED"):
        problems.append(f"the stop is said to be unconfirmed: {now['is_stop_unconfirmed']}")
    return str(now["sentence"])


def session_end_s(rig: Rig) -> float:
    """When the last record happened that can be read from the newest session, monotonic."""
    session = read_session(rig.newest_session)
    since_s = session.end_wall_s - float(session.metadata["start_wall_ns"]) / 1e9
    return float(session.metadata["start_monotonic_s"]) + since_s


def _session_problems(rig: Rig, begun_s: float, *, is_over: bool) -> list[str]:
    """Whether the session can be read up to the last second before the fault, or before now."""

    def is_synced() -> bool:
        wanted_s = begun_s if is_over else monotonic()
        return session_end_s(rig) >= wanted_s - SYNCED_S

    if until(is_synced, 0.0 if is_over else SYNC_WAIT_S):
        return []
    return [f"the session ends {begun_s - session_end_s(rig):.1f} s before the fault"]
