"""What the system knows of Bluetooth: adapter on or off, who is paired, what devices are called.

Reading the answers is pure; asking runs a system program with a time limit and never raises.
Linux answers through BlueZ's ``bluetoothctl``, Windows through its registry; elsewhere, and without
these, nothing is known.
"""

import importlib
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

ASK_WAIT_S: Final = 1.0
"""``bluetoothctl`` answers within some 30 ms; without a Bluetooth service it waits for ever."""

_ADDRESS: Final = re.compile(r"(?:[0-9A-F]{2}:){5}[0-9A-F]{2}", re.IGNORECASE)
_BTHENUM: Final = re.compile(r"BTHENUM\\.*[&\\]([0-9A-F]{12})_", re.IGNORECASE)
_REGISTRY: Final = r"SYSTEM\CurrentControlSet\Services\BTHPORT\Parameters\Devices"


@dataclass(frozen=True, slots=True)
class BluetoothDevice:
    """A device as the system knows it. ``None``: the system does not say.

    Attributes:
        name: As it calls itself, or as somebody renamed it; empty when not known.
        is_paired: It was paired with this machine.
    """

    name: str = ""
    is_paired: bool | None = None


def clean_address(text: str) -> str:
    """The first Bluetooth address in a text, ``00:06:66:AA:BB:CC``; empty when there is none."""
    found = _ADDRESS.search(text)
    return found.group().upper() if found else ""


def address_of_hwid(hwid: str) -> str:
    r"""The address in a Windows hardware id; empty without one, and for ports that wait for calls.

    As in ``BTHENUM\{00001101-...}_LOCALMFG&0000\7&1A2B3C4D&0&000666AABBCC_C00000000``; a port for
    incoming connections has only zeros there.
    """
    found = _BTHENUM.search(hwid)
    digits = found.group(1).upper() if found else ""
    if not digits.strip("0"):
        return ""
    return ":".join(digits[at : at + 2] for at in range(0, 12, 2))


def parse_powered(answer: str) -> bool | None:
    """Whether the adapter is on, from ``bluetoothctl show``; False also when there is none."""
    if "No default controller" in answer:
        return False
    return _yes_no(answer, "Powered")


def parse_device(answer: str) -> BluetoothDevice:
    """A device from ``bluetoothctl info ADDRESS``; an unknown one is not paired."""
    if "not available" in answer:
        return BluetoothDevice(is_paired=False)
    name = _field(answer, "Alias") or _field(answer, "Name")
    return BluetoothDevice(name, _yes_no(answer, "Paired"))


def parse_registry_name(value: object) -> str:
    """A name as the Windows registry holds it: UTF-8 with a zero at its end."""
    return value.split(b"\0")[0].decode("utf-8", "replace") if isinstance(value, bytes) else ""


def ask_powered() -> bool | None:
    """Whether the adapter is on; None when the system does not say. At most ``ASK_WAIT_S``."""
    return parse_powered(_ask("show"))


def ask_device(address: str) -> BluetoothDevice:
    """What the system knows of a device. At most ``ASK_WAIT_S``."""
    if sys.platform == "win32":
        name = parse_registry_name(_registry_value(address.replace(":", "").lower()))
        return BluetoothDevice(name, bool(name) or None)
    return parse_device(_ask("info", address))


def ask_rfcomm_address(device: str) -> str:
    """Whom a Linux Bluetooth port leads to, from the kernel; empty when it does not say.

    Source: the attribute ``address`` of a bound port, net/bluetooth/rfcomm/tty.c.
    """
    try:
        return clean_address(Path("/sys/class/tty", Path(device).name, "address").read_text())
    except (OSError, ValueError):
        return ""


def _ask(*words: str) -> str:
    command: Sequence[str] = ("bluetoothctl", *words)
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=ASK_WAIT_S,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return (done.stdout + done.stderr).decode("utf-8", "replace")


def _registry_value(key: str) -> object:
    try:
        registry: Any = importlib.import_module("winreg")
        with registry.OpenKey(registry.HKEY_LOCAL_MACHINE, rf"{_REGISTRY}\{key}") as opened:
            value: object = registry.QueryValueEx(opened, "Name")[0]
            return value
    except (ImportError, OSError):
        return None


def _field(answer: str, name: str) -> str:
    for line in answer.splitlines():
        key, colon, value = line.strip().partition(":")
        if colon and key == name:
            return value.strip()
    return ""


def _yes_no(answer: str, name: str) -> bool | None:
    return {"yes": True, "no": False}.get(_field(answer, name))
