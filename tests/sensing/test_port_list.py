"""Ports with names a person knows, from what systems really answered."""

from types import SimpleNamespace

import pytest

from gestureapp.sensing import bluetooth
from gestureapp.sensing.bluetooth import BluetoothDevice
from gestureapp.sensing.port_list import PortEntry, PortList, SystemPort, port_of

HWID = r"BTHENUM\{00001101-0000-1000-8000-00805F9B34FB}_LOCALMFG&0000\7&1A2B3C4D&0&%s_C00000000"

INFO = """Device 00:06:66:AA:BB:CC (public)
	Name: RNBT-BBCC
	Alias: left wrist
	Class: 0x00001f00
	Paired: yes
	Trusted: no
	Connected: no
"""

SHOW = """Controller 5C:F3:70:00:11:22 (public)
	Name: cell
	Powered: %s
	Discoverable: no
"""


def listed(**known: object) -> SimpleNamespace:
    """An entry of pyserial's ``comports``."""
    empty = dict.fromkeys(("vid", "pid", "serial_number", "manufacturer", "product"))
    return SimpleNamespace(**{"description": "n/a", "hwid": "n/a"} | empty | known)


def test_a_usb_port_is_called_by_its_product_and_known_by_its_serial_number():
    port = port_of(
        PortEntry(
            "/dev/ttyUSB0",
            "FT232R USB UART",
            vid=0x403,
            pid=0x6001,
            serial_number="A50285BI",
            manufacturer="FTDI",
            product="FT232R USB UART",
        )
    )
    assert port == SystemPort(
        "/dev/ttyUSB0", "FTDI FT232R USB UART (ttyUSB0)", "usb-0403:6001-A50285BI"
    )


def test_a_usb_port_without_a_serial_number_has_no_id_that_stays():
    port = port_of(PortEntry("COM7", "USB-SERIAL CH340 (COM7)", vid=0x1A86, pid=0x7523))
    assert port == SystemPort("COM7", "USB-SERIAL CH340 (COM7)")


def test_a_plain_port_is_a_serial_port():
    assert port_of(PortEntry("/dev/ttyS0", "ttyS0")).name == "serial port (ttyS0)"
    assert port_of(PortEntry("/dev/ttyS0", "n/a")).name == "serial port (ttyS0)"


def test_a_linux_bluetooth_port_has_its_device_s_name():
    asked: list[str] = []

    def ask_device(address: str) -> BluetoothDevice:
        asked.append(address)
        return BluetoothDevice("left wrist", is_paired=True)

    ports = PortList(
        lambda: [listed(device="/dev/rfcomm0"), listed(device="/dev/ttyS0")],
        ask_device,
        lambda device: "00:06:66:AA:BB:CC" if device == "/dev/rfcomm0" else "",
    )
    found = ports.look()
    assert found[0] == SystemPort(
        url="/dev/rfcomm0",
        name="left wrist (rfcomm0)",
        sensor_id="bt-00:06:66:AA:BB:CC",
        is_bluetooth=True,
        address="00:06:66:AA:BB:CC",
    )
    ports.look()
    assert asked == ["00:06:66:AA:BB:CC"]  # once a device: the system takes its time


def test_a_name_that_is_not_known_yet_is_asked_for_again():
    names = iter(["", "left wrist"])
    ports = PortList(
        lambda: [listed(device="/dev/rfcomm0")],
        lambda address: BluetoothDevice(next(names)),
        lambda device: "00:06:66:AA:BB:CC",
    )
    assert ports.look()[0].name == "Bluetooth 00:06:66:AA:BB:CC (rfcomm0)"
    assert ports.look()[0].name == "left wrist (rfcomm0)"


def test_a_windows_bluetooth_port_is_known_by_the_address_in_its_hardware_id():
    ports = PortList(
        lambda: [listed(device="COM5", hwid=HWID % "000666AABBCC")],
        lambda address: BluetoothDevice("RNBT-BBCC", is_paired=True),
        lambda device: "",
    )
    port = ports.look()[0]
    assert (port.name, port.sensor_id) == ("RNBT-BBCC (COM5)", "bt-00:06:66:AA:BB:CC")


def test_a_windows_port_that_waits_for_calls_leads_to_nobody():
    assert bluetooth.address_of_hwid(HWID % "000000000000") == ""
    assert bluetooth.address_of_hwid("USB VID:PID=0403:6001 SER=A50285BI") == ""


def test_what_bluez_says_of_a_device_is_read():
    assert bluetooth.parse_device(INFO) == BluetoothDevice("left wrist", is_paired=True)
    unpaired = INFO.replace("Paired: yes", "Paired: no")
    assert bluetooth.parse_device(unpaired).is_paired is False
    missing = "Device 00:06:66:AA:BB:CC not available\n"
    assert bluetooth.parse_device(missing) == BluetoothDevice(is_paired=False)
    assert bluetooth.parse_device("") == BluetoothDevice()


@pytest.mark.parametrize(
    ("answer", "powered"),
    [
        (SHOW % "yes", True),
        (SHOW % "no", False),
        ("No default controller available\n", False),
        ("", None),
    ],
)
def test_what_bluez_says_of_the_adapter_is_read(answer: str, powered: bool | None):
    assert bluetooth.parse_powered(answer) is powered


def test_a_name_in_the_windows_registry_ends_with_a_zero():
    assert bluetooth.parse_registry_name("Wächter".encode() + b"\0") == "Wächter"
    assert bluetooth.parse_registry_name(None) == ""


def test_a_system_without_any_of_this_says_nothing(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("PATH", "")
    assert bluetooth.ask_powered() is None
    assert bluetooth.ask_device("00:06:66:AA:BB:CC") == BluetoothDevice()
    assert bluetooth.ask_rfcomm_address("/dev/rfcomm0") == ""


def test_this_machine_can_be_asked():
    for port in PortList().look():
        assert port.url
        assert port.name


@pytest.mark.parametrize("error", [OSError("gone"), TypeError("int(None)"), ValueError("")])
def test_a_device_that_goes_while_it_is_asked_about_costs_one_look(error: Exception):
    def entries() -> list[SimpleNamespace]:
        raise error

    assert PortList(entries).look() == ()
