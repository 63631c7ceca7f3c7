"""The ports of this machine with names a person knows. Reading entries is pure; asking is thin."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

from serial.tools import list_ports
from serial.tools.list_ports_common import ListPortInfo

from gestureapp.sensing import bluetooth
from gestureapp.sensing.bluetooth import BluetoothDevice

_NO_NAME: Final = ("", "n/a")


@dataclass(frozen=True, slots=True)
class PortEntry:
    """A port as the system lists it; empty or None where it says nothing.

    Attributes:
        device: ``/dev/ttyUSB0``, ``COM5``.
        description: What the system calls it.
        hwid: The system's hardware id.
        vid: USB vendor.
        pid: USB product.
        serial_number: Of the USB device.
        manufacturer: Of the USB device.
        product: Of the USB device.
        address: Of the Bluetooth device behind it.
        bluetooth_name: Of that device.
    """

    device: str
    description: str = ""
    hwid: str = ""
    vid: int | None = None
    pid: int | None = None
    serial_number: str = ""
    manufacturer: str = ""
    product: str = ""
    address: str = ""
    bluetooth_name: str = ""


@dataclass(frozen=True, slots=True)
class SystemPort:
    """A port that a sensor may be on.

    Attributes:
        url: What stands in the settings when it is chosen.
        name: What a person calls it.
        sensor_id: What is behind it, the same on whatever port: ``usb-0403:6001-A50285BI``,
            ``bt-00:06:66:AA:BB:CC``; empty when the system does not know.
        is_bluetooth: A Bluetooth serial port.
        address: Of the Bluetooth device; empty otherwise.
    """

    url: str
    name: str
    sensor_id: str = ""
    is_bluetooth: bool = False
    address: str = ""


def is_bluetooth(device: str, hwid: str = "") -> bool:
    """Whether a port is a Bluetooth serial port, by its name or hardware id."""
    return "/rfcomm" in device or hwid.upper().startswith("BTHENUM")


def port_of(entry: PortEntry) -> SystemPort:
    """A listed port with the name a person knows and an id that stays."""
    if is_bluetooth(entry.device, entry.hwid):
        return _bluetooth_port(entry)
    product = " ".join(dict.fromkeys(part for part in (entry.manufacturer, entry.product) if part))
    described = "" if entry.description in (*_NO_NAME, entry.device) else entry.description
    plain = entry.device.rpartition("/")[2]
    named = product or ("" if described == plain else described) or "serial port"
    sensor_id = ""
    if entry.vid is not None and entry.pid is not None and entry.serial_number:
        sensor_id = f"usb-{entry.vid:04X}:{entry.pid:04X}-{entry.serial_number}"
    name = named if plain in named else f"{named} ({plain})"
    return SystemPort(entry.device, name, sensor_id)


def _bluetooth_port(entry: PortEntry) -> SystemPort:
    address, plain = entry.address, entry.device.rpartition("/")[2]
    named = entry.bluetooth_name or (f"Bluetooth {address}" if address else "Bluetooth port")
    return SystemPort(
        url=entry.device,
        name=f"{named} ({plain})",
        sensor_id=f"bt-{address}" if address else "",
        is_bluetooth=True,
        address=address,
    )


def _system_entries() -> Iterable[ListPortInfo]:
    found: Iterable[ListPortInfo] = list_ports.comports()
    return found


class PortList:
    """Asks the system for its ports; names of Bluetooth devices are asked for once each.

    Owned by one thread, which may wait for the system: never the window's.

    Args:
        entries: Lists what pyserial's ``comports`` lists.
        ask_device: What the system knows of a Bluetooth device.
        ask_address: Whom a Linux Bluetooth port leads to.
    """

    def __init__(
        self,
        entries: Callable[[], Iterable[ListPortInfo]] = _system_entries,
        ask_device: Callable[[str], BluetoothDevice] = bluetooth.ask_device,
        ask_address: Callable[[str], str] = bluetooth.ask_rfcomm_address,
    ) -> None:
        self._entries, self._ask_device, self._ask_address = entries, ask_device, ask_address
        self._names: dict[str, str] = {}

    def look(self) -> tuple[SystemPort, ...]:
        """All ports there are now, in the order of their names."""
        try:
            found = [port_of(self._entry(listed)) for listed in self._entries()]
        except (OSError, TypeError, ValueError):
            # pyserial reads numbers from the files of a device that has just gone (3.5,
            # list_ports_linux.py); the next look is soon.
            return ()
        return tuple(sorted(found, key=lambda port: (not port.is_bluetooth, port.name)))

    def _entry(self, listed: ListPortInfo) -> PortEntry:
        device, hwid = str(listed.device), str(listed.hwid or "")
        address = ""
        if is_bluetooth(device, hwid):
            address = bluetooth.address_of_hwid(hwid) or self._ask_address(device)
        return PortEntry(
            device=device,
            description=str(listed.description or ""),
            hwid=hwid,
            vid=listed.vid,
            pid=listed.pid,
            serial_number=str(listed.serial_number or ""),
            manufacturer=str(listed.manufacturer or ""),
            product=str(listed.product or ""),
            address=address,
            bluetooth_name=self._name(address) if address else "",
        )

    def _name(self, address: str) -> str:
        """Asked again as long as the system does not know it: it may come with the pairing."""
        if not self._names.get(address):
            self._names[address] = self._ask_device(address).name
        return self._names[address]
