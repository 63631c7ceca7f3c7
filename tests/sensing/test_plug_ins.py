"""Protocols of other packages: the documented example as it would be installed, and bad ones."""

import tomllib
from collections.abc import Callable, Iterator
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from gestureapp import cli
from gestureapp.errors import ConfigError
from gestureapp.running import RunningCell
from gestureapp.sensing import protocols as protocols_module
from gestureapp.sensing.calibration import NOMINAL, accel_of
from gestureapp.sensing.decoder import LineDecoder
from gestureapp.sensing.plug_ins import GROUP, load_plug_ins
from gestureapp.sensing.protocols import BUILT_IN, Protocol, plug_in_findings, protocol, protocols
from gestureapp.sensing.values import (
    Battery,
    CounterGap,
    CounterJump,
    DecoderEvent,
    Frame,
    Garbage,
    Identity,
    Impossible,
    Repeated,
)
from tests.cell.conftest import wait_until
from tests.sensing.test_reader import Bench, script

EXAMPLE = Path(__file__).parents[2] / "docs" / "examples" / "protocol_plug_in"
BUILT_IN_NAMES = {known.name for known in BUILT_IN}

Install = Callable[..., None]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """Puts a package where an installer would: its module, and the entry points beside it."""

    def put(name: str, points: dict[str, str], code: str) -> None:
        (tmp_path / f"{next(iter(points.values())).split(':')[0]}.py").write_text(code)
        info = tmp_path / f"{name}-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
        lines = "\n".join(f"{point} = {value}" for point, value in points.items())
        (info / "entry_points.txt").write_text(f"[{GROUP}]\n{lines}\n")

    monkeypatch.syspath_prepend(tmp_path)
    protocols_module._known.cache_clear()
    yield put
    protocols_module._known.cache_clear()


def install_example(install: Install) -> None:
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    points = project["entry-points"][GROUP]
    install(project["name"], points, (EXAMPLE / "milli_g_protocol.py").read_text())


def test_the_documented_example_is_found_and_read_like_any_other(install: Install):
    install_example(install)
    assert [known.name for known in protocols()] == [*(k.name for k in BUILT_IN), "milli-g"]
    assert plug_in_findings() == ()
    pieces = (b"\nA7 x=-12 y=4 z=998\r\nA9 x=0 y=", b"0 z=1000\nrubbish\n")
    with Bench("script", "milli-g", opener=script(*pieces)) as bench:
        first, second = bench.samples(2)
        assert bench.next(Garbage).first_bytes == b"rubbish"
    assert first.accel_g == (-0.012, 0.004, 0.998)
    assert (second.counter, second.accel_g) == (9, (0.0, 0.0, 1.0))


def test_the_example_is_as_long_as_promised_and_stands_in_the_documentation():
    text = (EXAMPLE / "milli_g_protocol.py").read_text()
    assert len(text.splitlines()) <= 30
    page = (EXAMPLE.parents[1] / "sensors.md").read_text()
    assert text in page
    assert (EXAMPLE / "pyproject.toml").read_text() in page


def test_an_unknown_protocol_names_those_of_plug_ins_too(install: Install):
    install_example(install)
    with pytest.raises(ConfigError, match=r"did you mean 'milli-g'\?.*csv, milli-g, witmotion"):
        protocol("milli_g")


def test_a_plug_in_that_cannot_be_imported_is_one_line_and_the_others_stay(
    install: Install, caplog: pytest.LogCaptureFixture
):
    install("broken", {"morse": "broken_protocol:PROTOCOL"}, "import no_such_module_at_all\n")
    install_example(install)
    caplog.set_level("INFO")
    assert "milli-g" in [known.name for known in protocols()]
    (finding,) = plug_in_findings()
    assert finding == (
        "protocol plug-in 'morse' of broken (broken_protocol:PROTOCOL) is not used: it fails with "
        "ModuleNotFoundError: No module named 'no_such_module_at_all'; mend or remove the package"
    )
    assert finding in [record.getMessage() for record in caplog.records]


def test_the_application_says_once_what_is_wrong_with_a_plug_in_and_starts(
    install: Install, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    install("broken", {"morse": "broken_protocol:PROTOCOL"}, "1 / 0\n")
    told: list[str] = []

    def open_window(running: RunningCell, _: float | None) -> int:
        assert wait_until(lambda: lines(running))
        told.extend(lines(running))
        return 0

    def lines(running: RunningCell) -> list[str]:
        events = running.cell.snapshot().events
        return [event.text for event in events if event.text.startswith(line)]

    line = "protocol plug-in 'morse' of broken (broken_protocol:PROTOCOL) is not used: it fails"
    assert cli.main(["--data-dir", str(tmp_path / "data")], open_window) == 0
    assert len(told) == 1
    assert capsys.readouterr().err.count(line) == 1


def test_plug_ins_are_loaded_once_and_not_for_what_is_built_in(install: Install):
    code = "import builtins\nbuiltins.n_loads = getattr(builtins, 'n_loads', 0) + 1\nPROTOCOL = 1\n"
    install("counting", {"counting": "counting_protocol:PROTOCOL"}, code)
    assert protocol("csv").name == "csv"
    import builtins

    assert not hasattr(builtins, "n_loads")
    assert protocols() is protocols()
    assert builtins.n_loads == 1
    del builtins.n_loads


def made(**changes: object) -> Protocol:
    """A protocol of a plug-in that is as it should be, but for the changes."""
    fields = {
        "name": "mine",
        "words": "lines",
        "new_decoder": lambda: LineDecoder(lambda line: Frame(None, (1.0, 2.0, 3.0)), "anything"),
        "to_nominal_g": lambda raw: raw,
        "limit_g": 4.0,
    }
    return Protocol(**{**fields, **changes})


class _Point:
    """An entry point of a module that is there already."""

    name, value, dist = "mine", "module:THING", None

    def __init__(self, thing: object) -> None:
        self._thing = thing

    def load(self) -> object:
        if isinstance(self._thing, BaseException):
            raise self._thing
        return self._thing


def load(*things: object) -> tuple[tuple[Protocol, ...], tuple[str, ...]]:
    points: list[EntryPoint] = [_Point(thing) for thing in things]  # type: ignore[misc]
    return load_plug_ins(points, BUILT_IN_NAMES)


class _Decoder:
    """Does what it is told with the bytes."""

    def __init__(self, does: Callable[[bytes], object]) -> None:
        self._does = does

    def feed(self, data: bytes) -> object:
        return self._does(data) if data else []

    def end(self) -> object:
        return self._does(b"end")


def _raise(error: BaseException) -> object:
    raise error


@pytest.mark.parametrize(
    ("thing", "words"),
    [
        ("a text", "it gives a str, expected a gestureapp.sensing.protocols.Protocol"),
        (made, "it gives a function, expected"),
        (made(name="csv"), "'csv' is a built-in protocol; rename it"),
        (made(name="Two Words"), "its name 'Two Words' is not of small letters"),
        (made(name=7), "its name 7 is not"),
        (made(name="x" * 41), "is not of small letters"),
        (made(words=""), "its words are missing"),
        (made(limit_g=0.0), "its limit_g 0.0 is no acceleration"),
        (made(limit_g=float("inf")), "its limit_g inf"),
        (made(limit_g="16 g"), "its limit_g '16 g'"),
        (made(new_decoder=lambda: object()), "its decoder has no feed and end"),
        (made(new_decoder=lambda: _Decoder(lambda data: None)), "gives no list of events"),
        (made(new_decoder=lambda: _raise(OSError("no port"))), "it fails with OSError: no port"),
        (made(to_nominal_g=lambda raw: 1.0), "it fails with TypeError: 1.0 instead of three"),
        (made(to_nominal_g=lambda raw: ("a", "b", "c")), "instead of three numbers"),
        (ValueError("two\nlines"), "it fails with ValueError: two lines; mend"),
        (ImportError(), "it fails with ImportError; mend"),
        (SystemExit(3), "it fails with SystemExit: 3; mend"),
        (made(new_decoder=lambda: _raise(SystemExit())), "it fails with SystemExit; mend"),
    ],
)
def test_a_plug_in_that_is_not_what_it_should_be_is_one_clear_line(thing: object, words: str):
    loaded, findings = load(thing)
    assert loaded == ()
    (finding,) = findings
    assert words in finding
    assert finding.startswith("protocol plug-in 'mine' (module:THING) is not used: ")
    assert "\n" not in finding


def test_of_two_plug_ins_with_one_name_neither_is_used():
    loaded, findings = load(made(), made())
    assert loaded == ()
    assert "both give it; remove one" in findings[0]


def guarded(does: Callable[[bytes], object]) -> Protocol:
    made_with = iter([_Decoder(lambda data: [])])  # the one that is tried when it is loaded
    (known,), findings = load(made(new_decoder=lambda: next(made_with, None) or _Decoder(does)))
    assert findings == ()
    return known


@pytest.mark.parametrize(
    ("does", "words"),
    [
        (lambda data: _raise(IndexError("out of range")), "IndexError: out of range"),
        (lambda data: None, "TypeError: a NoneType instead of a list"),
        (lambda data: ["frame"], "TypeError: a str instead of an event"),
        (lambda data: [Frame(None, (1.0, 2.0))], "instead of three numbers"),  # type: ignore[arg-type]
        (lambda data: [Frame(None, ("x", 0.0, 0.0))], "instead of three numbers"),  # type: ignore[arg-type]
        (lambda data: [Frame(1.5, (0.0, 0.0, 1.0))], "number 1.5 instead"),  # type: ignore[arg-type]
        (lambda data: [Frame(-1, (0.0, 0.0, 1.0))], "a whole number beyond 0"),
        (lambda data: [Frame(None, (10**400, 0, 0))], "OverflowError"),
        (lambda data: [Identity("x" * 41)], "instead of 1 to 40 printable"),
        (lambda data: [Identity("")], "name '' instead"),
        (lambda data: [Identity("a\nb")], "instead of 1 to 40 printable"),
        (lambda data: [Identity(7)], "name 7 instead"),  # type: ignore[arg-type]
        (lambda data: [Battery(101)], "battery 101 instead of 0 to 100 percent"),
        (lambda data: [Battery(float("nan"))], "battery nan instead"),
        (lambda data: [Battery("full")], "battery 'full' instead"),  # type: ignore[arg-type]
        (lambda data: [CounterGap(0)], "a whole number beyond 1 to 6000"),
        (lambda data: [CounterGap(10**400)], "a whole number beyond"),
        (lambda data: [CounterGap("3")], "number '3' instead"),  # type: ignore[arg-type]
        (lambda data: [CounterJump(1, None)], "number None instead"),  # type: ignore[arg-type]
        (lambda data: [Garbage(1, b"", None)], "whose reason is no text"),  # type: ignore[arg-type]
        (lambda data: _raise(SystemExit(3)), "SystemExit: 3"),
    ],
)
def test_a_decoder_of_a_plug_in_that_fails_gives_garbage(
    does: Callable[[bytes], object], words: str
):
    decoder = guarded(does).new_decoder()
    (event,) = decoder.feed(b"abc")
    assert isinstance(event, Garbage)
    assert (event.n_bytes, event.first_bytes) == (3, b"abc")
    assert words in event.reason
    assert decoder.end() == []


def test_what_a_decoder_of_a_plug_in_rightly_gives_comes_through():
    given: list[DecoderEvent] = [
        Frame(None, (1, 2.5, -3)),
        Frame(2**32, (0.0, 0.0, 1.0)),
        Garbage(3, b"abc", "no line"),
        Repeated(3, b"abc", "came twice"),
        CounterGap(6000),
        CounterJump(9, 7),
        Identity("arm 7"),
        Battery(100),
    ]
    assert guarded(lambda data: given).new_decoder().feed(b"x") == given


def test_garbage_of_a_plug_in_is_told_in_one_line_of_bounded_length():
    told = Garbage(9, b"x" * 100, "a\nb\0" + "c" * 1000)
    (event,) = guarded(lambda data: [told]).new_decoder().feed(b"x")
    assert isinstance(event, Garbage)
    assert event.reason.startswith("a b?ccc")
    assert (len(event.reason), len(event.first_bytes)) == (120, 32)


def test_ctrl_c_goes_through_a_plug_in():
    decoder = guarded(lambda data: _raise(KeyboardInterrupt())).new_decoder()
    with pytest.raises(KeyboardInterrupt):
        decoder.feed(b"x")


def test_a_reader_outlives_a_plug_in_that_ends_the_program(install: Install):
    code = (EXAMPLE / "milli_g_protocol.py").read_text()
    code = f"import sys\n{code}"
    broken = code.replace("raw[0] / 1000", "sys.exit(1) if raw[0] else 0.0")
    assert broken != code
    install("leaving", {"milli-g": "leaving_protocol:PROTOCOL"}, broken)
    pieces = (b"\nA7 x=-12 y=4 z=998\r\n", b"A9 x=0 y=0 z=1000\n")
    with Bench("script", "milli-g", opener=script(*pieces)) as bench:
        assert isinstance(bench.next(Impossible), Impossible)
        assert bench.samples(1)[0].accel_g == (0.0, 0.0, 1.0)


def test_a_decoder_of_a_plug_in_that_fails_at_the_end_gives_garbage():
    decoder = guarded(lambda data: [] if data == b"x" else _raise(OSError("end")))
    started = decoder.new_decoder()
    assert started.end() == []
    assert started.feed(b"x") == []
    (event,) = started.end()
    assert event == Garbage(0, b"", "the plug-in 'mine' failed with OSError: end")


def test_a_decoder_of_a_plug_in_begins_anew_after_it_failed():
    def does(data: bytes) -> object:
        return _raise(KeyError("x")) if data == b"bad" else [CounterGap(1)]

    decoder = guarded(does).new_decoder()
    assert decoder.feed(b"good") == [CounterGap(1)]
    assert isinstance(decoder.feed(b"bad")[0], Garbage)
    assert decoder.feed(b"good") == [CounterGap(1)]


def test_a_scale_that_fails_while_it_is_tried_is_a_finding(install: Install):
    code = (EXAMPLE / "milli_g_protocol.py").read_text()
    broken = code.replace("raw[0] / 1000", "1 / raw[0]")
    assert broken != code
    install("dividing", {"milli-g": "dividing_protocol:PROTOCOL"}, broken)
    (finding,) = plug_in_findings()
    assert "ZeroDivisionError" in finding


def test_a_scale_that_fails_later_makes_an_impossible_value_of_that_frame():
    (known,), _ = load(made(to_nominal_g=lambda raw: (1 / (raw[0] - 1), raw[1], raw[2])))
    good, bad = (accel_of(Frame(None, (x, 0.0, 1.0)), known, NOMINAL) for x in (2, 1))
    assert good == (1.0, 0.0, 1.0)
    assert isinstance(bad, Impossible)
