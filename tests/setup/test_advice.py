"""What to try while nothing comes: by cause, in the order of likelihood."""

import os
import pty
from dataclasses import replace
from pathlib import Path

import pytest

from gestureapp.sensing.bluetooth import BluetoothDevice
from gestureapp.sensing.port_list import SystemPort
from gestureapp.sensing.values import LinkState
from gestureapp.setup.advice import PortFacts, advise, gather, trouble_of
from tests.setup.streams import health_of

RFCOMM = PortFacts(
    "/dev/rfcomm0",
    LinkState.NOT_CONNECTED,
    "nobody answers at /dev/rfcomm0",
    is_bluetooth=True,
    is_powered=True,
    is_paired=True,
    exists=True,
    is_allowed=True,
    group="dialout",
)


@pytest.mark.parametrize(
    ("changes", "first"),
    [
        ({"is_powered": False, "is_paired": False}, "Bluetooth is off"),
        ({"is_paired": False}, "Not paired"),
        ({"reason": "/dev/rfcomm0 is in use by another program: close it"}, "In use by another"),
        ({"is_allowed": False}, "No permission: add the user to the group dialout"),
        ({"exists": False}, "/dev/rfcomm0 is not there: bind the sensor"),
        ({}, "Out of range or off"),
    ],
)
def test_a_known_cause_is_named_and_nothing_after_it(changes: dict[str, object], first: str):
    lines = advise(replace(RFCOMM, **changes))
    assert len(lines) == 1
    assert lines[0].startswith(first)


def test_what_nobody_knows_is_asked_in_the_same_order():
    lines = advise(replace(RFCOMM, is_powered=None, is_paired=None))
    assert [line[:12] for line in lines] == ["Is Bluetooth", "Is it paired", "Out of range"]


def test_a_cable_is_not_told_of_bluetooth():
    lines = advise(PortFacts("/dev/ttyUSB0", LinkState.NOT_CONNECTED, exists=False))
    assert lines == ("/dev/ttyUSB0 is not there: plug the receiver in, or choose another port.",)


def test_wrong_data_and_silence_and_no_port_are_told_apart():
    assert advise(replace(RFCOMM, link=LinkState.RECEIVING)) == ()
    assert "another protocol" in advise(replace(RFCOMM, link=LinkState.WRONG_DATA))[0]
    frozen = replace(RFCOMM, link=LinkState.WRONG_DATA, reason="frozen on one value for 9 s")
    assert advise(frozen) == ("The sensor sends one value only: switch it off and on.",)
    assert "Out of range" in advise(replace(RFCOMM, link=LinkState.NO_DATA))[0]
    assert "No port is chosen" in advise(PortFacts("", LinkState.NOT_CONNECTED))[0]


def test_an_address_says_what_its_reader_says():
    reason = "nobody answers at 10.0.0.9:5000: switch the sensor on, or check the address"
    facts = gather("socket://10.0.0.9:5000", health_of(LinkState.NOT_CONNECTED, reason), None)
    assert advise(facts) == (
        "Nobody answers at 10.0.0.9:5000: switch the sensor on, or check the address.",
    )


def test_facts_of_a_device_come_from_its_file(tmp_path: Path):
    missing = gather(str(tmp_path / "ttyUSB9"), health_of(LinkState.NOT_CONNECTED), None)
    assert missing.exists is False
    master, slave = pty.openpty()
    try:
        url = os.ttyname(slave)
        facts = gather(url, health_of(LinkState.NO_DATA), None)
        assert (facts.exists, facts.is_allowed) == (True, True)
        assert facts.group == Path(url).group()
        assert trouble_of(url) == ""
    finally:
        os.close(master)
        os.close(slave)


def test_a_port_that_may_not_be_opened_names_the_group_to_join(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    port = tmp_path / "ttyUSB0"
    port.touch()
    monkeypatch.setattr(os, "access", lambda *_: False)  # root, as in many test machines, may all
    assert trouble_of(str(port)) == f"no permission: join the group {port.group()}"
    facts = gather(str(port), health_of(LinkState.NOT_CONNECTED), None)
    assert advise(facts) == (
        f"No permission: add the user to the group {port.group()} "
        f"(sudo adduser $USER {port.group()}), then log in again.",
    )


def test_the_device_is_asked_about_only_while_bluetooth_is_on():
    asked: list[str] = []

    def ask_device(address: str) -> BluetoothDevice:
        asked.append(address)
        return BluetoothDevice(is_paired=False)

    port = SystemPort("/dev/rfcomm0", "x", "bt-x", is_bluetooth=True, address="00:06:66:AA:BB:CC")
    health = health_of(LinkState.NOT_CONNECTED)
    off = gather("/dev/rfcomm0", health, port, lambda: False, ask_device)
    assert (off.is_powered, off.is_paired, asked) == (False, None, [])
    on = gather("/dev/rfcomm0", health, port, lambda: True, ask_device)
    assert (on.is_paired, asked) == (False, ["00:06:66:AA:BB:CC"])


@pytest.mark.parametrize("url", ["/dev/\0a", "/dev/" + "a" * 300, "/dev/\ud800", "a" * 5000])
def test_a_text_that_can_be_no_file_is_a_port_that_is_not_there(url: str):
    assert trouble_of(url) == ""
    facts = gather(url, health_of(LinkState.NOT_CONNECTED), None)
    assert facts.exists is False
    assert "is not there" in advise(facts)[0]
