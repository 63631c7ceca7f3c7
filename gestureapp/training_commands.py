"""The commands ``train``, ``evaluate`` and ``train-base``: takes, and what comes of them."""

import argparse
import dataclasses
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # children start quickly only when nothing heavy is imported with the parser
    from gestureapp.recognition.model_file import Model
    from gestureapp.recognition.takes import TakeSet


def add_commands(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add both to the program's commands."""
    train = commands.add_parser("train", help="train a model from takes")
    train.add_argument("takes", type=Path, metavar="TAKES.npz")
    train.add_argument("-o", "--out", type=Path, required=True, metavar="MODEL.json")
    train.add_argument("--preset", choices=("default", "paper", "small"), default="default")
    train.add_argument("--seed", type=_seed, default=0)
    train.add_argument(
        "--folds",
        choices=("session", "time", "repetition", "user"),
        help="what the cross-validation keeps together; chosen by what the takes say when left out",
    )
    train.add_argument("--json", action="store_true")
    train.set_defaults(run=_train)

    evaluate = commands.add_parser("evaluate", help="what a model makes of takes")
    evaluate.add_argument("model", type=Path, metavar="MODEL.json")
    evaluate.add_argument("takes", type=Path, metavar="TAKES.npz")
    evaluate.add_argument("--json", action="store_true")
    evaluate.set_defaults(run=_evaluate)

    base = commands.add_parser("train-base")  # no help: for who changes the features
    base.add_argument("folder", type=Path)
    base.set_defaults(run=_train_base)


def _train(options: argparse.Namespace) -> int:
    from gestureapp.errors import ModelError
    from gestureapp.recognition.folds import FoldBy
    from gestureapp.recognition.model_file import save_model
    from gestureapp.recognition.presets import Preset
    from gestureapp.recognition.takes import load_takes
    from gestureapp.recognition.training import train

    takes = load_takes(options.takes)
    _check_place(options.out)
    left_out = _tell_about(takes)
    try:
        model = train(
            takes,
            Preset(options.preset),
            options.seed,
            _show_progress,
            takes_from=str(options.takes),
            folds=FoldBy(options.folds) if options.folds else None,
        )
    except ValueError as error:
        raise ModelError(options.takes, str(error)) from error
    save_model(options.out, model)
    _end_progress()
    _write(_train_json(options.out, model, left_out) if options.json else _text(options.out, model))
    return 0


def _train_base(options: argparse.Namespace) -> int:
    """Train the shared base model of ``resources/models``: minutes."""
    from gestureapp.benchmark.base_model import make_base
    from gestureapp.recognition.base import BASE

    out: Path = options.folder / BASE.name
    _check_place(out)
    model = make_base(options.folder, progress=_show_progress)
    _end_progress()
    _write(_text(out, model))
    return 0


def _show_progress(done: int, total: int, loss: float) -> None:
    if sys.stderr.isatty():
        sys.stderr.write(f"\r{done} of {total}, loss {loss:.5f} ")


def _end_progress() -> None:
    if sys.stderr.isatty():
        sys.stderr.write("\n")


def _train_json(out: Path, model: "Model", left_out: int) -> str:
    facts: dict[str, object] = {
        "model": str(out),
        "labels": list(model.labels),
        "left_out": left_out,
        "training": dataclasses.asdict(model.training),
    }
    if model.decision is not None:
        facts["decision"] = dataclasses.asdict(model.decision)
    if (found := model.cross_validation) is not None:
        facts["cross_validation"] = {"folds": found.folds, **found.evaluation.as_json()}
    return json.dumps(facts)


def _text(out: Path, model: "Model") -> str:
    from gestureapp.recognition.calibration import promise_of

    record = model.training
    lines = [
        f"{out}: {record.n_takes} takes, loss {record.loss:.6f}",
        f"trained in {record.duration_s:.1f} s",
    ]
    if (found := model.cross_validation) is not None:
        lines += [f"cross-validated {found.folds}:", found.evaluation.as_table()]
    if (promised := promise_of(model)) is not None:
        lines.append(f"{promised[0].value}; {promised[1]}")
    if (needs := model.decision) is not None:
        lines.append(f"an answer needs {needs.early:g} at once, {needs.last:g} in the end")
    return "\n".join(lines)


def _evaluate(options: argparse.Namespace) -> int:
    from gestureapp.recognition.hearing import evaluate, find_other_rate
    from gestureapp.recognition.model_file import load_model
    from gestureapp.recognition.takes import load_takes

    takes = load_takes(options.takes)
    model = load_model(options.model)
    evaluation = evaluate(model, takes)
    _tell_about(takes)
    if words := find_other_rate(model, takes):
        _remark(options.model, words)
    _write(json.dumps(evaluation.as_json()) if options.json else evaluation.as_table())
    return 0


def _tell_about(takes: "TakeSet") -> int:
    """Say what was put right and what is too short; how many takes are."""
    from gestureapp.recognition.patterns import whole_takes

    for remark in takes.remarks:
        _remark(takes.source, remark)
    whole = set(whole_takes(takes))
    short = [i for i in range(len(takes)) if i not in whole]
    if short:
        count = "1 take ends" if len(short) == 1 else f"{len(short)} takes end"
        labels = ", ".join(sorted({takes.labels[i] for i in short}))
        _remark(
            takes.source,
            f"{count} before the third sample after the activation ({labels}); nothing can be "
            "learned there, nor recognised",
        )
    return len(short)


def _remark(path: Path, words: str) -> None:
    sys.stderr.write(f"gestureapp: {path}: {words}\n")


def _check_place(out: Path) -> None:
    """A training takes its time: whether its model can be written is asked before.

    Raises:
        ModelError: there is no such folder, or the name is a folder's.
    """
    from gestureapp.errors import ModelError

    if out.is_dir() or not out.parent.is_dir():
        raise ModelError(out, "no file can be written there; name one in a folder that exists")


def _seed(text: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text) < 1 << 32):
        raise argparse.ArgumentTypeError(f"{text} is not a whole number from 0 to 4294967295")
    return int(text)


def _write(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()
