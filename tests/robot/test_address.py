"""Addresses: this machine or another, and one word for each."""

import ipaddress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gestureapp.robot import messages as m
from gestureapp.robot.address import address_word, is_loopback

ELSEWHERE = ["192.0.2.10", "0.0.0.0", "::", "fe80::1%eth0", "::ffff:192.0.2.10", "128.0.0.1"]
NO_ADDRESS = ["localhost", "robot", "127.0.0.1.example.org", "127.1", "", "127.0.0.01", "a..b"]


@pytest.mark.parametrize("host", ["127.0.0.1", "127.255.0.3", "::1", "0:0:0:0:0:0:0:1"])
def test_an_address_of_this_machine_is_known(host):
    assert is_loopback(host)


@pytest.mark.parametrize("host", ELSEWHERE + NO_ADDRESS)
def test_anything_else_is_not_this_machine(host):
    assert not is_loopback(host)


@given(st.ip_addresses(v=4))
def test_of_the_old_addresses_a_256th_is_this_machine(address):
    assert is_loopback(str(address)) == (address.packed[0] == 127)


@given(st.ip_addresses())
def test_an_address_has_one_word_however_it_is_written(address):
    words = {address_word(text, 80) for text in (str(address), address.exploded)}
    if isinstance(address, ipaddress.IPv4Address):
        words.add(address_word(f"::ffff:{address}", 80))
    assert len(words) == 1
    assert words.isdisjoint({address_word(str(address), 81)})


@given(st.text(), st.integers(-10, 70000))
def test_the_word_is_short_and_plain_whatever_is_given(host, port):
    word = address_word(host, port)
    assert 0 < len(word) <= 80
    assert word.isascii()
    assert set(word) <= set("_.-") | {c for c in word if c.isalnum()}


def test_the_name_of_this_machine_is_its_address():
    assert address_word("localhost", 80) == address_word("127.0.0.1", 80)


@pytest.mark.parametrize("host", [*ELSEWHERE, "localhost", "robot"])
def test_a_simulation_cannot_even_be_started_with_another_address(host, limits):
    with pytest.raises(ValueError, match="not this machine"):
        m.Start("t", host, 80, limits, "", is_simulation=True)
    line = m.encode(m.Start("t", host, 80, limits, ""))
    assert m.decode(line) is not None
    assert m.decode(line.replace(b'"is_simulation": false', b'"is_simulation": true')) is None


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", ""])
def test_a_simulation_is_started_with_an_address_of_this_machine_or_none(host, limits):
    start = m.Start("t", host, 80, limits, "", is_simulation=True)
    assert m.decode(m.encode(start)) == start
