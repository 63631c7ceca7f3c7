"""One arm's sensor on a card: state, port, figures, live plot or advice, what is against it."""

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QSizePolicy, QStackedWidget, QVBoxLayout, QWidget

from gestureapp.sensing.store import SampleStore
from gestureapp.sensing.values import LinkState, Side
from gestureapp.setup.values import Check, LinkTestView, PortChoice, Remedy, SensorCard
from ui.arm_plot import ArmPlot
from ui.labels import ElidedLabel, plain
from ui.marks import Level, Mark
from ui.operate_page import framed
from ui.pages import scrolled
from ui.port_chooser import PortChooser
from ui.setup_parts import Figure, OutcomeLine, enable, push, say
from ui.setup_words import FIGURES, card_title, figure_texts, link_level, link_word
from ui.theme import LARGE_PX, SMALL_PX, TEXT_PX, sized

_STATE_PX = 26


class SensorCardView(QFrame):
    """One arm's sensor. GUI thread only.

    Signals:
        port_chosen: The person wants this port with this protocol.
        act_wanted: The person wants this ``Remedy``.
    """

    port_chosen = Signal(str, str)
    act_wanted = Signal(Remedy)

    def __init__(
        self, side: Side, protocols: tuple[tuple[str, str], ...], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._name = name = side.value
        self._act, self._source = Remedy.NONE, ""
        self.setObjectName(f"{name}SensorCard")
        framed(self)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self._title = plain(f"{name}SensorTitle", LARGE_PX + 2, is_wrapped=False)
        self._mark = Mark(_STATE_PX)
        self._state = plain(f"{name}SensorState", _STATE_PX, is_wrapped=False)
        sized(self._state, _STATE_PX, is_bold=True)
        self._identity = ElidedLabel()
        self._identity.setObjectName(f"{name}SensorName")
        self._identity.setTextFormat(Qt.TextFormat.PlainText)
        self._identity.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self._ports = PortChooser(side, protocols)
        self._figures = [Figure(f"{name}{key}", caption) for key, caption in FIGURES]
        self._plot = ArmPlot(f"{name}SetupPlot", f"{name.capitalize()} arm")
        self._advice = _Advice(name)
        self._body = QStackedWidget()
        self._body.addWidget(self._plot)
        self._body.addWidget(self._advice)
        self._kept = plain(f"{name}Kept", TEXT_PX)
        self._problem = _ProblemRow(name)
        self._act_button = push(f"{name}Act", "")
        self._tested = OutcomeLine(f"{name}LinkTested", TEXT_PX)
        self._test = push(f"{name}TestLink", "Test link", f"Test the {name} arm's link for 30 s")
        self._lay_out()
        self._ports.chosen.connect(self.port_chosen)
        self._act_button.clicked.connect(lambda: self.act_wanted.emit(self._act))
        self._test.clicked.connect(lambda: self.act_wanted.emit(Remedy.TEST_LINK))

    def show_card(self, card: SensorCard, ports: tuple[PortChoice, ...]) -> None:
        """Show another moment of this sensor."""
        if self._source not in ("", card.port):
            self._plot.begin_anew()
        self._source = card.port
        self._plot.show_title(f"{card.worn.capitalize()} arm")
        self._mark.show_level(link_level(card))
        say(self._title, card_title(card))
        say(self._state, link_word(card))
        say(self._identity, card.name or card.sensor_id)
        self._identity.setToolTip(self._identity.text())
        self._ports.show_card(card, ports)
        for figure, text in zip(self._figures, figure_texts(card.health), strict=True):
            figure.show_value(text)
        is_coming = card.health.link is LinkState.RECEIVING
        self._body.setCurrentWidget(self._plot if is_coming else self._advice)
        enable(self._test, is_coming)
        self._advice.show_card(card)
        kept = (card.calibration, card.level, card.link)
        say(self._kept, "\n".join(text for text in kept if text))
        self._show_problem(card)

    def show_samples(self, store: SampleStore, now_s: float, is_alive: bool) -> None:
        """Draw the newest samples."""
        if self._body.currentWidget() is self._plot:
            self._plot.show_samples(store, now_s, is_alive)

    def show_link_test(self, test: LinkTestView, is_own: bool) -> None:
        """Show how this sensor's last link test ended."""
        is_run = is_own and test.outcome.check is not Check.NOT_RUN
        self._tested.setVisible(is_run)
        if is_run:
            self._tested.show_outcome(test.outcome)

    def _show_problem(self, card: SensorCard) -> None:
        reason = "" if card.health.is_ok else card.health.reason
        is_coming = card.health.link is LinkState.RECEIVING
        if is_coming and reason and not card.problem:
            self._problem.show_problem(reason, "")
        else:
            self._problem.show_problem(card.problem, card.remedy)
        self._act = card.act
        enable(self._act_button, card.act is not Remedy.NONE)
        self._act_button.setVisible(card.act is not Remedy.NONE)
        if self._act_button.text() != card.act.value:
            self._act_button.setText(card.act.value)
            spoken = f"{card.act.value}: {self._name} arm's sensor"
            self._act_button.setAccessibleName(spoken)

    def _lay_out(self) -> None:
        sized(self._title, LARGE_PX + 2, is_bold=True)
        head = QHBoxLayout()
        head.setSpacing(12)
        head.addWidget(self._title)
        head.addWidget(self._identity, 1)
        state = QHBoxLayout()
        state.setSpacing(10)
        state.addWidget(self._mark)
        state.addWidget(self._state, 1)
        figures = QHBoxLayout()
        figures.setSpacing(6)
        for figure in self._figures:
            figures.addWidget(figure, 1)
        foot = QHBoxLayout()
        foot.setSpacing(8)
        foot.addWidget(self._problem, 1)
        foot.addWidget(self._act_button)
        foot.addWidget(self._test)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(14, 8, 12, 8)
        layout.setSpacing(4)
        layout.addLayout(head)
        layout.addLayout(state)
        layout.addWidget(self._ports)
        layout.addLayout(figures)
        layout.addWidget(self._body, 1)
        layout.addWidget(self._kept)
        layout.addWidget(self._tested)
        layout.addLayout(foot)


class _Advice(QWidget):
    """Instead of the plot while no data come: why, the bytes that came, and what to try."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self._reason = plain(f"{name}Reason", LARGE_PX)
        sized(self._reason, LARGE_PX, is_bold=True)
        self._bytes = plain(f"{name}BadBytes", TEXT_PX)
        font = self._bytes.font()
        font.setFamilies(["DejaVu Sans Mono", "Consolas", "monospace"])
        self._bytes.setFont(font)
        self._tries = plain(f"{name}Advice", TEXT_PX + 1)
        texts = QVBoxLayout()
        texts.setContentsMargins(0, 4, 0, 0)
        texts.setSpacing(6)
        for label in (self._reason, self._bytes, self._tries):
            label.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
            texts.addWidget(label)
        texts.addStretch(1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(scrolled(texts, f"{name}AdviceArea", f"{name.capitalize()} arm: advice"))

    def show_card(self, card: SensorCard) -> None:
        """Show what is wrong with this sensor's data."""
        say(self._reason, card.health.reason)
        self._bytes.setVisible(bool(card.bad_bytes))
        say(self._bytes, f"came: {card.bad_bytes}" if card.bad_bytes else "")
        tries = (f"{number}.  {text}" for number, text in enumerate(card.advice, start=1))
        say(self._tries, "\n".join(tries))


class _ProblemRow(QWidget):
    """What is against arming with this sensor and what to do; keeps its room when nothing is."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self._mark = Mark(TEXT_PX + 3)
        self._problem = plain(f"{name}Problem", TEXT_PX + 1)
        self._remedy = plain(f"{name}Remedy", SMALL_PX + 1)
        words = QVBoxLayout()
        words.setSpacing(0)
        words.addWidget(self._problem)
        words.addWidget(self._remedy)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(8)
        layout.addWidget(self._mark, 0, Qt.AlignmentFlag.AlignVCenter)
        layout.addLayout(words, 1)

    def show_problem(self, problem: str, remedy: str) -> None:
        """Show another problem; two empty texts when there is none."""
        self._mark.show_level(Level.ATTENTION if problem else Level.OK)
        sized(self._problem, TEXT_PX + 1, is_bold=bool(problem))
        say(self._problem, problem or "nothing stands against this sensor")
        self._remedy.setVisible(bool(remedy))
        say(self._remedy, remedy)
