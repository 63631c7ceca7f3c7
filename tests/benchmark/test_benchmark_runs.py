"""The benchmark runs the real window on the real demo cell; here only that it measures at all."""

import json
import os
import subprocess
import sys

import pytest


@pytest.mark.process
@pytest.mark.parametrize("what", ["latency", "stop", "hearing"])
def test_a_short_run_measures_every_row(what):
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    done = subprocess.run(
        [sys.executable, "-m", "ui", "benchmark", what, "--seconds", "1", "--json"],
        env=environment,
        capture_output=True,
        text=True,
        timeout=100,
    )
    assert done.returncode == 0, done.stderr
    rows = json.loads(done.stdout)["rows"]
    assert rows
    assert [row["name"] for row in rows if row["n"] < 1] == []
    # Beyond the trip level may be less than 0: a last sample that equals the one before, as 10 bits
    # often give, does not count, so the time runs from the one before.
    assert [row for row in rows if not -100 < row["median"] < 5000] == []


@pytest.mark.process
def test_the_demo_opens_its_window_and_closes_by_itself(tmp_path):
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    arguments = ["--demo", "--data-dir", str(tmp_path), "--exit-after", "3", "--log-level", "info"]
    done = subprocess.run(
        [sys.executable, "-m", "ui", *arguments],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    assert "painted at" in done.stderr
    assert "ERROR" not in done.stderr, done.stderr
    assert len(list((tmp_path / "sessions").glob("*.mcap"))) == 1
