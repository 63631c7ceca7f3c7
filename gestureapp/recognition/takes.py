"""Sets of takes, and their exchange file.

One NPZ: ``samples`` float (n, 3) in g, ``offsets`` int (m+1), ``labels`` str (m), ``activation``
int (m, sample index inside the take, 0 if absent), optional ``user``, ``session`` and
``repetition`` (m), ``rate_hz``. Takes of other makers: see ``marked_takes``.
"""

import hashlib
import io
import unicodedata
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gestureapp.errors import RecordingInvalid
from gestureapp.recognition.files import write_atomically
from gestureapp.recognition.marked_takes import add_gravity, put_right
from gestureapp.recognition.readings import find_doubts, find_fault

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

_CONTROL = ("Cc", "Cs", "Zl", "Zp")
"""Kinds of letters that steer a terminal, end a line or cannot be written out."""
_PER_TAKE = ("user", "session", "repetition")

_UNREADABLE = (OSError, ValueError, EOFError, KeyError, MemoryError, NotImplementedError)
"""What numpy and zipfile raise on a file that is no NPZ or a damaged one (BadZipFile and zlib.error
beside these); NotImplementedError is a compression that this Python cannot read."""


RATE_UNKNOWN_HZ = 100.0
"""Taken for takes of unknown rate: the paper's."""
RATE_UNKNOWN = (
    f"'rate_hz' is missing: {RATE_UNKNOWN_HZ:g} Hz is taken, times are only as right as that"
)


@dataclass(frozen=True, slots=True)
class TakeSet:
    """Takes of any gestures by anybody. Arrays are read-only.

    Attributes:
        samples: All takes one after the other, shape (n, 3), specific force in g.
        offsets: Take i is ``samples[offsets[i]:offsets[i + 1]]``; shape (m + 1,).
        labels: What was done in each take.
        activation: Index inside each take of the first sample at or after the activation; shape
            (m,).
        user: Who did it, for each take; empty when unknown.
        session: In which session, for each take; empty when unknown.
        repetition: Which repetition of its gesture each take is; empty when unknown.
        rate_hz: Sample rate; None when unknown.
        source: The file it is from, for messages.
        remarks: What was put right while it was read, in words.
    """

    samples: F64
    offsets: I64
    labels: tuple[str, ...]
    activation: I64
    user: tuple[str, ...] = ()
    session: tuple[str, ...] = ()
    repetition: tuple[str, ...] = ()
    rate_hz: float | None = None
    source: Path = Path("takes")
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name, dtype in (("samples", float), ("offsets", np.int64), ("activation", np.int64)):
            array = np.array(getattr(self, name), dtype=dtype)
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        fault = _find_fault(self)
        if fault:
            raise ValueError(fault)

    def __len__(self) -> int:
        return len(self.labels)

    def accel_g(self, index: int) -> F64:
        """The samples of one take, shape (k, 3), in g."""
        return self.samples[self.offsets[index] : self.offsets[index + 1]]

    def select(self, indices: Sequence[int]) -> "TakeSet":
        """The takes with these numbers, in this order."""
        parts = [self.accel_g(i) for i in indices]
        return replace(
            self,
            samples=np.concatenate(parts) if parts else np.zeros((0, 3)),
            offsets=np.cumsum([0, *(len(part) for part in parts)]),
            labels=tuple(self.labels[i] for i in indices),
            activation=self.activation[list(indices)],
            user=_chosen(self.user, indices),
            session=_chosen(self.session, indices),
            repetition=_chosen(self.repetition, indices),
        )

    def fingerprint(self) -> str:
        """A digest that changes with any sample, label, activation or the rate; ``sha256:…``.

        Of the samples as the exchange file holds them: the same before saving and after loading.
        """
        digest = hashlib.sha256()
        for array in (self.samples.astype(np.float32), self.offsets, self.activation):
            digest.update(np.ascontiguousarray(array).tobytes())
        digest.update("\0".join(self.labels).encode())
        digest.update(repr(self.rate_hz).encode())
        return f"sha256:{digest.hexdigest()}"


def load_takes(path: Path) -> TakeSet:
    """Read takes from an NPZ file. Nothing in the file is executed.

    Raises:
        RecordingInvalid: the file cannot be read, is no NPZ, is damaged, not in g or at no usable
            rate; says what and where.
    """
    arrays = _read_arrays(path)
    for name in ("samples", "offsets", "labels"):
        if name not in arrays:
            raise RecordingInvalid(path, f"the array '{name}' is missing; this is no file of takes")
    try:
        return _take_set(arrays, path)
    except ValueError as error:
        raise RecordingInvalid(path, str(error)) from error


def save_takes(path: Path, takes: TakeSet) -> None:
    """Write takes to an NPZ file, atomically.

    Raises:
        DiskFull: no room is left there.
        RecordingError: it cannot be written there.
    """
    arrays: dict[str, NDArray[np.generic]] = {
        "samples": takes.samples.astype(np.float32),
        "offsets": takes.offsets,
        "labels": np.array(takes.labels, dtype=np.str_),
        "activation": takes.activation,
        "rate_hz": np.array(np.nan if takes.rate_hz is None else takes.rate_hz),
    }
    for name in _PER_TAKE:
        if texts := getattr(takes, name):
            arrays[name] = np.array(texts, dtype=np.str_)
    buffer = io.BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **arrays)
    write_atomically(path, buffer.getvalue())


def _take_set(arrays: Mapping[str, NDArray[np.generic]], path: Path) -> TakeSet:
    is_marked = "target_start" in arrays and "activation" not in arrays
    labels, name = _texts("labels", arrays["labels"]), "target_start" if is_marked else "activation"
    takes = TakeSet(
        samples=_numbers("samples", arrays["samples"]),
        offsets=_whole_numbers("offsets", arrays["offsets"]),
        labels=labels,
        activation=_whole_numbers(name, arrays.get(name, np.zeros(len(labels), dtype=np.int64))),
        user=_known_texts("user", arrays),
        session=_known_texts("session", arrays),
        repetition=_known_texts("repetition", arrays),
        rate_hz=_rate(arrays.get("rate_hz")),
        source=path,
    )
    if fault := find_fault(takes.samples, takes.offsets, takes.rate_hz):
        raise ValueError(fault)
    unknown = (RATE_UNKNOWN,) if takes.rate_hz is None else ()
    takes = replace(takes, remarks=(*unknown, *find_doubts(takes.samples, takes.offsets)))
    if not is_marked:
        return _with_gravity(takes)
    turn = arrays.get("R_device_to_paper")
    samples, remarks = put_right(
        takes.samples,
        takes.offsets,
        None if turn is None else _numbers("R_device_to_paper", turn),
    )
    return replace(takes, samples=samples, remarks=(*takes.remarks, *remarks))


def _with_gravity(takes: TakeSet) -> TakeSet:
    samples, remarks = add_gravity(takes.samples, takes.offsets)
    return replace(takes, samples=samples, remarks=(*takes.remarks, *remarks))


def _chosen(texts: tuple[str, ...], indices: Sequence[int]) -> tuple[str, ...]:
    return tuple(texts[i] for i in indices) if texts else ()


def _read_arrays(path: Path) -> Mapping[str, NDArray[np.generic]]:
    if path.exists() and not path.is_file():
        raise RecordingInvalid(path, "is not a file; name an NPZ file of takes")
    try:
        with path.open("rb") as file:
            if not zipfile.is_zipfile(file):
                raise RecordingInvalid(path, "is not an NPZ file, or its end is missing")
            file.seek(0)
            with np.load(file, allow_pickle=False) as archive:
                arrays = {name: archive[name] for name in archive.files}
    except (*_UNREADABLE, zipfile.BadZipFile, zlib.error) as error:
        words = getattr(error, "strerror", None) or str(error) or type(error).__name__
        cause = words.splitlines()[0]
        raise RecordingInvalid(path, f"cannot be read: {cause}") from error
    for name, array in arrays.items():
        if not isinstance(array, np.ndarray):
            raise RecordingInvalid(path, f"'{name}' is not an array")
    return arrays


def _numbers(name: str, array: NDArray[np.generic]) -> F64:
    if array.dtype.kind not in "fiu":
        raise ValueError(f"'{name}' must hold numbers, found {array.dtype}")
    return array.astype(np.float64)


def _whole_numbers(name: str, array: NDArray[np.generic]) -> I64:
    if array.dtype.kind not in "iu" or array.ndim != 1:
        raise ValueError(
            f"'{name}' must be one row of whole numbers, found {array.dtype} of shape {array.shape}"
        )
    whole = array.astype(np.int64)
    if array.dtype.kind == "u" and np.any(whole < 0):
        raise ValueError(f"'{name}' holds a number that is too large")
    return whole


def _texts(name: str, array: NDArray[np.generic]) -> tuple[str, ...]:
    if array.ndim != 1 or array.dtype.kind not in "USiu":
        raise ValueError(
            f"'{name}' must be one row of texts, found {array.dtype} of shape {array.shape}"
        )
    if array.dtype.kind == "S":
        return tuple(bytes(value).decode("utf-8") for value in array.tolist())
    return tuple(str(value) for value in array.tolist())


def _known_texts(name: str, arrays: Mapping[str, NDArray[np.generic]]) -> tuple[str, ...]:
    """One text a take; none at all when the array is missing or holds empty texts only."""
    texts = _texts(name, arrays[name]) if name in arrays else ()
    return texts if any(texts) else ()


def _rate(array: NDArray[np.generic] | None) -> float | None:
    if array is None:
        return None
    if array.size != 1 or array.dtype.kind not in "fiu":
        raise ValueError(f"'rate_hz' must be one number, found shape {array.shape}")
    rate_hz = float(array.reshape(-1)[0].item())
    return None if np.isnan(rate_hz) else rate_hz


def _find_fault(takes: TakeSet) -> str:
    """What is wrong with a set, in words; empty when nothing is."""
    n_takes, offsets = len(takes.labels), takes.offsets
    if takes.samples.ndim != 2 or takes.samples.shape[1] != 3:
        return f"'samples' must have shape (n, 3), found {takes.samples.shape}"
    if offsets.shape != (n_takes + 1,):
        return (
            f"'offsets' must have one more entry than 'labels' ({n_takes}), found {offsets.shape}"
        )
    for name in ("activation", *_PER_TAKE):
        length = len(getattr(takes, name))
        if length != n_takes and (name == "activation" or length):
            return f"'{name}' must have one entry a take ({n_takes}), found {length}"
    if takes.rate_hz is not None and not 0.0 < takes.rate_hz < 1e5:
        return f"'rate_hz' must lie between 0 and 100000, found {takes.rate_hz}"
    return _find_fault_inside(takes)


def _find_fault_inside(takes: TakeSet) -> str:
    offsets, n = takes.offsets, len(takes.samples)
    if offsets[0] != 0:
        return f"'offsets' must begin with 0, found {offsets[0]}"
    lengths = np.diff(offsets)
    if np.any(lengths <= 0):
        take = int(np.argmax(lengths <= 0))
        return f"'offsets' must increase, but take {take} ends where it begins or before"
    if offsets[-1] != n:
        return f"'offsets' must end with the number of samples ({n}), found {offsets[-1]}"
    outside = (takes.activation < 0) | (takes.activation >= lengths)
    if np.any(outside):
        take = int(np.argmax(outside))
        return (
            f"'activation' of take {take} is {takes.activation[take]}, "
            f"outside its {lengths[take]} samples"
        )
    bad = ~np.isfinite(takes.samples).all(axis=1)
    if np.any(bad):
        row = int(np.argmax(bad))
        take = int(np.searchsorted(offsets, row, side="right")) - 1
        return f"'samples' holds a number that is not finite at row {row} (take {take})"
    return _find_fault_of_labels(takes.labels)


def _find_fault_of_labels(labels: tuple[str, ...]) -> str:
    for take, label in enumerate(labels):
        if not label:
            return f"'labels' is empty for take {take}"
        if any(unicodedata.category(letter) in _CONTROL for letter in label):
            return f"'labels' has a control character in {label!a} (take {take})"
    return ""
