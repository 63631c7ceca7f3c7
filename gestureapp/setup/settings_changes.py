"""What changes between two settings, and how it is told. Pure."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

from gestureapp.config import Settings
from gestureapp.settings_check import SettingsFinding, named_values
from gestureapp.settings_values import plain
from gestureapp.settings_words import shown

LATER: Final = ", used from the next start on"


def waits(name: str) -> bool:
    """Whether a change of this setting is used at the next start only: people are chosen."""
    return name.startswith("person.")


def values_of(settings: Settings) -> dict[str, Any]:
    """Every setting by dotted name."""
    return {name: value for name, _, value in named_values(settings)}


def changed(
    used: Settings, before: Settings, after: Settings, wishes: Mapping[str, object] | None = None
) -> Settings:
    """The used settings with what differs between two readings of the files.

    What is wished for is taken even where the files say so already: something else may be in use,
    as with a demo, which is not started from its files.
    """
    old, new = values_of(before), values_of(after)
    given = {name for name, value in (wishes or {}).items() if value is not None}
    return with_values(used, {n: new[n] for n in new if new[n] != old[n] or n in given})


def with_values(used: Settings, values: Mapping[str, object]) -> Settings:
    """The used settings with these values, by dotted name."""
    for name, value in values.items():
        table, _, key = name.partition(".")
        used = replace(used, **{table: replace(getattr(used, table), **{key: value})})
    return used


def new_findings(
    before: Sequence[SettingsFinding], after: Sequence[SettingsFinding]
) -> dict[str, str]:
    """What is wrong now and was not before, by setting, in words for beside its field."""
    known = {(finding.setting, finding.text) for finding in before}
    new = [finding for finding in after if (finding.setting, finding.text) not in known]
    return {finding.setting: finding.cause or finding.text for finding in new}


def told(before: Settings, after: Settings) -> list[str]:
    """Lines for the session's events: which settings the window has changed, from what to what."""
    old, new = values_of(before), values_of(after)
    return [
        f"settings: {name} {shown(plain(old[name]))} -> {shown(plain(new[name]))} by the window"
        f"{LATER if waits(name) else ''}"
        for name in new
        if new[name] != old[name]
    ]
