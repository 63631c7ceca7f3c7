"""Where everybody's takes and model are: one folder a person, below ``<data>/people``.

A folder is named after its person as far as file systems allow, with a digest of the exact name
behind it: two names never share a folder, whatever their characters and on whatever disk.
"""

import contextlib
import hashlib
import re
import unicodedata
from pathlib import Path
from typing import Final

from gestureapp.errors import RecordingError
from gestureapp.recognition.files import write_atomically

PEOPLE_FOLDER: Final = "people"
TAKES_FILE: Final = "takes.sqlite"
MODEL_FILE: Final = "model.json"
_NAME_FILE: Final = "name.txt"
_LAST_FILE: Final = "last.txt"
MAX_NAME_CHARS: Final = 60
_SLUG_CHARS: Final = 24
_DIGEST_CHARS: Final = 12
_NOT_PLAIN: Final = re.compile(r"[^a-z0-9]+")


def clean_name(person: str) -> str:
    """The name as it is kept: composed letters, single spaces, no control characters."""
    plain = "".join(c if c.isprintable() else " " for c in unicodedata.normalize("NFC", person))
    return " ".join(plain.split())


def person_folder(data: Path, person: str) -> Path:
    """Where this person's files are, whether or not the folder is there.

    Args:
        data: The data folder.
        person: The name, as typed.

    Raises:
        RecordingError: the name is empty or too long.
    """
    name = clean_name(person)
    people = data / PEOPLE_FOLDER
    if not name:
        raise RecordingError(people, "a person needs a name; type one")
    if len(name) > MAX_NAME_CHARS:
        raise RecordingError(people, f"a name has at most {MAX_NAME_CHARS} characters; shorten it")
    return people / plain_name(name, "person")


def plain_name(name: str, otherwise: str) -> str:
    """A name for a file or folder: what can be kept of it on any disk, and a digest of all of it.

    Args:
        name: Any text.
        otherwise: What stands before the digest where nothing of it can be kept.
    """
    plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode().lower()
    slug = _NOT_PLAIN.sub("-", plain)[:_SLUG_CHARS].strip("-") or otherwise
    digest = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:_DIGEST_CHARS]
    return f"{slug}-{digest}"


def model_path(data: Path, person: str) -> Path:
    """The file of this person's model, whether or not it is there.

    Raises:
        RecordingError: the name is empty or too long.
    """
    return person_folder(data, person) / MODEL_FILE


def make_person_folder(data: Path, person: str) -> Path:
    """The person's folder, made and labelled with the name if need be.

    Raises:
        DiskFull: no room is left there.
        RecordingError: the name cannot be used, somebody else here is called nearly the same, or
            the folder cannot be made or written to.
    """
    folder = person_folder(data, person)
    if not folder.exists() and (there := look_alike(data, person)):
        reason = f"there is already {there}; choose that name in the list, or another one"
        raise RecordingError(data / PEOPLE_FOLDER, reason)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = f"cannot be made: {error.strerror or error}; choose another folder with --data-dir"
        raise RecordingError(folder, reason) from error
    name_file = folder / _NAME_FILE
    if not name_file.exists():
        content = clean_name(person).encode("utf-8", "surrogatepass")
        write_atomically(name_file, content)
    return folder


def list_people(data: Path) -> tuple[str, ...]:
    """Names of everybody who has a folder there, in the order of the alphabet; bad ones left out.

    Nothing is raised: a folder that cannot be read has nobody in it.
    """
    names = []
    try:
        folders = sorted((data / PEOPLE_FOLDER).iterdir())
    except OSError:
        return ()
    for folder in folders:
        try:
            name = (folder / _NAME_FILE).read_text("utf-8")
        except (OSError, ValueError):
            continue
        try:
            if person_folder(data, name) == folder:
                names.append(clean_name(name))
        except RecordingError:
            continue
    return tuple(sorted(names, key=str.casefold))


def look_alike(data: Path, person: str) -> str:
    """Who here has a name that differs only in case, spaces or accents; empty when nobody."""
    name, looks = clean_name(person), _looks_of(person)
    others = (one for one in list_people(data) if one != name and _looks_of(one) == looks)
    return next(others, "")


def _looks_of(name: str) -> str:
    """What is left of a name without spaces, accents and case; all of it where that is nothing."""
    apart = unicodedata.normalize("NFKD", clean_name(name)).casefold()
    return "".join(c for c in apart if not (c.isspace() or unicodedata.combining(c))) or name


def note_last_person(data: Path, person: str) -> None:
    """Remember whose takes were opened last; a disk that refuses costs only this memory."""
    with contextlib.suppress(RecordingError):
        content = clean_name(person).encode("utf-8", "surrogatepass")
        write_atomically(data / PEOPLE_FOLDER / _LAST_FILE, content)


def last_person(data: Path) -> str:
    """Whose takes were opened last, if that person still has a folder; else empty."""
    try:
        name = clean_name((data / PEOPLE_FOLDER / _LAST_FILE).read_text("utf-8"))
    except (OSError, ValueError):
        return ""
    return name if name in list_people(data) else ""
