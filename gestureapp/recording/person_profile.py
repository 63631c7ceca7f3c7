"""What is kept of a person besides takes and model: handedness and the left arm's postures."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from enum import Enum
from pathlib import Path
from typing import Final

from gestureapp.recognition.fields import object_in, text_in
from gestureapp.recording.kept_json import read_kept, write_kept
from gestureapp.recording.people import make_person_folder, person_folder
from gestureapp.recording.sensor_records import vector_in, wall_s_in
from gestureapp.sensing.posture import LeftPostures

PROFILE_FILE: Final = "profile.json"
_KIND: Final = "gestureapp person"
_SCHEMA: Final = 1
_UNIT_WITHIN: Final = 1e-6


class Handedness(Enum):
    """Which hand shows the gestures; the value is the word on the screen.

    A left-handed person wears the right arm's sensor on the left arm, and starts and stops with
    the other one. Left and right in the code are the roles: left starts and stops.
    """

    RIGHT = "right-handed"
    LEFT = "left-handed"


@dataclass(frozen=True, slots=True)
class PersonProfile:
    """One person's.

    Attributes:
        handedness: Theirs.
        postures: Of the arm that starts and stops; None for the built-in ones.
        recorded_wall_s: When they were recorded, seconds since the epoch; 0 for the built-in ones.
    """

    handedness: Handedness = Handedness.RIGHT
    postures: LeftPostures | None = None
    recorded_wall_s: float = 0.0


def save_profile(data: Path, person: str, profile: PersonProfile) -> None:
    """Keep it in the person's folder, which is made if need be.

    Raises:
        DiskFull: no room is left there; what was kept before is as it was.
        RecordingError: the name cannot be used, or nothing can be written there.
    """
    content = {
        "handedness": profile.handedness.value,
        "postures": None if profile.postures is None else asdict(profile.postures),
        "recorded_wall_s": profile.recorded_wall_s,
    }
    write_kept(make_person_folder(data, person) / PROFILE_FILE, _KIND, _SCHEMA, content)


def load_profile(data: Path, person: str) -> tuple[PersonProfile, str]:
    """A person's profile, and what is wrong with the file; the built-in one where none is.

    A file that cannot be used is one line for a person, the cause without its remedy, and blocks
    arming where that line is treated as a problem: whoever recorded postures does not expect the
    built-in ones.

    Raises:
        RecordingError: the name cannot be used.
    """
    path = person_folder(data, person) / PROFILE_FILE
    try:
        content = read_kept(path, _KIND, _SCHEMA)
        return (PersonProfile() if content is None else _profile_in(content)), ""
    except ValueError as error:
        return PersonProfile(), f"{person}'s {PROFILE_FILE} {_as_verb(error)}"


def _as_verb(error: ValueError) -> str:
    text = str(error)
    return text if text.startswith(("is ", "cannot ")) else f"is damaged: {text}"


def _profile_in(content: Mapping[str, object]) -> PersonProfile:
    """Raises ``ValueError`` with a line on what cannot be used."""
    handedness = text_in(content, "handedness")
    if handedness not in {known.value for known in Handedness}:
        raise ValueError(f"'handedness' is {handedness[:40]!r}")
    postures = None
    if content.get("postures") is not None:
        table = object_in(content, "postures")
        postures = LeftPostures(vector_in(table, "stop"), vector_in(table, "start"))
        for vector in (postures.stop, postures.start):
            if abs(math.hypot(*vector) - 1.0) > _UNIT_WITHIN:
                raise ValueError("a posture is no direction")
    return PersonProfile(Handedness(handedness), postures, wall_s_in(content, "recorded_wall_s"))
