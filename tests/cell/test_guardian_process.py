"""The spare guardian: ready, replaced when it has died, and never left behind."""

from collections.abc import Iterator

import pytest

from gestureapp.cell.guardian_process import SpareGuardian, close_pipes

pytestmark = pytest.mark.process

LIMIT_S = 10.0


@pytest.fixture
def spare() -> Iterator[SpareGuardian]:
    kept = SpareGuardian()
    yield kept
    kept.close()


def ended(process):
    close_pipes(process)
    return process.wait(LIMIT_S)


def test_the_one_that_waits_is_taken_and_ends_in_order_when_nobody_can_start_it_any_more(spare):
    spare.prepare()
    spare.prepare()
    first, second = spare.take(), spare.take()
    assert first.pid != second.pid
    assert (ended(first), ended(second)) == (0, 0)


def test_one_that_has_died_while_waiting_is_not_handed_out(spare):
    spare.prepare()
    dead = spare.take()
    dead.kill()
    dead.wait(LIMIT_S)
    spare._process = dead
    living = spare.take()
    assert living.poll() is None
    assert (ended(living), living.pid == dead.pid) == (0, False)
    close_pipes(dead)


def test_closing_ends_the_one_that_waits_and_nothing_is_prepared_after_it(spare):
    spare.prepare()
    waiting = spare._process
    spare.close()
    assert waiting.returncode == 0
    spare.prepare()
    assert spare._process is None
