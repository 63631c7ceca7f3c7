"""What the emulated NX100 answers: a request's operands checked, done on the controller. Pure.

Commands that an NX100 has and this emulator does not (jobs, files, MOVL and MOVJ, HLOCK) are not
known here and get the NG of an unknown command at their header, as an option that is not installed.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass

from gestureapp.robot import hp6
from gestureapp.robot.values import Pose, PoseIncrement
from gestureapp.simulation.controller import Controller
from gestureapp.simulation.nx100_lines import Request
from gestureapp.simulation.nx100_values import READABLE, Code, Cycle, Mode, Move
from gestureapp.simulation.pulses import pulses

IMOV_FIELDS = 17
OPERAND_MAX_CHARS = 32
SPEEDS_MM_S = (0.1, 1500.0)
SPEEDS_DEG_S = (0.1, 180.0)
"""Source: INFORM's limits for V and VR, from memory."""
MESSAGE_MAX_CHARS = 30
TOOL_MAX = 23
FRAME_MAX = 25
"""User frame 24. The tool frame's code on an NX100 is not known, so it is refused."""
INCREMENT_MAX_MM = 10_000.0
INCREMENT_MAX_DEG = 360.0
"""Ours, far outside the cell: the arm's own reach answers before them."""

_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)")
_WHOLE = re.compile(r"[+-]?[0-9]+")


@dataclass(frozen=True, slots=True)
class Answer:
    """What follows ``OK: CMD``.

    Attributes:
        line: Without its end.
        has_data: Ends in CR only; all others end in CR LF.
        delay_s: How long the controller works before it answers.
    """

    line: str
    has_data: bool = False
    delay_s: float = 0.0

    @property
    def wire(self) -> bytes:
        """The bytes. Source: DX200 Ethernet manual p. 15."""
        return self.line.encode("ascii") + (b"\r" if self.has_data else b"\r\n")


def execute(request: Request, controller: Controller, now_s: float) -> Answer:
    """Do what a request asks, or say why not. Never raises on what a client sent.

    Args:
        request: With a name out of ``NAMES``.
        controller: Changed by it.
        now_s: When its last byte arrived; for a command that only reads, when it is answered.
    """
    if request.name in NEEDS_REMOTE and not controller.is_remote:
        return refusal(request.name, Code.NOT_REMOTE)
    result = _COMMANDS[request.name](_operands(request.data), controller, now_s)
    if isinstance(result, str):
        return Answer(result, has_data=True)
    if result is not Code.OK:
        return refusal(request.name, result)
    delay_s = 0.0
    if request.name == "SVON" and not controller.is_servo_on and request.data.strip() == "1":
        delay_s = controller.options.servo_on_delay_s
    return Answer("0000", delay_s=delay_s)


def refusal(name: str, code: int) -> Answer:
    """Give the answer to a command that cannot be carried out."""
    return Answer(f"ERROR: {name} is not successful({code:04d}).")


_Handler = Callable[[list[str], Controller, float], Code | str]


def _rstats(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    if operands:
        return Code.OPERAND_COUNT
    return "{},{}".format(*controller.status(now_s))


def _ralarm(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    if operands:
        return Code.OPERAND_COUNT
    controller.advance(now_s)
    pairs = [controller.error or (0, 0), *controller.alarms]
    pairs += [(0, 0)] * (5 - len(pairs))
    return ",".join(f"{code},{data}" for code, data in pairs)


def _rposj(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    if operands:
        return Code.OPERAND_COUNT
    axes = pulses(controller.joints(now_s))
    return ",".join(str(pulse) for pulse in (*axes, 0, 0, 0, 0, 0, 0))


def _rposc(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    numbers = _wholes(operands, 2)
    if isinstance(numbers, Code):
        return numbers
    if numbers[1] not in (0, 1):
        return Code.OPERAND_VALUE
    pose = controller.pose_in(numbers[0], now_s)
    if isinstance(pose, Code):
        return pose
    posture = hp6.posture_of(controller.joints(now_s))
    held = f"{posture.bits},{controller.options.tool}"
    return f"{_pose_text(pose)},{held}" + (",0,0,0,0,0,0" if numbers[1] else "")


def _svon(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    is_on = _switch(operands)
    return is_on if isinstance(is_on, Code) else controller.command_servo(is_on, now_s)


def _hold(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    is_on = _switch(operands)
    return is_on if isinstance(is_on, Code) else controller.command_hold(is_on, now_s)


def _reset(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    return Code.OPERAND_COUNT if operands else controller.reset(now_s)


def _cancel(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    return Code.OPERAND_COUNT if operands else controller.cancel(now_s)


def _imov(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    if len(operands) != IMOV_FIELDS:
        return Code.OPERAND_COUNT
    numbers = _numbers(operands)
    if isinstance(numbers, Code):
        return numbers
    wholes = _wholes([operands[0], operands[2], *operands[9:]], 10)
    if isinstance(wholes, Code):
        return wholes
    speed_class, frame, _, tool = wholes[:4]
    increment = PoseIncrement(*numbers[3:9])
    if not _is_in_range(speed_class, numbers[1], frame, tool, increment):
        return Code.DATA_RANGE
    return controller.move(Move(speed_class, numbers[1], frame, increment), now_s)


def _iowrite(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    if len(operands) < 3:
        return Code.OPERAND_COUNT
    numbers = _wholes(operands, len(operands))
    if isinstance(numbers, Code):
        return numbers
    first, n_contacts, values = numbers[0], numbers[1], numbers[2:]
    if first % 10 or n_contacts % 8 or n_contacts <= 0:
        return Code.OPERAND_VALUE
    if len(values) != n_contacts // 8:
        return Code.OPERAND_COUNT
    if any(not 0 <= value <= 255 for value in values):
        return Code.OPERAND_VALUE
    return controller.write_inputs(first, values, now_s)


def _ioread(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    numbers = _wholes(operands, 2)
    if isinstance(numbers, Code):
        return numbers
    first, n_contacts = numbers
    if first % 10 or n_contacts % 8 or not 0 < n_contacts <= 1024:
        return Code.OPERAND_VALUE
    addresses = [first + 10 * i for i in range(n_contacts // 8)]
    if not all(any(address in area for area in READABLE) for address in addresses):
        return Code.NO_ACCESS
    controller.advance(now_s)
    return ",".join(str(controller.inputs.get(address, 0)) for address in addresses)


def _mode(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    numbers = _wholes(operands, 1)
    if isinstance(numbers, Code):
        return numbers
    mode = {1: Mode.TEACH, 2: Mode.PLAY}.get(numbers[0])
    if mode is None:
        return Code.OPERAND_VALUE
    if not controller.options.allows_mode_switch:
        return Code.MODE
    controller.set_mode(mode, now_s)
    return Code.OK


def _cycle(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    numbers = _wholes(operands, 1)
    if isinstance(numbers, Code):
        return numbers
    cycle = {1: Cycle.STEP, 2: Cycle.ONE, 3: Cycle.AUTO}.get(numbers[0])
    if cycle is None:
        return Code.OPERAND_VALUE
    controller.cycle = cycle
    return Code.OK


def _mdsp(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    if len(",".join(operands)) > MESSAGE_MAX_CHARS:
        return Code.OPERAND_LENGTH
    return Code.OK


def _loadv(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    if len(operands) < 3:
        return Code.OPERAND_COUNT
    numbers = _wholes(operands[:2], 2)
    if isinstance(numbers, Code):
        return numbers
    return controller.variables.load(numbers[0], numbers[1], ",".join(operands[2:]))


def _savev(operands: list[str], controller: Controller, now_s: float) -> Code | str:
    numbers = _wholes(operands, 2)
    if isinstance(numbers, Code):
        return numbers
    return controller.variables.save(numbers[0], numbers[1])


_COMMANDS: dict[str, _Handler] = {
    "RSTATS": _rstats,
    "RALARM": _ralarm,
    "RPOSJ": _rposj,
    "RPOSC": _rposc,
    "IOREAD": _ioread,
    "SVON": _svon,
    "HOLD": _hold,
    "RESET": _reset,
    "CANCEL": _cancel,
    "IMOV": _imov,
    "IOWRITE": _iowrite,
    "MODE": _mode,
    "CYCLE": _cycle,
    "MDSP": _mdsp,
    "LOADV": _loadv,
    "SAVEV": _savev,
}
NAMES = frozenset(_COMMANDS)
READS = frozenset({"RSTATS", "RALARM", "RPOSJ", "RPOSC", "IOREAD", "SAVEV"})
"""Change nothing; they read the moment they are answered."""
NEEDS_REMOTE = NAMES - READS | {"SAVEV"}
"""Refused without command remote, before their operands are looked at. Reading a variable: the
stricter of two contradicting sources."""


def _operands(data: str) -> list[str]:
    return [word.strip() for word in data.split(",")] if data.strip() else []


def _numbers(operands: list[str]) -> list[float] | Code:
    if any(not word or len(word) > OPERAND_MAX_CHARS for word in operands):
        return Code.OPERAND_LENGTH
    if any(_NUMBER.fullmatch(word) is None for word in operands):
        return Code.OPERAND_VALUE
    return [float(word) for word in operands]


def _wholes(operands: list[str], n: int) -> list[int] | Code:
    if len(operands) != n:
        return Code.OPERAND_COUNT
    if any(not word or len(word) > OPERAND_MAX_CHARS for word in operands):
        return Code.OPERAND_LENGTH
    if any(_WHOLE.fullmatch(word) is None for word in operands):
        return Code.OPERAND_VALUE
    return [int(word) for word in operands]


def _switch(operands: list[str]) -> bool | Code:
    numbers = _wholes(operands, 1)
    if isinstance(numbers, Code):
        return numbers
    return numbers[0] == 1 if numbers[0] in (0, 1) else Code.OPERAND_VALUE


def _is_in_range(
    speed_class: int, speed: float, frame: int, tool: int, increment: PoseIncrement
) -> bool:
    if speed_class not in (0, 1):
        return False
    slowest, fastest = SPEEDS_DEG_S if speed_class == 1 else SPEEDS_MM_S
    return (
        slowest <= speed <= fastest
        and 0 <= frame <= FRAME_MAX
        and 0 <= tool <= TOOL_MAX
        and all(abs(part) <= INCREMENT_MAX_MM for part in increment.translation_mm)
        and all(abs(part) <= INCREMENT_MAX_DEG for part in increment.rotation_deg)
    )


def _pose_text(pose: Pose) -> str:
    position = ",".join(f"{round(part, 3) + 0.0:.3f}" for part in pose.position_mm)
    turned = ",".join(f"{round(part, 2) + 0.0:.2f}" for part in pose.rotation_deg)
    return f"{position},{turned}"
