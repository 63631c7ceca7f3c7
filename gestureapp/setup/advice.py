"""What to try while a sensor sends nothing, in the order of likelihood. Facts in, lines out."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from gestureapp.sensing import bluetooth
from gestureapp.sensing.port_list import SystemPort
from gestureapp.sensing.ports import IN_USE, group_of
from gestureapp.sensing.values import LinkState, Side, StreamHealth

_SWITCH_ON: Final = "Out of range or off: switch the sensor on, bring it closer, charge it."


@dataclass(frozen=True, slots=True)
class PortFacts:
    """What is known of a port that gives no data. ``None``: nobody knows.

    Attributes:
        url: As in the settings; empty when none is chosen.
        link: State of the stream.
        reason: Why it is so, as the reader says it.
        is_bluetooth: A Bluetooth serial port.
        is_powered: The Bluetooth adapter is on.
        is_paired: The Bluetooth device is paired with this machine.
        exists: The device file is there; None for an address.
        is_allowed: This user may read and write it.
        group: Its group, who may.
    """

    url: str
    link: LinkState
    reason: str = ""
    is_bluetooth: bool = False
    is_powered: bool | None = None
    is_paired: bool | None = None
    exists: bool | None = None
    is_allowed: bool | None = None
    group: str = ""


def advise(facts: PortFacts) -> tuple[str, ...]:
    """What to try, likeliest first; a cause that is known for certain ends the list.

    The order is that of the chain: nothing later can be found out before the earlier one is mended.
    """
    if facts.link is LinkState.RECEIVING:
        return ()
    if not facts.url:
        return ("No port is chosen: choose one, or press Find sensors.",)
    if facts.link is LinkState.WRONG_DATA:
        return _wrong_data(facts)
    if facts.link is LinkState.NO_DATA:
        return (_SWITCH_ON, *_maybe_protocol(facts))
    lines: list[str] = []
    for cause in (_off, _not_paired, _in_use, _forbidden, _missing):
        line, is_certain = cause(facts)
        if line:
            lines.append(line)
        if is_certain:
            return tuple(lines)
    return (*lines, _no_answer(facts))


def advise_same(other: Side, health: StreamHealth) -> tuple[str, ...]:
    """The same for a port that the other arm's sensor is on, too: no other program has it."""
    if health.link is LinkState.RECEIVING:
        return ()
    return (f"This is the {other.value} arm's port: choose another one, or press Swap.",)


def _off(facts: PortFacts) -> tuple[str, bool]:
    if not facts.is_bluetooth or facts.is_powered:
        return "", False
    if facts.is_powered is None:
        return "Is Bluetooth off? Switch it on in the system's settings.", False
    return "Bluetooth is off: switch it on in the system's settings.", True


def _not_paired(facts: PortFacts) -> tuple[str, bool]:
    if not facts.is_bluetooth or facts.is_paired:
        return "", False
    if facts.is_paired is None:
        return "Is it paired? Pair the sensor in the system's Bluetooth settings.", False
    return "Not paired: pair the sensor in the system's Bluetooth settings.", True


def _in_use(facts: PortFacts) -> tuple[str, bool]:
    if IN_USE not in facts.reason:
        return "", False
    return "In use by another program: close that program.", True


def _forbidden(facts: PortFacts) -> tuple[str, bool]:
    if facts.is_allowed is not False or not facts.exists:
        return "", False
    join = f"sudo adduser $USER {facts.group}" if facts.group else "ask the administrator"
    group = f" to the group {facts.group}" if facts.group else ""
    return f"No permission: add the user{group} ({join}), then log in again.", True


def _missing(facts: PortFacts) -> tuple[str, bool]:
    if facts.exists is not False:
        return "", False
    if facts.is_bluetooth:
        bind = f"sudo rfcomm bind {Path(facts.url).name} ADDRESS"
        return f"{facts.url} is not there: bind the sensor to it ({bind}).", True
    return f"{facts.url} is not there: plug the receiver in, or choose another port.", True


def _no_answer(facts: PortFacts) -> str:
    if "://" in facts.url:
        return f"{facts.reason[:1].upper()}{facts.reason[1:]}."
    return _SWITCH_ON


def _maybe_protocol(facts: PortFacts) -> tuple[str, ...]:
    if facts.is_bluetooth:
        return ()
    return ("Does the line have the right speed? It is read at 115200 baud.",)


def _wrong_data(facts: PortFacts) -> tuple[str, ...]:
    if "frozen" in facts.reason:
        return ("The sensor sends one value only: switch it off and on.",)
    return (
        "What comes cannot be read: choose another protocol, or press Find sensors.",
        "Is this port the sensor's? Choose another port.",
    )


def gather(
    url: str,
    health: StreamHealth,
    port: SystemPort | None,
    ask_powered: Callable[[], bool | None] = bluetooth.ask_powered,
    ask_device: Callable[[str], bluetooth.BluetoothDevice] = bluetooth.ask_device,
) -> PortFacts:
    """Find out what may keep a port from giving data. May wait for the system; never raises.

    Args:
        url: Of the port, as in the settings.
        health: Of its stream.
        port: The port as the system lists it, if it does.
        ask_powered: Whether the Bluetooth adapter is on.
        ask_device: What the system knows of a Bluetooth device.
    """
    facts = PortFacts(url, health.link, health.reason)
    if not url or health.link is LinkState.RECEIVING or "://" in url:
        return facts
    is_device = os.name == "posix"
    is_wireless = port.is_bluetooth if port is not None else "/rfcomm" in url
    address = port.address if port is not None else ""
    powered = ask_powered() if is_wireless else None
    return PortFacts(
        url=url,
        link=health.link,
        reason=health.reason,
        is_bluetooth=is_wireless,
        is_powered=powered,
        is_paired=ask_device(address).is_paired if address and powered else None,
        exists=_exists(url) if is_device else None,
        is_allowed=_is_allowed(url) if is_device else None,
        group=group_of(url),
    )


def trouble_of(url: str) -> str:
    """Why this port cannot be opened by this user, without opening it; empty when nobody knows.

    Never raises.
    """
    if os.name != "posix" or not _exists(url) or _is_allowed(url):
        return ""
    group = group_of(url)
    return f"no permission: join the group {group}" if group else "no permission"


def _exists(url: str) -> bool:
    """No device has a name that the system cannot take: with a NUL in it, or far too long."""
    try:
        return Path(url).exists()
    except (OSError, ValueError):
        return False


def _is_allowed(url: str) -> bool:
    try:
        return os.access(url, os.R_OK | os.W_OK)
    except (OSError, ValueError):
        return False
