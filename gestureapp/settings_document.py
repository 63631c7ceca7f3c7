"""Values put into the text of a settings file, whose comments and order stay. Pure."""

from collections.abc import Mapping
from typing import Any, Final, cast, get_type_hints

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT, Table

from gestureapp.config import Settings
from gestureapp.settings_check import LOCK_TABLE
from gestureapp.settings_text import comment_on_key, comment_on_table

_LOCK_COMMENT: Final = (
    "# The PIN before settings that bear on motion; take this table out to have none."
)


class UnfitLayout(Exception):
    """A list of tables stands where a table should be, or the like."""


def with_values(text: str, values: Mapping[str, Any]) -> str:
    """The text with these values in it.

    Args:
        text: Valid TOML.
        values: In TOML's types, by dotted name of table and key. None takes the key out.

    Raises:
        UnfitLayout: they cannot be put into it.
    """
    try:
        document = tomlkit.parse(text)
        for name, value in values.items():
            _put(document, name, value)
        return tomlkit.dumps(document)
    except (TOMLKitError, TypeError, AttributeError) as error:
        raise UnfitLayout(str(error)) from error


def _put(document: tomlkit.TOMLDocument, name: str, value: Any) -> None:  # noqa: ANN401 - TOML
    table_name, _, key = name.partition(".")
    if value is None:
        if table_name in document:
            cast("Any", document[table_name]).pop(key, None)
        return
    if table_name not in document:
        _add_table(document, table_name)
    table = cast("Any", document[table_name])
    if key in table and isinstance(table[key], AoT):
        table.pop(key)
    has_room = isinstance(table, Table) and not any(
        isinstance(item, AoT | Table) for item in table.values()
    )  # before tables of its own a comment would not stay with its key
    if key not in table and has_room:
        for line in _comment_lines(name):
            table.add(tomlkit.comment(line.removeprefix("# ")))
    table[key] = _item(value)


def _item(value: Any) -> Any:  # noqa: ANN401 - TOML
    """Boxes stay inside their list, each a table on one line."""
    if not isinstance(value, list) or not any(isinstance(item, dict) for item in value):
        return value
    items = tomlkit.array()
    for item in value:
        inline = tomlkit.inline_table()
        inline.update(item)
        items.append(inline)
    return items.multiline(True)


def _add_table(document: tomlkit.TOMLDocument, name: str) -> None:
    document.add(tomlkit.nl())
    owner = _owner_of(name)
    for line in [_LOCK_COMMENT] if owner is None else comment_on_table(owner):
        document.add(tomlkit.comment(line.removeprefix("# ")))
    document.add(name, tomlkit.table())
    cast("Any", document[name]).trivia.indent = ""  # right below its comment


def _comment_lines(name: str) -> list[str]:
    table, _, key = name.partition(".")
    owner = _owner_of(table)
    return [] if owner is None else comment_on_key(owner, key)


def _owner_of(table: str) -> type | None:
    """The settings class of a table; None for that of the PIN."""
    return None if table == LOCK_TABLE else cast("type", get_type_hints(Settings)[table])
