"""Both sensors on pseudo terminals, real readers, a clock in the hand, and setting up before them.

What the cell's control thread would do with judgements is noted; nothing of it is needed here.
"""

import contextlib
import os
import queue
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from gestureapp.cell.snapshot import CellState, RecordingView, RobotView, Snapshot
from gestureapp.config import SensorSettings, Settings
from gestureapp.sensing.bluetooth import BluetoothDevice
from gestureapp.sensing.calibration import Calibration
from gestureapp.sensing.port_list import PortList
from gestureapp.sensing.posture import LeftPostures
from gestureapp.sensing.reader import SensorReader
from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.stream import StreamTracker
from gestureapp.sensing.values import ArmPosture, Connected, LinkState, Sample, SensorEvent, Side
from gestureapp.setup.desk import Desk
from gestureapp.setup.people_desk import PeopleSource
from gestureapp.setup.port_watch import PortWatch
from gestureapp.setup.settings_use import SettingsUse
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.setup.values import SensorCard
from gestureapp.simulation.sensor_wire import Accel, encode_csv

WALL_S = 1_800_000_000.0
LIMIT_S = 10.0
"""Nothing here takes that long; a test that waits for it has failed."""
LEVEL: Accel = (0.0, 0.0, 1.0)


class PtyPort:
    """A serial port with a name that stays, as a receiver's has; unplugged by closing its master.

    Attributes:
        url: What stands in the settings.
    """

    def __init__(self, folder: Path, name: str) -> None:
        self._link = folder / name
        self.url = str(self._link)
        self._fds: tuple[int, ...] = ()
        self.plug()

    def plug(self) -> None:
        """Plug the receiver in."""
        master, slave = os.openpty()
        self._link.symlink_to(os.ttyname(slave))
        self._fds = (master, slave)

    def unplug(self) -> None:
        """Pull it out. Idempotent."""
        for fd in self._fds:
            os.close(fd)
        self._fds = ()
        self._link.unlink(missing_ok=True)

    @property
    def is_plugged(self) -> bool:
        return bool(self._fds)

    def write(self, data: bytes) -> None:
        os.write(self._fds[0], data)


class ReadCell:
    """A cell that reads its sensors and notes what it is told; stands in for the control thread."""

    def __init__(self, settings: Settings, clock: Callable[[], float]) -> None:
        self.settings = settings
        self._clock = clock
        self.left, self.right = SampleStore(), SampleStore()
        self.state = CellState.NOT_READY
        self.person = settings.person.name
        self.judged: dict[Side, tuple[str, str]] = {}
        self.calibrations: dict[Side, Calibration] = {}
        self.postures: list[tuple[LeftPostures, str, str]] = []
        self.models: list[tuple[Path | None, str, str]] = []
        self.held: list[str] = []
        self.told: list[str] = []
        self.used: list[Settings] = []
        self.is_busy = False
        self._waiting: dict[Side, SensorSettings] = {}
        self.n_opened = dict.fromkeys(Side, 0)
        self._inbox: queue.SimpleQueue[tuple[Side, Sample | SensorEvent]] = queue.SimpleQueue()
        site = settings.site
        self._trackers = {
            side: StreamTracker(side, site.trip_level_s, site.rate_min_hz, site.rate_max_hz)
            for side in Side
        }
        self._readers = {
            Side.LEFT: self._reader(Side.LEFT, settings.left, self.left),
            Side.RIGHT: self._reader(Side.RIGHT, settings.right, self.right),
        }
        for reader in self._readers.values():
            reader.start()

    def close(self) -> None:
        for reader in self._readers.values():
            assert reader.stop()

    def snapshot(self) -> Snapshot:
        now_s = self._clock()
        while not self._inbox.empty():
            side, item = self._inbox.get()
            if isinstance(item, Sample):
                self._trackers[side].sample(item)
            else:
                self.n_opened[side] += isinstance(item, Connected)
                self._trackers[side].event(now_s, item)
        left, right = (self._trackers[side].health(now_s) for side in (Side.LEFT, Side.RIGHT))
        return Snapshot(
            t_s=now_s,
            state=self.state,
            sentence="",
            blockers=(),
            can_arm=False,
            is_stop_unconfirmed=False,
            left=left,
            right=right,
            posture=ArmPosture.STOP,
            trip_level_s=self.settings.site.trip_level_s,
            recognition=None,
            direction=None,
            robot=RobotView(False, "no robot"),
            events=(),
            is_simulation=False,
            recording=RecordingView(),
            person=self.person,
            model="",
        )

    def use_sensor(self, side: Side, settings: SensorSettings) -> None:
        if self.is_busy:
            self._waiting[side] = settings
            return
        self._readers[side].use(settings)
        if side is Side.LEFT:
            self.settings = replace(self.settings, left=settings)
        else:
            self.settings = replace(self.settings, right=settings)

    def take(self) -> None:
        """Nothing may move any more: take what has waited for that."""
        self.is_busy = False
        for side, settings in self._waiting.items():
            self.use_sensor(side, settings)

    def use_calibration(self, side: Side, calibration: Calibration) -> None:
        self.calibrations[side] = calibration
        self._readers[side].set_calibration(calibration)

    def judge_sensor(self, side: Side, problem: str, remedy: str = "") -> None:
        self.judged[side] = (problem, remedy)

    def use_postures(self, postures: LeftPostures, problem: str = "", remedy: str = "") -> None:
        self.postures.append((postures, problem, remedy))

    def use_settings(self, settings: Settings) -> None:
        self.used.append(settings)
        self.settings = replace(self.settings, site=settings.site, robot=settings.robot)

    def use_model(self, path: Path | None, problem: str = "", person: str = "") -> None:
        self.models.append((path, problem, person))
        self.person = person

    def hold_arming(self, why: str) -> None:
        self.held.append(why)

    def tell(self, text: str) -> None:
        self.told.append(text)

    def _reader(self, side: Side, settings: SensorSettings, store: SampleStore) -> SensorReader:
        def on_sample(sample: Sample) -> None:
            self._inbox.put((side, sample))
            store.append(sample)

        return SensorReader(
            side, settings, on_sample, lambda event: self._inbox.put((side, event)), self._clock
        )


@dataclass
class Worn:
    """What one sensor sends at every tick.

    Attributes:
        port: Where.
        accel_g: What it measures; by default it lies level and trembles.
        encode: Running number and acceleration to bytes.
        is_on: It sends at all.
    """

    port: PtyPort
    accel_g: Callable[[float], Accel] = lambda t_s: (0.001 * (round(t_s * 100) % 3), 0.0, 1.0)
    encode: Callable[[int | None, Accel], bytes] = encode_csv
    is_on: bool = True
    n_sent: int = field(default=0)


class SetupBench:
    """Setting up's desk with two sensors before it. Time passes only in ``run``."""

    def __init__(self, folder: Path, settings: Settings | None = None) -> None:
        self.folder = folder
        self.now_s = 1000.0
        self.wall_s = WALL_S
        self.sensors = {side: Worn(PtyPort(folder, f"tty_{side.value}")) for side in Side}
        base = Settings() if settings is None else settings
        self.cell = ReadCell(
            replace(
                base,
                left=SensorSettings(self.sensors[Side.LEFT].port.url),
                right=SensorSettings(self.sensors[Side.RIGHT].port.url),
            ),
            lambda: self.now_s,
        )
        self.remembered: list[dict[str, object]] = []
        self._use = SettingsUse(self.cell, self.cell.settings)  # type: ignore[arg-type]
        ports = PortList(lambda: (), lambda address: BluetoothDevice(), lambda device: "")
        self.desk = Desk(
            self.cell,  # type: ignore[arg-type]
            folder / "data",
            self._remember,
            PeopleSource(),
            lambda: self.now_s,
            lambda: self.wall_s,
            PortWatch(ports),
        )

    def close(self) -> None:
        self.desk.close()
        self.cell.close()
        for sensor in self.sensors.values():
            sensor.port.unplug()

    @property
    def picture(self) -> SetupSnapshot:
        return self.desk.picture

    def card(self, side: Side = Side.LEFT) -> SensorCard:
        return self.picture.left if side is Side.LEFT else self.picture.right

    def judged(self, side: Side = Side.LEFT) -> str:
        return self.cell.judged[side][0]

    def connect(self) -> None:
        """Let both sensors send until they are heard; from then on every sample is waited for."""
        until_s = time.monotonic() + LIMIT_S
        while any(self.card(side).health.link is not LinkState.RECEIVING for side in Side):
            assert time.monotonic() < until_s, f"they are not heard: {self.picture}"
            self.run(0.02)
            time.sleep(0.005)

    @contextlib.contextmanager
    def reopening(self, *sides: Side) -> Iterator[None]:
        """What is done here has these sensors' ports opened anew; it is waited for."""
        before = dict(self.cell.n_opened)
        yield
        self.wait(lambda: all(self.cell.n_opened[side] > before[side] for side in sides))

    def run(self, span_s: float) -> None:
        """Let both sensors send at 100 Hz for so long, and setting up tick at 50 Hz."""
        for tick in range(round(span_s * 100)):
            self.now_s += 0.01
            self.wall_s += 0.01
            expected = {side: self._send(side) for side in Side}
            self._await(expected)
            if tick % 2:
                self.desk.step()
        self.desk.step()

    def run_until(self, condition: Callable[[], bool], limit_s: float = 60.0) -> None:
        for _ in range(round(limit_s * 10)):
            if condition():
                return
            self.run(0.1)
        raise AssertionError(f"it did not become so in {limit_s} s: {self.picture}")

    def wait(self, condition: Callable[[], bool]) -> None:
        """Wait in real time, for threads and ports, with the clock standing; step meanwhile."""
        until_s = time.monotonic() + LIMIT_S
        while not condition():
            assert time.monotonic() < until_s, f"it did not become so: {self.picture}"
            self.desk.step()
            time.sleep(0.005)

    def _send(self, side: Side) -> int:
        sensor, store = self.sensors[side], self._store(side)
        before = store.count
        if not sensor.is_on or not sensor.port.is_plugged:
            return before
        sensor.port.write(sensor.encode(sensor.n_sent % 65536, sensor.accel_g(self.now_s)))
        sensor.n_sent += 1
        is_read = self.card(side).health.link is LinkState.RECEIVING
        return before + is_read

    def _await(self, expected: dict[Side, int]) -> None:
        """A sample that is read late would get a later time: wait for it, but not for ever."""
        until_s = time.monotonic() + 1.0
        for side, count in expected.items():
            while self._store(side).count < count and time.monotonic() < until_s:
                time.sleep(0.0002)

    def _store(self, side: Side) -> SampleStore:
        sensor_port = self.sensors[side].port.url
        settings = self.cell.settings
        return self.cell.left if settings.left.port == sensor_port else self.cell.right

    def _remember(self, changes: dict[str, object]) -> dict[str, str]:
        """As the settings' desk does, without a file."""
        self.remembered.append(dict(changes))
        settings = self.cell.settings
        for side in Side:
            values = {
                name: changes.get(
                    f"{side.value}.{name}", getattr(getattr(settings, side.value), name)
                )
                for name in ("port", "protocol", "name")
            }
            settings = replace(settings, **{side.value: SensorSettings(**values)})  # type: ignore[arg-type]
        self._use(settings)
        return {}
