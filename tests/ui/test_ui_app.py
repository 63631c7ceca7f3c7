"""Start and end of the application: platform, hooks, exit."""

import logging
import os
import signal
import sys
from dataclasses import replace

import pytest
from PySide6.QtCore import QTimer, qWarning
from PySide6.QtWidgets import QApplication, QLabel, QMessageBox

from ui.app import choose_platform, run_window, show_message, stopping_hook


def test_the_window_opens_lives_and_closes_by_itself(qapp, cell, operator):
    assert run_window(cell, operator, exit_after_s=0.3) == 0
    assert cell.n_ticks > 0
    assert cell.calls == ["stop", "disarm", "shutdown", "shutdown"]


def test_a_request_to_terminate_closes_the_window(qapp, cell):
    QTimer.singleShot(50, lambda: os.kill(os.getpid(), signal.SIGTERM))
    before = signal.getsignal(signal.SIGTERM)
    assert run_window(cell, exit_after_s=20.0) == 0
    assert cell.calls[:3] == ["stop", "disarm", "shutdown"]
    assert signal.getsignal(signal.SIGTERM) is before


def test_hooks_are_there_while_the_window_runs_and_taken_back_after(qapp, cell):
    before = sys.excepthook
    seen: list[object] = []
    QTimer.singleShot(20, lambda: seen.append(sys.excepthook))
    run_window(cell, exit_after_s=0.2)
    assert len(seen) == 1
    assert seen[0] is not before
    assert sys.excepthook is before


@pytest.mark.logs_errors
def test_an_error_nobody_handled_stops_the_robot_before_it_is_logged(cell, caplog):
    passed_on: list[object] = []
    hook = stopping_hook(cell, lambda *args: passed_on.append(args))
    order: list[str] = []
    cell.stop = lambda why: order.append(f"{why}, {len(caplog.records)} logged")
    error = RuntimeError("a widget broke")
    hook(RuntimeError, error, None)
    assert order == ["an error nobody handled: RuntimeError: a widget broke, 0 logged"]
    assert [r.levelno for r in caplog.records] == [logging.CRITICAL]
    assert passed_on == []
    hook(KeyboardInterrupt, KeyboardInterrupt(), None)
    assert len(order) == 2
    assert len(passed_on) == 1


def test_without_a_screen_the_window_is_drawn_off_screen_and_says_so(monkeypatch, capsys):
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    choose_platform()
    assert os.environ["QT_QPA_PLATFORM"] == "offscreen"
    assert capsys.readouterr().err.count("\n") == 1


def test_a_screen_or_a_choice_of_the_person_is_respected(monkeypatch, capsys):
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("QT_QPA_PLATFORM", "minimal")
    monkeypatch.delenv("DISPLAY", raising=False)
    choose_platform()
    assert os.environ["QT_QPA_PLATFORM"] == "minimal"
    monkeypatch.delenv("QT_QPA_PLATFORM")
    monkeypatch.setenv("DISPLAY", ":0")
    choose_platform()
    assert "QT_QPA_PLATFORM" not in os.environ
    assert capsys.readouterr().err == ""


def test_qt_messages_go_to_the_log(qapp, cell, caplog):
    def complain() -> None:
        qWarning("a widget has a wish")

    QTimer.singleShot(20, complain)
    with caplog.at_level(logging.WARNING):
        run_window(cell, exit_after_s=0.2)
    assert "Qt: a widget has a wish" in caplog.text


def test_the_alarm_bar_is_painted_red(qapp, qtbot, window, cell):
    cell.shown = replace(cell.shown, is_stop_unconfirmed=True)
    window.poll()
    QApplication.processEvents()
    bar = window.findChild(QLabel, "stopUnconfirmedBar")
    corner = bar.grab().toImage().pixelColor(1, 1)
    assert corner.red() > 150
    assert corner.green() < 80


def test_why_it_did_not_start_is_shown_on_a_screen_and_only_there(qapp, monkeypatch):
    shown: list[str] = []
    monkeypatch.setattr(QMessageBox, "exec", lambda box: shown.append(box.text()))
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setenv("QT_QPA_PLATFORM", "offscreen")
    show_message("nobody sees it")
    monkeypatch.delenv("QT_QPA_PLATFORM")
    show_message("line 3: <b>\nline 4")
    monkeypatch.delenv("DISPLAY")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    show_message("nobody sees it")
    assert shown == ["line 3: <b>\nline 4"]
