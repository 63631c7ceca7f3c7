"""The ladder of the emulated controller stops the robot when everybody else is gone."""

import os
import signal

import pytest

from gestureapp.robot import messages as m
from gestureapp.simulation.nx100_log import What
from gestureapp.simulation.nx100_options import Nx100Options
from gestureapp.simulation.nx100_values import ControllerOptions

pytestmark = [pytest.mark.process, pytest.mark.skipif(os.name == "nt", reason="signals")]

LADDER_S = 0.5
BRAKING_S = 0.1
"""From 100 mm/s at 1000 mm/s^2."""
INPUT = 22010


def edges_s(emulator):
    """When the input changed, by the emulator's log."""
    writes = emulator.log.requests("IOWRITE")
    return [
        b.t_s for a, b in zip([None, *writes], writes, strict=False) if not a or a.text != b.text
    ]


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP])
def test_without_guardian_and_application_the_ladder_holds_and_the_way_back_is_free(start, how):
    started, application = start
    cell = ControllerOptions(ladder_s=LADDER_S)
    emulator, guardian = started(Nx100Options(controller=cell), supervision_input=INPUT)
    app = application(guardian)
    app.wait_for(m.StatusReport)
    assert emulator.log.wait_for(lambda e: e.what is What.REQUEST and e.name == "IOWRITE")
    app.move(emulator)
    os.kill(guardian.child.pid, how)
    app.close()
    assert emulator.log.wait_for(lambda e: e.what is What.MOTION_END)

    (end,) = emulator.log.events(What.MOTION_END)
    assert end.name == "hold"
    assert end.t_s <= edges_s(emulator)[-1] + LADDER_S + BRAKING_S + 1e-6
    assert emulator.log.requests("HOLD") == []

    guardian.close()
    _, second = started(port=emulator.port, supervision_input=INPUT)
    again = application(second)
    again.wait_for(
        m.StatusReport, lambda x: x.data_2 & 0x0C == 0x08
    )  # ours, no longer the ladder's
    again.move(emulator)
    held = [e for e in emulator.log.requests() if e.t_s > end.t_s and e.name in ("HOLD", "IOWRITE")]
    assert (held[0].name, held[0].text) == ("HOLD", "1")
