"""The application as it is, with a command port through which faults are brought into it.

What goes wrong inside a process can only be done from inside: a window's thread that does not come
back, a control thread that raises, a call that keeps the interpreter's lock. All of it is done from
here with the means of the interpreter and of the window's own event queue; the product's modules
know nothing of it. Started by the harness in ``rig``, never by a person.
"""

import contextlib
import ctypes
import json
import os
import selectors
import socket
import sys
import threading
from collections.abc import Callable
from pathlib import Path

from gestureapp.clock import monotonic
from gestureapp.running import RunningCell, running_cell
from gestureapp.settings_file import load_settings
from gestureapp.simulation.control_port import ControlPort
from gestureapp.simulation.listening import received
from gestureapp.simulation.parent import on_stdin_end
from gestureapp.window_port import OpenWindow, WindowHands

HOST = "127.0.0.1"
SOON_S = 0.5
"""The window's thread comes to a call within this, or the answer says that it did not."""
LINES_TOLD = 8

Fields = dict[str, object]


def run_subject(config: Path, folder: Path, open_window: OpenWindow) -> int:
    """Run the application until its window is closed or standard input ends; the exit code.

    Prints ``listening on HOST:PORT`` when its command port can be used.

    Args:
        config: Its settings.
        folder: For its sessions and the guardian's log.
        open_window: Opens its window.

    Raises:
        GestureAppError: the settings are wrong, or something could not be started.
    """
    settings, findings = load_settings([], config)
    for finding in findings:
        sys.stderr.write(f"{finding}\n")
    with running_cell(settings, folder) as running:
        return open_window(running, None, lambda hands: Subject(running, hands).serve())


class Subject:
    """Answers the harness's lines; lives in the driver's thread beside the window's."""

    def __init__(self, running: RunningCell, hands: WindowHands) -> None:
        self._running, self._hands = running, hands
        self._selector = selectors.DefaultSelector()
        self._waker, self._wakened = socket.socketpair()
        self._selector.register(self._wakened, selectors.EVENT_READ, self._end)
        self._port = ControlPort("fault harness", HOST, 0, self._selector, self._answer)
        self._later: list[Callable[[], None]] = []
        self._is_free = threading.Event()
        self._lock_s: float | None = None
        self._is_over = False

    def serve(self) -> None:
        """Answer until standard input ends; then close the window."""
        sys.stdout.write(f"listening on {HOST}:{self._port.port}\n")
        sys.stdout.flush()
        on_stdin_end(self._wake)
        while not self._is_over:
            for key, _ in self._selector.select():
                key.data()
            while self._later:  # once the answer has gone out
                self._later.pop(0)()
        self._is_free.set()
        self._port.close()
        self._hands.close_dialog()
        self._hands.close()

    def _wake(self) -> None:
        with contextlib.suppress(OSError):
            self._waker.send(b"!")

    def _end(self) -> None:
        self._is_over = received(self._wakened) is not None

    def _answer(self, line: bytes) -> Fields:
        fields = json.loads(line)
        return {"ok": True} | _ACTIONS[fields["do"]](self, fields)

    # What a person does and sees.

    def _state(self, _: Fields) -> Fields:
        s = self._running.cell.snapshot()
        status = s.robot.status
        return {
            "state": s.state.value,
            "sentence": s.sentence,
            "can_arm": s.can_arm,
            "blockers": [blocker.text for blocker in s.blockers],
            "is_stop_unconfirmed": s.is_stop_unconfirmed,
            "is_held": status is None or status.is_held or status.is_running,
            "is_recording": s.recording.is_on,
            "recording": s.recording.text,
            "events": [line.text for line in s.events[-LINES_TOLD:]],
            "lock_s": self._lock_s,
        }

    def _arm(self, _: Fields) -> Fields:
        self._running.cell.arm()
        return {}

    def _disarm(self, _: Fields) -> Fields:
        self._running.cell.disarm()
        return {}

    def _servo_on(self, _: Fields) -> Fields:
        self._running.cell.servo_on()
        return {}

    def _press_stop(self, _: Fields) -> Fields:
        return {"t_s": self._hands.press_stop()}

    def _press_key(self, _: Fields) -> Fields:
        return {"t_s": self._hands.press_stop_key()}

    # What goes wrong.

    def _block_window(self, fields: Fields) -> Fields:
        """The window's thread does not come back from a call until it is freed, or too long."""
        has_begun = threading.Event()
        begun_s: list[float] = []
        self._is_free.clear()

        def block() -> None:
            begun_s.append(monotonic())
            has_begun.set()
            self._is_free.wait(float(str(fields["seconds"])))

        self._hands.call(block)
        return {"t_s": begun_s[0]} if has_begun.wait(SOON_S) else {}

    def _free_window(self, _: Fields) -> Fields:
        self._is_free.set()
        return {}

    def _open_dialog(self, _: Fields) -> Fields:
        """A modal dialog; the answer comes once the window's thread is in the dialog's own loop."""
        is_open = threading.Event()
        self._hands.open_dialog("A question that nobody answers.")
        self._hands.call(is_open.set)
        return {"is_open": is_open.wait(SOON_S)}

    def _close_dialog(self, _: Fields) -> Fields:
        self._hands.close_dialog()
        return {}

    def _break_thread(self, fields: Fields) -> Fields:
        """A thread raises at its next step, wherever it is."""
        name = fields["name"]
        thread = next(t for t in threading.enumerate() if t.name == name)
        raised = ctypes.py_object(RuntimeError)
        begun_s = monotonic()
        n = ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident or 0), raised)
        return {"t_s": begun_s, "n": n}

    def _hold_lock(self, fields: Fields) -> Fields:
        """One call into C that keeps the interpreter's lock: no thread of Python runs meanwhile."""
        microseconds = round(1e6 * float(str(fields["seconds"])))

        def hold() -> None:
            self._lock_s = monotonic()
            ctypes.PyDLL(None).usleep(microseconds)

        self._later.append(hold)
        return {"pid": os.getpid()}


_ACTIONS: dict[object, Callable[[Subject, Fields], Fields]] = {
    "state": Subject._state,
    "arm": Subject._arm,
    "disarm": Subject._disarm,
    "servo_on": Subject._servo_on,
    "press_stop": Subject._press_stop,
    "press_key": Subject._press_key,
    "block_window": Subject._block_window,
    "free_window": Subject._free_window,
    "open_dialog": Subject._open_dialog,
    "close_dialog": Subject._close_dialog,
    "break_thread": Subject._break_thread,
    "hold_lock": Subject._hold_lock,
}
