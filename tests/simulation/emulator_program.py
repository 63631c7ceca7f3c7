"""A stand-in for ``python -m gestureapp``: ``simulate sensor`` as it is, and broken emulators.

``--arm`` may name a side whose process breaks: see ``BREAK`` in the environment, ``side=way``.
"""

import argparse
import os
import sys

from gestureapp.sensing.values import Side
from gestureapp.simulation.sensor import SensorOptions, serve_sensor


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("simulate")
    parser.add_argument("kind")
    parser.add_argument("--arm", default="left")
    parser.add_argument("--port", type=int)
    parser.add_argument("--control-port", type=int)
    parser.add_argument("--protocol", default="csv")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--session", type=int, default=2)
    parser.add_argument("--exit-with-stdin", action="store_true")
    given = parser.parse_args()
    if os.environ.get("BREAK") == f"{given.kind}=die":
        sys.stderr.write("no room for another emulator\n")
        return 3
    if os.environ.get("BREAK") == f"{given.kind}=mute":
        sys.stdin.read()
        return 0
    options = SensorOptions(
        Side(given.arm),
        given.port,
        given.control_port,
        given.protocol,
        seed=given.seed,
        session=given.session,
    )
    return serve_sensor(options, given.exit_with_stdin)


if __name__ == "__main__":
    sys.exit(main())
