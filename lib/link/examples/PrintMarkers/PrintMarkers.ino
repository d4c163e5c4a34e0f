// Prints what the camera sees: ids, where they are in the image and, with a map, on the plan.
//
// The device's TX goes to the RX of the board's free serial port (on a Mega or a Leonardo that is Serial1; through a
// level shifter where the board has 5 V and its TX goes to the device). An Uno has one port for everything: its TX
// tells what came, and nothing else may drive its RX.
#include <tapemark_receiver.h>

#ifdef SERIAL_PORT_HARDWARE_OPEN
#define CAMERA SERIAL_PORT_HARDWARE_OPEN
#else
#define CAMERA Serial
#endif

static tapemark_receiver receiver;

static void printNumbers(const __FlashStringHelper *label, long a, long b, long c) {
  Serial.print(label);
  Serial.print(a);
  Serial.print(' ');
  Serial.print(b);
  Serial.print(' ');
  Serial.println(c);
}

static void printRecord(const tapemark_record &record) {
  switch (record.type) {
    case TAPEMARK_RECORD_FRAME:  // every frame has one, also without markers: when they stop, trust nothing
      printNumbers(F("frame "), record.as.frame.seq, record.as.frame.flags, record.as.frame.records);
      break;
    case TAPEMARK_RECORD_CM:  // an id, and its centre in tenths of a pixel
      printNumbers(F("cm "), record.as.cm.id, record.as.cm.x_tenth_px, record.as.cm.y_tenth_px);
      break;
    case TAPEMARK_RECORD_TM:
      printNumbers(F("tm "), record.as.tm.code, record.as.tm.length, record.as.tm.x_tenth_px);
      break;
    case TAPEMARK_RECORD_PLACE:  // millimetres on the plan
      printNumbers(F("place "), record.as.place.index, record.as.place.x_mm, record.as.place.y_mm);
      break;
    case TAPEMARK_RECORD_ANSWER:
      Serial.println(record.as.answer.text);
      break;
  }
}

void setup() {
  Serial.begin(115200);
  CAMERA.begin(115200);

  char command[TAPEMARK_SENTENCE_MAX_BYTES];
  CAMERA.write(command, tapemark_command_write(command, sizeof command, 1, "VERSION", NULL, NULL));
}

void loop() {
  // A line that does not fit into the output is left out: waiting would cost records.
  while (CAMERA.available())
    if (tapemark_receiver_push(&receiver, CAMERA.read()) && Serial.availableForWrite() > 45)
      printRecord(receiver.record);
}
