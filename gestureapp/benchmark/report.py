"""Measured values as a table for people and as JSON."""

import os
import platform
import statistics
from collections.abc import Sequence
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Row:
    """One measured thing.

    Attributes:
        name: What was measured.
        unit: Of the values.
        values: All of them.
        aim: What was asked for, in words; empty when nothing was.
    """

    name: str
    unit: str
    values: tuple[float, ...]
    aim: str = ""

    def quantile(self, share: float) -> float:
        """The smallest value that at least this share of all values does not exceed."""
        ordered = sorted(self.values)
        return ordered[min(len(ordered) - 1, max(0, -int(-share * len(ordered) // 1) - 1))]

    def as_json(self) -> dict[str, object]:
        """Plain values."""
        if not self.values:
            return {"name": self.name, "unit": self.unit, "n": 0, "aim": self.aim}
        return {
            "name": self.name,
            "unit": self.unit,
            "n": len(self.values),
            "median": statistics.median(self.values),
            "p99": self.quantile(0.99),
            "max": max(self.values),
            "aim": self.aim,
        }


@dataclass(frozen=True, slots=True)
class Report:
    """Rows, and text that belongs to them."""

    title: str
    rows: Sequence[Row]
    notes: Sequence[str] = field(default_factory=tuple)

    def as_json(self) -> dict[str, object]:
        """Plain values, with the machine."""
        rows = [row.as_json() for row in self.rows]
        return {"title": self.title, "machine": machine(), "rows": rows, "notes": list(self.notes)}

    def as_table(self) -> str:
        """A Markdown table, as it stands in the README."""
        lines = [
            f"{self.title} ({machine()})",
            "",
            "| what | n | median | 99 % | max | aim |",
            "|---|---|---|---|---|---|",
        ]
        for row in self.rows:
            if not row.values:
                lines.append(f"| {row.name} | 0 | | | | {row.aim} |")
                continue
            middle, high, top = statistics.median(row.values), row.quantile(0.99), max(row.values)
            figures = " | ".join(f"{value:.1f} {row.unit}" for value in (middle, high, top))
            lines.append(f"| {row.name} | {len(row.values)} | {figures} | {row.aim} |")
        return "\n".join([*lines, *(f"\n{note}" for note in self.notes)])


def machine() -> str:
    """The machine in one line: cores, processor type, system, Python."""
    cores = os.cpu_count() or 1
    return f"{cores} cores {platform.machine()}, {platform.system()}, Python " + (
        platform.python_version()
    )
