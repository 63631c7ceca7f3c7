"""What came of the faults, as the table of the documents and as JSON."""

import statistics
from collections.abc import Sequence
from dataclasses import dataclass

from gestureapp.benchmark.faults.scenario import Expected, Outcome, Scenario
from gestureapp.benchmark.report import machine

_HEAD = (
    "| fault | noticed by | n | HOLD, median | HOLD, worst | aim | standstill, median "
    "| standstill, worst |"
)
_RULE = "|---|---|---|---|---|---|---|---|"


@dataclass(frozen=True, slots=True)
class FaultRow:
    """One fault and all that came of its trials."""

    scenario: Scenario
    outcomes: Sequence[Outcome]

    @property
    def hold_ms(self) -> list[float]:
        """From each fault to the last byte of HOLD."""
        return [o.hold_ms for o in self.outcomes if o.hold_ms is not None]

    @property
    def stand_ms(self) -> list[float]:
        """From each fault to standstill."""
        return [o.stand_ms for o in self.outcomes if o.stand_ms is not None]

    @property
    def problems(self) -> list[str]:
        """What was not as it has to be, in any trial."""
        return [problem for outcome in self.outcomes for problem in outcome.problems]

    @property
    def line(self) -> str:
        """Of the table."""
        s = self.scenario
        words = f"{s.words} ({s.counted})" if s.counted else s.words
        stood = "nothing moves | " if s.expected is Expected.MOVES_NOT else _two(self.stand_ms)
        return (
            f"| {words} | {s.detection} | {len(self.outcomes)} | {_two(self.hold_ms)} "
            f"| {s.aim_ms:.0f} ms | {stood} |"
        )

    def as_json(self) -> dict[str, object]:
        """Plain values, every trial's."""
        s = self.scenario
        return {
            "name": s.name,
            "fault": s.words,
            "noticed_by": s.detection,
            "counted": s.counted,
            "aim_ms": s.aim_ms,
            "n": len(self.outcomes),
            "hold_ms": self.hold_ms,
            "stand_ms": self.stand_ms,
            "told": sorted({o.told for o in self.outcomes}),
            "problems": self.problems,
        }


@dataclass(frozen=True, slots=True)
class FaultReport:
    """All faults that were tried.

    Attributes:
        rows: One for each.
        n_surprises: Stops that nobody asked for, on the way to a fault.
    """

    rows: Sequence[FaultRow]
    n_surprises: int

    @property
    def is_fine(self) -> bool:
        """The robot stood, the reason was right and so on, in every trial; times are not judged."""
        return not any(row.problems for row in self.rows)

    def as_json(self) -> dict[str, object]:
        """Plain values, with the machine."""
        rows = [row.as_json() for row in self.rows]
        return {"machine": machine(), "rows": rows, "n_surprises": self.n_surprises}

    def as_table(self) -> str:
        """A Markdown table, as it stands in the documents."""
        lines = [f"Faults while the robot moves at 100 mm/s ({machine()})", "", _HEAD, _RULE]
        lines += [row.line for row in self.rows]
        lines += ["", f"{self.n_surprises} unasked stops on the way."]
        for row in self.rows:
            lines += [f"* {row.scenario.name}: {problem}" for problem in row.problems]
        return "\n".join(lines)


def _two(values: Sequence[float]) -> str:
    if not values:
        return " | "
    return f"{statistics.median(values):.1f} ms | {max(values):.1f} ms"
