"""The computer is about to sleep, shut down, lock or log off: stop and disarm first.

On Linux logind announces it on the system's D-Bus and waits for us (a "delay" inhibitor) until the
robot is read back to stand, for a few seconds at most. Qt announces a log-off; on Windows a message
of the system announces a suspend. What nobody announces is found by the watchdogs.
"""

import logging
import os
import sys
from collections.abc import Callable

from PySide6.QtCore import (
    SLOT,
    QAbstractNativeEventFilter,
    QByteArray,
    QEventLoop,
    QObject,
    QTimer,
    Slot,
)
from PySide6.QtDBus import QDBusConnection, QDBusMessage, QDBusPendingCallWatcher
from PySide6.QtGui import QGuiApplication, QSessionManager

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import CellState

log = logging.getLogger(__name__)

LOGIND = "org.freedesktop.login1"
LOGIND_PATH = "/org/freedesktop/login1"
MANAGER = "org.freedesktop.login1.Manager"
REST_LIMIT_S = 3.0
"""A robot stands, or servo power is off, within 1.0 s; logind waits 5 s (InhibitDelayMaxSec)."""
LOOK_MS = 20
_AT_REST = (CellState.NOT_READY, CellState.READY, CellState.STOPPED)
_PBT_APMSUSPEND = 0x0004
_WM_POWERBROADCAST = 0x0218
"""Source: Microsoft's reference of WM_POWERBROADCAST."""


class SessionEnd(QObject):
    """Hears that the session ends or pauses, and has the cell stopped. GUI thread only.

    Args:
        cell: What is stopped.
        bus: Where logind is; None where there is none.
        session: logind's id of our session, XDG_SESSION_ID; empty when it is not known: then a lock
            of any session counts.
    """

    def __init__(self, cell: CellControls, bus: QDBusConnection | None, session: str = "") -> None:
        super().__init__()
        self._cell = cell
        self._bus = bus
        self._inhibitor: QDBusPendingCallWatcher | None = None
        self._n_looks = 0
        self._at_rest: Callable[[], None] = self._release
        self._timer = QTimer(self, interval=LOOK_MS)
        self._timer.timeout.connect(self._look)
        self._filter = _PowerFilter(self._sleep_at_once) if sys.platform == "win32" else None
        app = QGuiApplication.instance()
        if isinstance(app, QGuiApplication):
            app.commitDataRequest.connect(self._log_off)
            if self._filter is not None:
                app.installNativeEventFilter(self._filter)
        if bus is not None:
            self._listen(bus, session)
            self._inhibit()

    def halt(self, why: str) -> None:
        """Stop what may move, and take the permission back. A robot at rest is not held."""
        if not self._is_at_rest():
            self._cell.stop(why)
        self._cell.disarm()
        log.warning("%s: stopped and disarmed", why)

    def close(self) -> None:
        """Hear nothing any more, and let the computer do as it likes. Idempotent."""
        app = QGuiApplication.instance()
        if app is not None and self._filter is not None:
            app.removeNativeEventFilter(self._filter)
        self._timer.stop()
        self._release()
        self.deleteLater()

    @Slot(bool)
    def _sleep(self, is_ahead: bool) -> None:
        if is_ahead:
            self.halt("the computer goes to sleep")
            self._when_at_rest(self._release)
        elif self._inhibitor is None:
            self._inhibit()

    @Slot(bool)
    def _shut_down(self, is_ahead: bool) -> None:
        if is_ahead:
            self.halt("the computer is shut down")
            self._when_at_rest(self._release)
        elif self._inhibitor is None:  # it was called off
            self._inhibit()

    @Slot()
    def _lock(self) -> None:
        self.halt("the session was locked")

    @Slot(QSessionManager)
    def _log_off(self, _manager: QSessionManager) -> None:
        self._halt_and_wait("the session ends")

    def _sleep_at_once(self) -> None:
        self._halt_and_wait("the computer goes to sleep")

    def _halt_and_wait(self, why: str) -> None:
        """The system goes on as soon as this returns: not before the robot stands."""
        self.halt(why)
        if not self._is_at_rest():
            loop = QEventLoop()
            self._when_at_rest(loop.quit)
            loop.exec(QEventLoop.ProcessEventsFlag.ExcludeUserInputEvents)
            self._release()

    def _is_at_rest(self) -> bool:
        return self._cell.snapshot().state in _AT_REST

    def _when_at_rest(self, then: Callable[[], None]) -> None:
        self._n_looks, self._at_rest = 0, then
        self._timer.start()

    def _look(self) -> None:
        self._n_looks += 1
        is_over = self._n_looks * LOOK_MS > REST_LIMIT_S * 1000
        if is_over:
            log.error("the robot was not read back to stand within %.0f s", REST_LIMIT_S)
        if is_over or self._is_at_rest():
            self._timer.stop()
            self._at_rest()

    # logind.

    def _listen(self, bus: QDBusConnection, session: str) -> None:
        path = f"{LOGIND_PATH}/session/{_bus_word(session)}" if session else ""
        for where, interface, name, slot in (
            (LOGIND_PATH, MANAGER, "PrepareForSleep", "_sleep(bool)"),
            (LOGIND_PATH, MANAGER, "PrepareForShutdown", "_shut_down(bool)"),
            (path, f"{LOGIND}.Session", "Lock", "_lock()"),
        ):
            # Qt's SLOT gives text where the type stubs say bytes.
            if not bus.connect(LOGIND, where, interface, name, self, SLOT(slot)):  # type: ignore[call-overload]
                log.warning("%s of logind cannot be heard", name)

    def _inhibit(self) -> None:
        """Have logind wait for us. Never waits itself."""
        if self._bus is None:
            return
        call = QDBusMessage.createMethodCall(LOGIND, LOGIND_PATH, MANAGER, "Inhibit")
        why = "the robot is stopped first"
        call.setArguments(["sleep:shutdown", "gestureapp", why, "delay"])
        # The descriptor in the answer is the inhibitor: it lasts as long as the answer is kept.
        self._inhibitor = QDBusPendingCallWatcher(self._bus.asyncCall(call), self)
        self._inhibitor.finished.connect(self._inhibited)

    def _inhibited(self, watcher: QDBusPendingCallWatcher) -> None:
        if watcher.isError():
            log.warning("a sleep will not wait for the robot: %s", watcher.error().message())
            self._release()

    def _release(self) -> None:
        inhibitor, self._inhibitor = self._inhibitor, None
        if inhibitor is not None:
            inhibitor.deleteLater()


class _PowerFilter(QAbstractNativeEventFilter):
    """Windows only: hears of a suspend. Not tried on a real machine."""

    def __init__(self, on_suspend: Callable[[], None]) -> None:
        super().__init__()
        self._on_suspend = on_suspend

    def nativeEventFilter(  # noqa: N802, Qt's spelling
        self, kind: QByteArray | bytes | bytearray | memoryview, message: int
    ) -> object:
        """Look at one message of the system; it always goes on its way."""
        if bytes(kind) == b"windows_generic_MSG":  # type: ignore[arg-type]
            from ctypes import wintypes

            told = wintypes.MSG.from_address(int(message))
            if (told.message, told.wParam) == (_WM_POWERBROADCAST, _PBT_APMSUSPEND):
                self._on_suspend()
        return False, 0


def system_bus() -> QDBusConnection | None:
    """Where logind is; None where there is no such bus."""
    if not sys.platform.startswith("linux"):
        return None
    bus = QDBusConnection.systemBus()
    return bus if bus.isConnected() else None


def session_id() -> str:
    """Logind's id of this session; empty when the environment does not tell."""
    return os.environ.get("XDG_SESSION_ID", "")


def _bus_word(session: str) -> str:
    """A session's id as a part of an object's path. Source: sd_bus_path_encode(3)."""
    plain = "".join(c if c.isascii() and c.isalnum() else f"_{ord(c):02x}" for c in session)
    return f"_{ord(plain[0]):02x}{plain[1:]}" if plain[:1].isdigit() else plain
