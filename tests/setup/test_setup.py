"""Setting up with its thread, as a window uses it: wishes in, pictures out, files written."""

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from gestureapp.cell.controls import SETUP_OPEN
from gestureapp.config import PersonSettings, SensorSettings, Settings
from gestureapp.recording.people import list_people, make_person_folder, person_folder
from gestureapp.recording.person_profile import (
    Handedness,
    PersonProfile,
    load_profile,
    save_profile,
)
from gestureapp.recording.sensor_records import SensorRecord, save_record
from gestureapp.sensing.posture import LeftPostures
from gestureapp.sensing.values import Side
from gestureapp.settings_file import load_settings
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.settings_desk import SettingsDesk
from gestureapp.setup.settings_use import SettingsUse
from gestureapp.setup.setup import Setup
from tests.setup.bench import LIMIT_S, ReadCell


class Started:
    """Setting up, started, in front of a cell whose sensors are on pyserial's own loop."""

    def __init__(self, folder: Path, named: Path | None = None) -> None:
        self.data, self.user = folder / "data", folder / "settings.toml"
        self.data.mkdir()
        self.files = [folder / "site.toml", self.user]
        self.user.write_text(
            'schema = 1\n# ours\n[left]\nport = "loop://"\n[right]\nport = "loop://"\n'
        )
        settings, _ = load_settings(self.files, named)
        if named is None:
            settings = replace(settings, person=PersonSettings("Ana"))
        self.cell = ReadCell(settings, time.monotonic)
        use = SettingsUse(self.cell, settings)  # type: ignore[arg-type]
        desk = SettingsDesk(self.files, named, settings, use, tell=self.cell.tell)
        self.setup = Setup(self.cell, self.data, desk)  # type: ignore[arg-type]
        self.setup.start_thread()

    def close(self) -> None:
        self.setup.shutdown()
        self.cell.close()

    def wait(self, condition: Callable[[], bool]) -> None:
        until_s = time.monotonic() + LIMIT_S
        while not condition():
            assert time.monotonic() < until_s, f"it did not become so: {self.setup.snapshot()}"
            time.sleep(0.01)


@pytest.fixture
def started(tmp_path: Path) -> Iterator[Started]:
    made = Started(tmp_path)
    yield made
    made.close()


def test_it_is_what_the_window_asks_for(started: Started):
    controls: SetupControls = started.setup
    assert controls.snapshot().left.port == "loop://"
    assert dict(controls.protocols())["csv"]
    assert any(row.name == "robot.speed_mm_s" for row in controls.settings())


def test_arming_is_held_before_look_returns_and_told_once(started: Started):
    started.setup.look(True)
    started.setup.look(True)
    assert started.cell.held == [SETUP_OPEN]
    started.setup.look(False)
    assert started.cell.held == [SETUP_OPEN, ""]
    started.setup.look(False)
    assert started.cell.held == [SETUP_OPEN, ""]


def test_sensors_are_judged_from_the_start_whether_or_not_anybody_looks(started: Started):
    started.wait(lambda: set(started.cell.judged) == set(Side))
    assert started.cell.judged[Side.LEFT][0] == "not calibrated"


def test_a_chosen_port_stands_in_the_user_s_file_and_is_reopened_at_the_next_start(
    started: Started,
):
    started.setup.choose_port(Side.LEFT, "socket://127.0.0.1:9", "adxl330")
    started.wait(lambda: started.setup.snapshot().left.protocol == "adxl330")
    settings, findings = load_settings(started.files)
    assert settings.left == SensorSettings("socket://127.0.0.1:9", "adxl330")
    assert not findings
    assert "# ours" in started.user.read_text()
    assert started.setup.snapshot().trouble == ""


def test_swapping_is_remembered_too(started: Started):
    started.setup.choose_port(Side.LEFT, "socket://127.0.0.1:9", "csv")
    started.setup.swap_sensors()
    started.wait(lambda: started.setup.snapshot().right.port == "socket://127.0.0.1:9")
    settings, _ = load_settings(started.files)
    assert (settings.left.port, settings.right.port) == ("loop://", "socket://127.0.0.1:9")


@pytest.fixture
def named(tmp_path: Path) -> Iterator[Started]:
    """As ``started``, with a file named at the start that has both ports."""
    file = tmp_path / "named.toml"
    file.write_text(
        'schema = 1\n[left]\nport = "loop://?l"\n'
        '[right]\nport = "loop://?r"\nprotocol = "adxl330"\n'
    )
    made = Started(tmp_path, file)
    yield made
    made.close()


def test_sensors_of_a_named_file_are_swapped_as_often_as_it_is_asked_for(named: Started):
    ports = [("loop://?r", "loop://?l"), ("loop://?l", "loop://?r")] * 2
    for n_done, (left, right) in enumerate(ports, 1):
        named.setup.swap_sensors()
        named.wait(lambda n=n_done: named.cell.told.count("left and right sensor are swapped") == n)
        assert (named.cell.settings.left.port, named.cell.settings.right.port) == (left, right)
        is_named = left == "loop://?l"
        named.wait(
            lambda fine=is_named: ("not remembered" in named.setup.snapshot().trouble) != fine
        )
    assert named.cell.settings.right.protocol == "adxl330"


def test_a_port_of_a_named_file_is_typed_away_and_back(named: Started):
    for port in ("socket://127.0.0.1:9", "loop://?l", "socket://127.0.0.1:9"):
        named.setup.choose_port(Side.LEFT, port, "csv")
        named.wait(lambda port=port: named.setup.snapshot().left.port == port)
        named.wait(lambda port=port: named.cell.told[-1:] == [f"left sensor: {port}, csv"])
    row = next(row for row in named.setup.settings() if row.name == "left.port")
    assert (row.value, row.origin) == ("socket://127.0.0.1:9", "this run only")
    assert "named.toml" in row.fixed


def test_swapping_is_told_once_it_is_in_force(named: Started):
    named.cell.is_busy = True
    named.setup.swap_sensors()
    named.wait(lambda: "not remembered" in named.setup.snapshot().trouble)
    assert named.cell.told == []
    named.cell.take()
    named.wait(lambda: named.cell.told == ["left and right sensor are swapped"])
    assert named.cell.settings.left.port == "loop://?r"


def test_a_file_that_cannot_be_written_costs_only_the_memory(started: Started):
    started.user.write_text("schema = 1\n[left\n")
    started.setup.choose_port(Side.LEFT, "socket://127.0.0.1:9", "csv")
    started.wait(lambda: started.setup.snapshot().left.port == "socket://127.0.0.1:9")
    started.wait(lambda: "not remembered" in started.setup.snapshot().trouble)


def test_a_person_is_chosen_and_noted(started: Started):
    assert "needs a name" in started.setup.choose_person("  ")
    assert started.setup.choose_person("Bea") == ""
    started.wait(lambda: started.cell.models == [(None, "", "Bea")])
    assert list_people(started.data) == ("Bea",)
    started.wait(lambda: [row.name for row in started.setup.people() if row.is_chosen] == ["Bea"])
    assert started.setup.set_handedness("Bea", Handedness.LEFT) == ""
    started.wait(lambda: started.setup.people()[-1].handedness is Handedness.LEFT)
    assert load_profile(started.data, "Bea")[0].handedness is Handedness.LEFT


def damage(started: Started, person: str) -> Path:
    """Postures that were recorded, in a file that is damaged since."""
    own = LeftPostures((0.0, 0.0, 1.0), (-1.0, 0.0, 0.0))
    save_profile(started.data, person, PersonProfile(Handedness.LEFT, own, 1.8e9))
    file = person_folder(started.data, person) / "profile.json"
    file.write_text(file.read_text().replace("left-handed", "right-handed"))
    started.setup.choose_person(person)
    started.wait(lambda: started.setup.snapshot().postures.person == person)
    return file


def test_a_damaged_profile_is_not_replaced_by_noting_the_hand(started: Started):
    file = damage(started, "Bea")
    content = file.read_bytes()
    started.wait(lambda: bool(started.setup.people()))
    for _ in range(2):
        assert "Bea's profile.json is damaged" in started.setup.set_handedness(
            "Bea", Handedness.LEFT
        )
    started.setup.look(True)
    assert file.read_bytes() == content
    view = started.setup.snapshot().postures
    assert view.problem.startswith("Bea's profile.json is damaged")
    assert "Setup, step Calibrate" in view.remedy
    assert started.cell.postures[-1][1:] == (view.problem, view.remedy)
    started.setup.forget_postures()
    started.wait(lambda: started.setup.snapshot().postures.problem == "")
    started.wait(lambda: any("set aside; Bea uses the built-in" in t for t in started.cell.told))
    assert file.with_name("profile.damaged-1.json").read_bytes() == content
    started.wait(lambda: started.setup.set_handedness("Bea", Handedness.LEFT) == "")


def test_the_thread_refuses_the_hand_of_a_damaged_profile_too(started: Started):
    file = damage(started, "Bea")
    content = file.read_bytes()
    assert "is damaged" in started.setup._desk.people.set_handedness("Bea", Handedness.LEFT)
    assert file.read_bytes() == content
    assert "handedness not noted" in started.cell.told[-1]


def test_a_left_handed_person_is_asked_by_the_arm_that_wears_it(started: Started):
    save_profile(started.data, "Bea", PersonProfile(Handedness.LEFT))
    started.setup.choose_person("Bea")
    started.wait(lambda: started.setup.snapshot().postures.person == "Bea")
    picture = started.setup.snapshot()
    assert (picture.left.worn, picture.right.worn, picture.postures.arm) == (
        "right",
        "left",
        "right",
    )
    started.setup.begin_shake()
    started.wait(lambda: "on your RIGHT arm" in started.setup.snapshot().shake.sentence)
    started.setup.begin_postures()
    started.wait(lambda: "with the right arm" in started.setup.snapshot().postures.sentence)


def test_a_name_that_only_looks_different_is_not_a_new_person(started: Started):
    make_person_folder(started.data, "José")
    assert "there is already José" in started.setup.choose_person("jose")
    assert list_people(started.data) == ("José",)


def test_postures_go_with_the_person_and_block_when_they_lie_too_close(started: Started):
    close = LeftPostures((0.0, 0.0, 1.0), (-0.8660254037844386, 0.0, 0.5))
    save_profile(started.data, "Bea", PersonProfile(postures=close, recorded_wall_s=1.8e9))
    started.wait(lambda: bool(started.cell.postures))
    assert started.cell.postures == [(LeftPostures(), "", "")]
    started.setup.choose_person("Bea")
    started.wait(lambda: len(started.cell.postures) == 2)
    postures, problem, remedy = started.cell.postures[-1]
    assert postures == close
    assert "degrees apart, 70 are needed" in problem
    assert remedy
    started.wait(lambda: started.setup.snapshot().postures.person == "Bea")
    assert started.setup.snapshot().postures.margin_deg < 5.0
    started.setup.forget_postures()
    started.wait(lambda: started.cell.postures[-1] == (LeftPostures(), "", ""))
    assert load_profile(started.data, "Bea")[0].postures is None


def test_postures_are_judged_anew_when_the_site_s_angles_change(started: Started):
    own = LeftPostures((0.0, 0.0, 1.0), (-0.9510565162951535, 0.0, 0.3090169943749474))  # 72 deg
    save_profile(started.data, "Bea", PersonProfile(postures=own, recorded_wall_s=1.8e9))
    started.setup.look(True)
    started.setup.choose_person("Bea")
    started.wait(lambda: started.cell.postures[-1:] == [(own, "", "")])
    wider = {"site.posture_enter_deg": 43.0, "site.posture_leave_deg": 44.0}
    assert started.setup.change_settings(wider) == {}
    started.wait(lambda: "degrees apart" in started.cell.postures[-1][1])
    assert started.cell.postures[-1][0] == own
    assert started.cell.postures[-1][2]
    started.wait(lambda: any("margin -15" in row.postures for row in started.setup.people()))
    assert started.setup.change_settings(dict.fromkeys(wider)) == {}
    started.wait(lambda: started.cell.postures[-1] == (own, "", ""))


def test_a_robot_s_address_is_used_and_remembered(started: Started):
    assert started.setup.choose_robot("192.0.2.9", 10040) == ""
    assert started.cell.used[-1].robot.host == "192.0.2.9"
    assert load_settings(started.files)[0].robot.port == 10040
    started.wait(lambda: started.setup.snapshot().robot.address == "192.0.2.9:10040")


def test_changed_settings_of_the_training_are_used(started: Started):
    assert started.setup.change_settings({"training.n_takes": 11}) == {}
    assert [settings.training.n_takes for settings in started.cell.used] == [11]


@pytest.mark.logs_errors
def test_a_thread_that_ended_leaves_no_sensor_fit(tmp_path: Path):
    started = Started(tmp_path)
    try:
        for side in Side:
            save_record(started.data, SensorRecord("loop://", calibrated_wall_s=time.time()))
            started.wait(lambda side=side: side in started.cell.judged)
        started.cell.snapshot = None  # type: ignore[assignment,method-assign]
        started.wait(lambda: "restart" in started.cell.judged[Side.LEFT][1])
        assert "setup: TypeError" in started.setup.snapshot().trouble
    finally:
        started.close()


def test_settings_without_a_port_say_what_to_do(tmp_path: Path):
    cell = ReadCell(Settings(), time.monotonic)
    desk = SettingsDesk([], None, Settings(), lambda settings: None)
    setup = Setup(cell, tmp_path, desk)  # type: ignore[arg-type]
    setup.start_thread()
    try:
        until_s = time.monotonic() + LIMIT_S
        while Side.RIGHT not in cell.judged and time.monotonic() < until_s:
            time.sleep(0.01)
        assert cell.judged[Side.LEFT][0] == "no sensor is chosen"
    finally:
        setup.shutdown()
        cell.close()


@pytest.mark.parametrize("port", ["/dev/\0a", "/dev/" + "a" * 300, "/dev/\ud800"])
def test_a_text_that_can_be_no_port_is_refused_and_all_goes_on(started: Started, port: str):
    started.setup.look(True)
    before = started.user.read_text()
    started.setup.choose_port(Side.LEFT, port, "csv")
    started.wait(lambda: "left.port" in started.setup.snapshot().trouble)
    assert "\n" not in started.setup.snapshot().trouble
    assert started.user.read_text() == before
    assert started.cell.settings.left.port == "loop://"
    started.setup.choose_port(Side.LEFT, "/dev/ttyUSB77", "csv")
    started.wait(lambda: started.cell.settings.left.port == "/dev/ttyUSB77")
    started.wait(lambda: started.setup.snapshot().trouble == "")


@pytest.mark.logs_errors
def test_a_wish_that_fails_costs_nothing_but_itself(
    started: Started, monkeypatch: pytest.MonkeyPatch
):
    def fail(*_: object) -> None:
        raise OSError("something new")

    with monkeypatch.context() as patched:
        patched.setattr("gestureapp.setup.sensors.Sensors.swap", fail)
        started.setup.swap_sensors()
        started.wait(lambda: "that failed (OSError)" in started.setup.snapshot().trouble)
    started.setup.swap_sensors()
    started.wait(lambda: started.setup.snapshot().trouble == "")
    assert started.cell.told[-1] == "left and right sensor are swapped"
