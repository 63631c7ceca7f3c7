"""A cell with everything around it: its emulators in a demo, its recorder, its folders."""

import contextlib
import os
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import platformdirs

from gestureapp import __version__
from gestureapp.cell.engine import Cell
from gestureapp.cell.last_time import LastTime, find_last_time
from gestureapp.cell.limits import checked_limits
from gestureapp.cell.snapshot import RecordingView
from gestureapp.clock import monotonic
from gestureapp.config import RobotSettings, Settings
from gestureapp.errors import ConfigError, RobotInUse
from gestureapp.guided.guided import Guided
from gestureapp.guided.trained import find_own_model
from gestureapp.guided.trainer import Trainer
from gestureapp.recording.people import last_person, model_path
from gestureapp.recording.session_writer import SessionWriter
from gestureapp.robot.lock import find_other
from gestureapp.setup.people_desk import PeopleSource
from gestureapp.setup.settings_desk import SettingsDesk
from gestureapp.setup.settings_use import SettingsUse
from gestureapp.setup.setup import Setup
from gestureapp.simulation.demo import DemoCell, DemoOptions, keep_fresh_records
from gestureapp.simulation.operator import OperatorClient

APP_NAME = "gestureapp"


@dataclass(frozen=True, slots=True)
class RunningCell:
    """What the window is given.

    Attributes:
        cell: Started.
        operator: The virtual operator of a demo, or None.
        recorder: Writes the session.
        demo: The emulators of a demo, or None.
        last_time: What the guardian did when no application could show it, or None.
        guided: Guided training, started; nobody's takes are open.
        trainer: Trains the model of whoever is chosen there; started.
        setup: Sensors, calibration, robot, settings and people; started.
    """

    cell: Cell
    operator: OperatorClient | None
    recorder: SessionWriter
    demo: DemoCell | None
    last_time: LastTime | None
    guided: Guided
    trainer: Trainer
    setup: Setup


def data_folder(chosen: Path | None = None) -> Path:
    """Where sessions, takes and models are kept: the folder chosen, or the user's data folder.

    Raises:
        ConfigError: it cannot be made or written to.
    """
    folder = chosen or Path(platformdirs.user_data_dir(APP_NAME, appauthor=False))
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = f"cannot be made: {error.strerror}; choose another with --data-dir"
        raise ConfigError("data folder", str(folder), reason) from error
    if not os.access(folder, os.W_OK):
        reason = "cannot be written to; choose another with --data-dir"
        raise ConfigError("data folder", str(folder), reason)
    return folder


def settings_files() -> list[Path]:
    """The site's settings file, then the user's; either may be missing."""
    site = Path(platformdirs.site_config_dir(APP_NAME, appauthor=False))
    user = Path(platformdirs.user_config_dir(APP_NAME, appauthor=False))
    return [site / "site.toml", user / "settings.toml"]


@contextlib.contextmanager
def running_cell(
    settings: Settings,
    folder: Path,
    demo: DemoOptions | None = None,
    files: Sequence[Path] = (),
    named: Path | None = None,
) -> Iterator[RunningCell]:
    """Start a cell; on leaving, the robot is stopped and everything is ended in order.

    Args:
        settings: Of the cell; in a demo the ports and the robot's address are the emulators'.
        folder: Where sessions, takes and models are kept.
        demo: Start emulators and use them instead of hardware.
        files: The settings files, the user's last; without any, changes hold for this run only.
        named: The settings file named at the start.

    Raises:
        GestureAppError: something could not be started.
    """
    with contextlib.ExitStack() as opened:
        emulators = None
        if demo is not None:
            emulators = opened.enter_context(DemoCell(demo))
            settings = emulators.settings(settings)
            keep_fresh_records(folder, settings, time.time())
        _refuse_second(settings.robot)
        recorder = SessionWriter(folder, monotonic, time.time, describe(settings))
        recorder.start()
        opened.callback(recorder.stop)
        log_file = folder / "guardian.log"
        last_time = find_last_time(log_file)
        cell = Cell(settings, recorder.put, lambda: _view_of(recorder), log_file, time.time)
        opened.callback(cell.shutdown)
        cell.start()
        if last_time is not None:
            cell.tell(last_time.event)
        operator = emulators.operator if emulators is not None else None
        if (own := find_own_model(folder, _first_person(settings, folder))) is not None:
            cell.use_model(*own)
        guided = Guided(cell, folder, on_ended=lambda text: cell.use_model(None, text))
        opened.callback(guided.shutdown)
        guided.start_thread()
        trainer = Trainer(guided, folder, cell.use_model)
        opened.callback(trainer.shutdown)
        trainer.start_thread()
        setup = _setup(
            cell,
            folder,
            files,
            named,
            PeopleSource(
                lambda person: _own_model(folder, person, guided, trainer),
                lambda: (guided.snapshot().person, guided.takes()),
            ),
        )
        opened.callback(setup.shutdown)
        setup.start_thread()
        yield RunningCell(cell, operator, recorder, emulators, last_time, guided, trainer, setup)


def _setup(
    cell: Cell, folder: Path, files: Sequence[Path], named: Path | None, source: PeopleSource
) -> Setup:
    settings = cell.settings
    use = SettingsUse(cell, settings)
    desk = SettingsDesk(files, named, settings, use, _check_as_a_whole, cell.tell)
    return Setup(cell, folder, desk, source)


def _check_as_a_whole(settings: Settings) -> None:
    """Raises ConfigError: the settings contradict each other."""
    checked_limits(settings)


def _own_model(
    folder: Path, person: str, guided: Guided, trainer: Trainer
) -> tuple[Path, str] | None:
    """The model that a person has trained here; of one who is open in the training it is known."""
    if person != guided.snapshot().person:
        return find_own_model(folder, person)
    path = model_path(folder, person)
    return (path, trainer.view().out_of_date) if path.exists() else None


def _first_person(settings: Settings, folder: Path) -> str:
    """Whose own model the cell begins with: the settings' person, else who was chosen last."""
    person = settings.person
    return person.name or (last_person(folder) if person.model is None else "")


def _refuse_second(robot: RobotSettings) -> None:
    other = find_other(robot.host, robot.port) if robot.host else None
    if other is not None:
        raise RobotInUse(f"{other.text}: {other.remedy}")


def _view_of(recorder: SessionWriter) -> RecordingView:
    path = recorder.path
    return RecordingView(recorder.is_recording, path.name if path else "", recorder.status)


def describe(settings: Settings) -> dict[str, str]:
    """The metadata of a session: version, mode, and every setting as it is used."""
    facts = {
        "app_version": __version__,
        "mode": "simulation" if settings.is_simulation else "live",
        "person": settings.person.name,
    }
    for table in ("left", "right", "site", "robot", "joints", "person", "training"):
        values = getattr(settings, table)
        facts |= {f"{table}.{f.name}": str(getattr(values, f.name)) for f in fields(values)}
    return facts
