"""A settings file is changed as a careful person would: nothing is lost or halved."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.config import DriveMode, KeepOutSettings
from gestureapp.errors import ConfigError
from gestureapp.settings_edit import BACKUP_FOLDER, N_BACKUPS, edited, replace_settings
from gestureapp.settings_file import read_settings
from gestureapp.settings_source import MAX_BYTES, bytes_if_there

WHEN_S = 1.75e9


def write(file, changes, wall_clock=lambda: WHEN_S):
    """Change some values in a settings file, as the application does."""
    old = bytes_if_there(file)
    replace_settings(file, old, edited(file, old, changes), wall_clock)


MINE = """\
# how we work here
schema = 1

[robot]   # the big one
# why so slow
speed_mm_s = 50 # agreed
host = "10.0.0.1"

[person]
name = 'Ana'
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "settings.toml"
    path.write_text(MINE)
    return path


def backups(file: Path) -> list[str]:
    return sorted(path.name for path in (file.parent / BACKUP_FOLDER).iterdir())


def test_only_the_value_changes_and_every_comment_stays(file: Path):
    write(file, {"robot.speed_mm_s": 80.0})
    assert file.read_text() == MINE.replace("= 50 #", "= 80.0 #")


def test_a_new_key_and_a_new_table_come_with_their_meaning(file: Path):
    write(file, {"robot.tool": 3, "left.port": "COM3"})
    text = file.read_text()
    assert "# Tool number, 0 to 23; the controller must tell its position" in text
    assert text.index("tool = 3") < text.index("[person]")
    assert "\n# One sensor: where it is" in text
    assert text.replace("\n", " ").index("[left]") > text.index("[person]")
    loaded, found = read_settings([file])
    assert found == []
    assert (loaded.robot.tool, loaded.left.port, loaded.robot.speed_mm_s) == (3, "COM3", 50.0)


def test_a_missing_file_is_made_with_its_folder(tmp_path: Path):
    file = tmp_path / "not" / "yet" / "settings.toml"
    write(file, {"site.drive_mode": DriveMode.START_STOP, "person.model": Path("ana.json")})
    loaded, found = read_settings([file])
    assert found == []
    assert loaded.site.drive_mode is DriveMode.START_STOP
    assert loaded.person.model == file.parent / "ana.json"
    assert not (file.parent / BACKUP_FOLDER).exists()


def test_none_takes_a_key_out_and_nothing_else(file: Path):
    write(file, {"robot.host": None, "left.port": None, "robot.port": None})
    assert file.read_text() == MINE.replace('host = "10.0.0.1"\n', "")


def test_boxes_are_written_whichever_way_they_stood(file: Path):
    box = '\n[[robot.keep_outs]]\nname = "a"\nlow_mm = [0, 0, 0]\nhigh_mm = [1, 1, 1]\n'
    boxes = (KeepOutSettings("b", (0.0, 0.0, 0.0), (2.0, 2.0, 2.0)),)
    for there in ("", box):
        file.write_text(MINE + there)
        write(file, {"robot.keep_outs": boxes, "robot.tool": 2})
        loaded, found = read_settings([file])
        assert found == []
        assert (loaded.robot.keep_outs, loaded.robot.tool) == (boxes, 2)


@pytest.mark.parametrize(
    "text",
    [
        "schema = 1\nrobot.speed_mm_s = 50\nperson = { name = 'Ana' }\n",
        "schema = 1\r\n[robot]\r\nspeed_mm_s = 50\r\n",
        "\ufeffschema = 1\n[robot]\nspeed_mm_s = 50",
        "schema = 1\n[robot]\nspeed_mm_s = 50\n[joints]\n[person]\nname = 'x'",
        "",
    ],
)
def test_any_layout_is_kept_and_reads_back(tmp_path: Path, text: str):
    file = tmp_path / "settings.toml"
    file.write_bytes(text.encode())
    write(
        file,
        {"robot.speed_mm_s": 80.0, "robot.tool": 4, "person.name": "Bo", "site.gui_limit_s": 0.3},
    )
    after = file.read_bytes()
    assert after.startswith(b"\xef\xbb\xbf") is text.startswith("\ufeff")
    assert (after.count(b"\n") == after.count(b"\r\n")) is ("\r\n" in text)
    loaded, found = read_settings([file])
    assert [finding.setting for finding in found] == ([] if text else ["schema"])
    assert (loaded.robot.speed_mm_s, loaded.robot.tool) == (80.0, 4)
    assert (loaded.person.name, loaded.site.gui_limit_s) == ("Bo", 0.3)


_NAMES = st.sampled_from(
    ["robot.speed_mm_s", "robot.tool", "left.port", "person.name", "right.port"]
)
_VALUES = st.integers(0, 9) | st.floats(0, 9) | st.text(max_size=9) | st.booleans() | st.none()


@settings(max_examples=60, deadline=None)
@given(st.lists(st.dictionaries(_NAMES, _VALUES, max_size=3), max_size=4))
def test_whatever_is_written_one_after_the_other_is_what_stands_there(changes):
    content: bytes | None = None
    wanted: dict[str, object] = {}
    for step in changes:
        content = edited(Path("any.toml"), content, step)
        wanted |= step
    tables = tomllib.loads((content or b"").decode())
    for name, value in wanted.items():
        table, _, key = name.partition(".")
        assert tables.get(table, {}).get(key) == value


_LINES = st.sampled_from(
    [
        *(
            "[robot]",
            "[left]",
            "[person]",
            "[[robot.keep_outs]]",
            "[ robot ]",
            "[robot.x]",
            "[[left]]",
        ),
        *("tool = 3", "  speed_mm_s = 50 # why", "name = 'a'", 'port = "x"', "# a comment", ""),
        *("robot.tool = 1", "person = { name = 'Ana' }", '"robot".host = "x"', "a.b = 3"),
        *(
            "keep_outs = [{ name='a' },\n  # in\n { name='b' }]",
            'name = """a\nb"""',
            "keep_outs = []",
        ),
    ]
)


def _is_toml(text: str) -> bool:
    try:
        tomllib.loads(text)
    except ValueError:
        return False
    return True


@settings(max_examples=200, deadline=None)
@given(
    text=st.lists(_LINES, max_size=8).map("\n".join).filter(_is_toml),
    changes=st.dictionaries(_NAMES, _VALUES, min_size=1, max_size=3),
)
def test_whatever_the_layout_only_what_was_asked_for_changes(text, changes):
    wanted = tomllib.loads(text)
    try:
        after = tomllib.loads(edited(Path("any.toml"), text.encode(), changes).decode())
    except ConfigError as error:
        refused = str(error)
    else:
        refused = ""
    if refused:
        assert "laid out in a way that this cannot be put into; use an editor" in refused
        return
    for name, value in changes.items():
        table, _, key = name.partition(".")
        wanted.setdefault(table, {}).pop(key, None)
        wanted[table] |= {} if value is None else {key: value}
    assert {k: v for k, v in after.items() if v} == {k: v for k, v in wanted.items() if v}


@pytest.mark.parametrize(
    "text", ["[robot\n", "schema = 1\n[robot]\nx = 1\nx = 2\n", "\0", "robot = 3"]
)
def test_a_damaged_file_is_not_touched_and_says_why(tmp_path: Path, text: str):
    file = tmp_path / "settings.toml"
    file.write_text(text)
    with pytest.raises(ConfigError) as caught:
        write(file, {"robot.tool": 1})
    assert len(str(caught.value).splitlines()) == 1
    assert file.read_text() == text
    assert [path.name for path in tmp_path.iterdir()] == ["settings.toml"]


def test_a_file_that_somebody_changed_since_it_was_read_is_left_to_them(file: Path):
    old = file.read_bytes()
    new = edited(file, old, {"robot.tool": 1})
    file.write_text(MINE + "# by hand\n")
    with pytest.raises(ConfigError, match="changed by another program meanwhile"):
        replace_settings(file, old, new)
    assert file.read_text() == MINE + "# by hand\n"
    file.unlink()
    with pytest.raises(ConfigError, match="meanwhile"):
        replace_settings(file, old, new)


def test_ten_backups_are_kept_the_newest_ones(file: Path):
    (file.parent / BACKUP_FOLDER).mkdir()
    mine = file.parent / BACKUP_FOLDER / "settings-1 before the fair Z.toml"
    mine.write_text(MINE)
    for i in range(N_BACKUPS + 3):
        write(file, {"robot.tool": i}, wall_clock=lambda i=i: 1.75e9 + i)
    names = [name for name in backups(file) if name != mine.name]
    assert mine.exists(), "what a person has put there stays"
    assert len(names) == N_BACKUPS
    assert names[-1] == "settings-20250615T150652.000000Z.toml"
    newest = (file.parent / BACKUP_FOLDER / names[-1]).read_text()
    assert newest == file.read_text().replace("tool = 12", "tool = 11")


def test_nothing_is_written_when_nothing_changes(file: Path):
    before = file.stat().st_mtime_ns
    write(file, {"robot.host": "10.0.0.1"})
    assert file.stat().st_mtime_ns == before
    assert not (file.parent / BACKUP_FOLDER).exists()


@pytest.mark.skipif(os.name != "posix", reason="permissions and links as on POSIX systems")
def test_permissions_stay_and_a_link_stays_a_link(file: Path, tmp_path: Path):
    file.chmod(0o600)
    link = tmp_path / "link.toml"
    link.symlink_to(file)
    write(link, {"robot.tool": 1})
    assert link.is_symlink()
    assert "tool = 1" in file.read_text()
    assert file.stat().st_mode & 0o777 == 0o600
    (kept,) = (tmp_path / BACKUP_FOLDER).iterdir()
    assert kept.stat().st_mode & 0o777 == 0o600


def test_a_folder_that_takes_no_backup_takes_no_change(file: Path):
    (file.parent / BACKUP_FOLDER).write_text("not a folder")
    with pytest.raises(ConfigError) as caught:
        write(file, {"robot.tool": 1})
    assert "cannot be written" in str(caught.value)
    assert file.read_text() == MINE


@pytest.mark.skipif(sys.platform != "linux", reason="/dev/full is a full disk on Linux")
def test_a_full_disk_is_told_and_the_old_file_stays(file: Path):
    script = f"""
import resource, signal, sys
from pathlib import Path
from gestureapp.errors import ConfigError
from tests.test_settings_edit import write
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (20, 20))
try:
    write(Path({str(file)!r}), {{"robot.tool": 1}})
except ConfigError as error:
    sys.exit(str(error))
"""
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert ended.returncode == 1
    assert len(ended.stderr.splitlines()) == 1
    assert "cannot be written: File too large" in ended.stderr
    assert file.read_text() == MINE
    assert not list(file.parent.glob(".*"))


KILLED = 9
_STEP_BY_STEP = """
import os, sys
from pathlib import Path
from tests.test_settings_edit import write

file, old = Path(sys.argv[1]), Path(sys.argv[1]).read_bytes()
n = 0
while True:
    n += 1
    child = os.fork()
    if child == 0:
        left = [n]
        def count(event, arguments):
            if event in ("open", "os.rename", "os.chmod", "os.remove", "os.mkdir"):
                left[0] -= 1
                if not left[0]:
                    os._exit(9)
        sys.addaudithook(count)
        write(file, {"robot.tool": 1})
        os._exit(0)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    is_old = file.read_bytes() == old
    print(n, code, "old" if is_old else "new", flush=True)
    if not is_old:
        file.read_text().index("tool = 1")
        file.write_bytes(old)
    if code == 0:
        break
"""


@pytest.mark.process
@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_killed_before_any_step_the_file_is_the_old_one_or_the_new_one(file: Path):
    """The interpreter tells of every step at the file system before it is made."""
    command = [sys.executable, "-c", _STEP_BY_STEP, str(file)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert ended.returncode == 0, ended.stderr
    steps = [line.split()[1:] for line in ended.stdout.splitlines()]
    assert len(steps) > 6
    assert steps[-1] == ["0", "new"]
    assert {tuple(step) for step in steps[:-1]} == {(str(KILLED), "old")}


def test_a_file_never_becomes_longer_than_its_reader_takes(file: Path):
    note = "# a note kept by hand\n"
    file.write_text(MINE + note * ((MAX_BYTES - len(MINE) - 10) // len(note)))
    before = file.read_bytes()
    with pytest.raises(ConfigError, match="would become larger than 100000 bytes; take comments"):
        write(file, {"robot.host": "10.0.0.1" * 40})
    assert file.read_bytes() == before
    assert not (file.parent / BACKUP_FOLDER).exists()
    write(file, {"robot.host": None})
    assert read_settings([file])[0].robot.host == ""
