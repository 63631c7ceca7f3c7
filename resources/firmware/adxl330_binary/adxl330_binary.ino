// An ADXL330 or ADXL335 on three analogue inputs, sent as `binary` frames at 100 Hz.
//
// For ESP32 boards (over their own Bluetooth serial port) and boards with an AVR (over the serial
// port, with a Bluetooth module such as an HC-05 on it). Wiring and use: the README one folder up.

#include <stddef.h>
#include <stdint.h>
#include <string.h>

// ---- What you may change ------------------------------------------------------------------------

#define SENSOR_NAME "arm 1"  // 1 to 20 bytes; give each sensor a name of its own

#if defined(ESP32)
#include <BluetoothSerial.h>
const int PINS[3] = {34, 35, 32};  // X, Y, Z; inputs of the first converter
const uint32_t FULL_SCALE = 3300;  // supply of the sensor in mV, as measured
#elif defined(ARDUINO)
const int PINS[3] = {A0, A1, A2};  // X, Y, Z
const uint32_t FULL_SCALE = 1024;  // steps of the converter; its reference is the sensor's supply
const uint32_t BAUD_RATE = 115200;
#endif

const uint8_t BATTERY_PERCENT = 255;  // unknown: nothing measures it here

// ---- Frames: plain C++, compiled and tried on a computer, too -------------------------------------

const uint8_t FORMAT_VERSION = 1, KIND_SAMPLE = 1, KIND_IDENTITY = 2;
const size_t NAME_MAX_BYTES = 20;
const size_t FRAME_MAX_BYTES = 2 + NAME_MAX_BYTES + 2 + 2;  // head, name, CRC, one count and the zero

// Reading of a converter to counts of 0.5 mg. The sensor's output is half its supply at zero g and
// a tenth of the supply per g. A reading within 2 % of either rail is no acceleration (a broken
// wire, no supply): it becomes the end of the scale, which the application takes for impossible.
static int16_t counts_of(uint32_t reading, uint32_t full_scale) {
  if (reading * 50 < full_scale) return INT16_MIN;
  if (reading * 50 > full_scale * 49) return INT16_MAX;
  return (int16_t)((int32_t)((reading * 20000 + full_scale / 2) / full_scale) - 10000);
}

// CRC-16, polynomial 0x1021, beginning with 0xFFFF.
static uint16_t crc16(const uint8_t *data, size_t n) {
  uint16_t crc = 0xFFFF;
  for (size_t i = 0; i < n; i++) {
    crc ^= (uint16_t)((uint16_t)data[i] << 8);
    for (int bit = 0; bit < 8; bit++)
      crc = (crc & 0x8000) ? (uint16_t)((crc << 1) ^ 0x1021) : (uint16_t)(crc << 1);
  }
  return crc;
}

// Adds CRC, byte stuffing (COBS) and the final zero. `packet` has room for two bytes more than its
// `n`, `frame` for four more; n + 2 is below 254. Returns the frame's length.
static size_t finish_frame(uint8_t *packet, size_t n, uint8_t *frame) {
  const uint16_t crc = crc16(packet, n);
  packet[n++] = (uint8_t)(crc & 0xFF);
  packet[n++] = (uint8_t)(crc >> 8);
  size_t count_at = 0, length = 1;
  for (size_t i = 0; i < n; i++) {
    if (packet[i] == 0) {
      frame[count_at] = (uint8_t)(length - count_at);
      count_at = length++;
    } else {
      frame[length++] = packet[i];
    }
  }
  frame[count_at] = (uint8_t)(length - count_at);
  frame[length++] = 0;
  return length;
}

static size_t sample_frame(uint16_t number, const int16_t counts[3], uint8_t battery, uint8_t *frame) {
  uint8_t packet[FRAME_MAX_BYTES] = {FORMAT_VERSION, KIND_SAMPLE};
  size_t n = 2;
  packet[n++] = (uint8_t)(number & 0xFF);
  packet[n++] = (uint8_t)(number >> 8);
  for (int axis = 0; axis < 3; axis++) {
    packet[n++] = (uint8_t)((uint16_t)counts[axis] & 0xFF);
    packet[n++] = (uint8_t)((uint16_t)counts[axis] >> 8);
  }
  packet[n++] = battery;
  return finish_frame(packet, n, frame);
}

static size_t identity_frame(const char *name, uint8_t *frame) {
  uint8_t packet[FRAME_MAX_BYTES] = {FORMAT_VERSION, KIND_IDENTITY};
  size_t n = strlen(name);
  if (n > NAME_MAX_BYTES) n = NAME_MAX_BYTES;
  memcpy(packet + 2, name, n);
  return finish_frame(packet, 2 + n, frame);
}

// ---- The board ----------------------------------------------------------------------------------

#if defined(ARDUINO)

const uint32_t PERIOD_US = 10000;  // 100 Hz
const uint16_t IDENTITY_EVERY = 100;

#if defined(ESP32)
BluetoothSerial radio;
#else
auto &radio = Serial;
#endif

uint32_t due_us;
uint16_t number;

void setup() {
#if defined(ESP32)
  radio.begin(SENSOR_NAME);
#else
  analogReference(EXTERNAL);  // AREF is wired to the sensor's supply
  radio.begin(BAUD_RATE);
#endif
  due_us = micros();
}

void loop() {
  // The due time goes on by whole periods, whatever the work takes: the rate does not drift. After a
  // pause of a period or more it begins anew, as samples cannot be made up for.
  const uint32_t late_us = micros() - due_us;
  if ((int32_t)late_us < 0) return;
  due_us += late_us < PERIOD_US ? PERIOD_US : late_us + PERIOD_US;

  int16_t counts[3];
  for (int axis = 0; axis < 3; axis++) {
#if defined(ESP32)
    counts[axis] = counts_of(analogReadMilliVolts(PINS[axis]), FULL_SCALE);
#else
    counts[axis] = counts_of(analogRead(PINS[axis]), FULL_SCALE);
#endif
  }
  uint8_t frame[FRAME_MAX_BYTES];
  if (number % IDENTITY_EVERY == 0) radio.write(frame, identity_frame(SENSOR_NAME, frame));
  radio.write(frame, sample_frame(number, counts, BATTERY_PERCENT, frame));
  number++;
}

#endif
