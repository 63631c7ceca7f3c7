"""From the start of ``gestureapp --demo`` to its first painted window, and what memory it takes."""

import re
import subprocess
import tempfile
from pathlib import Path

from gestureapp.benchmark.report import Report, Row
from gestureapp.children import child_environment, program_command
from gestureapp.clock import monotonic

RUNS = 7
STAY_S = 3.0
"""How long the window stays open before its memory is read."""
_PAINTED = re.compile(r"painted at (\d+\.\d+) s")
_MEBIBYTE_KB = 1024.0


def measure_startup() -> Report:
    """The first run warms the disk's cache and is not counted."""
    times: list[float] = []
    memory: dict[str, list[float]] = {}
    for run in range(RUNS + 1):
        painted_s, sizes = _one()
        if run and painted_s is not None:
            times.append(painted_s)
            for name, size in sizes.items():
                memory.setdefault(name, []).append(size)
    rows = [Row("process start to window painted", "s", tuple(times), "at most 2.5 s")]
    rows += [Row(f"memory of {name}", "MiB", tuple(v)) for name, v in sorted(memory.items())]
    return Report("gestureapp --demo", rows)


def _one() -> tuple[float | None, dict[str, float]]:
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["--demo", "--data-dir", folder, "--log-level", "info"]
        begun_s = monotonic()
        with subprocess.Popen(
            program_command(*arguments, "--exit-after", str(STAY_S + 1.0)),
            env=child_environment(),
            stderr=subprocess.PIPE,
            text=True,
        ) as child:
            assert child.stderr is not None
            painted_s = None
            for line in child.stderr:
                match = _PAINTED.search(line)
                if match is not None:
                    painted_s = float(match[1]) - begun_s
                    break
            try:
                child.wait(STAY_S)
            except subprocess.TimeoutExpired:
                sizes = _memory(child.pid)
            else:
                sizes = {}
            child.stderr.read()
    return painted_s, sizes


def _memory(pid: int) -> dict[str, float]:
    """Resident memory of the application and its two guardians, MiB; empty without /proc."""
    sizes = {"the application": _resident(pid)}
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            text = status.read_text()
            line = (status.parent / "cmdline").read_bytes()
        except OSError:
            continue  # it has ended meanwhile
        if f"PPid:\t{pid}\n" in text and b"guardian" in line:
            size = _resident(int(status.parent.name))
            sizes["guardian and spare one"] = sizes.get("guardian and spare one", 0.0) + size
    return {name: size for name, size in sizes.items() if size}


def _resident(pid: int) -> float:
    try:
        text = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return 0.0
    match = re.search(r"VmRSS:\s+(\d+) kB", text)
    return int(match[1]) / _MEBIBYTE_KB if match else 0.0
