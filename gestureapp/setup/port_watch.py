"""Looks at the ports of this machine from time to time, and at why one gives no data."""

from collections.abc import Callable
from typing import Final

from gestureapp.sensing.port_list import PortList, SystemPort
from gestureapp.sensing.ports import is_same_port
from gestureapp.sensing.values import LinkState, Side, StreamHealth
from gestureapp.setup.advice import PortFacts, advise, advise_same, gather, trouble_of
from gestureapp.setup.values import PortChoice

LOOK_S: Final = 2.0
"""A receiver that is plugged in is listed within this."""

Gather = Callable[[str, StreamHealth, SystemPort | None], PortFacts]


class PortWatch:
    """Ports and advice as of the last look. Owned by one thread, which may wait for the system.

    Args:
        ports: Asks the system.
        gather: Finds out what keeps a port from giving data.

    Attributes:
        advice: What to try, for each arm's sensor.
    """

    def __init__(self, ports: PortList | None = None, gather: Gather = gather) -> None:
        self._list, self._gather = ports or PortList(), gather
        self._found: dict[str, SystemPort] = {}
        self._troubles: dict[str, str] = {}
        self._looked_s = float("-inf")
        self._links: dict[Side, tuple[str, str]] = {}
        self.advice: dict[Side, tuple[str, ...]] = dict.fromkeys(Side, ())

    def look(
        self, now_s: float, streams: dict[Side, tuple[str, StreamHealth]], *, is_open: bool
    ) -> None:
        """Look if it is time: every ``LOOK_S`` while somebody watches, else when something changed.

        Args:
            now_s: Monotonic clock.
            streams: Port and health of each arm's sensor.
            is_open: Somebody watches.
        """
        links = {
            side: (url, health.reason if health.link is LinkState.NOT_CONNECTED else "")
            for side, (url, health) in streams.items()
        }
        has_changed, self._links = links != self._links, links
        is_due = is_open and now_s - self._looked_s >= LOOK_S
        if not is_due and not has_changed:
            return
        self._looked_s = now_s
        self._found = {port.url: port for port in self._list.look()}
        self._troubles = {url: trouble_of(url) for url in self._found}
        if is_open:
            for side, (url, health) in streams.items():
                other = Side.RIGHT if side is Side.LEFT else Side.LEFT
                if url and is_same_port(url, streams[other][0]):
                    self.advice[side] = advise_same(other, health)
                else:
                    self.advice[side] = advise(self._gather(url, health, self._found.get(url)))

    def port(self, url: str) -> SystemPort | None:
        """A port as the system lists it; None when it does not, or not now."""
        return self._found.get(url)

    def choices(self, chosen: tuple[str, ...]) -> tuple[PortChoice, ...]:
        """For the window: all that are listed, and those that are chosen without being listed."""
        listed = [
            PortChoice(url, port.name, port.sensor_id, port.is_bluetooth, self._troubles[url])
            for url, port in self._found.items()
        ]
        typed = dict.fromkeys(url for url in chosen if url and url not in self._found)
        return (*listed, *(PortChoice(url, url) for url in typed))

    def free(self, chosen: tuple[str, ...]) -> tuple[PortChoice, ...]:
        """Those that this cell does not read and that this user may open."""
        free = [port for port in self.choices(()) if port.url not in chosen and not port.trouble]
        return tuple(free)
