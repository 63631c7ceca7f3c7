"""Setting up without its threads: every state of it for a window, every wish noted."""

from collections.abc import Mapping
from dataclasses import replace

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QApplication, QLabel, QWidget

from gestureapp.config import KeepOutSettings, Settings
from gestureapp.recording.person_profile import Handedness
from gestureapp.sensing.values import LinkState, Side, StreamHealth
from gestureapp.settings_check import (
    bad_pairs,
    named_values,
    why_not_below,
    why_out_of_range,
)
from gestureapp.settings_text import about, allowed, choices
from gestureapp.settings_values import plain
from gestureapp.settings_words import unit_of
from gestureapp.setup.lock import NO_PIN
from gestureapp.setup.site_values import (
    LockView,
    PersonRow,
    RobotCard,
    SettingRow,
    StopTestPhase,
    StopTestView,
)
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.setup.values import (
    CalibrationView,
    FindingView,
    LevelView,
    LinkTestView,
    PortChoice,
    Position,
    PositionState,
    PositionView,
    PosturesView,
    SensorCard,
    ShakeView,
)
from ui.main_window import MainWindow

NOW_S = 1000.0
LEFT_PORT = PortChoice("/dev/rfcomm0", "BWT901CL left", "98:D3:31:F4:07:A2", is_bluetooth=True)
RIGHT_PORT = PortChoice("/dev/rfcomm1", "BWT901CL right", "98:D3:31:F4:11:5C", is_bluetooth=True)
BUSY_PORT = PortChoice(
    "/dev/ttyUSB0", "FT232R USB UART", "A50285BI", trouble="in use by another program"
)
PROTOCOL_ROWS = (
    ("csv", "one line a sample, in g: ax,ay,az or n,ax,ay,az"),
    ("adxl330", "ADXL330 at 3.0 V, one line a sample, in 10-bit counts: n,x,y,z"),
    ("witmotion", "Bluetooth sensors that send 0x55 0x51 frames"),
    ("binary", "our own frames, with running number and battery"),
)


def stream(side: Side, link: LinkState = LinkState.RECEIVING) -> StreamHealth:
    """A sensor's stream in one of the four states."""
    is_fine = link is LinkState.RECEIVING
    reasons = {
        LinkState.NOT_CONNECTED: "/dev/rfcomm0 does not exist: switch the sensor on and pair it",
        LinkState.NO_DATA: "connected, but silent: is the sensor switched on?",
        LinkState.WRONG_DATA: "what comes is no csv line: choose another protocol",
        LinkState.RECEIVING: "",
    }
    return StreamHealth(
        side=side,
        link=link,
        is_alive=is_fine,
        is_valid=is_fine,
        is_freq_ok=is_fine,
        reason=reasons[link],
        age_s=0.004 if is_fine else float("inf"),
        rate_hz=100.2 if is_fine else 0.0,
        worst_gap_s=0.034 if is_fine else 0.0,
        n_samples=12000 if is_fine else 0,
        n_bad=2 if is_fine else 0,
        n_lost=17 if is_fine else 0,
        jitter_s=0.0062 if is_fine else 0.0,
        identity=f"BWT901CL {side.value}" if is_fine else "",
        battery_percent=87.0 if is_fine else None,
    )


def card(side: Side, link: LinkState = LinkState.RECEIVING, **changes: object) -> SensorCard:
    """A sensor that nothing is against, or one in another state."""
    port = LEFT_PORT if side is Side.LEFT else RIGHT_PORT
    base = SensorCard(
        side=side,
        port=port.url,
        protocol="witmotion",
        sensor_id=port.sensor_id,
        name=port.name,
        health=stream(side, link),
        calibration="calibrated 2026-11-22, within 4 mg",
        level="level, 0.4 degrees, today at 07:58",
        link="link tested on 21 November 2026, carries 60 ms",
    )
    return replace(base, **changes)


def fine() -> SetupSnapshot:
    """Everything is set up."""
    return SetupSnapshot(
        t_s=NOW_S,
        left=card(Side.LEFT),
        right=card(Side.RIGHT),
        robot=RobotCard("192.168.1.31:80", True, "NX100 at 192.168.1.31:80"),
        ports=(LEFT_PORT, RIGHT_PORT, BUSY_PORT),
        postures=PosturesView(
            person="Ana",
            is_stop_done=True,
            is_start_done=True,
            between_deg=84.0,
            margin_deg=34.0,
            wall_s=1.79e9,
        ),
        lock=LockView(text=NO_PIN),
    )


def six(n_done: int, progress: float = 0.4) -> tuple[PositionView, ...]:
    """The first so many positions are done, and the next is being held."""
    states = (
        [PositionState.DONE] * n_done + [PositionState.HOLD_STILL] + [PositionState.MISSING] * 6
    )
    return tuple(
        PositionView(position, state, progress if state is PositionState.HOLD_STILL else 0.0)
        for position, state in zip(Position, states, strict=False)
    )


def every_setting(settings: Settings | None = None) -> tuple[SettingRow, ...]:
    """All settings as a window gets them, with their real meanings and ranges."""
    rows = []
    for name, owner, value in named_values(Settings() if settings is None else settings):
        key = name.rpartition(".")[2]
        said = (about(owner, key), plain(value), unit_of(name), allowed(owner, key))
        rows.append(SettingRow(name, *said, "built-in", False, choices(owner, key)))
    if all(row.name != "robot.yaw_deg" for row in rows):
        rows.append(SettingRow("robot.yaw_deg", "", 0, "deg", "0, 90, 180 or -90", "", False))
    return tuple(rows)


def wrong_in(rows: tuple[SettingRow, ...], changes: Mapping[str, object]) -> dict[str, str]:
    """What the real checks say to changed values, each by itself and in pairs."""
    owners = {name: owner for name, owner, _ in named_values(Settings())}
    wrong = {}
    for name, value in changes.items():
        if name not in owners:
            continue
        frozen = tuple(map(_as_kept, value)) if isinstance(value, list) else value
        if text := why_out_of_range(owners[name], name.rpartition(".")[2], frozen):
            wrong[name] = text
    values = {row.name: row.value for row in rows} | dict(changes)
    for low, high in bad_pairs(values):
        wrong.setdefault(low, why_not_below(values, low, high))
    return wrong


def _as_kept(item: object) -> object:
    if isinstance(item, dict):
        return KeepOutSettings(item["name"], tuple(item["low_mm"]), tuple(item["high_mm"]))
    return item


class FakeSetup:
    """Implements ``SetupControls``: the test sets ``shown`` and reads ``calls``.

    Attributes:
        shown: What ``snapshot`` gives.
        calls: Every wish, with its arguments, in order.
        rows: What ``settings`` gives; ``change_settings`` changes them.
        folk: What ``people`` gives.
        refused: What ``change_settings`` says; then nothing is changed.
        answer: What every call that says why not says.
        takes_ports: A chosen port is used.
    """

    def __init__(self, shown: SetupSnapshot | None = None) -> None:
        self.shown = fine() if shown is None else shown
        self.calls: list[str] = []
        self.rows: tuple[SettingRow, ...] = every_setting()
        self.folk: tuple[PersonRow, ...] = ()
        self.refused: dict[str, str] = {}
        self.answer = ""
        self.is_open = False
        self.takes_ports = True

    def show(self, **changes: object) -> None:
        """Change some of what is shown."""
        self.shown = replace(self.shown, **changes)

    def snapshot(self) -> SetupSnapshot:
        return self.shown

    def look(self, is_open: bool) -> None:
        self.is_open = is_open
        self.calls.append("setup open" if is_open else "setup closed")

    def protocols(self) -> tuple[tuple[str, str], ...]:
        return PROTOCOL_ROWS

    def choose_port(self, side: Side, port: str, protocol: str) -> None:
        self.calls.append(f"choose_port {side.value} {port} {protocol}")
        name = "left" if side is Side.LEFT else "right"
        if self.takes_ports:
            self.show(**{name: replace(getattr(self.shown, name), port=port, protocol=protocol)})

    def find_sensors(self) -> None:
        self.calls.append("find_sensors")
        self.show(finding=FindingView(True, "Listening on /dev/rfcomm0…"))

    def stop_finding(self) -> None:
        self.calls.append("stop_finding")
        self.show(finding=replace(self.shown.finding, is_on=False))

    def begin_shake(self) -> None:
        self.calls.append("begin_shake")
        self.show(shake=ShakeView(True, "Shake the sensor on your LEFT arm"))

    def end_shake(self) -> None:
        self.calls.append("end_shake")
        self.show(shake=ShakeView())

    def swap_sensors(self) -> None:
        self.calls.append("swap_sensors")

    def begin_link_test(self, side: Side) -> None:
        self.calls.append(f"begin_link_test {side.value}")

    def end_link_test(self) -> None:
        self.calls.append("end_link_test")
        self.show(link_test=LinkTestView())

    def begin_calibration(self, side: Side) -> None:
        self.calls.append(f"begin_calibration {side.value}")
        self.show(
            calibration=CalibrationView(
                side, True, "Lay the sensor on its back and let go", six(0, 0.0), Position.Z_UP
            )
        )

    def end_calibration(self) -> None:
        self.calls.append("end_calibration")
        self.show(calibration=CalibrationView())

    def begin_level_check(self, side: Side) -> None:
        self.calls.append(f"begin_level_check {side.value}")
        self.show(level=LevelView(side))

    def begin_postures(self) -> None:
        self.calls.append("begin_postures")
        self.show(postures=PosturesView(self.shown.postures.person, True, "Hold STOP"))

    def end_postures(self) -> None:
        self.calls.append("end_postures")
        self.show(postures=replace(self.shown.postures, is_on=False))

    def forget_postures(self) -> None:
        self.calls.append("forget_postures")

    def choose_robot(self, host: str, port: int) -> str:
        self.calls.append(f"choose_robot {host} {port}")
        return self.answer

    def begin_stop_test(self, label: str) -> None:
        self.calls.append(f"begin_stop_test {label}")
        self.show(stop_test=StopTestView(StopTestPhase.ARMING, "Keep holding"))

    def release_stop_test(self) -> None:
        self.calls.append("release_stop_test")

    def settings(self) -> tuple[SettingRow, ...]:
        return self.rows

    def check_settings(self, changes: Mapping[str, object]) -> Mapping[str, str]:
        return self.refused or wrong_in(self.rows, changes)

    def change_settings(self, changes: Mapping[str, object]) -> Mapping[str, str]:
        self.calls.append(f"change_settings {dict(changes)}")
        if wrong := self.check_settings(changes):
            return wrong
        self.rows = tuple(
            replace(row, value=changes[row.name], origin="settings.toml, line 1")
            if row.name in changes
            else row
            for row in self.rows
        )
        return {}

    def open_lock(self, pin: str) -> None:
        self.calls.append(f"open_lock {pin}")
        self.show(lock=LockView(has_pin=True, is_open=True, text="open for ten minutes"))

    def close_lock(self) -> None:
        self.calls.append("close_lock")
        self.show(lock=LockView(True, False, "Settings that bear on motion are locked."))

    def set_pin(self, pin: str) -> str:
        self.calls.append(f"set_pin {pin}")
        if not self.answer:
            self.show(lock=LockView(bool(pin), is_open=True, text="" if pin else NO_PIN))
        return self.answer

    def people(self) -> tuple[PersonRow, ...]:
        return self.folk

    def choose_person(self, name: str) -> str:
        self.calls.append(f"choose_person {name}")
        if not self.answer:
            self.folk = tuple(replace(row, is_chosen=row.name == name) for row in self.folk)
        return self.answer

    def set_handedness(self, name: str, handedness: Handedness) -> str:
        self.calls.append(f"set_handedness {name} {handedness.value}")
        if not self.answer:
            self.folk = tuple(
                replace(row, handedness=handedness) if row.name == name else row
                for row in self.folk
            )
        return self.answer


class SetupRoom:
    """The window at its setup page.

    Attributes:
        window: Shown; polled only here.
        setup: What it shows and asks.
        cell: The cell it belongs to.
    """

    def __init__(self, cell, operator=None) -> None:
        self.cell = cell
        self.setup = FakeSetup()
        self.window = MainWindow(cell, operator, lambda: NOW_S, setup=self.setup)
        self.window.resize(1366, 768)
        self.window.show()
        self.look()

    def look(self) -> None:
        """The window's timer comes round."""
        self.window.poll()
        QApplication.processEvents()

    def show(self, **changes: object) -> None:
        """Setting up goes on to another moment, and the window sees it."""
        self.setup.show(**changes)
        self.look()

    def enter(self, step: str = "Sensors") -> None:
        """Go to a step of the setup page."""
        if not self.button("navSetup").isChecked():
            self.press("navSetup")
        self.press(f"setupStep{step}")
        self.setup.calls.clear()

    def press(self, name: str) -> None:
        """Press a button that is in sight and can be pressed."""
        found = self.button(name)
        assert found.isVisible(), f"{name} is not in sight"
        assert found.isEnabled(), f"{name} cannot be pressed"
        QTest.mouseClick(found, Qt.MouseButton.LeftButton)
        self.look()

    def button(self, name: str) -> QAbstractButton:
        found = self.window.findChild(QAbstractButton, name)
        assert found is not None, name
        return found

    def widget(self, name: str) -> QWidget:
        found = self.window.findChild(QWidget, name)
        assert found is not None, name
        return found

    def text(self, name: str) -> str:
        """What a label says; empty while it is out of sight."""
        label = self.window.findChild(QLabel, name)
        assert label is not None, name
        return label.text() if label.isVisible() else ""
