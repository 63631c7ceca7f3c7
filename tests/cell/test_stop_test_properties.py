"""Whatever happens in whatever order, what must hold of a stop test holds."""

from hypothesis import given

from gestureapp.cell import events as e
from gestureapp.cell.machine_state import Rules
from gestureapp.cell.snapshot import CellState
from gestureapp.gestures import LABELS
from gestureapp.sensing.values import ArmPosture
from tests.cell.test_machine_properties import LIFE, RULES, Happening, live, sent

S = CellState


@given(LIFE, RULES)
def test_a_stop_test_moves_once_its_own_way_with_the_left_arm_at_rest(
    life: list[Happening], rules: Rules
):
    label, n_moves = "", 0
    for lived in live(life, rules).steps:
        if lived.after.test and not lived.before.test:
            assert isinstance(lived.event, e.StopTestPressed)
            label, n_moves = lived.event.label, 0
        for proposal in sent(lived, e.SendProposal):
            assert proposal.is_test == bool(lived.before.test)
            if proposal.is_test:
                n_moves += 1
                assert lived.before.state is S.ARMED
                assert lived.after.posture is ArmPosture.STOP
                assert proposal.label == label == lived.before.test
                assert label in LABELS[:6]
        assert n_moves <= 1


@given(LIFE, RULES)
def test_nobody_is_armed_after_a_stop_test(life: list[Happening], rules: Rules):
    for lived in live(life, rules).steps:
        if lived.before.test and not lived.after.test:
            assert lived.after.is_at_rest
            assert not lived.after.has_permission
            assert not lived.after.is_arming
        if lived.before.test and lived.after.test:
            assert lived.after.test == lived.before.test


@given(LIFE, RULES)
def test_a_stop_test_that_goes_with_the_permission_gives_it_back(
    life: list[Happening], rules: Rules
):
    """Either the guardian was told, or it has taken the permission itself, or it stops, latched."""
    for lived in live(life, rules).steps:
        if lived.before.test and lived.before.has_permission and not lived.after.test:
            told = sent(lived, e.SendDisarm)
            latched = lived.before.stop_reason is not None and lived.before.stop_reason.is_latched
            assert told or latched or isinstance(lived.event, e.PermissionLost)
