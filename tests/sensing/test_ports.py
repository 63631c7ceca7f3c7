"""Opening, reading and losing real ports: pseudo terminals, TCP, pyserial's loop."""

import errno
import os
import socket
import sys

import pytest
import serial

from gestureapp.errors import SensorBusy, SensorDisconnected, SensorError, SensorNotFound
from gestureapp.sensing.ports import DevicePort, Port, is_same_port, open_failure, open_port

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo terminals")


def read_all(port: Port, n_bytes: int) -> bytes:
    """Read until so many bytes are there; gives up after some empty reads."""
    data, n_empty = b"", 0
    while len(data) < n_bytes and n_empty < 50:
        piece = port.read()
        data += piece
        n_empty += not piece
    return data


@pytest.fixture
def server():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        listener.settimeout(5)
        yield listener


def url_of(listener: socket.socket) -> str:
    host, port = listener.getsockname()
    return f"socket://{host}:{port}"


def test_tcp_gives_what_was_sent_from_the_first_byte(server: socket.socket):
    port = open_port("left", url_of(server))
    peer, _ = server.accept()
    with peer:
        peer.sendall(b"0,0,1\n" * 300)
        assert read_all(port, 1800) == b"0,0,1\n" * 300
        assert port.read() == b""
    port.close()


def test_tcp_tells_the_end_of_the_stream(server: socket.socket):
    port = open_port("left", url_of(server))
    server.accept()[0].close()
    with pytest.raises(SensorDisconnected, match="lost: switch the sensor on"):
        read_all(port, 1)
    port.close()


def test_tcp_tells_a_reset_connection(server: socket.socket):
    port = open_port("left", url_of(server))
    peer, _ = server.accept()
    linger_off = b"\x01\x00\x00\x00\x00\x00\x00\x00"
    peer.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, linger_off)
    peer.close()
    with pytest.raises(SensorDisconnected, match="lost"):
        read_all(port, 1)
    port.close()


def test_tcp_does_not_wait_to_gather_small_packets(server: socket.socket):
    port = open_port("left", url_of(server))
    assert port._socket.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)  # type: ignore[attr-defined]
    port.close()


def test_nobody_answers_names_address_and_remedy(server: socket.socket):
    url = url_of(server)
    server.close()
    with pytest.raises(SensorNotFound) as caught:
        open_port("left", url)
    assert caught.value.reason == (
        f"nobody answers at {url[9:]}: switch the sensor on, or check the address"
    )
    assert str(caught.value).startswith("left sensor: nobody answers")


@pytest.mark.parametrize(
    "url", ["socket://", "socket://host", "socket://host:0", "socket://h:99999", "socket://[::1:3"]
)
def test_an_address_that_is_none_says_what_one_looks_like(url: str):
    with pytest.raises(SensorNotFound, match=r"give socket://HOST:PORT"):
        open_port("right", url)


def test_a_host_name_that_no_host_can_have_is_no_crash():
    with pytest.raises(SensorError, match="socket://HOST:PORT"):
        open_port("right", f"socket://{'x' * 80}.example:1")


@pytest.mark.parametrize("url", ["", "  "])
def test_no_port_set_says_so(url: str):
    with pytest.raises(SensorNotFound, match="no port is set: choose one"):
        open_port("left", url)


def test_an_unknown_kind_of_url_is_no_port():
    with pytest.raises(SensorError, match="is no port: give a device or socket://HOST:PORT"):
        open_port("left", "carrier-pigeon://roof")


@pytest.mark.parametrize("url", ["loop://?logging=abc", "loop://?x=1", "hwgrep://[", "hwgrep://("])
def test_a_url_with_a_mistake_in_it_is_no_port(url: str):
    with pytest.raises(SensorError, match="is no port: give a device or socket://HOST:PORT"):
        open_port("left", url)


def test_loop_gives_what_was_written():
    port = open_port("left", "loop://")
    assert isinstance(port, DevicePort)
    port.serial.write(b"1,0,0,1\n")
    assert read_all(port, 8) == b"1,0,0,1\n"
    port.close()


@posix_only
def test_a_device_that_is_not_there_is_not_found():
    with pytest.raises(SensorNotFound, match="port /dev/rfcomm77 not found: plug the receiver in"):
        open_port("left", "/dev/rfcomm77")


@posix_only
def test_a_file_that_is_no_device_cannot_be_opened(tmp_path):
    file = tmp_path / "notes.txt"
    file.write_text("no device")
    with pytest.raises(SensorError, match=r"notes.txt cannot be opened"):
        open_port("left", str(file))


@posix_only
def test_a_device_is_read_and_its_loss_told():
    master, slave = os.openpty()
    port = open_port("left", os.ttyname(slave))
    os.close(slave)
    os.write(master, b"1,0,0,1\r\n2,0,0,1\r\n")
    assert read_all(port, 18) == b"1,0,0,1\r\n2,0,0,1\r\n"
    os.close(master)
    with pytest.raises(SensorDisconnected, match="is gone: plug the receiver in"):
        read_all(port, 1)
    port.close()


@posix_only
def test_a_device_that_another_program_reads_is_busy():
    master, slave = os.openpty()
    busy = pytest.raises(SensorBusy, match="in use by another program: close that program")
    with serial.Serial(os.ttyname(slave), exclusive=True), busy:
        open_port("left", os.ttyname(slave))
    open_port("left", os.ttyname(slave)).close()
    os.close(master)
    os.close(slave)


def test_reading_a_closed_port_is_a_loss_not_a_crash():
    port = open_port("left", "loop://")
    port.close()
    port.close()
    with pytest.raises(SensorDisconnected):
        port.read()


@posix_only
@pytest.mark.parametrize(
    ("error", "kind", "words"),
    [
        (PermissionError(errno.EACCES, "x"), SensorError, "dialout"),
        (OSError(errno.EBUSY, "x"), SensorBusy, "in use by another program"),
        (OSError(errno.EHOSTDOWN, "x"), SensorNotFound, "nobody answers"),
        (OSError(errno.EHOSTUNREACH, "x"), SensorNotFound, "nobody answers"),
        (TimeoutError("timed out"), SensorNotFound, "nobody answers"),
        (socket.gaierror(-2, "x"), SensorNotFound, "no host has this name"),
        (OSError(errno.ENXIO, "x"), SensorNotFound, "not found"),
        (OSError("FileNotFoundError(2, 'x')"), SensorNotFound, "not found"),
        (OSError("something new"), SensorError, "cannot be opened"),
    ],
)
def test_a_failure_is_told_by_its_cause(error: Exception, kind: type[SensorError], words: str):
    failure = open_failure("left", "COM3", error)
    assert type(failure) is kind
    assert words in failure.reason
    assert "COM3" in failure.reason
    assert "\n" not in failure.reason


@pytest.mark.parametrize(
    ("one", "other", "is_same"),
    [
        ("/dev/ttyUSB0", "/dev/ttyUSB0", True),
        ("/dev/ttyUSB0", "/dev/../dev/ttyUSB0", True),
        ("/dev/ttyUSB0", "/dev/ttyUSB1", False),
        ("socket://10.0.0.9:5001", "SOCKET://10.0.0.9:5001/", True),
        ("socket://localhost:5001", "socket://127.0.0.1:5001", True),
        ("socket://10.0.0.9:5001", "socket://10.0.0.9:5002", False),
        ("/dev/\0a", "/dev/\0b", False),
        ("", "", False),
        ("loop://", "loop://", False),
    ],
)
@posix_only
def test_two_texts_may_mean_one_port(one: str, other: str, is_same: bool):
    assert is_same_port(one, other) is is_same
    assert is_same_port(other, one) is is_same


@posix_only
def test_a_link_to_a_device_is_that_device(tmp_path):
    (tmp_path / "by-id").symlink_to("/dev/ttyUSB0")
    assert is_same_port(str(tmp_path / "by-id"), "/dev/ttyUSB0")
