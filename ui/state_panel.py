"""The state in one big word, what to do next, and the buttons that give and take permission."""

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QGridLayout, QHBoxLayout, QPushButton, QWidget

from gestureapp.cell.snapshot import CellState, Snapshot
from gestureapp.clock import Clock, monotonic
from ui.hold_button import HoldButton
from ui.labels import BigWord, plain
from ui.marks import Mark
from ui.theme import LARGE_PX, TEXT_PX, sized
from ui.words import state_level

WORD_MIN_PX = 67
"""Cap height is about 0.73 of this with the fonts at hand: 48 px at the least."""
WORD_MAX_PX = 130
_WITH_PERMISSION = (
    CellState.ARMED,
    CellState.ACTIVATED,
    CellState.MOVING,
    CellState.STOPPING,
)

_SERVO_ON = "Switch the robot's servo power on"
_SERVO_OFF = "Switch the robot's servo power off: discards the move that the controller keeps"


class StatePanel(QFrame):
    """Word, sentence, arm, disarm, servo on.

    Signals:
        arm_wanted: The arm button was held long enough.
        disarm_wanted: The permission is taken back.
        servo_on_wanted: Servo power is asked for.
        servo_off_wanted: It is to go off, which discards a move that the controller keeps.
    """

    arm_wanted = Signal()
    disarm_wanted = Signal()
    servo_on_wanted = Signal()
    servo_off_wanted = Signal()

    def __init__(self, clock: Clock = monotonic, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._mark = Mark(44)
        longest = max((state.value for state in CellState), key=len)
        self._word = BigWord(longest, WORD_MIN_PX, WORD_MAX_PX)
        self._word.setObjectName("stateLabel")
        self._sentence = plain("sentenceLabel", LARGE_PX + 1)
        self._sentence.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self._arm = HoldButton("Hold 1 s to arm", clock)
        self._disarm = QPushButton("Disarm")
        self._servo = QPushButton("Servo on")
        self._name_buttons()
        self._arm.held.connect(self.arm_wanted)
        self._disarm.clicked.connect(lambda: self.disarm_wanted.emit())
        self._servo.clicked.connect(self._press_servo)
        self._is_servo_off = False
        buttons = QGridLayout()
        buttons.setSpacing(6)
        buttons.addWidget(self._arm, 0, 0, 1, 2)
        buttons.addWidget(self._disarm, 1, 0)
        buttons.addWidget(self._servo, 1, 1)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(12, 4, 10, 6)
        layout.setSpacing(12)
        layout.addWidget(self._mark)
        layout.addWidget(self._word, 10)
        layout.addWidget(self._sentence, 7)
        layout.addLayout(buttons, 4)
        layout.setAlignment(buttons, Qt.AlignmentFlag.AlignTop)  # however long the sentence is

    def show_snapshot(self, snapshot: Snapshot) -> None:
        """Show another moment."""
        state = snapshot.state
        self._mark.show_level(state_level(state))
        if self._word.text() != state.value:
            self._word.setText(state.value)
            self._word.setAccessibleName(f"State: {state.value}")
        if self._sentence.text() != snapshot.sentence:
            self._sentence.setText(snapshot.sentence)
            self._sentence.setAccessibleName(snapshot.sentence)
        has_permission = state in _WITH_PERMISSION
        status = snapshot.robot.status
        if self._arm.hasFocus() and not snapshot.can_arm:
            # Left to itself Qt hands the focus, and a key still held from arming, to Disarm.
            self.setFocus()
        self._arm.setEnabled(snapshot.can_arm)
        self._disarm.setEnabled(has_permission)
        is_kept = any(blocker.id == "move_kept" for blocker in snapshot.blockers)
        self._name_servo(is_off=is_kept and status is not None and status.is_servo_on)
        self._servo.setEnabled(
            snapshot.robot.is_connected
            and status is not None
            and (not status.is_servo_on or self._is_servo_off)
            and not has_permission
        )

    def _press_servo(self) -> None:
        (self.servo_off_wanted if self._is_servo_off else self.servo_on_wanted).emit()

    def _name_servo(self, *, is_off: bool) -> None:
        """The same button leads through both steps, off and on again."""
        if is_off == self._is_servo_off:
            return
        self._is_servo_off = is_off
        spoken = _SERVO_OFF if is_off else _SERVO_ON
        self._servo.setText("Servo off" if is_off else "Servo on")
        self._servo.setAccessibleName(spoken)
        self._servo.setToolTip(spoken)

    def _name_buttons(self) -> None:
        for button, name, spoken in (
            (self._arm, "armButton", "Arm: hold for one second. Arming moves nothing."),
            (self._disarm, "disarmButton", "Disarm: stops a running move"),
            (self._servo, "servoButton", _SERVO_ON),
        ):
            button.setObjectName(name)
            button.setAccessibleName(spoken)
            button.setToolTip(spoken)
            button.setEnabled(False)
        sized(self._arm, LARGE_PX, is_bold=True)
        for small in (self._disarm, self._servo):
            small.setAutoDefault(False)
            sized(small, TEXT_PX)
