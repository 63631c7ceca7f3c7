"""The command line: one subcommand is one call. No command moves a robot.

Exit codes: 0 fine, 1 failed, 2 usage, 3 hardware not found, 4 data damaged but recovered. An error
is one line on standard error that names the cause and the remedy; wrong settings are a line each.
"""

import argparse
import json
import logging
import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from gestureapp import __version__

if TYPE_CHECKING:  # children start quickly only when nothing heavy is imported with the parser
    from gestureapp.errors import GestureAppError
    from gestureapp.window_port import OpenWindow

FINE, FAILED, USAGE = 0, 1, 2
CHILDREN = (["guardian"], ["training-child"])
"""Started by the application, by no person."""


def main(
    arguments: Sequence[str] | None = None,
    open_window: "OpenWindow | None" = None,
    show_refusal: Callable[[str], None] | None = None,
) -> int:
    """Run one command and return its exit code.

    Args:
        arguments: Without the program's name; those of the process when None.
        open_window: Opens the application's window; without it only the other commands exist.
        show_refusal: Shows why the application did not start to somebody without a terminal.
    """
    arguments = sys.argv[1:] if arguments is None else arguments
    if list(arguments) in CHILDREN:
        return _child(*arguments)
    options = _parser(open_window is not None).parse_args(arguments)
    from gestureapp.errors import GestureAppError

    try:
        if options.run is not None:
            return int(options.run(options))
        if hasattr(options, "what"):
            return _benchmark(options, open_window)
        if hasattr(options, "subject_config"):
            return _fault_subject(options, open_window)
        return _application(options, open_window)
    except GestureAppError as error:
        return _refused(error, options, show_refusal)
    except BrokenPipeError:  # whoever read our output has gone; nobody is left to be told
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115  until the very end
        return FAILED
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        sys.stderr.write(f"gestureapp: {where}{error.strerror or error}\n")
        return FAILED
    except ModuleNotFoundError as error:
        remedy = "pip install 'gestureapp[training]'" if error.name == "torch" else "install it"
        sys.stderr.write(f"gestureapp: this needs {error.name}, which is not here: {remedy}\n")
        return FAILED
    except KeyboardInterrupt:
        return 130


def _child(name: str) -> int:
    if name == "guardian":  # must answer in a few hundredths of a second
        from gestureapp.robot.guardian import main as guardian

        return guardian()
    from gestureapp.recognition.training_child import main as training_child

    return training_child()


def _refused(
    error: "GestureAppError",
    options: argparse.Namespace,
    show_refusal: Callable[[str], None] | None,
) -> int:
    for line in str(error).splitlines():
        sys.stderr.write(f"gestureapp: {line}\n")
    is_application = options.run is None and not {"what", "subject_config"} & set(vars(options))
    # Runs that end by themselves have nobody who would put the message away.
    is_attended = is_application and options.exit_after is None
    if show_refusal and is_attended and not (sys.stdout.isatty() or sys.stderr.isatty()):
        show_refusal(str(error))
    return FAILED


def _parser(has_window: bool) -> argparse.ArgumentParser:
    from gestureapp import config_commands, training_commands

    parser = argparse.ArgumentParser(
        prog="gestureapp",
        description="Arm gestures for a robot cell. Without a command: the application.",
    )
    parser.add_argument("--version", action="version", version=f"gestureapp {__version__}")
    parser.set_defaults(run=None)
    if has_window:
        _add_application(parser)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=not has_window)
    _add_simulate(commands)
    training_commands.add_commands(commands)
    config_commands.add_commands(commands)
    _add_benchmark(commands)
    if has_window:
        _add_fault_subject(commands)
    return parser


def _add_application(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--demo", action="store_true", help="work on an emulated cell")
    parser.add_argument("--data-dir", type=Path, help="where sessions are recorded")
    parser.add_argument(
        "--config", type=Path, help="settings file, on top of the site's and user's"
    )
    parser.add_argument(
        "--log-level", choices=("debug", "info", "warning", "error"), default="warning"
    )
    parser.add_argument("--exit-after", type=_seconds, metavar="SECONDS", help="close by itself")


def _add_simulate(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    from gestureapp.simulation import nx100_process, sensor_process

    simulate = commands.add_parser("simulate", help="emulate a sensor or a controller; make takes")
    kinds = simulate.add_subparsers(title="what", metavar="WHAT", required=True)

    nx100 = kinds.add_parser("nx100", help="an NX100 controller on TCP")
    nx100_process.add_arguments(nx100)
    nx100.set_defaults(run=nx100_process.run)

    sensor = kinds.add_parser("sensor", help="a worn accelerometer on TCP")
    sensor_process.add_arguments(sensor)
    sensor.set_defaults(run=sensor_process.run)

    takes = kinds.add_parser("takes", help="takes of simulated people, as NPZ")
    takes.add_argument("out", type=Path, metavar="OUT.npz")
    takes.add_argument("--people", type=int, default=1)
    takes.add_argument("--takes", type=int, default=30)
    takes.add_argument("--seed", type=int, default=0)
    takes.add_argument("--session", type=int, default=1)
    takes.add_argument("--rate-hz", type=float, default=100.0, help="20 to 1000")
    takes.add_argument("--gestures", metavar="X+,X-,…", help="only these, in this order")
    takes.add_argument("--practised", action="store_true", help="trained operators")
    takes.set_defaults(run=_simulate_takes)


def _add_benchmark(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    benchmark = commands.add_parser("benchmark", help="measure the figures of the README")
    figures = ("latency", "stop", "training", "hearing", "recognition", "startup", "faults")
    benchmark.add_argument("what", choices=figures)
    benchmark.add_argument("--seconds", type=_seconds, default=40.0, help="at least, per case")
    benchmark.add_argument("--runs", type=_count, default=3, help="of each fault")
    benchmark.add_argument(
        "--fault", action="append", metavar="NAME", help="this one only; may be repeated"
    )
    benchmark.add_argument("--people", type=_count, default=40, help="for recognition: simulated")
    benchmark.add_argument(
        "--takes", type=Path, metavar="TAKES.npz", help="for recognition: takes from a file instead"
    )
    benchmark.add_argument(
        "--gestures", default="", metavar="A,B", help="for recognition: of the file's only these"
    )
    benchmark.add_argument("--json", action="store_true")
    benchmark.set_defaults(run=None)


def _add_fault_subject(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """The application for ``benchmark faults``; no help: the harness starts it, no person."""
    subject = commands.add_parser("fault-subject")
    subject.add_argument("subject_config", type=Path)
    subject.add_argument("folder", type=Path)
    subject.set_defaults(run=None)


def _application(options: argparse.Namespace, open_window: "OpenWindow | None") -> int:
    assert open_window is not None
    from gestureapp.running import data_folder, running_cell, settings_files
    from gestureapp.sensing.protocols import plug_in_findings
    from gestureapp.settings_file import load_settings
    from gestureapp.simulation.demo import DemoOptions

    logging.basicConfig(
        level=options.log_level.upper(), format="%(asctime)s %(levelname)s %(name)s: %(message)s"
    )
    # A demo is the same everywhere: the files of site and user are for the real cell.
    files = [] if options.demo else settings_files()
    settings, findings = load_settings(files, options.config)
    # Plug-ins are imported here, before there is a window that they could block.
    told = [*map(str, findings), *plug_in_findings()]
    for line in told:
        sys.stderr.write(f"gestureapp: {line}\n")
    demo = DemoOptions() if options.demo else None
    folder = data_folder(options.data_dir)
    with running_cell(settings, folder, demo, files, options.config) as running:
        for line in told:
            running.cell.tell(line)
        return open_window(running, options.exit_after)


def _simulate_takes(options: argparse.Namespace) -> int:
    from gestureapp.gestures import LABELS
    from gestureapp.recognition.takes import save_takes
    from gestureapp.simulation.takes import make_takes

    try:
        takes = make_takes(
            options.people,
            options.takes,
            options.seed,
            options.session,
            options.rate_hz,
            options.practised,
            LABELS if options.gestures is None else _names(options.gestures),
        )
    except ValueError as error:
        sys.stderr.write(f"gestureapp: {error}\n")
        return USAGE
    save_takes(options.out, takes)
    _write(f"{options.out}: {len(takes.labels)} takes")
    return FINE


def _benchmark(options: argparse.Namespace, open_window: "OpenWindow | None") -> int:
    from gestureapp.benchmark import measure

    if options.what == "faults":
        return _benchmark_faults(options, open_window)
    if options.what == "recognition":
        return _benchmark_recognition(options)
    report = measure(options.what, options.seconds, open_window)
    _write(json.dumps(report.as_json()) if options.json else report.as_table())
    return FINE


def _benchmark_recognition(options: argparse.Namespace) -> int:
    from gestureapp.benchmark import measure_recognition

    report = measure_recognition(options.people, options.takes, _names(options.gestures))
    _write(json.dumps(report.as_json()) if options.json else report.as_table())
    return FINE


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def _benchmark_faults(options: argparse.Namespace, open_window: "OpenWindow | None") -> int:
    from gestureapp.benchmark import measure_faults

    report = measure_faults(options.runs, options.fault or (), open_window)
    _write(json.dumps(report.as_json()) if options.json else report.as_table())
    return FINE if report.is_fine else FAILED


def _fault_subject(options: argparse.Namespace, open_window: "OpenWindow | None") -> int:
    assert open_window is not None
    from gestureapp.benchmark.faults.subject import run_subject

    return run_subject(options.subject_config, options.folder, open_window)


def _count(text: str) -> int:
    if not (text.isascii() and text.isdigit() and 0 < int(text) < 100_000):
        raise argparse.ArgumentTypeError(f"{text} is not a whole number from 1 to 99999")
    return int(text)


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < 1e6:
        raise argparse.ArgumentTypeError(f"{text} is not a time in seconds above zero")
    return value


def _write(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
