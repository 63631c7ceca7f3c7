"""What a recogniser made of takes: counts, shares, tables. Pure."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Percentages = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Evaluation:
    """What a recogniser made of a set of takes.

    Attributes:
        labels: The model's gestures, then others that occur in the takes.
        confusion: Counts, shape (labels, labels + 1), read-only: rows what was done, columns what
            was heard, the last one "not recognised".
        decision_ms: Median and 95th percentile of the time from the activation to the answer (to
            the receipt of the last sample needed; the pass itself takes some 20 us); 0 without
            takes.
    """

    labels: tuple[str, ...]
    confusion: NDArray[np.int64]
    decision_ms: tuple[float, float]

    def __post_init__(self) -> None:
        self.confusion.setflags(write=False)

    @property
    def n(self) -> int:
        """Number of takes."""
        return int(self.confusion.sum())

    @property
    def recognised(self) -> float:
        """Share of all takes heard as what was done; 0 to 1."""
        return self._share(int(np.trace(self.confusion)))

    @property
    def rejected(self) -> float:
        """Share of all takes not recognised; 0 to 1."""
        return self._share(int(self.confusion[:, -1].sum()))

    @property
    def wrong(self) -> float:
        """Share of all takes heard as another gesture; 0 to 1."""
        heard = int(self.confusion[:, :-1].sum()) - int(np.trace(self.confusion))
        return self._share(heard)

    def per_gesture(self) -> dict[str, Percentages]:
        """Recognised, wrong and rejected share, 0 to 1, of each gesture in the takes."""
        shares: dict[str, Percentages] = {}
        for row, label in enumerate(self.labels):
            counts = self.confusion[row]
            total = int(counts.sum())
            if total:
                right, rejected = int(counts[row]), int(counts[-1])
                wrong = total - right - rejected
                shares[label] = (right / total, wrong / total, rejected / total)
        return shares

    def as_json(self) -> dict[str, object]:
        """The same as plain values for ``json.dumps``."""
        return {
            "n": self.n,
            "labels": list(self.labels),
            "confusion": self.confusion.tolist(),
            "recognised": self.recognised,
            "wrong": self.wrong,
            "rejected": self.rejected,
            "per_gesture": {
                label: {"recognised": share[0], "wrong": share[1], "rejected": share[2]}
                for label, share in self.per_gesture().items()
            },
            "decision_ms": {"median": self.decision_ms[0], "p95": self.decision_ms[1]},
        }

    def as_table(self) -> str:
        """A text table like the paper's Table I, in per cent; the last row is the mean.

        What a terminal would obey in a label is written out.
        """
        rows = [(_visible(label), share) for label, share in self.per_gesture().items()]
        width = max([len("Gesture"), *(len(label) for label, _ in rows)])
        lines = [f"{'Gesture':<{width}}  recognised  wrong  rejected"]
        if rows:
            mean = np.mean([share for _, share in rows], axis=0).tolist()
            rows.append(("Mean", (mean[0], mean[1], mean[2])))
        for label, (right, wrong, rejected) in rows:
            lines.append(
                f"{label:<{width}}  {100 * right:10.1f}  {100 * wrong:5.1f}  {100 * rejected:8.1f}"
            )
        return "\n".join(lines)

    def _share(self, count: int) -> float:
        return count / self.n if self.n else 0.0


def _visible(label: str) -> str:
    """The label with what cannot be seen, as line ends and control characters, written out."""
    return "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in label)


def tally(
    labels: Sequence[str],
    answers: Iterable[tuple[str, str | None]],
    took_ms: Sequence[float] = (),
) -> Evaluation:
    """Count what was done against what was heard.

    Args:
        labels: Gestures, in the order of the table; others that were done or heard follow by name.
        answers: For each take what was done, and what was heard or None for "not recognised".
        took_ms: From the activation to each answer.
    """
    pairs = list(answers)
    found = {label for pair in pairs for label in pair if label is not None}
    known = (*labels, *sorted(found - set(labels)))
    column = {label: k for k, label in enumerate(known)}
    confusion = np.zeros((len(known), len(known) + 1), dtype=np.int64)
    for done, heard in pairs:
        confusion[column[done], len(known) if heard is None else column[heard]] += 1
    median, p95 = np.percentile(took_ms, [50, 95]).tolist() if len(took_ms) else (0.0, 0.0)
    return Evaluation(known, confusion, (median, p95))
