"""Sensors: where each arm's sensor is, how its stream is, and what to do when it is not well."""

from functools import partial

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

from gestureapp.cell.controls import CellControls
from gestureapp.cell.snapshot import Snapshot
from gestureapp.sensing.values import Side
from gestureapp.setup.controls import SetupControls
from gestureapp.setup.snapshot import SetupSnapshot
from gestureapp.setup.values import Check, FoundSensor, Remedy
from ui.find_panel import FindPanel
from ui.labels import plain
from ui.link_test_panel import LinkTestPanel
from ui.pages import PageStack
from ui.sensor_card import SensorCardView
from ui.setup_parts import enable, push, say
from ui.shake_panel import ShakePanel
from ui.theme import LARGE_PX, TEXT_PX


class SetupSensorsStep(QWidget):
    """Both arms' sensors; finding, shaking and the link test take the whole step. GUI thread only.

    Signals:
        calibration_wanted: The person wants to calibrate the sensor of this ``Side``.
    """

    calibration_wanted = Signal(Side)

    def __init__(
        self, cell: CellControls, setup: SetupControls, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setObjectName("setupSensorsStep")
        self._cell, self._setup = cell, setup
        self._snapshot = setup.snapshot()
        protocols = setup.protocols()
        self._cards = {side: SensorCardView(side, protocols) for side in Side}
        self._find = FindPanel()
        self._shake = ShakePanel()
        self._link = LinkTestPanel()
        self._told = plain("setupSensorsTold", TEXT_PX)
        self._find_button = push("findSensors", "Find sensors", size_px=LARGE_PX)
        self._shake_button = push("assignByShaking", "Assign by shaking", size_px=LARGE_PX)
        self._swap_button = push("swapSensors", "Swap", "Swap the two sensors", LARGE_PX)
        self._overview = self._lay_out_cards()
        self._stack = PageStack("setupSensorPanels")
        for panel in (self._overview, self._find, self._shake, self._link):
            self._stack.addWidget(panel)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._stack)
        self._connect()

    def show_snapshot(self, setup: SetupSnapshot, cell: Snapshot) -> None:
        """Show another moment."""
        self._snapshot = setup
        if setup.shake.is_on:
            self._open(self._shake)
        elif setup.finding.is_on:
            self._open(self._find)
        elif setup.link_test.outcome.check is Check.RUNNING:
            self._open(self._link)
        panel = self._stack.currentWidget()
        if panel is self._shake:
            self._shake.show_shake(setup.shake)
        elif panel is self._find:
            self._find.show_finding(setup.finding, (setup.left, setup.right))
        elif panel is self._link:
            card = setup.right if setup.link_test.side is Side.RIGHT else setup.left
            self._link.show_test(setup.link_test, card.worn)
        else:
            self._show_cards(setup, cell)

    def leave(self) -> None:
        """The step goes out of sight: nobody would see what is asked for."""
        if self._snapshot.shake.is_on:
            self._setup.end_shake()
        if self._snapshot.finding.is_on:
            self._setup.stop_finding()
        self._open(self._overview)

    def _show_cards(self, setup: SetupSnapshot, cell: Snapshot) -> None:
        stores = {Side.LEFT: self._cell.left, Side.RIGHT: self._cell.right}
        for card in (setup.left, setup.right):
            view = self._cards[card.side]
            view.show_card(card, setup.ports)
            view.show_samples(stores[card.side], cell.t_s, card.health.is_alive)
            view.show_link_test(setup.link_test, setup.link_test.side is card.side)
        has_both = bool(setup.left.port and setup.right.port)
        enable(self._swap_button, has_both)
        is_coming = setup.left.health.is_alive and setup.right.health.is_alive
        enable(self._shake_button, is_coming)
        say(self._told, "" if is_coming else "Shaking needs data from both sensors.")

    def _connect(self) -> None:
        for side, card in self._cards.items():
            card.port_chosen.connect(partial(self._setup.choose_port, side))
            card.act_wanted.connect(partial(self._act, side))
        self._find_button.clicked.connect(self._begin_finding)
        self._shake_button.clicked.connect(self._begin_shake)
        self._swap_button.clicked.connect(self._setup.swap_sensors)
        self._find.wanted.connect(self._use)
        self._find.closed.connect(self._end_finding)
        self._shake.closed.connect(self._end_shake)
        self._link.again.connect(self._setup.begin_link_test)
        self._link.closed.connect(self._end_link_test)

    def _act(self, side: Side, act: Remedy) -> None:
        match act:
            case Remedy.CALIBRATE:
                self.calibration_wanted.emit(side)
            case Remedy.SWAP:
                self._setup.swap_sensors()
            case Remedy.TEST_LINK:
                self._setup.begin_link_test(side)
                self._open(self._link)
            case Remedy.FIND:
                self._begin_finding()
            case Remedy.NONE:
                pass

    def _begin_finding(self) -> None:
        self._setup.find_sensors()
        self._open(self._find)

    def _begin_shake(self) -> None:
        self._setup.begin_shake()
        self._open(self._shake)

    def _use(self, found: FoundSensor, side: Side) -> None:
        self._setup.choose_port(side, found.port.url, found.protocol)

    def _end_finding(self) -> None:
        self._setup.stop_finding()
        self._open(self._overview)

    def _end_shake(self) -> None:
        self._setup.end_shake()
        self._open(self._overview)

    def _end_link_test(self) -> None:
        if self._snapshot.link_test.outcome.check is Check.RUNNING:
            self._setup.end_link_test()
        self._open(self._overview)

    def _open(self, panel: QWidget) -> None:
        if self._stack.currentWidget() is not panel:
            self._stack.setCurrentWidget(panel)
            panel.setFocus()  # else Space would press whatever Qt hands the focus to

    def _lay_out_cards(self) -> QWidget:
        cards = QHBoxLayout()
        cards.setSpacing(6)
        for card in self._cards.values():
            cards.addWidget(card, 1)
        foot = QHBoxLayout()
        foot.setSpacing(8)
        foot.addWidget(self._told, 1)
        for button in (self._find_button, self._shake_button, self._swap_button):
            foot.addWidget(button)
        overview = QWidget()
        layout = QVBoxLayout(overview)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        layout.addLayout(cards, 1)
        layout.addLayout(foot)
        return overview
