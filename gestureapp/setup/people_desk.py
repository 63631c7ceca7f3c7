"""Who uses this cell: everybody's takes, model, postures and hand; whose are in use."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from gestureapp.cell.controls import CellControls
from gestureapp.cell.ear import describe_model
from gestureapp.errors import ModelError, RecordingError
from gestureapp.recognition.model_file import load_model
from gestureapp.recording.people import (
    clean_name,
    list_people,
    look_alike,
    make_person_folder,
    note_last_person,
    person_folder,
)
from gestureapp.recording.person_profile import (
    Handedness,
    PersonProfile,
    load_profile,
    save_profile,
)
from gestureapp.recording.take_store import TakeStore
from gestureapp.recording.take_values import Take
from gestureapp.sensing.posture import LeftPostures
from gestureapp.setup.arm_sensor import day_words
from gestureapp.setup.postures import LEAST_MARGIN_DEG, between_deg, margin_deg, posture_problem
from gestureapp.setup.site_values import PersonRow
from gestureapp.setup.values import PosturesView

_BUILT_IN_WORDS = "the built-in ones"
DAMAGED_REMEDY: Final = (
    "record the postures anew or press Use the built-in ones: Setup, step Calibrate"
)
_AND_THE_HAND: Final = "then note the handedness again"


@dataclass(frozen=True, slots=True)
class PeopleSource:
    """What training knows of people.

    Attributes:
        own_model: The model that a person has trained here, and why it is out of date; None when
            there is none.
        open_takes: Whose takes are open there, and these: nobody else can read them meanwhile.
    """

    own_model: Callable[[str], tuple[Path, str] | None] = lambda _person: None
    open_takes: Callable[[], tuple[str, Sequence[Take]]] = lambda: ("", ())


class PeopleDesk:
    """Follows whose model is in use, and gives the cell that person's postures.

    Owned by the setup thread, but for ``rows``, which any may read.

    Args:
        cell: Is given models and postures.
        data: The data folder.
        source: What training knows.

    Attributes:
        rows: Everybody, as of the last look.
        person: Whose model and postures are in use.
    """

    def __init__(self, cell: CellControls, data: Path, source: PeopleSource) -> None:
        self._cell, self._data, self._source = cell, data, source
        self.rows: tuple[PersonRow, ...] = ()
        self.person = ""
        self._told: tuple[LeftPostures, str, str] | None = None
        self._chosen: tuple[PersonProfile, str] = PersonProfile(), ""
        self._angles_deg = self._site_angles_deg()

    @property
    def handedness(self) -> Handedness:
        """Of whoever is chosen."""
        return self._chosen[0].handedness

    def follow(self, person: str, wall_s: float) -> None:
        """Whose arms the cell's model is for; the postures are then theirs, too.

        The site's angles may change, too: the same postures may be too close together then.
        """
        if person != self.person or self._told is None:
            self.person = person
            self.use_postures()
            self.rows = tuple(replace(row, is_chosen=row.name == person) for row in self.rows)
        elif self._angles_deg != self._site_angles_deg():
            self.use_postures()
            self.look(wall_s)

    def use_postures(self) -> None:
        """Give the cell the postures of whoever is chosen, as they are kept now."""
        site = self._cell.settings.site
        self._angles_deg = self._site_angles_deg()
        profile, trouble = self._chosen = self._profile(self.person)
        postures = profile.postures or LeftPostures()
        problem, remedy = posture_problem(postures, site)
        if trouble:
            problem, remedy = trouble, DAMAGED_REMEDY
        chosen = (postures, problem, remedy)
        if chosen != self._told:
            self._told = chosen
            self._cell.use_postures(*chosen)

    def _site_angles_deg(self) -> tuple[float, float]:
        """Within which a posture is taken and up to which it holds."""
        site = self._cell.settings.site
        return site.posture_enter_deg, site.posture_leave_deg

    def postures_view(self) -> PosturesView:
        """The chosen person's postures, while none are being recorded."""
        profile, trouble = self._chosen
        _, problem, remedy = self._told or (LeftPostures(), "", "")
        if trouble:
            return PosturesView(
                person=self.person,
                sentence=f"{trouble}: {remedy}, {_AND_THE_HAND}.",
                least_margin_deg=LEAST_MARGIN_DEG,
                problem=problem,
                remedy=remedy,
            )
        postures = profile.postures or LeftPostures()
        own = profile.postures is not None
        whose = f"{self.person}'s own" if own else _BUILT_IN_WORDS
        return PosturesView(
            person=self.person,
            sentence=f"In use: {whose}.",
            is_stop_done=own,
            is_start_done=own,
            between_deg=between_deg(postures.stop, postures.start),
            margin_deg=margin_deg(postures, self._cell.settings.site),
            least_margin_deg=LEAST_MARGIN_DEG,
            wall_s=profile.recorded_wall_s if own else 0.0,
            arm=start_stop_arm(profile.handedness),
            problem=problem,
            remedy=remedy,
        )

    def forget_postures(self) -> str:
        """Use the built-in postures for the chosen person. Returns why not, or empty."""
        person = self.person
        if not person:
            return "nobody is chosen: choose a person first"
        old, trouble = self._profile(person)
        if wrong := self._keep(person, replace(old, postures=None)):
            return wrong
        if trouble:
            self._cell.tell(f"{trouble}: set aside; {person} uses the built-in postures")
        return ""

    def set_handedness(self, person: str, handedness: Handedness) -> str:
        """Note which hand shows the gestures. Returns why not, or empty.

        A damaged profile is not replaced by this: whoever recorded postures would go on with the
        built-in ones without having chosen them.
        """
        if not person:
            return "nobody is chosen: choose a person first"
        old, trouble = self._profile(person)
        if trouble:
            wrong = _hand_refused(trouble)
            self._cell.tell(f"handedness not noted: {wrong}")
            return wrong
        return self._keep(person, replace(old, handedness=handedness))

    def why_not_hand(self, name: str) -> str:
        """Why this person's handedness cannot be noted, as far as is known without looking."""
        trouble = next((row.trouble for row in self.rows if row.name == name), "")
        return _hand_refused(trouble) if trouble else ""

    def why_not(self, name: str) -> str:
        """Why nobody can be called so; empty when somebody can."""
        try:
            folder = person_folder(self._data, name)
        except RecordingError as error:
            return str(error).removeprefix(f"{error.path}: ")
        if not folder.exists() and (there := look_alike(self._data, name)):
            return f"there is already {there}: choose that one, or another name"
        return ""

    def choose(self, name: str) -> None:
        """Use this person's model and postures; a new name is new here.

        Raises:
            RecordingError: there is no room for a folder.
        """
        person = clean_name(name)
        if person != self._cell.settings.person.name:
            make_person_folder(self._data, person)
        note_last_person(self._data, person)
        own = self._source.own_model(person)
        if own is None:
            self._cell.use_model(None, "", person)
        else:
            self._cell.use_model(*own, person)

    def look(self, wall_s: float) -> None:
        """Look at everybody's files."""
        names = [*list_people(self._data)]
        for name in (self._cell.settings.person.name, self.person):
            if name and name not in names:
                names.append(name)
        self.rows = tuple(self._row(name, wall_s) for name in sorted(names, key=str.casefold))

    def _row(self, name: str, wall_s: float) -> PersonRow:
        profile, trouble = self._profile(name)
        words = _BUILT_IN_WORDS
        if profile.postures is not None:
            margin = margin_deg(profile.postures, self._cell.settings.site)
            when = day_words(profile.recorded_wall_s, wall_s)
            words = f"recorded {when}, margin {math.floor(margin)} degrees"
        return PersonRow(
            name=name,
            is_chosen=name == self.person,
            handedness=profile.handedness,
            n_takes=self._n_takes(name),
            model=self._model_words(name),
            postures=trouble or words,
            trouble=trouble,
        )

    def _n_takes(self, name: str) -> int:
        person, takes = self._source.open_takes()
        if person == name:
            return sum(take.counts for take in takes)
        if name not in list_people(self._data):
            return 0
        try:
            store = TakeStore(self._data, name)
        except RecordingError:
            return 0
        try:
            return sum(take.counts for take in store.takes())
        finally:
            store.close()

    def _model_words(self, name: str) -> str:
        own = self._source.own_model(name)
        settings = self._cell.settings.person
        if own is None and name == settings.name and settings.model is not None:
            own = settings.model, ""
        if own is None:
            return "no model yet"
        path, out_of_date = own
        try:
            words = describe_model(load_model(path), path.stem)
        except ModelError as error:
            return f"{path.name}: {str(error).removeprefix(f'{error.path}: ')}"
        return f"{words}; {out_of_date}" if out_of_date else words

    def _profile(self, person: str) -> tuple[PersonProfile, str]:
        if not person:
            return PersonProfile(), ""
        try:
            return load_profile(self._data, person)
        except RecordingError as error:
            return PersonProfile(), str(error)

    def _keep(self, person: str, profile: PersonProfile) -> str:
        try:
            save_profile(self._data, person, profile)
        except RecordingError as error:
            return str(error)
        if person == self.person:
            self.use_postures()
        return ""


def start_stop_arm(handedness: Handedness) -> str:
    """On which arm the sensor that starts and stops is worn, in a word; the other shows gestures.

    In the code, the files and the settings that sensor is the left one, whoever wears it.
    """
    return "left" if handedness is Handedness.RIGHT else "right"


def _hand_refused(trouble: str) -> str:
    return f"{trouble}: {DAMAGED_REMEDY}, {_AND_THE_HAND}"
