"""A robot's address: is it this machine, and one word for it however it is written. Pure."""

import ipaddress


def is_loopback(host: str) -> bool:
    """Whether this is an IP address of this very machine. A name is not: it could mean any."""
    address = _parsed(host)
    return address is not None and address.is_loopback


def address_word(host: str, port: int) -> str:
    """One word for an address, the same for all ways to write it, of plain characters only."""
    address = _parsed("127.0.0.1" if host == "localhost" else host)
    word = f"{host if address is None else address}-{port}"
    return "".join(c if (c.isascii() and c.isalnum()) or c in ".-" else "_" for c in word)[:80]


def _parsed(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return None
    return getattr(address, "ipv4_mapped", None) or address
