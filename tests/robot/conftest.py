"""A supervisor in manual time, against a small scripted controller that speaks bytes."""

from dataclasses import dataclass, field

import pytest

from gestureapp.robot import messages as m
from gestureapp.robot.gate import Limits
from gestureapp.robot.outputs import DropRobot, ToApp, ToRobot
from gestureapp.robot.supervisor import Supervisor
from gestureapp.robot.values import Direction, Pose
from gestureapp.robot.workspace import FieldOfOperation
from gestureapp.simulation.controller import Controller
from gestureapp.simulation.nx100_commands import execute
from gestureapp.simulation.nx100_conversation import Conversation
from gestureapp.simulation.nx100_lines import Request
from gestureapp.simulation.nx100_options import Fault, Nx100Options
from gestureapp.simulation.nx100_values import ControllerOptions, Hold

FIELD = FieldOfOperation(1200.0, 500.0, 20.0, ((120.0, 240.0), (-60.0, 60.0), (-90.0, 90.0)), 2.0)
LIMITS = Limits(FIELD, 100.0, 10.0, 1, 0, True, 0.125, 0.25, 0.5)
BANNER = b"OK: NX Information Server( 1.07) Keep-Alive:-1.\r\n"
TICK_S = 0.005
START_S = 100.0
START = Pose(800.0, 0.0, 300.0, 180.0, 0.0, 0.0)
FORWARD = Direction(0, 1, is_rotation=False)


@dataclass
class ScriptedRobot:
    """Just enough of a controller: one session, straight moves of constant speed, many faults.

    Attributes:
        refuses: Command, or command with data, to the code it is answered with.
        is_mute: Hears and obeys, never answers.
        is_deaf: Neither hears nor answers.
        answer_s: From a line to its answer.
        slows_s: HOLD brings it to a stand only this much later.
        ignores: Commands that are answered and not obeyed.
        resumes: HOLD 0 goes on with the rest of the move.
        start_s: From accepting a move to the running bit.
        stops_after_mm: The move ends there by itself.
    """

    pose: Pose = START
    data_1: int = 0xC2
    data_2: int = 0x40
    refuses: dict[str, int] = field(default_factory=dict)
    ignores: set[str] = field(default_factory=set)
    raw: dict[str, bytes] = field(default_factory=dict)
    is_mute: bool = False
    is_deaf: bool = False
    answer_s: float = 0.0
    slows_s: float = 0.0
    resumes: bool = False
    start_s: float = 0.0
    stops_after_mm: float = float("inf")
    requests: list[tuple[float, str]] = field(default_factory=list)
    out: list[tuple[float, bytes]] = field(default_factory=list)
    header: str | None = None
    unread: bytes = b""
    move: tuple[list[float], float, float] | None = None  # unit, speed, mm left
    since_s: float = 0.0
    rest: tuple[list[float], float, float] | None = None
    stop_at_s: float = float("inf")

    @property
    def is_running(self):
        return self.move is not None

    @property
    def is_held(self):
        return bool(self.data_2 & 0x08)

    def advance(self, now_s):
        """Carry the move on to this moment."""
        if self.move is None:
            return
        unit, speed, left = self.move
        until_s = min(now_s, self.stop_at_s)
        gone = max(0.0, min(left, (until_s - self.since_s) * speed))
        parts = (*self.pose.position_mm, *self.pose.rotation_deg)
        self.pose = Pose(*(p + u * gone for p, u in zip(parts, unit, strict=True)))
        self.move = (unit, speed, left - gone)
        self.since_s = max(self.since_s, until_s)
        if left - gone <= 1e-9:
            self.move = None
        elif now_s >= self.stop_at_s:
            self.move, self.rest = None, self.move

    def status(self, now_s):
        running = 0x08 if self.move is not None and now_s >= self.since_s else 0
        return f"{self.data_1 | running},{self.data_2}"

    def connected(self):
        self.out, self.unread, self.header = [], b"", None

    def receive(self, data, now_s):
        if self.is_deaf:
            return
        *lines, self.unread = (self.unread + data.replace(b"\n", b"")).split(b"\r")
        for line in lines:
            for answer in self._line(line.decode("ascii"), now_s):
                if not self.is_mute:
                    self.out.append((now_s + self.answer_s, answer))

    def due(self, now_s):
        ready = b"".join(data for t_s, data in self.out if t_s <= now_s)
        self.out = [item for item in self.out if item[0] > now_s]
        return ready

    def _line(self, line, now_s):
        if line.startswith("CONNECT"):
            return [BANNER]
        if self.header is None:
            _, name, size = line.split(" ")
            if name in self.raw:
                return [self.raw[name]]
            if size != "0":
                self.header = name
                return [f"OK: {name}\r\n".encode()]
            return [f"OK: {name}\r\n".encode(), self._answer(name, "", now_s)]
        name, self.header = self.header, None
        return [self._answer(name, line, now_s)]

    def _answer(self, name, data, now_s):
        self.advance(now_s)
        asked = f"{name} {data}".strip()
        self.requests.append((now_s, asked))
        code = self.refuses.get(asked, self.refuses.get(name))
        if code is not None:
            return f"ERROR: {name} is not successful({code}).\r\n".encode()
        if name == "RSTATS":
            return f"{self.status(now_s)}\r".encode()
        if name == "RALARM":
            return b"0,0,4416,3,0,0,0,0,0,0\r"
        if name == "RPOSC":
            parts = [f"{v:.3f}" for v in self.pose.position_mm]
            parts += [f"{(v + 180) % 360 - 180:.2f}" for v in self.pose.rotation_deg]
            return (",".join(parts) + ",1,0\r").encode()
        if asked not in self.ignores and name not in self.ignores:
            self._obey(asked, data, now_s)
        return b"0000\r\n"

    def _obey(self, asked, data, now_s):
        if asked == "HOLD 1":
            self.data_2 |= 0x08
            self.stop_at_s = min(self.stop_at_s, now_s + self.slows_s)
            self.advance(now_s)
        elif asked == "HOLD 0":
            self.data_2 &= ~0x08
            self.stop_at_s = float("inf")
            if self.resumes and self.rest is not None:
                self.move, self.rest, self.since_s = self.rest, None, now_s + self.start_s
        elif asked == "SVON 0":
            self.data_2 &= ~0x40
            self.move = self.rest = None
        elif asked == "SVON 1":
            self.data_2 |= 0x40
        elif asked.startswith("IMOV"):
            self._move(data, now_s)

    def _move(self, data, now_s):
        fields = [float(text) for text in data.split(",")]
        steps, speed = fields[3:9], fields[1]
        length = max(abs(step) for step in steps)
        unit = [step / length for step in steps]
        self.move = (unit, speed, min(length, self.stops_after_mm))
        self.since_s, self.stop_at_s = now_s + self.start_s, float("inf")


class EmulatedRobot:
    """The emulated controller and its conversation, in the cell's manual time; no sockets.

    Attributes:
        controller: The model.
        events: Starts and ends of motion, in order.
    """

    def __init__(self, **cell):
        self.options = Nx100Options(controller=ControllerOptions(**cell))
        self.controller = Controller(self.options.controller, START_S)
        self.requests, self.events = [], []
        self.now_s = START_S

    @property
    def is_running(self):
        return self.controller.is_running(self.now_s)

    @property
    def is_held(self):
        return Hold.COMMAND in self.controller.holds

    def advance(self, now_s):
        self.now_s = now_s
        self.controller.advance(now_s)
        self.events += self.controller.take_events()

    def connected(self):
        def executed(request, now_s):
            return execute(request, self.controller, now_s)

        self.talk = Conversation(self.options, executed, self.now_s)

    def receive(self, data, now_s):
        for event in self.talk.receive(data, now_s, Fault()):
            if isinstance(event, Request):
                self.requests.append((now_s, f"{event.name} {event.data}".strip()))

    def due(self, now_s):
        return b"".join(self.talk.take(now_s, Fault()))


class Cell:
    """A supervisor, its robot and its application, in steps of 5 ms of manual time.

    Attributes:
        wire: What was sent: time, bytes, whether armed, and the latch, at that moment.
        told: What the application was told, with the time.
        story: Everything said, told and sent, in its order.
    """

    def __init__(self, limits=LIMITS, robot=None, is_connected=True):
        self.supervisor = Supervisor(limits)
        self.robot = robot or ScriptedRobot()
        self.now_s = START_S
        self.wire, self.told, self.drops, self.story = [], [], [], []
        self.posture = "stop"
        self.beats = True
        self.left_s = self.control_s = self.gui_s = 0.0  # how old each is
        self.is_connected = False
        self.is_reachable = is_connected
        self.activation_id = 0
        if is_connected:
            self.run(0.1)

    # Time

    def step(self, seconds=TICK_S):
        self.now_s += seconds
        self.robot.advance(self.now_s)
        if self.beats:
            self.beat()
        if not self.is_connected and self.is_reachable:
            self.is_connected = True
            self.robot.connected()
            self.supervisor.robot_connected(self.now_s)
            self.collect()
        if self.is_connected and (data := self.robot.due(self.now_s)):
            self.supervisor.robot_bytes(data, self.now_s)
            self.collect()
        self.supervisor.tick(self.now_s)
        self.collect()

    def run(self, seconds):
        for _ in range(round(seconds / TICK_S)):
            self.step()

    def until(self, is_it, limit_s=5.0):
        """Step until something is so; the seconds it took. Fails at the limit."""
        __tracebackhide__ = True
        begin_s = self.now_s
        while not is_it():
            self.step()
            assert self.now_s - begin_s < limit_s, "it did not come to this"
        return self.now_s - begin_s

    # The application

    def say(self, message):
        self.story.append(message)
        self.supervisor.message(message, self.now_s)
        self.collect()

    def beat(self, **change):
        t_s = self.now_s
        fields = {
            "left_s": t_s - self.left_s,
            "is_left_start": self.posture == "start",
            "is_left_stop": self.posture == "stop",
            "control_s": t_s - self.control_s,
            "gui_s": t_s - self.gui_s,
        }
        self.say(m.Beat(**{**fields, **change}))

    def stop(self, reason, text="asked"):
        self.say(m.Stop(reason, text, self.now_s))

    def propose(self, direction=FORWARD, activation_id=None, t_s=None):
        if activation_id is None:
            activation_id = self.activation_id = self.activation_id + 1
        self.say(m.Propose(activation_id, direction, self.now_s if t_s is None else t_s))

    def arm(self):
        self.step()
        self.say(m.Arm())
        self.until(lambda: self.supervisor.is_armed)

    def move(self, **how):
        """Arm, take the start posture, propose, and see it run."""
        if not self.supervisor.is_armed:
            self.arm()
        self.posture = "start"
        self.run(0.1)
        self.propose(**how)
        self.until(lambda: self.heard(m.CommandAccepted))
        self.run(0.1)

    def heard(self, kind):
        return [message for _, message in self.told if isinstance(message, kind)]

    def forget_told(self):
        self.told.clear()

    def forget(self):
        self.forget_told()
        self.wire.clear()
        self.robot.requests.clear()

    # The wire

    def collect(self):
        while outputs := self.supervisor.take_outputs():
            for output in outputs:
                self._take(output)

    def _take(self, output):
        self.story.append(output)
        match output:
            case ToRobot(data):
                armed, latch = self.supervisor.is_armed, self.supervisor.latch
                self.wire.append((self.now_s, data, armed, latch))
                if self.is_connected:
                    self.robot.receive(data, self.now_s)
            case DropRobot(reason):
                self.drops.append(reason)
                self.is_connected = False
            case ToApp(message):
                assert m.decode(m.encode(message).strip()) == message
                self.told.append((self.now_s, message))

    def cut(self, reason="cable"):
        """The socket ends."""
        self.is_connected = False
        self.supervisor.robot_ended(reason, self.now_s)
        self.collect()

    def asked(self, since_s=0.0):
        """What the controller was asked, in order: commands with their data."""
        return [text for t_s, text in self.robot.requests if t_s >= since_s]

    def headers(self):
        return [d for _, d, _, _ in self.wire if d.startswith((b"HOSTCTRL", b"CONNECT"))]

    def moves(self):
        """The IMOV bytes that left: headers."""
        return [item for item in self.wire if item[1].startswith(b"HOSTCTRL_REQUEST IMOV")]

    def payloads(self):
        """The IMOV bytes that left: data."""
        return [item for item in self.wire if item[1].count(b",") == 16]


@pytest.fixture(scope="session")
def new_cell():
    """Makes cells: ``new_cell(limits=…, robot=…)``."""
    return Cell


@pytest.fixture(scope="session")
def new_robot():
    """Makes scripted controllers."""
    return ScriptedRobot


@pytest.fixture(scope="session")
def new_emulated():
    """Makes emulated controllers: ``new_emulated(ladder_s=…)``."""
    return EmulatedRobot


@pytest.fixture(scope="session")
def limits():
    """Trip level 125 ms, control 250 ms, window 500 ms; 100 mm/s and 10 deg/s; hold-to-run."""
    return LIMITS


@pytest.fixture
def cell():
    """A connected cell, disarmed and ready to arm."""
    return Cell()
