"""Takes of other makers, which mark where the gesture begins and know no activation. Pure.

Such a file has ``target_start`` instead of ``activation``. What differs from ours is put right:

* ``target_start`` is taken for the activation: as if the left arm had started exactly then.
* ``R_device_to_paper`` (3, 3), when present, turns the samples into our axes: ``samples @ R.T``.
* A driver may have removed gravity already. When the quiet part before the gestures reads about
  0 g, 1 g is added on Z, as a level sensor would read it: also to takes that know their activation.
"""

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

GRAVITY_HALF_G = 0.5
"""A sensor at rest reads 1 g, one whose gravity was removed 0 g: half way between the two."""


def put_right(
    samples: F64, offsets: I64, starts: I64, turn: F64 | None
) -> tuple[F64, tuple[str, ...]]:
    """Samples as our sensors would have given them, and what was done to them, in words.

    Args:
        samples: Shape (n, 3), in g.
        offsets: Shape (m + 1,), where each take begins.
        starts: Shape (m,), index of the gesture's first sample inside each take.
        turn: Rotation from the device's axes to ours, or None when they are ours.

    Raises:
        ValueError: the rotation is none.
    """
    remarks = ["the activation is where the file marks the gesture's begin ('target_start')"]
    if turn is not None:
        if turn.shape != (3, 3) or not np.allclose(turn @ turn.T, np.eye(3), atol=1e-3):
            raise ValueError("'R_device_to_paper' must be a rotation of shape (3, 3)")
        samples = samples @ turn.T
        remarks.append("the axes are turned by 'R_device_to_paper'")
    samples, of_gravity = add_gravity(samples, offsets, starts)
    return samples, (*remarks, *of_gravity)


def add_gravity(samples: F64, offsets: I64, starts: I64) -> tuple[F64, tuple[str, ...]]:
    """Samples as a level sensor would have read them, and what was done, in words.

    Args:
        samples: Shape (n, 3), in g.
        offsets: Shape (m + 1,), where each take begins.
        starts: Shape (m,), before which the hand is quiet in each take.
    """
    if not _has_no_gravity(samples, offsets, starts):
        return samples, ()
    return samples + np.array([0.0, 0.0, 1.0]), ("gravity had been removed: 1 g is added on Z",)


def _has_no_gravity(samples: F64, offsets: I64, starts: I64) -> bool:
    quiet = np.zeros(len(samples), dtype=np.bool_)
    for begin, start in zip(offsets[:-1].tolist(), starts.tolist(), strict=True):
        quiet[begin : begin + start] = True
    size_g = np.linalg.norm(samples[quiet] if quiet.any() else samples, axis=1)
    return bool(size_g.size) and float(np.median(size_g)) < GRAVITY_HALF_G
