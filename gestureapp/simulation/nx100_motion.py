"""How the emulated robot moves: a path in a frame and a velocity profile along it. Pure.

A path is travelled by its fraction, 0 at the start and 1 at the end of the increment; a profile
gives the fraction as an exact function of the time.
"""

import math
from dataclasses import dataclass

from gestureapp.robot import hp6
from gestureapp.robot.values import Pose, PoseIncrement


@dataclass(frozen=True, slots=True)
class Phase:
    """A piece of constant acceleration. Fractions of the path, seconds."""

    start_s: float
    duration_s: float
    fraction: float
    rate: float
    accel: float

    def fraction_at(self, elapsed_s: float) -> float:
        """Give the fraction reached this long after the phase's start."""
        return self.fraction + elapsed_s * (self.rate + 0.5 * self.accel * elapsed_s)


@dataclass(frozen=True, slots=True)
class Profile:
    """Fraction of the path over time.

    Attributes:
        start_s: When it begins to move.
        end_s: When it stands.
        begin: Fraction before the start.
        final: Fraction from ``end_s`` on, exactly.
        phases: In order of time, without gaps.
    """

    start_s: float
    end_s: float
    begin: float
    final: float
    phases: tuple[Phase, ...]

    def fraction_at(self, now_s: float) -> float:
        """Give the fraction reached; never beyond ``final``."""
        if now_s >= self.end_s:
            return self.final
        phase = self._phase(now_s)
        if phase is None:
            return self.begin
        return min(self.final, max(self.begin, phase.fraction_at(now_s - phase.start_s)))

    def rate_at(self, now_s: float) -> float:
        """Give the speed, in fractions of the path a second."""
        phase = self._phase(now_s)
        if phase is None or now_s >= self.end_s:
            return 0.0
        return max(0.0, phase.rate + phase.accel * (now_s - phase.start_s))

    def time_of(self, fraction: float) -> float:
        """Give when a fraction is reached; infinity when it never is."""
        if fraction > self.final:
            return math.inf
        low, high = self.start_s, self.end_s
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.fraction_at(middle) >= fraction else (middle, high)
        return high

    def stopped(self, now_s: float, accel: float) -> "Profile":
        """Give the profile that follows this one until now and then slows down to a stand.

        Args:
            now_s: Between ``start_s`` and ``end_s``.
            accel: Magnitude of the deceleration, fractions a second squared.
        """
        at, rate = self.fraction_at(now_s), self.rate_at(now_s)
        final = min(self.final, at + 0.5 * rate * rate / accel)
        slowing = Phase(now_s, rate / accel, at, rate, -accel)
        before = tuple(phase for phase in self.phases if phase.start_s < now_s)
        end_s = now_s + slowing.duration_s
        return Profile(self.start_s, end_s, self.begin, final, (*before, slowing))

    def _phase(self, now_s: float) -> Phase | None:
        found = None
        for phase in self.phases:
            if phase.start_s <= now_s:
                found = phase
        return found


def trapezoid(start_s: float, begin: float, rate: float, accel: float) -> Profile:
    """Give the profile from a fraction to 1: speed up, cruise, slow down; a triangle if short.

    Args:
        start_s: When it begins to move.
        begin: Fraction it begins at, below 1.
        rate: Cruising speed, fractions a second.
        accel: Both ways, fractions a second squared.
    """
    length = 1.0 - begin
    peak = min(rate, math.sqrt(length * accel))
    ramp_s, ramp = peak / accel, 0.5 * peak * peak / accel
    cruise_s = max(0.0, (length - 2.0 * ramp) / peak)
    slow_s = start_s + ramp_s + cruise_s
    phases = (
        Phase(start_s, ramp_s, begin, 0.0, accel),
        Phase(start_s + ramp_s, cruise_s, begin + ramp, peak, 0.0),
        Phase(slow_s, ramp_s, 1.0 - ramp, peak, -accel),
    )
    return Profile(start_s, slow_s + ramp_s, begin, 1.0, phases)


@dataclass(frozen=True, slots=True)
class Path:
    """A straight increment, its angles turning evenly with the distance.

    Attributes:
        frame: The increment's frame, seen from the robot frame; None is the robot frame itself.
        start: Pose at fraction 0, in that frame.
        increment: What is added until fraction 1, in that frame.
    """

    frame: Pose | None
    start: Pose
    increment: PoseIncrement

    def pose_at(self, fraction: float) -> Pose:
        """Give the tool pose in the robot frame; angles are not brought into +-180 degrees."""
        step = self.increment
        here = Pose(
            self.start.x_mm + fraction * step.dx_mm,
            self.start.y_mm + fraction * step.dy_mm,
            self.start.z_mm + fraction * step.dz_mm,
            self.start.rx_deg + fraction * step.drx_deg,
            self.start.ry_deg + fraction * step.dry_deg,
            self.start.rz_deg + fraction * step.drz_deg,
        )
        return here if self.frame is None else from_frame(self.frame, here)


def from_frame(frame: Pose, pose: Pose) -> Pose:
    """Give a pose of a frame in the robot frame."""
    axes = hp6.rotation(*frame.rotation_deg)
    moved = hp6.turned(axes, pose.position_mm)
    x, y, z = (a + b for a, b in zip(frame.position_mm, moved, strict=True))
    return Pose(x, y, z, *hp6.angles(hp6.times(axes, hp6.rotation(*pose.rotation_deg))))


def into_frame(frame: Pose, pose: Pose) -> Pose:
    """Give a pose of the robot frame in another frame."""
    axes = hp6.transposed(hp6.rotation(*frame.rotation_deg))
    dx, dy, dz = (a - b for a, b in zip(pose.position_mm, frame.position_mm, strict=True))
    x, y, z = hp6.turned(axes, (dx, dy, dz))
    return Pose(x, y, z, *hp6.angles(hp6.times(axes, hp6.rotation(*pose.rotation_deg))))


def normal(pose: Pose) -> Pose:
    """Give the pose with its angles in (-180, 180] degrees."""
    rx, ry, rz = (hp6.normal_deg(angle) for angle in pose.rotation_deg)
    return Pose(pose.x_mm, pose.y_mm, pose.z_mm, rx, ry, rz)
