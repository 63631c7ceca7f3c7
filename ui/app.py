"""Starts Qt, shows the window, and makes sure that whatever ends it stops the robot first."""

import logging
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType, TracebackType

from PySide6.QtCore import (
    QCoreApplication,
    QEvent,
    QMessageLogContext,
    QObject,
    Qt,
    QTimer,
    QtMsgType,
    qInstallMessageHandler,
)
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QApplication, QMessageBox

from gestureapp.cell.controls import CellControls
from gestureapp.cell.last_time import LastTime
from gestureapp.clock import monotonic
from gestureapp.guided.controls import GuidedControls, TrainerControls
from gestureapp.setup.controls import SetupControls
from gestureapp.window_port import Driver
from gestureapp.worker import Worker
from ui.hands import Hands
from ui.main_window import MainWindow
from ui.session_end import SessionEnd, session_id, system_bus
from ui.theme import Theme
from ui.virtual_operator import VirtualOperator

log = logging.getLogger(__name__)

DRIVER_ENDS_WITHIN_S = 10.0

ExceptHook = Callable[[type[BaseException], BaseException, TracebackType | None], object]

_QT_LEVELS = {
    QtMsgType.QtDebugMsg: logging.DEBUG,
    QtMsgType.QtInfoMsg: logging.INFO,
    QtMsgType.QtWarningMsg: logging.WARNING,
    QtMsgType.QtCriticalMsg: logging.ERROR,
    QtMsgType.QtFatalMsg: logging.CRITICAL,
}


def run_window(
    cell: CellControls,
    virtual: VirtualOperator | None = None,
    exit_after_s: float | None = None,
    driver: Driver | None = None,
    last_time: LastTime | None = None,
    guided: GuidedControls | None = None,
    trainer: TrainerControls | None = None,
    setup: SetupControls | None = None,
) -> int:
    """Show the cell until the window is closed; then the cell is shut down.

    Ctrl+C, a request to terminate and a terminal that is closed close the window as its own button
    does. A sleep, a shutdown, a lock or a log-off stop and disarm first.

    Args:
        cell: The running cell.
        virtual: Moves the emulated arms; its panel is shown when it is given.
        exit_after_s: Close the window by itself after this time, for unattended runs.
        driver: Uses the window as a person would, in a thread of its own.
        last_time: What the guardian did when no window could show it.
        guided: Records and tries takes; without it and a trainer there is no page for training.
        trainer: Trains the model.
        setup: Sensors, calibration, robot, settings, people; without it there is no page for them.

    Returns:
        The exit code: 0.
    """
    choose_platform()
    app = _application()
    Theme(app)
    try:
        window = MainWindow(cell, virtual, guided=guided, trainer=trainer, setup=setup)
        try:
            with _hooks(cell, window):
                _fit(window)
                if last_time is not None:
                    window.tell_last_time(last_time)
                if exit_after_s is not None:
                    QTimer.singleShot(round(exit_after_s * 1000), window, window.close)
                window.installEventFilter(_FirstPaint(window))
                with _driven(window, driver):
                    return app.exec()
        finally:
            _delete(window)
    finally:
        cell.shutdown()


def show_message(text: str) -> None:
    """Show why the application did not start until somebody puts it away; not without a screen."""
    if not _has_screen() or os.environ.get("QT_QPA_PLATFORM") in ("offscreen", "minimal"):
        return
    _application()
    box = QMessageBox()
    box.setIcon(QMessageBox.Icon.Critical)
    box.setWindowTitle("gestureapp was not started")
    box.setTextFormat(Qt.TextFormat.PlainText)
    box.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    box.setText(text)
    box.exec()


def choose_platform() -> None:
    """Take Qt's offscreen platform on a Linux machine without a screen, and say so."""
    if "QT_QPA_PLATFORM" not in os.environ and not _has_screen():
        os.environ["QT_QPA_PLATFORM"] = "offscreen"
        sys.stderr.write(
            "No screen (DISPLAY and WAYLAND_DISPLAY are empty): the window is drawn off screen.\n"
        )


def _has_screen() -> bool:
    names = ("DISPLAY", "WAYLAND_DISPLAY")
    return not sys.platform.startswith("linux") or any(os.environ.get(name) for name in names)


def stopping_hook(cell: CellControls, before: ExceptHook) -> ExceptHook:
    """An excepthook that stops the robot first and reports the error after.

    Args:
        cell: Whose robot.
        before: The hook for what is no error of the program: Ctrl+C.
    """

    def hook(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        cell.stop(f"an error nobody handled: {kind.__name__}: {error}")
        if issubclass(kind, KeyboardInterrupt):
            before(kind, error, trace)
            return
        log.critical(
            "an error nobody handled; the robot was stopped", exc_info=(kind, error, trace)
        )

    return hook


class _FirstPaint(QObject):
    """Notes in the log when the window has been painted for the first time."""

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Watch for the first paint; the note is made after it."""
        if event.type() is QEvent.Type.Paint:
            watched.removeEventFilter(self)
            QTimer.singleShot(0, lambda: log.info("painted at %.4f s", monotonic()))
        return False


@contextmanager
def _driven(window: MainWindow, driver: Driver | None) -> Iterator[None]:
    """Let a driver use the window for as long as it is open."""
    if driver is None:
        yield
        return
    hands = Hands(window)
    worker = Worker("driver", lambda _: driver(hands), lambda _: hands.close())
    worker.start()
    try:
        yield
    finally:
        worker.stop(DRIVER_ENDS_WITHIN_S)


def _application() -> QApplication:
    existing = QApplication.instance()
    if isinstance(existing, QApplication):
        return existing
    QGuiApplication.setHighDpiScaleFactorRoundingPolicy(
        Qt.HighDpiScaleFactorRoundingPolicy.PassThrough
    )
    app = QApplication(sys.argv[:1])
    app.setApplicationName("gestureapp")
    app.setApplicationDisplayName("gestureapp")
    return app


def _delete(window: MainWindow) -> None:
    # Left to Python's garbage collector, the parts of the plots go in any order, and Qt crashes.
    window.deleteLater()
    QCoreApplication.sendPostedEvents(window, QEvent.Type.DeferredDelete.value)


def _fit(window: MainWindow) -> None:
    screen = window.screen().availableGeometry()
    window.resize(screen.size())
    window.move(screen.topLeft())
    window.showMaximized()


@contextmanager
def _hooks(cell: CellControls, window: MainWindow) -> Iterator[None]:
    """Qt's messages, unhandled errors, signals and the session's end, while the window lives."""

    def close(number: int, frame: FrameType | None) -> None:
        log.info("signal %d: closing", number)
        window.close()

    old_messages = qInstallMessageHandler(_log_qt_message)
    old_hook, old_thread_hook = sys.excepthook, threading.excepthook
    sys.excepthook = hook = stopping_hook(cell, old_hook)

    def thread_hook(args: threading.ExceptHookArgs) -> None:
        hook(args.exc_type, args.exc_value or args.exc_type(), args.exc_traceback)

    threading.excepthook = thread_hook
    # Python sees a signal as soon as the window's timer runs next.
    old_signals = {
        getattr(signal, name): signal.signal(getattr(signal, name), close)
        for name in ("SIGINT", "SIGTERM", "SIGHUP")
        if hasattr(signal, name)
    }
    session_end = SessionEnd(cell, system_bus(), session_id())
    try:
        yield
    finally:
        session_end.close()
        for number, handler in old_signals.items():
            signal.signal(number, handler)
        sys.excepthook, threading.excepthook = old_hook, old_thread_hook
        qInstallMessageHandler(old_messages)


def _log_qt_message(kind: QtMsgType, context: QMessageLogContext, message: str) -> None:
    log.log(_QT_LEVELS.get(kind, logging.WARNING), "Qt: %s", message)
