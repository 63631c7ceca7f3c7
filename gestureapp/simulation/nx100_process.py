"""The emulated NX100 as a process of its own: its command line, its life, its script of faults."""

import argparse
import sys
import threading
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import TextIO

from gestureapp.errors import ConfigError, GestureAppError
from gestureapp.robot.values import Pose
from gestureapp.simulation.nx100 import Nx100Emulator
from gestureapp.simulation.nx100_commands import TOOL_MAX
from gestureapp.simulation.nx100_control import fault_of
from gestureapp.simulation.nx100_options import Nx100Options, ScriptedFault, Second, Segments
from gestureapp.simulation.nx100_values import ControllerOptions
from gestureapp.simulation.parent import on_end_signals, on_stdin_end


def serve(
    options: Nx100Options,
    *,
    exit_with_stdin: bool = False,
    out: TextIO | None = None,
) -> int:
    """Serve until SIGTERM, SIGINT, or with ``exit_with_stdin`` the end of standard input.

    Prints ``control on HOST:PORT`` if there is a control port, then ``listening on HOST:PORT``.

    Args:
        options: The emulator's.
        exit_with_stdin: So that it never outlives who started it.
        out: Where the lines go; standard output.

    Returns:
        Exit code 0.

    Raises:
        GestureAppError: a port or the log file cannot be had.
    """
    stopping = threading.Event()
    emulator = Nx100Emulator(options)

    def end() -> None:
        stopping.set()
        emulator.wake()

    on_end_signals(end)
    emulator.open()
    stream = out or sys.stdout
    if emulator.control_port is not None:
        stream.write(f"control on {options.host}:{emulator.control_port}\n")
    stream.write(f"listening on {options.host}:{emulator.port}\n")
    stream.flush()
    if exit_with_stdin:
        on_stdin_end(end)
    emulator.run(stopping)
    return 0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what ``gestureapp simulate nx100`` understands."""
    cell = ControllerOptions()
    add = parser.add_argument
    add("--port", type=int, required=True, metavar="N", help="TCP port; 0 picks a free one")
    add("--host", default="127.0.0.1", help="address to listen on (default: %(default)s)")
    add("--control-port", type=int, metavar="M", help="virtual pendant, JSON lines; 0 picks one")
    add("--segments", choices=[s.value for s in Segments], default=Segments.SEPARATE.value)
    add("--answer-delay-ms", type=float, default=0.0, metavar="MS")
    add("--second", choices=[s.value for s in Second], default=Second.ACCEPT.value)
    add("--strict", action="store_true", help="refuse odd data sizes and spellings")
    add("--idle-close-s", type=float, metavar="S", help="close a connection silent for so long")
    add("--log", type=Path, metavar="FILE", help="every byte, request and motion, JSON lines")
    add("--script", type=Path, metavar="FILE", help="faults at given times, TOML")
    add("--exit-with-stdin", action="store_true", help="end when standard input is closed")
    add("--pose", type=_pose, default=cell.start_pose, metavar="X,Y,Z,RX,RY,RZ", help="at start")
    add("--tool", type=_tool, default=cell.tool, metavar="N", help="tool selected (%(default)s)")
    add("--tool-mm", type=_offset, default=cell.tool_mm, metavar="X,Y,Z", help="its point")
    add("--resume-after-hold", action="store_true", help="HOLD 0 goes on with the move")
    add("--allow-mode", action="store_true", help="MODE is taken over the network")
    add("--accel-mm-s2", type=float, default=cell.accel_mm_s2, metavar="A")
    add("--accel-deg-s2", type=float, default=cell.accel_deg_s2, metavar="A")
    add("--start-delay-ms", type=float, default=1000.0 * cell.start_delay_s, metavar="MS")
    add("--servo-on-delay-ms", type=float, default=0.0, metavar="MS")
    add("--ladder-ms", type=float, metavar="MS", help="timer on #22010 that drives external hold")


def run(arguments: argparse.Namespace) -> int:
    """Do what the parsed command line says; returns the exit code. Raises as ``serve``.

    Raises:
        ConfigError: a number makes no sense, or the script cannot be read.
    """
    return serve(options_of(arguments), exit_with_stdin=arguments.exit_with_stdin)


def options_of(arguments: argparse.Namespace) -> Nx100Options:
    """Make options of a parsed command line.

    Raises:
        ConfigError: a number makes no sense, or the script cannot be read.
    """
    _check(arguments)
    cell = replace(
        ControllerOptions(),
        start_pose=arguments.pose,
        tool=arguments.tool,
        tool_mm=arguments.tool_mm,
        start_delay_s=arguments.start_delay_ms / 1000.0,
        accel_mm_s2=arguments.accel_mm_s2,
        accel_deg_s2=arguments.accel_deg_s2,
        servo_on_delay_s=arguments.servo_on_delay_ms / 1000.0,
        allows_mode_switch=arguments.allow_mode,
        resumes_after_hold=arguments.resume_after_hold,
        ladder_s=None if arguments.ladder_ms is None else arguments.ladder_ms / 1000.0,
    )
    return Nx100Options(
        host=arguments.host,
        port=arguments.port,
        control_port=arguments.control_port,
        controller=cell,
        segments=Segments(arguments.segments),
        answer_delay_s=arguments.answer_delay_ms / 1000.0,
        is_strict=arguments.strict,
        second=Second(arguments.second),
        idle_close_s=arguments.idle_close_s,
        script=() if arguments.script is None else read_script(arguments.script),
        log_file=arguments.log,
    )


def read_script(path: Path) -> tuple[ScriptedFault, ...]:
    """Read faults: tables ``[[fault]]`` with ``at_s``, ``kind`` and what the kind takes.

    Raises:
        ConfigError: the file cannot be read, or says something that makes no sense.
    """
    try:
        tables = tomllib.loads(path.read_text("utf-8")).get("fault", [])
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ConfigError("--script", str(path), str(error)) from error
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise ConfigError("--script", str(path), "holds tables named [[fault]]")
    return tuple(_scripted(table) for table in tables)


def main(words: list[str] | None = None) -> int:
    """Run the emulator alone: ``python -m gestureapp.simulation.nx100_process --port 0``."""
    parser = argparse.ArgumentParser("nx100", description="An emulated NX100 controller.")
    add_arguments(parser)
    try:
        return run(parser.parse_args(words))
    except GestureAppError as error:
        sys.stderr.write(f"{error}\n")
        return 1


def _scripted(table: dict[str, object]) -> ScriptedFault:
    at_s = table.get("at_s")
    if isinstance(at_s, bool) or not isinstance(at_s, int | float) or not at_s >= 0.0:
        raise ConfigError("fault.at_s", at_s, "seconds from the start are wanted")
    try:
        return ScriptedFault(float(at_s), fault_of(table))
    except ValueError as error:
        raise ConfigError("fault", table, str(error)) from error


def _check(arguments: argparse.Namespace) -> None:
    """Refuse what the model cannot move with."""
    for name in ("accel_mm_s2", "accel_deg_s2", "idle_close_s", "ladder_ms"):
        value = getattr(arguments, name)
        if value is not None and not 0.0 < value < 1e9:
            raise ConfigError(f"--{name.replace('_', '-')}", value, "a positive number is wanted")
    for name in ("answer_delay_ms", "start_delay_ms", "servo_on_delay_ms"):
        value = getattr(arguments, name)
        if not 0.0 <= value <= 60_000.0:
            wanted = "milliseconds from 0 to 60000 are wanted"
            raise ConfigError(f"--{name.replace('_', '-')}", value, wanted)


def _pose(text: str) -> Pose:
    x, y, z, rx, ry, rz = _numbers(text, "X,Y,Z,RX,RY,RZ")
    return Pose(x, y, z, rx, ry, rz)


def _offset(text: str) -> tuple[float, float, float]:
    x, y, z = _numbers(text, "X,Y,Z")
    return (x, y, z)


def _tool(text: str) -> int:
    if not text.isdecimal() or int(text) > TOOL_MAX:
        raise argparse.ArgumentTypeError(f"a whole number from 0 to {TOOL_MAX} is wanted")
    return int(text)


def _numbers(text: str, form: str) -> list[float]:
    words, n = text.split(","), form.count(",") + 1
    if len(words) != n:
        raise argparse.ArgumentTypeError(f"{n} numbers with commas are wanted: {form}")
    try:
        numbers = [float(word) for word in words]
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    if not all(abs(value) < 1e4 for value in numbers):
        raise argparse.ArgumentTypeError("mm and degrees below 10000 are wanted")
    return numbers


if __name__ == "__main__":
    sys.exit(main())
