"""The command line of the emulated sensor."""

import argparse
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # late at run time: the parser is built for every command
    from gestureapp.simulation.sensor_radio import RadioOptions


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add what can be chosen."""
    parser.add_argument("--arm", choices=("left", "right"), required=True)
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--control-port", type=int, help="what the arm does, JSON lines")
    parser.add_argument("--protocol", default="csv", help="csv, adxl330, witmotion or binary")
    parser.add_argument("--rate-hz", type=float, default=100.0)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--session", type=int, default=2)
    parser.add_argument("--identity", default="", metavar="NAME", help="what binary calls itself")
    parser.add_argument("--battery", type=int, default=80, metavar="PERCENT", help="of binary")
    parser.add_argument(
        "--link", choices=("direct", "bluetooth"), default="direct", help="what is between"
    )
    parser.add_argument("--link-burst", type=int, metavar="FRAMES", help="at least in a burst")
    parser.add_argument(
        "--link-gap-ms", type=float, nargs=2, metavar=("MIN", "MAX"), help="between two bursts"
    )
    parser.add_argument("--link-loss", type=float, metavar="SHARE", help="of the frames, 0 to 1")
    parser.add_argument(
        "--clock-ppm", type=float, metavar="PPM", help="how slow the sensor's clock is"
    )
    parser.add_argument("--exit-with-stdin", action="store_true")


def run(options: argparse.Namespace) -> int:
    """Serve one sensor until it is told to end; returns the exit code.

    Raises:
        ConfigError: the protocol is unknown or a value is out of range.
        SensorError: a port cannot be served.
    """
    from gestureapp.sensing.values import Side
    from gestureapp.simulation.sensor import SensorOptions, serve_sensor

    sensor = SensorOptions(
        side=Side(options.arm),
        port=options.port,
        control_port=options.control_port,
        protocol=options.protocol,
        rate_hz=options.rate_hz,
        seed=options.seed,
        session=options.session,
        radio=_radio(options),
        identity=options.identity,
        battery_percent=options.battery,
    )
    return serve_sensor(sensor, exit_with_stdin=options.exit_with_stdin)


def _radio(options: argparse.Namespace) -> "RadioOptions":
    """The link that is named, with what is said more finely."""
    from gestureapp.simulation.sensor_radio import LINKS

    radio = LINKS[options.link]
    if options.link_burst is not None:
        radio = replace(radio, burst=options.link_burst)
    if options.link_gap_ms is not None:
        shortest_ms, longest_ms = options.link_gap_ms
        radio = replace(radio, gap_s=(shortest_ms / 1000, longest_ms / 1000))
    if options.link_loss is not None:
        radio = replace(radio, loss=options.link_loss)
    if options.clock_ppm is not None:
        radio = replace(radio, clock_ppm=options.clock_ppm)
    return radio
