"""Every fault of the matrix, once, on the real application, its guardian and real emulators.

The robot's motion and the bytes that stopped it are read from the emulated controller's log. How
soon they came is a figure of ``gestureapp benchmark faults``, no test.
"""

import sys

import pytest

from gestureapp.benchmark.faults.rig import Rig
from gestureapp.benchmark.faults.scenario import Scenario, try_fault
from gestureapp.benchmark.faults.scenarios import SCENARIOS

pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(
        not sys.platform.startswith("linux"), reason="stops processes as Linux does"
    ),
]


@pytest.mark.parametrize("scenario", SCENARIOS, ids=lambda scenario: scenario.name)
def test_the_robot_stands_the_reason_is_told_and_it_moves_again_after(rig: Rig, scenario: Scenario):
    outcome = try_fault(rig, scenario)
    assert outcome.problems == ()
    assert outcome.hold_ms is not None
