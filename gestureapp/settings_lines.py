"""The line of each setting in a settings file, which the TOML parser does not tell. Pure."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Final

_MAX_STATEMENT_LINES: Final = 50


def lines_of(text: str) -> Mapping[str, int]:
    """The line of every key and of every item of a list, by dotted name, from 1.

    Any statement of a valid file is a valid file by itself: lines are added until they parse, and
    the keys found there stand on the first of them. An item of a list stands where the list, closed
    after it, parses. After a statement of absurd length the table just ends.
    """
    lines: dict[str, int] = {}
    table: tuple[str, ...] = ()
    n_of: dict[tuple[str, ...], int] = {}
    for start, statement, found, items in _statements(text):
        paths = list(_paths(found))
        if statement.startswith("["):
            table = paths[0] if paths else ()
            if statement.startswith("[["):
                n_of[table] = n_of.get(table, -1) + 1
                table = (*table, str(n_of[table]))
            paths, items = [()], {}
        for path in paths:
            _note(lines, (*table, *path), start)
        for path, at in items.items():
            _note(lines, (*table, *path), at)
    return lines


def _statements(
    text: str,
) -> Iterator[tuple[int, str, Mapping[str, Any], Mapping[tuple[str, ...], int]]]:
    """First line, text and content of every statement, and the lines of the items of its lists."""
    items: dict[tuple[str, ...], int] = {}
    statement, start = "", 1
    for number, line in enumerate(text.split("\n"), 1):
        if not statement:
            if not line.strip() or line.lstrip().startswith("#"):
                continue
            start, items = number, {}
        statement += line + "\n"
        found = _parsed(statement)
        so_far = _parsed(f"{statement}]") if found is None else found
        for path in _items(so_far or {}):
            items.setdefault(path, number)
        if found is not None:
            yield start, statement.lstrip(), found, items
            statement = ""
        elif number - start >= _MAX_STATEMENT_LINES:
            return


def _parsed(text: str) -> dict[str, Any] | None:
    try:
        return tomllib.loads(text)
    except ValueError:
        return None


def _note(lines: dict[str, int], path: Sequence[str], line: int) -> None:
    for n in range(1, len(path) + 1):
        lines.setdefault(".".join(path[:n]), line)


def _items(found: Mapping[str, Any]) -> Iterator[tuple[str, ...]]:
    """The dotted paths to every item of every list in a parsed statement."""
    for key, value in found.items():
        if isinstance(value, dict):
            for path in _items(value):
                yield (key, *path)
        elif isinstance(value, list):
            for i in range(len(value)):
                yield (key, str(i))


def _paths(found: Mapping[str, Any]) -> Iterator[tuple[str, ...]]:
    """The dotted paths to everything in a parsed statement."""
    for key, value in found.items():
        inner = value[-1] if isinstance(value, list) and value else value
        if isinstance(inner, dict) and inner:
            for path in _paths(inner):
                yield (key, *path)
        else:
            yield (key,)
