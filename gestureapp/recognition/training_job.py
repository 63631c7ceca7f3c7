"""What the application and its training child say to each other: one JSON object a line. Pure."""

import json
import math
from dataclasses import asdict, dataclass
from pathlib import Path

from gestureapp.recognition.presets import Preset


@dataclass(frozen=True, slots=True)
class Job:
    """What is to be trained; the first and only line on the child's standard input.

    The child ends as soon as its standard input does: that is how it is cancelled, and how it ends
    with the application.

    Attributes:
        takes: NPZ file of the takes.
        out: Where the model is to be written.
        preset: The recipe.
        seed: Of all chance.
        takes_from: Where the takes came from, for the model's record.
    """

    takes: Path
    out: Path
    preset: Preset = Preset.DEFAULT
    seed: int = 0
    takes_from: str = ""

    def as_line(self) -> bytes:
        """For the child."""
        fields = {**asdict(self), "preset": self.preset.value}
        return _line({**fields, "takes": str(self.takes), "out": str(self.out)})


@dataclass(frozen=True, slots=True)
class Progress:
    """How far it is.

    Attributes:
        done: Passes done.
        total: Passes in all.
        loss: The error now.
        remaining_s: How long it will still take; NaN while that is not known.
    """

    done: int
    total: int
    loss: float
    remaining_s: float

    def as_line(self) -> bytes:
        """For the application."""
        remaining_s = None if math.isnan(self.remaining_s) else self.remaining_s
        return _line({"progress": {**asdict(self), "remaining_s": remaining_s}})


@dataclass(frozen=True, slots=True)
class Finished:
    """The model is written."""

    def as_line(self) -> bytes:
        """For the application."""
        return _line({"finished": True})


@dataclass(frozen=True, slots=True)
class Failed:
    """There is no model; ``text`` says why and what to do, in one line."""

    text: str

    def as_line(self) -> bytes:
        """For the application."""
        return _line({"failed": self.text})


def parse_job(line: bytes) -> Job:
    """A job from its line.

    Raises:
        ValueError: the line is no job.
    """
    try:
        fields = json.loads(line)
        return Job(
            takes=Path(str(fields["takes"])),
            out=Path(str(fields["out"])),
            preset=Preset(fields["preset"]),
            seed=int(fields["seed"]),
            takes_from=str(fields["takes_from"]),
        )
    except (KeyError, TypeError) as error:
        raise ValueError(f"no training job: {error}") from error


def parse_answer(line: bytes) -> Progress | Finished | Failed | None:
    """What the child said; None for a line that is none of ours."""
    try:
        fields = json.loads(line)
        if "failed" in fields:
            return Failed(str(fields["failed"]))
        if "finished" in fields:
            return Finished()
        told = fields["progress"]
        left = told["remaining_s"]
        remaining_s = math.nan if left is None else float(left)
        return Progress(int(told["done"]), int(told["total"]), float(told["loss"]), remaining_s)
    except (ValueError, KeyError, TypeError):
        return None


def _line(content: dict[str, object]) -> bytes:
    return json.dumps(content).encode() + b"\n"
