"""What guided training asks of a person, taken from what it shows. Pure, no Qt."""

from gestureapp.guided.values import GuidedSnapshot, Pace, Phase
from gestureapp.simulation.prompts import NOTHING, Prompt

_ASKING = (Phase.COUNT_IN, Phase.WAITING, Phase.TAKING)


def prompt_of(guided: GuidedSnapshot) -> Prompt:
    """What a person who looks at this is to do now."""
    trying = guided.trying
    if trying.is_on:
        return Prompt(trying.asked, bool(trying.asked), number=trying.n_done, is_trial=True)
    if guided.phase not in _ASKING:
        return NOTHING
    if guided.pace is Pace.RHYTHM:
        return Prompt(guided.label, False, guided.next_beat_s, guided.beat_s)
    return Prompt(guided.label, guided.phase is Phase.WAITING)
