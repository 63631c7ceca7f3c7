"""The frames of the firmware, built by a real compiler, against the encoder and the decoder."""

import shutil
import subprocess
from pathlib import Path

import pytest

from gestureapp.sensing.protocols import protocol
from gestureapp.sensing.values import Battery, Frame, Identity
from gestureapp.simulation.sensor_wire import encode_binary, encode_identity

SKETCH = (
    Path(__file__).parents[2] / "resources" / "firmware" / "adxl330_binary" / "adxl330_binary.ino"
)
COMPILER = shutil.which("g++") or shutil.which("clang++")
LIMIT_S = 60.0

FRAMES = """
#include <stdio.h>
#include <stdlib.h>
#include "{sketch}"
// Reads commands: "s number x y z battery", "i name", "c reading full_scale"; answers in hex.
static void show(const uint8_t *frame, size_t n) {{
  for (size_t i = 0; i < n; i++) printf("%02x", frame[i]);
  printf("\\n");
}}
int main() {{
  char word[64];
  uint8_t frame[FRAME_MAX_BYTES];
  while (scanf("%63s", word) == 1) {{
    if (word[0] == 's') {{
      int number, x, y, z, battery;
      if (scanf("%d %d %d %d %d", &number, &x, &y, &z, &battery) != 5) return 1;
      const int16_t counts[3] = {{(int16_t)x, (int16_t)y, (int16_t)z}};
      show(frame, sample_frame((uint16_t)number, counts, (uint8_t)battery, frame));
    }} else if (word[0] == 'i') {{
      if (scanf("%63s", word) != 1) return 1;
      show(frame, identity_frame(word, frame));
    }} else {{
      unsigned reading, full_scale;
      if (scanf("%u %u", &reading, &full_scale) != 2) return 1;
      printf("%d\\n", counts_of(reading, full_scale));
    }}
  }}
  (void)BATTERY_PERCENT;
  return 0;
}}
"""

BOARD = """
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string>
const int A0 = 14, A1 = 15, A2 = 16, EXTERNAL = 0;
static uint32_t now_us;
static uint32_t micros() {{ return now_us; }}
static int analogRead(int pin) {{ return pin == A2 ? 614 : 512; }}
static uint32_t analogReadMilliVolts(int pin) {{ return pin == 32 ? 1980 : 1650; }}
static void analogReference(int) {{}}
struct Port {{
  void begin(uint32_t) {{}}
  void begin(const char *) {{}}
  void write(const uint8_t *data, size_t n) {{
    printf("%u ", now_us);
    for (size_t i = 0; i < n; i++) printf("%02x", data[i]);
    printf("\\n");
  }}
}};
typedef Port BluetoothSerial;
static Port Serial;
#include "{sketch}"
// A board whose loop takes as long as it happens to; the third second it does nothing for 35 ms.
int main(int, char **arguments) {{
  now_us = (uint32_t)strtoul(arguments[1], nullptr, 10);
  const uint32_t begin_us = now_us;
  setup();
  bool has_paused = false;
  while (now_us - begin_us < 10000000) {{
    loop();
    now_us += 150 + (uint32_t)rand() % 1700;
    if (!has_paused && now_us - begin_us > 3000000) {{ now_us += 35000; has_paused = true; }}
  }}
  (void)analogRead; (void)analogReadMilliVolts; (void)analogReference; (void)Serial;
  return 0;
}}
"""


def build(folder: Path, text: str, *options: str) -> Path:
    """A program of this computer that has the sketch in it; no warning is let through."""
    if COMPILER is None:
        pytest.skip("no C++ compiler here: install g++ or clang++")
    (folder / "program.cpp").write_text(text.format(sketch=SKETCH))
    (folder / "BluetoothSerial.h").touch()
    strict = ["-std=c++11", "-Wall", "-Wextra", "-Werror", "-fsanitize=undefined", f"-I{folder}"]
    made = folder / "program"
    command = [COMPILER, *strict, *options, str(folder / "program.cpp"), "-o", str(made)]
    built = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S, check=False)
    assert built.returncode == 0, built.stderr
    return made


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sketch's frames alone."""
    return build(tmp_path_factory.mktemp("frames"), FRAMES, "-Wconversion")


def ask(program: Path, *commands: str) -> list[str]:
    """The program's answers."""
    text = "\n".join(commands)
    ran = subprocess.run([program], input=text, capture_output=True, text=True, timeout=LIMIT_S)
    assert ran.returncode == 0, ran.stderr
    assert ran.stderr == ""
    return ran.stdout.split()


SAMPLES = [
    (number, (x, y, z), battery)
    for number in (0, 1, 255, 256, 65_535)
    for x, y, z in ((0, 0, 2000), (-1, 1, -32_768), (256, -256, 32_767), (0, 0, 0))
    for battery in (0, 80, 255)
]


def test_samples_of_the_firmware_are_those_of_the_encoder_and_are_read(program: Path):
    commands = [f"s {n} {x} {y} {z} {b}" for n, (x, y, z), b in SAMPLES]
    frames = [bytes.fromhex(text) for text in ask(program, *commands)]
    for frame, (number, counts, battery) in zip(frames, SAMPLES, strict=True):
        x, y, z = (count * 0.0005 for count in counts)
        assert frame == encode_binary(number, (x, y, z), battery)
        decoded = protocol("binary").new_decoder().feed(frame)
        told = [] if battery == 255 else [Battery(battery)]
        assert decoded == [*told, Frame(number, tuple(map(float, counts)))]


@pytest.mark.parametrize("name", ["a", "arm-1", "exactly-twenty-bytes"])
def test_names_of_the_firmware_are_those_of_the_encoder_and_are_read(program: Path, name: str):
    (text,) = ask(program, f"i {name}")
    assert bytes.fromhex(text) == encode_identity(name)
    assert protocol("binary").new_decoder().feed(bytes.fromhex(text)) == [Identity(name)]


def test_a_name_that_is_too_long_is_cut_by_the_firmware(program: Path):
    (text,) = ask(program, "i more-than-twenty-bytes-of-name")
    assert bytes.fromhex(text) == encode_identity("more-than-twenty-byt")


@pytest.mark.parametrize(
    ("reading", "full_scale", "value_g"),
    [(512, 1024, 0.0), (614, 1024, 1.0), (410, 1024, -1.0), (1650, 3300, 0.0), (1980, 3300, 1.0)],
)
def test_a_reading_becomes_g_by_the_sensors_nominal_scale(
    program: Path, reading: int, full_scale: int, value_g: float
):
    (counts,) = ask(program, f"c {reading} {full_scale}")
    assert int(counts) * 0.0005 == pytest.approx(value_g, abs=0.006)


@pytest.mark.parametrize("full_scale", [1024, 3300])
def test_a_reading_at_a_rail_becomes_impossible(program: Path, full_scale: int):
    low, high, inside = ask(
        program,
        f"c 0 {full_scale}",
        f"c {full_scale} {full_scale}",
        f"c {full_scale // 40} {full_scale}",
    )
    assert (int(low), int(high)) == (-32_768, 32_767)
    assert -9_600 < int(inside) < -9_400


@pytest.mark.parametrize("options", [("-DARDUINO=1",), ("-DARDUINO=1", "-DESP32=1")])
def test_a_board_samples_at_100_hz_without_drift_and_makes_nothing_up(
    tmp_path: Path, options: tuple[str, ...]
):
    board = build(tmp_path, BOARD, *options)
    begin_us = 2**32 - 2_000_000  # the clock of the board wraps on the way
    command = [board, str(begin_us)]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S, check=True)
    sent = [line.split() for line in ran.stdout.splitlines()]
    events = protocol("binary").new_decoder().feed(bytes.fromhex("".join(data for _, data in sent)))
    assert events[0] == Identity("arm 1")
    assert [event.counter for event in events[1:]] == list(range(len(events) - 1))
    g = protocol("binary").to_nominal_g(events[-1].raw)
    assert g == pytest.approx((0.0, 0.0, 1.0), abs=0.006)

    times_us = sorted({(int(at_us) - begin_us) % 2**32 for at_us, _ in sent})
    before = [at_us for at_us in times_us if at_us < 3_000_000]
    assert len(before) == 300
    assert all(0 <= at_us - 10_000 * n < 2_000 for n, at_us in enumerate(before))
    after = times_us[300:]
    first_us = after[0]
    assert all(0 <= at_us - first_us - 10_000 * n < 2_000 for n, at_us in enumerate(after))
