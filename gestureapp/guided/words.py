"""What guided recording says to the person, one sentence for every moment. Pure."""

from gestureapp.gestures import gesture, is_held
from gestureapp.guided.batch import Batch
from gestureapp.guided.values import Pace, Phase
from gestureapp.recording.take_values import Take

CHOOSE_PERSON = "Choose whose takes these are."
ALL_DONE = "All takes are there: look at them, then train."


def idle_sentence(label: str, suggested: str) -> str:
    """Between batches: ``label`` is what would be recorded."""
    if not suggested and not label:
        return ALL_DONE
    words = f"{label}: {gesture(label).words}. Start when you are ready."
    return words if suggested else f"{ALL_DONE} Or record more of {words}"


def batch_sentence(batch: Batch, label: str, n_good: int) -> str:
    """During a batch; ``n_good`` takes of the gesture count, of this batch and all before."""
    match batch.phase:
        case Phase.PAUSED:
            return f"Paused; {_kept(n_good)}."
        case Phase.SENSOR_LOST:
            side = batch.lost.value.capitalize() if batch.lost else "A"
            lost = f"{side} sensor lost during take {n_good + 1}; {_kept(n_good)}"
            return f"{lost}. It goes on by itself when the sensor is back."
        case Phase.COUNT_IN:
            return f"Get ready: {gesture(label).words}."
    if batch.pace is Pace.RHYTHM:
        return _by_rhythm(label)
    if batch.phase is Phase.TAKING:
        return "Now back to the start, and the left arm to its stop posture."
    if not batch.is_left_rested:
        return "Bring the left arm to the stop posture."
    return _hands_free(label)


def _by_rhythm(label: str) -> str:
    words = gesture(label).words
    if is_held(label):
        return f"{words.capitalize()}: be there at each beat, then back to level."
    return f"{words.capitalize()} at each beat, then back to the start."


def _hands_free(label: str) -> str:
    words = gesture(label).words
    if is_held(label):
        return f"{words.capitalize()}; then take the start posture with the left arm."
    return f"{words.capitalize()} as the left arm takes the start posture."


def _kept(n_good: int) -> str:
    return "1 good take is kept" if n_good == 1 else f"{n_good} good takes are kept"


def kept_words(take: Take) -> str:
    """What became of a gesture that was kept as a take."""
    if take.judgement.is_good:
        return f"Kept as a take of {take.label}: the next training learns from it."
    return f"Kept as a take of {take.label}, but it does not count: {take.judgement.words}."


def whose_words(person: str, open_person: str) -> str:
    """Why a gesture cannot be kept as a take of its person."""
    if not person:
        return "The model in use is nobody's: train one on the page Train to keep takes."
    if not open_person:
        return f"{person} has no takes here: record some on the page Train first."
    return f"The takes of {open_person} are open: choose {person} on the page Train first."
