"""Whatever happens in whatever order, what must hold of the machine holds."""

from dataclasses import dataclass, field

from hypothesis import given, settings
from hypothesis import strategies as st

from gestureapp.cell import events as e
from gestureapp.cell.machine import step
from gestureapp.cell.machine_state import MachineState, Rules, Step
from gestureapp.cell.snapshot import Blocker, CellState
from gestureapp.config import DriveMode
from gestureapp.gestures import LABELS
from gestureapp.robot.values import StopReason
from gestureapp.sensing.values import ArmPosture, Side

S = CellState
BLOCKER = Blocker("servo", "servo power is off", "press Servo on")
SETUP = Blocker("setup", "setup is open", "go back to Operate")
PERMITTED = (S.ARMED, S.ACTIVATED, S.MOVING)


@dataclass(frozen=True)
class Happening:
    """Something that happens; which activation it is about is told from the newest one."""

    kind: str
    delay_s: float = 0.01
    id_offset: int = 0
    posture: ArmPosture = ArmPosture.STOP
    side: Side = Side.LEFT
    label: str | None = None
    reason: StopReason = StopReason.LEFT_ARM
    is_blocked: bool = False
    is_setup: bool = False

    def event(self, s: MachineState, t_s: float) -> e.Event:
        activation_id = s.activation_id + self.id_offset
        against = (BLOCKER, SETUP) if self.is_blocked else (SETUP,) if self.is_setup else ()
        made: dict[str, e.Event] = {
            "tick": e.Ticked(t_s, against),
            "posture": e.LeftPosture(t_s, self.posture),
            "lost": e.StreamLost(t_s, self.side, "no data"),
            "arm": e.ArmPressed(t_s),
            "disarm": e.DisarmPressed(t_s),
            "stop": e.StopPressed(t_s),
            "decided": e.Decided(t_s, activation_id, self.label, "text"),
            "taken": e.ArmTaken(t_s),
            "denied": e.ArmDenied(t_s, "text"),
            "unarmed": e.PermissionLost(t_s),
            "accepted": e.MoveAccepted(t_s, activation_id),
            "refused": e.MoveRefused(t_s, activation_id, "text"),
            "ended": e.MoveEnded(t_s, activation_id),
            "stopping": e.StopTaken(t_s, self.reason, "text"),
            "stands": e.StopDone(t_s, self.reason),
            "open": e.StopOpen(t_s, "text"),
            "gone": e.GuardianGone(t_s, "text"),
            "fault": e.Faulted(t_s, "text"),
            "stall": e.Stalled(t_s, "text"),
            "test": e.StopTestPressed(t_s, self.label or "X+"),
            "released": e.StopTestReleased(t_s),
        }
        return made[self.kind]


def _to_ready() -> list[Happening]:
    return [Happening("posture"), Happening("tick")]


def _to_armed() -> list[Happening]:
    return [Happening("arm"), Happening("taken")]


def _to_moving(label: str = "X+") -> list[Happening]:
    start = Happening("posture", posture=ArmPosture.START)
    return [start, Happening("decided", label=label), Happening("accepted")]


def _to_test_moving(label: str = "Y-") -> list[Happening]:
    before = [Happening("posture"), Happening("tick", is_setup=True)]
    armed = [Happening("test", label=label), Happening("taken")]
    return [*before, *armed, Happening("tick", 0.6, is_setup=True), Happening("accepted")]


def _stretch(happenings: list[Happening]) -> st.SearchStrategy[list[Happening]]:
    return st.just(happenings)


ANYTHING = st.builds(
    Happening,
    kind=st.sampled_from(
        (
            *("tick", "posture", "lost", "arm", "disarm", "stop", "decided", "taken", "denied"),
            *("unarmed", "accepted", "refused", "ended", "stopping", "stands", "open", "gone"),
            "fault",
            "stall",
            "test",
            "released",
        )
    ),
    delay_s=st.sampled_from((0.0, 0.01, 0.2, 1.1, 3.5)),
    id_offset=st.sampled_from((0, 0, 0, 0, -1, 1)),
    posture=st.sampled_from(ArmPosture),
    side=st.sampled_from(Side),
    label=st.sampled_from((*LABELS, None)),
    reason=st.sampled_from(StopReason),
    is_blocked=st.booleans(),
    is_setup=st.booleans(),
)
LIFE = st.lists(
    st.one_of(
        st.lists(ANYTHING, max_size=3),
        _stretch(_to_ready()),
        _stretch(_to_armed()),
        _stretch(_to_moving()),
        _stretch([*_to_ready(), *_to_armed(), *_to_moving()]),
        _stretch(_to_test_moving()),
        _stretch(_to_test_moving()[:4]),
        _stretch([Happening("stopping"), Happening("stands"), Happening("posture")]),
    ),
    max_size=12,
).map(lambda parts: [h for part in parts for h in part])
"""Pure chance hardly ever moves the robot, so stretches of what usually happens are mixed in."""

RULES = st.builds(Rules, drive_mode=st.sampled_from(DriveMode), stop_on_right_lost=st.booleans())


@dataclass
class Lived:
    """One step of a life: before, event, after, effects."""

    before: MachineState
    event: e.Event
    after: MachineState
    effects: tuple[e.Effect, ...]


@dataclass
class Life:
    steps: list[Lived] = field(default_factory=list)
    state: MachineState = field(default_factory=MachineState)
    t_s: float = 0.0

    def do(self, event: e.Event, rules: Rules) -> None:
        after, effects = step(self.state, event, rules)
        self.steps.append(Lived(self.state, event, after, effects))
        self.state = after


def live(happenings: list[Happening], rules: Rules) -> Life:
    life = Life()
    for happening in happenings:
        life.t_s += happening.delay_s
        life.do(happening.event(life.state, life.t_s), rules)
    return life


def sent(step_: Lived, kind: type) -> list[e.Effect]:
    return [effect for effect in step_.effects if isinstance(effect, kind)]


@given(LIFE, RULES)
def test_nothing_is_proposed_but_what_was_decided_for_this_activation(
    life: list[Happening], rules: Rules
):
    for lived in live(life, rules).steps:
        for proposal in sent(lived, e.SendProposal):
            if proposal.is_test:
                continue
            assert lived.before.state is lived.after.state is S.ACTIVATED
            assert isinstance(lived.event, e.Decided)
            assert proposal == e.SendProposal(
                lived.after.activation_id, lived.event.label, lived.event.t_s
            )
            assert lived.event.activation_id == lived.after.activation_id


@given(LIFE, RULES)
def test_one_activation_proposes_at_most_one_increment(life: list[Happening], rules: Rules):
    ids = [
        p.activation_id for lived in live(life, rules).steps for p in sent(lived, e.SendProposal)
    ]
    assert ids == sorted(set(ids))


@given(LIFE, RULES)
def test_every_way_out_of_moving_but_its_end_has_asked_for_a_stop(
    life: list[Happening], rules: Rules
):
    for lived in live(life, rules).steps:
        if lived.before.state is not S.MOVING or lived.after.state is S.MOVING:
            continue
        if isinstance(lived.event, e.MoveEnded):
            assert lived.after.state is (S.NOT_READY if lived.before.test else S.ARMED)
        else:
            assert lived.after.state is S.STOPPING
            assert sent(lived, e.SendStop) or isinstance(lived.event, e.StopTaken)


@given(LIFE, RULES)
def test_no_proposal_that_is_out_is_left_without_an_answer_or_a_stop(
    life: list[Happening], rules: Rules
):
    answers = (e.MoveAccepted, e.MoveRefused, e.MoveEnded, e.StopTaken)
    for lived in live(life, rules).steps:
        was_out = lived.before.state is S.ACTIVATED and lived.before.is_proposed
        if was_out and lived.after.state is not S.ACTIVATED:
            assert isinstance(lived.event, answers) or sent(lived, e.SendStop)


@given(LIFE, RULES)
def test_a_latched_stop_is_left_only_by_arming_again(life: list[Happening], rules: Rules):
    has_asked = False
    for lived in live(life, rules).steps:
        if lived.before.state is S.STOPPED and lived.after.state is not S.STOPPED:
            is_armed = isinstance(lived.event, e.ArmTaken) and lived.after.state is S.ARMED
            assert is_armed or lived.after.state is S.STOPPING
            assert has_asked or not is_armed
        has_asked = has_asked and lived.after.state is lived.before.state
        has_asked = has_asked or bool(sent(lived, e.SendArm))


@given(LIFE, RULES)
def test_a_latched_reason_ends_in_stopped_and_only_the_left_arms_own_in_armed(
    life: list[Happening], rules: Rules
):
    for lived in live(life, rules).steps:
        if lived.before.state is S.STOPPING and lived.after.state is not S.STOPPING:
            reason = lived.before.stop_reason
            assert isinstance(lived.event, e.StopDone)
            assert reason is not None
            is_armed = lived.before.has_permission and not reason.is_latched
            is_armed = is_armed and not lived.before.test
            assert lived.after.state is (S.ARMED if is_armed else S.STOPPED)


@given(LIFE, RULES)
def test_nothing_but_the_guardians_permission_leads_from_rest_to_armed(
    life: list[Happening], rules: Rules
):
    has_permission = False
    for lived in live(life, rules).steps:
        if isinstance(lived.event, e.PermissionLost):
            has_permission = False
        elif isinstance(lived.event, e.ArmTaken) and lived.after.state is S.ARMED:
            has_permission = True
        elif lived.after.state in (S.STOPPED, S.READY, S.NOT_READY):
            has_permission = False
        assert has_permission or lived.after.state is not S.ARMED


@given(LIFE, RULES)
def test_the_left_arm_is_seen_in_stop_between_two_activations(life: list[Happening], rules: Rules):
    is_rested = False
    for lived in live(life, rules).steps:
        if isinstance(lived.event, e.LeftPosture) and lived.event.posture is ArmPosture.STOP:
            is_rested = True
        if lived.after.activation_id != lived.before.activation_id:
            assert lived.after.activation_id == lived.before.activation_id + 1
            assert lived.before.state is S.ARMED
            if lived.before.test:
                assert lived.after.posture is ArmPosture.STOP
            else:
                assert is_rested
                is_rested = False


@given(LIFE, RULES)
def test_permission_is_only_there_after_it_was_asked_for_and_taken_with_nothing_against_it(
    life: list[Happening], rules: Rules
):
    for lived in live(life, rules).steps:
        if lived.before.is_at_rest and lived.after.state in PERMITTED:
            assert isinstance(lived.event, e.ArmTaken)
            assert lived.before.is_arming
            against = {blocker.id for blocker in lived.after.blockers}
            assert against <= ({"setup"} if lived.before.test else set())


@given(LIFE, RULES)
def test_stop_is_asked_of_the_guardian_from_every_state(life: list[Happening], rules: Rules):
    state = live(life, rules).state
    after, effects = step(state, e.StopPressed(1e3), rules)
    assert after.state is S.STOPPING
    assert after.stop_reason is not None
    assert after.stop_reason.is_latched
    assert e.SendStop(StopReason.STOP_PRESSED, "STOP was pressed") in effects


@given(LIFE, RULES)
def test_the_recogniser_is_asked_and_released_in_turn(life: list[Happening], rules: Rules):
    """An answer still wanted belongs to the newest activation, and to none outside ACTIVATED."""
    is_collecting = False
    for lived in live(life, rules).steps:
        for effect in lived.effects:
            if isinstance(effect, e.BeginCollecting):
                assert not is_collecting
                is_collecting = True
            if isinstance(effect, e.EndCollecting | e.SendProposal):
                is_collecting = False
        assert not is_collecting or lived.after.state is S.ACTIVATED


def cooperate(s: MachineState, t_s: float) -> e.Event:
    """What a patient person, a healthy cell and a guardian that answers would bring next."""
    if s.test and s.state is not S.STOPPING:
        return e.StopTestReleased(t_s)
    if s.state is S.STOPPING:
        return e.StopDone(t_s, StopReason.LEFT_ARM)
    if s.state is S.ACTIVATED:
        if s.is_proposed:
            return e.MoveRefused(t_s, s.activation_id, "text")
        return e.Decided(t_s, s.activation_id, None, "text")
    if s.state is S.MOVING:
        return e.MoveEnded(t_s, s.activation_id)
    if s.blockers or s.state is S.NOT_READY:
        return e.Ticked(t_s, ())
    return e.ArmTaken(t_s) if s.is_arming else e.ArmPressed(t_s)


@settings(max_examples=200)
@given(LIFE, RULES)
def test_from_wherever_it_is_the_cell_can_be_armed_and_activated_again(
    happenings: list[Happening], rules: Rules
):
    life = live(happenings, rules)
    for _ in range(6):
        if life.state.state is S.ARMED and not life.state.test:
            break
        life.t_s += 0.01
        life.do(cooperate(life.state, life.t_s), rules)
    assert life.state.state is S.ARMED
    life.do(e.LeftPosture(life.t_s, ArmPosture.STOP), rules)
    life.do(e.LeftPosture(life.t_s, ArmPosture.START), rules)
    assert life.state.state is S.ACTIVATED


@given(LIFE, RULES)
def test_a_guardian_that_has_forgotten_all_leaves_nothing_waiting(
    happenings: list[Happening], rules: Rules
):
    """No answer comes to what was asked: time alone, and a new stop, free the cell again."""
    life = live(happenings, rules)
    life.do(e.Ticked(life.t_s + 5.0, ()), rules)
    life.do(e.Ticked(life.t_s + 10.0, ()), rules)
    assert not life.state.is_arming
    assert life.state.state is not S.ACTIVATED


@given(LIFE, RULES)
def test_the_same_events_give_the_same_states_and_effects(life: list[Happening], rules: Rules):
    first, again = live(life, rules), MachineState()
    for lived in first.steps:
        again, effects = step(again, lived.event, rules)
        assert (again, effects) == (lived.after, lived.effects)


def test_the_mixed_lives_do_reach_every_state():
    """Else the properties above would hold of nothing."""
    happenings = [*_to_ready(), *_to_armed(), *_to_moving(), Happening("stop"), Happening("stands")]
    seen = {lived.after.state for lived in live(happenings, Rules()).steps}
    assert seen == set(CellState)


def test_a_step_is_a_state_and_its_effects():
    result: Step = step(MachineState(), e.Ticked(0.0, ()), Rules())
    assert result == (MachineState(state=S.READY), ())
