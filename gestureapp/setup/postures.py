"""A person's own stop and start posture, and whether they lie far apart. Pure."""

import math
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from gestureapp.config import SiteSettings
from gestureapp.sensing.calibration import Vector
from gestureapp.sensing.posture import LeftPostures
from gestureapp.setup.stillness import Still, Stillness
from gestureapp.setup.values import Check, Outcome, PosturesView

F64 = NDArray[np.float64]

HOLD_S: Final = 1.5
STILL_WITHIN_G: Final = 0.1
"""An arm that is held trembles by some hundredths of a g; 0.1 g is 6 degrees."""
LEAD_S: Final = 3.0
"""Time to take the stop posture after the button: what is held at once is not it yet."""
LEFT_DEG: Final = 20.0
"""The start posture is looked for once the arm has left the stop posture by this much."""
MAGNITUDE_G: Final = (0.85, 1.15)
"""A calibrated sensor that is held still reads 1 g; else it is not calibrated."""
LEAST_MARGIN_DEG: Final = 5.0
"""Less is left between two postures left as far as the settings allow, and they may be mixed up."""
READING_S: Final = 5.0
"""Time to read what comes next."""
GIVE_UP_S: Final = 30.0
"""For each posture; then it ends by itself."""

_START: Final = "Stop posture recorded. Now take the start posture and hold it still."
_AGAIN: Final = "record the postures anew: Setup, Calibrate, Postures"


class PostureRecorder:
    """Records stop, then start, of one person. Owned by one thread.

    Args:
        person: Whose they are.
        site: Says how far a posture may be left.
        arm: Which one starts and stops: ``left`` or ``right``.
    """

    def __init__(self, person: str, site: SiteSettings, arm: str = "left") -> None:
        self._site = site
        ask = f"Take the stop posture with the {arm} arm and hold it still."
        self._ask = ask
        self._stillness = Stillness(HOLD_S, STILL_WITHIN_G, may_sway=True)
        self._began_s = math.nan
        self._stop: Vector | None = None
        self._postures: LeftPostures | None = None
        self._told = ""
        self._view = PosturesView(
            person=person,
            is_on=True,
            sentence=ask,
            least_margin_deg=LEAST_MARGIN_DEG,
            outcome=Outcome(Check.RUNNING, ask),
            arm=arm,
        )

    @property
    def view(self) -> PosturesView:
        """What the window shows; dates are the caller's to set."""
        return self._view

    @property
    def postures(self) -> LeftPostures | None:
        """What was recorded, once it has passed; else None."""
        return self._postures

    def step(self, now_s: float, rows: F64) -> None:
        """Take new samples.

        Args:
            now_s: Monotonic clock.
            rows: The left arm's, shape (n, 4): t_s, x, y, z in g, calibrated, oldest first; may be
                empty, and may begin with samples that were handed in before.
        """
        if not self._view.is_on:
            return
        if math.isnan(self._began_s):
            self._began_s = now_s
        still = self._stillness.step(now_s, rows)
        if self._stop is None and now_s - self._began_s < LEAD_S:
            self._stillness.restart()
        elif still is not None:
            self._take(now_s, still)
        if self._view.is_on and now_s - self._began_s >= GIVE_UP_S:
            self._fail(self._why_nothing())
        if self._view.is_on:
            self._show()

    def _take(self, now_s: float, still: Still) -> None:
        low, high = MAGNITUDE_G
        if not low <= still.magnitude_g <= high:
            text = f"The sensor reads {still.magnitude_g:.2f} g where 1 g is: calibrate it first."
            self._told = text
            return
        unit = _unit(still.mean_g)
        if self._stop is None:
            self._stop, self._began_s, self._told = unit, now_s, ""
            self._view = replace(self._view, is_stop_done=True)
        elif between_deg(self._stop, unit) < LEFT_DEG:
            if now_s - self._began_s > READING_S:
                self._told = "The arm is still in the stop posture."
        else:
            self._judge(LeftPostures(self._stop, unit))

    def _judge(self, postures: LeftPostures) -> None:
        angle_deg = between_deg(postures.stop, postures.start)
        self._view = replace(
            self._view,
            is_start_done=True,
            progress=1.0,
            between_deg=angle_deg,
            margin_deg=margin_deg(postures, self._site),
        )
        problem, remedy = posture_problem(postures, self._site)
        if problem:
            self._fail(f"{problem[:1].upper()}{problem[1:]}: {remedy}.")
            return
        self._postures = postures
        text = f"{angle_deg:.0f} degrees between them, {self._view.margin_deg:.0f} to spare."
        outcome = Outcome(Check.PASSED, text)
        self._view = replace(
            self._view, is_on=False, sentence=f"Postures recorded. {text}", outcome=outcome
        )

    def _why_nothing(self) -> str:
        if self._stillness.is_silent:
            arm = self._view.arm
            return f"No samples come from the {arm} arm: switch the sensor on, or see Sensors."
        which = "stop" if self._stop is None else "start"
        told = self._told or f"The {which} posture was not held still for {HOLD_S:g} s."
        return f"{told} Nothing is kept; begin anew."

    def _fail(self, text: str) -> None:
        outcome = Outcome(Check.FAILED, text)
        self._view = replace(self._view, is_on=False, sentence=text, outcome=outcome)

    def _show(self) -> None:
        asked = self._ask if self._stop is None else _START
        silent = "No samples come from the left sensor." if self._stillness.is_silent else ""
        sentence = " ".join(filter(None, (silent or self._told, asked)))
        self._view = replace(
            self._view,
            sentence=sentence,
            progress=self._stillness.progress,
            outcome=Outcome(Check.RUNNING, sentence),
        )


def between_deg(one: Vector, other: Vector) -> float:
    """The angle between two directions, 0 to 180 degrees."""
    product = sum(a * b for a, b in zip(one, other, strict=True))
    across = np.linalg.norm(np.cross(one, other))
    return math.degrees(math.atan2(float(across), product))


def margin_deg(postures: LeftPostures, site: SiteSettings) -> float:
    """What is left between the postures when one is kept and the other entered at its farthest."""
    apart_deg = between_deg(postures.stop, postures.start)
    return apart_deg - site.posture_enter_deg - site.posture_leave_deg


def posture_problem(postures: LeftPostures, site: SiteSettings) -> tuple[str, str]:
    """Why these postures must not be armed with, and the remedy; two empty texts when they may."""
    margin = margin_deg(postures, site)
    if margin >= LEAST_MARGIN_DEG:
        return "", ""
    apart_deg = between_deg(postures.stop, postures.start)
    least_deg = LEAST_MARGIN_DEG + site.posture_enter_deg + site.posture_leave_deg
    problem = (
        f"stop and start posture are {math.floor(apart_deg)} degrees apart, "
        f"{least_deg:.0f} are needed"
    )
    return problem, f"{_AGAIN}, with the arm turned farther"


def _unit(vector: Vector) -> Vector:
    length = math.hypot(*vector)
    x, y, z = (value / length for value in vector)
    return x, y, z
