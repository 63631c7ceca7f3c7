"""The commands ``config show|path|check|defaults``: settings without a window."""

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

_WIDEST = 40
"""Characters of a column; what is longer pushes the rest of its line to the right."""

if TYPE_CHECKING:  # children start quickly only when nothing heavy is imported with the parser
    from gestureapp.settings_origins import SettingsLayers


def add_commands(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add them to the program's commands."""
    config = commands.add_parser("config", help="settings: show, check and explain them")
    kinds = config.add_subparsers(title="what", metavar="WHAT", required=True)
    show = kinds.add_parser("show", help="every value in use, and where it comes from")
    show.add_argument("--json", action="store_true")
    show.set_defaults(run=_show)
    check = kinds.add_parser("check", help="what is wrong in the files; exit code 1 if anything is")
    check.set_defaults(run=_check)
    path = kinds.add_parser("path", help="which files are read, lowest layer first")
    path.set_defaults(run=_path)
    for command in (show, check, path):
        # Left unset where it is not given: the same option before the command holds then.
        command.add_argument("--config", type=Path, default=argparse.SUPPRESS, help="the top layer")
    kinds.add_parser("defaults", help="a settings file with all that is built in").set_defaults(
        run=_defaults
    )


def _show(options: argparse.Namespace) -> int:
    layers = _layers(options)
    if options.json:
        _write(json.dumps(_as_json(layers), ensure_ascii=False))
        return 0
    findings = ["", *map(str, layers.findings)] if layers.findings else []
    for line in (*_files(options), *_table(layers), *findings):
        _write(line)
    return 0


def _check(options: argparse.Namespace) -> int:
    from gestureapp.cell.limits import checked_limits
    from gestureapp.errors import ConfigError

    layers = _layers(options)
    lines = [str(finding) for finding in layers.findings]
    try:
        checked_limits(layers.settings)
    except ConfigError as error:  # each fits its range, but they do not fit together
        lines.append(str(error))
    for line in lines or ["nothing is wrong"]:
        _write(line)
    return 1 if lines else 0


def _path(options: argparse.Namespace) -> int:
    for line in _files(options):
        _write(line)
    return 0


def _files(options: argparse.Namespace) -> list[str]:
    from gestureapp.running import settings_files

    site, user = settings_files()
    rows = [("site", site), ("user", user)]
    if (named := _named(options)) is not None:
        rows.append(("--config", named))
    return [f"{layer:<10}{_is_there(file):<11}{file}" for layer, file in rows]


def _is_there(file: Path) -> str:
    try:
        return "there" if file.exists() else "not there"
    except OSError:
        return "unreadable"


def _defaults(options: argparse.Namespace) -> int:
    from gestureapp.settings_text import default_settings_text

    sys.stdout.write(default_settings_text())
    return 0


def _layers(options: argparse.Namespace) -> "SettingsLayers":
    from gestureapp.running import settings_files
    from gestureapp.settings_file import read_layers

    return read_layers(settings_files(), _named(options))


def _named(options: argparse.Namespace) -> Path | None:
    named: Path | None = getattr(options, "config", None)
    return named


def _table(layers: "SettingsLayers") -> list[str]:
    """Aligned columns: setting, value with unit, origin, what is allowed."""
    from gestureapp.settings_check import named_values
    from gestureapp.settings_text import allowed, toml
    from gestureapp.settings_words import shown, unit_of

    rows = []
    for name, owner, value in named_values(layers.settings):
        key = name.partition(".")[2]
        text = shown(value) if name == "robot.keep_outs" else toml(value)
        origin = str(layers.origins[name])
        rows.append((name, f"{text} {unit_of(key)}".rstrip(), origin, allowed(owner, key)))
    widths = [min(max(len(row[i]) for row in rows), _WIDEST) for i in range(3)]
    lines, table = [], ""
    for row in rows:
        if (here := row[0].partition(".")[0]) != table:
            table = here
            lines.append("")
        padded = "  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=False))
        lines.append(f"{padded}  {row[3]}".rstrip())
    return lines


def _as_json(layers: "SettingsLayers") -> dict[str, Any]:
    from gestureapp.settings_check import named_values
    from gestureapp.settings_text import allowed
    from gestureapp.settings_values import plain
    from gestureapp.settings_words import unit_of

    settings = []
    for name, owner, value in named_values(layers.settings):
        key, origin = name.partition(".")[2], layers.origins[name]
        settings.append(
            {
                "name": name,
                "value": plain(value),
                "unit": unit_of(key),
                "allowed": allowed(owner, key),
                "origin": str(origin),
                "file": str(origin.file) if origin.file else None,
                "line": origin.line,
            }
        )
    findings = [
        {
            "setting": finding.setting,
            "text": finding.text,
            "file": str(finding.file) if finding.file else None,
            "line": finding.line,
            "stops_the_start": finding.is_refused,
        }
        for finding in layers.findings
    ]
    return {"settings": settings, "findings": findings}


def _write(text: str) -> None:
    sys.stdout.write(f"{text}\n")
