"""Settings as the window changes them: checked as a whole, written, used, and nothing by halves."""

from dataclasses import replace
from pathlib import Path

import pytest

from gestureapp.config import DriveMode, RobotSettings, SensorSettings, Settings
from gestureapp.errors import ConfigError
from gestureapp.running import describe
from gestureapp.settings_check import named_values
from gestureapp.settings_file import load_settings, settings_text
from gestureapp.setup.lock import OPEN_FOR_S
from gestureapp.setup.settings_desk import LOCKED, SettingsDesk
from gestureapp.setup.site_values import SettingRow


class Cell:
    """What the desk tells a cell."""

    def __init__(self) -> None:
        self.used: list[Settings] = []
        self.told: list[str] = []


class ManualClock:
    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


class Bench:
    """A site's and a user's file, and a cell that was started with them."""

    def __init__(self, folder: Path) -> None:
        self.site, self.user = folder / "site" / "site.toml", folder / "user" / "settings.toml"
        self.site.parent.mkdir()
        self.user.parent.mkdir()
        self.named: Path | None = None
        self.cell, self.clock = Cell(), ManualClock()

    def opened(self) -> SettingsDesk:
        files = [self.site, self.user]
        settings, _ = load_settings(files, self.named)
        return SettingsDesk(
            files,
            self.named,
            settings,
            self.cell.used.append,
            tell=self.cell.told.append,
            clock=self.clock,
            wall_clock=lambda: 1.7e9,
        )


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(tmp_path)


def row(desk: SettingsDesk, name: str) -> SettingRow:
    return next(row for row in desk.settings() if row.name == name)


def test_every_setting_has_a_row_with_its_meaning_and_where_it_comes_from(bench: Bench):
    bench.site.write_text("schema = 1\n[robot]\nspeed_mm_s = 150\n")
    bench.user.write_text("schema = 1\n\n[robot]\n# slower\nspeed_mm_s = 90\n")
    desk = bench.opened()
    assert [row.name for row in desk.settings()] == [n for n, _, _ in named_values(Settings())]
    speed = row(desk, "robot.speed_mm_s")
    assert (speed.value, speed.unit, speed.allowed) == (90.0, "mm/s", "1 to 250; here at most 150")
    assert (speed.origin, speed.fixed, speed.is_locked) == ("settings.toml, line 5", "", False)
    assert speed.about.startswith("Speed of a translation")
    assert row(desk, "robot.margin_mm").origin == "built-in"
    assert row(desk, "site.drive_mode").choices == ("hold_to_run", "start_stop")


def test_a_change_is_written_used_and_told(bench: Bench):
    bench.user.write_text("schema = 1\n# mine\n[robot]\nspeed_mm_s = 90 # slow\n")
    desk = bench.opened()
    assert desk.change_settings({"robot.speed_mm_s": 80, "site.drive_mode": "start_stop"}) == {}
    (used,) = bench.cell.used
    assert (used.robot.speed_mm_s, used.site.drive_mode) == (80.0, DriveMode.START_STOP)
    text = bench.user.read_text()
    assert text.startswith("schema = 1\n# mine\n[robot]\nspeed_mm_s = 80 # slow\n")
    assert load_settings([bench.site, bench.user]) == (used, [])
    assert row(desk, "robot.speed_mm_s").value == 80.0
    assert bench.cell.told == [
        "settings: site.drive_mode 'hold_to_run' -> 'start_stop' by the window",
        "settings: robot.speed_mm_s 90.0 -> 80.0 by the window",
    ]


@pytest.mark.parametrize(
    ("changes", "wrong"),
    [
        ({"robot.speed_mm_s": 300}, "allowed is 1 to 250 mm/s"),
        ({"robot.speed_mm_s": float("nan")}, "allowed is a finite number"),
        ({"robot.speed_mm_s": "fast"}, "allowed is a number"),
        ({"robot.speed_mm_s": 121.0}, "is wider than the site allows; allowed is at most 120.0"),
        ({"robot.host": "robot.local"}, "give the controller's IP address"),
        ({"site.drive_mode": "fly"}, "allowed is"),
        ({"robot.rx_range_deg": (200.0, 130.0)}, "first number must be below the second"),
        ({"robot.int_radius_mm": 1190.0}, "leaves no room"),
        ({"robot.keep_outs": [{"name": "a"}]}, "missing"),
        ({"robot.keep_outs": ()}, "the boxes of the site's file stay"),
        ({"robot.spede": 3}, "there is no such setting"),
    ],
)
def test_what_is_wrong_is_told_by_name_and_changes_nothing(bench: Bench, changes, wrong):
    bench.site.write_text(
        "schema = 1\n[robot]\nspeed_mm_s = 120\n"
        'keep_outs = [{ name = "t", low_mm = [0, 0, 0], high_mm = [1, 1, 1] }]\n'
    )
    desk = bench.opened()
    before = desk.settings()
    (name,) = changes
    for told in (
        desk.check_settings(changes),
        desk.change_settings(changes | {"person.name": "A"}),
    ):
        assert list(told) == [name]
        assert wrong in told[name]
        assert "correct it" not in told[name]
    assert not bench.user.exists()
    assert desk.settings() == before
    assert (bench.cell.used, bench.cell.told) == ([], [])


def test_what_would_be_wrong_can_be_asked_without_changing_anything(bench: Bench):
    desk = bench.opened()
    assert desk.check_settings({"robot.speed_mm_s": 50.0}) == {}
    assert not bench.user.exists()
    assert bench.cell.used == []


def test_taking_a_value_out_lets_the_layers_below_hold(bench: Bench):
    bench.site.write_text("schema = 1\n[robot]\nspeed_mm_s = 150\n")
    bench.user.write_text("schema = 1\n[robot]\nspeed_mm_s = 90\n")
    desk = bench.opened()
    assert desk.change_settings({"robot.speed_mm_s": None}) == {}
    assert bench.cell.used[-1].robot.speed_mm_s == 150.0
    assert row(desk, "robot.speed_mm_s").origin == "site.toml, line 3"


def test_what_the_named_file_sets_cannot_be_changed_here(bench: Bench, tmp_path: Path):
    bench.named = tmp_path / "cell.toml"
    bench.named.write_text("schema = 1\n[robot]\nspeed_mm_s = 70\n")
    desk = bench.opened()
    speed = row(desk, "robot.speed_mm_s")
    assert speed.origin == "--config cell.toml, line 3"
    assert desk.change_settings({"robot.speed_mm_s": 60.0}) == {"robot.speed_mm_s": speed.fixed}
    assert desk.change_settings({"robot.speed_deg_s": 5.0}) == {}


def test_a_narrower_limit_that_the_named_file_then_exceeds_is_refused(bench: Bench, tmp_path: Path):
    bench.named = tmp_path / "cell.toml"
    bench.named.write_text("schema = 1\n[robot]\next_radius_mm = 1000\n")
    desk = bench.opened()
    told = desk.change_settings({"robot.int_radius_mm": 990.0})
    assert "leaves no room" in " ".join(told.values())
    assert not bench.user.exists()


def test_a_demo_changes_settings_for_this_run_only(bench: Bench):
    at = RobotSettings(host="127.0.0.1", port=4711)
    emulated = replace(Settings(), left=SensorSettings("socket://a"), robot=at, is_simulation=True)
    desk = SettingsDesk([], None, emulated, bench.cell.used.append)
    assert (row(desk, "left.port").origin, row(desk, "left.port").fixed) == (
        "given at the start",
        "",
    )
    assert "is not this machine" in desk.change_settings({"robot.host": "10.0.0.9"})["robot.host"]
    assert desk.change_settings({"robot.speed_mm_s": 50.0, "site.gui_limit_s": 0.3}) == {}
    assert bench.cell.used[-1].robot == replace(at, speed_mm_s=50.0)
    assert desk.change_settings({"left.port": "socket://b"}) == {}
    assert desk.change_settings({"left.port": "socket://a"}) == {}
    assert [used.left.port[-1] for used in bench.cell.used] == ["a", "b", "a"]
    assert row(desk, "robot.speed_mm_s").origin.startswith("this run only")
    assert "is wider" in desk.change_settings({"robot.speed_mm_s": 120.0})["robot.speed_mm_s"]
    assert desk.set_pin("1234") == ""
    desk.close_lock()
    assert desk.change_settings({"robot.speed_mm_s": 40.0}) == {"robot.speed_mm_s": LOCKED}


def test_a_demo_takes_what_its_files_would_have_said_anyway(bench: Bench):
    left, right = SensorSettings("socket://a", "adxl330"), SensorSettings("socket://b", "csv")
    emulated = replace(Settings(), left=left, right=right, is_simulation=True)
    desk = SettingsDesk([], None, emulated, bench.cell.used.append)
    assert desk.change_settings({"left.protocol": "csv"}) == {}
    assert bench.cell.used[-1].left == SensorSettings("socket://a", "csv")
    assert desk.change_settings({"left.protocol": "adxl330"}) == {}
    swap = {"left.port": "socket://b", "left.protocol": "csv"}
    assert (
        desk.change_settings(swap | {"right.port": "socket://a", "right.protocol": "adxl330"}) == {}
    )
    assert (bench.cell.used[-1].left, bench.cell.used[-1].right) == (right, left)


def test_what_was_given_at_the_start_beside_the_files_stays(bench: Bench):
    given = replace(Settings(), robot=RobotSettings(tool=3))
    desk = SettingsDesk([bench.site, bench.user], None, given, bench.cell.used.append)
    tool = row(desk, "robot.tool")
    assert (tool.value, tool.origin) == (3, "given at the start")
    assert desk.change_settings({"robot.tool": 4}) == {"robot.tool": tool.fixed}
    assert desk.change_settings({"robot.speed_mm_s": 50.0}) == {}
    assert bench.cell.used[-1].robot == RobotSettings(tool=3, speed_mm_s=50.0)


def test_a_cell_that_cannot_use_them_has_the_last_word(bench: Bench):
    def check(settings: Settings) -> None:
        raise ConfigError("robot", "as given", "the field has no room")

    desk = SettingsDesk([bench.site, bench.user], None, Settings(), bench.cell.used.append, check)
    told = desk.change_settings({"robot.speed_mm_s": 50.0})
    assert told == {"robot.speed_mm_s": "the field has no room"}
    assert not bench.user.exists()


def test_a_file_that_is_damaged_since_is_not_written(bench: Bench):
    desk = bench.opened()
    bench.user.write_text("schema = 1\n[robot\n")
    told = desk.change_settings({"robot.speed_mm_s": 50.0})["robot.speed_mm_s"]
    assert f"{bench.user}: line 2: not TOML" in told
    assert bench.user.read_text() == "schema = 1\n[robot\n"
    assert bench.cell.used == []


def test_what_another_program_wrote_meanwhile_is_not_used_unseen(bench: Bench):
    desk = bench.opened()
    bench.user.write_text("schema = 1\n[robot]\nspeed_mm_s = 20\n")
    told = desk.change_settings({"robot.margin_mm": 30.0})["robot.margin_mm"]
    assert "robot.speed_mm_s was changed by another program; start the application again" in told
    assert bench.user.read_text() == "schema = 1\n[robot]\nspeed_mm_s = 20\n"
    # A sensor's port is remembered there by the application itself.
    bench.user.write_text("schema = 1\n[left]\nport = 'COM3'\n")
    assert desk.change_settings({"robot.margin_mm": 30.0}) == {}
    assert (bench.cell.used[-1].left.port, bench.cell.used[-1].robot.margin_mm) == ("COM3", 30.0)


def test_a_folder_that_cannot_be_written_is_one_line_and_nothing_is_used(bench: Bench):
    bench.user.parent.rmdir()
    bench.user.parent.write_text("a file where the folder should be")
    desk = SettingsDesk([bench.site, bench.user], None, Settings(), bench.cell.used.append)
    told = desk.change_settings({"robot.speed_mm_s": 50.0})["robot.speed_mm_s"]
    assert "cannot be written" in told or "cannot be read" in told
    assert "\n" not in told
    assert bench.cell.used == []


# The PIN.


def test_with_a_pin_what_bears_on_motion_waits_for_it(bench: Bench):
    desk = bench.opened()
    assert "No PIN is set" in desk.lock.text
    assert desk.set_pin("123") == "A PIN has 4 to 12 digits and nothing else."
    assert desk.set_pin("1234") == ""
    assert desk.lock.is_open
    desk.close_lock()
    assert row(desk, "robot.speed_mm_s").is_locked
    assert not row(desk, "left.port").is_locked
    assert desk.change_settings({"robot.speed_mm_s": 50.0}) == {"robot.speed_mm_s": LOCKED}
    assert desk.change_settings({"person.name": "Ana"}) == {}
    assert desk.set_pin("") == "Give the PIN that is set first."
    desk.open_lock("1234")
    assert desk.change_settings({"robot.speed_mm_s": 50.0}) == {}
    bench.clock.now_s += OPEN_FOR_S
    assert desk.change_settings({"robot.speed_mm_s": 40.0}) == {"robot.speed_mm_s": LOCKED}


def test_the_pin_is_the_sites_and_outlives_the_application(bench: Bench):
    assert bench.opened().set_pin("271828") == ""
    assert "pin_hash" in bench.site.read_text()
    assert "271828" not in bench.site.read_text()
    desk = bench.opened()
    assert not desk.lock.is_open
    desk.open_lock("271828")
    assert desk.set_pin("") == ""
    assert not bench.opened().lock.has_pin


def test_where_the_site_cannot_be_written_the_users_file_has_the_pin(bench: Bench):
    bench.site.parent.rmdir()
    bench.site.parent.write_text("no folder")
    files = [bench.site, bench.user]
    desk = SettingsDesk(files, None, Settings(), bench.cell.used.append)
    assert desk.set_pin("1234") == ""
    assert "pin_hash" in bench.user.read_text()


def test_a_pin_that_cannot_be_kept_is_told_and_not_set(bench: Bench):
    for folder in (bench.site.parent, bench.user.parent):
        folder.rmdir()
        folder.write_text("no folder")
    desk = SettingsDesk([bench.site, bench.user], None, Settings(), bench.cell.used.append)
    assert "cannot be" in desk.set_pin("1234")
    assert not desk.lock.has_pin
    assert desk.lock.text.startswith(str(bench.user))


def test_the_hash_is_shown_and_recorded_nowhere(bench: Bench):
    desk = bench.opened()
    desk.set_pin("1234")
    kept = bench.site.read_text().split('"')[1]
    settings, findings = load_settings([bench.site, bench.user])
    everything = [describe(settings), desk.settings(), desk.lock, bench.cell.told, findings]
    everything += [settings_text(settings), desk.findings, vars(desk)["_layers"]]
    assert kept.startswith("scrypt$")
    assert kept.partition("$")[2] not in repr(everything)
    assert "PIN" in bench.cell.told[-1]


def test_a_damaged_pin_opens_to_nobody_and_says_what_to_do(bench: Bench):
    bench.site.write_text("schema = 1\n[lock]\npin_hash = 'scrypt$12$34'\n")
    desk = bench.opened()
    desk.open_lock("1234")
    assert (desk.lock.has_pin, desk.lock.is_open) == (True, False)
    assert "site.toml, line 3 cannot be read: take [lock] out" in desk.lock.text


@pytest.mark.parametrize("name", ["left.port", "left.name", "person.name", "person.model"])
def test_half_a_character_is_refused_before_anything_is_written(bench: Bench, name: str):
    wrong = bench.opened().change_settings({name: "a\ud800"})
    assert list(wrong) == [name]
    assert "\n" not in wrong[name]
    assert not bench.user.exists()


def test_whose_arms_these_are_is_said_to_be_used_at_the_next_start(bench: Bench):
    desk = bench.opened()
    assert row(desk, "person.name").about.endswith("A change is used from the next start on.")
    assert desk.change_settings({"person.name": "Ana", "training.n_takes": 11}) == {}
    assert row(desk, "person.name").origin.endswith(", used from the next start on")
    assert "next start" not in row(desk, "training.n_takes").origin
    assert bench.cell.told[0].endswith("'Ana' by the window, used from the next start on")
    assert "next start" not in row(bench.opened(), "person.name").origin
