#!/bin/sh
# Usage: build_sketch.sh LINK_FOLDER ARDUINO_CORE OUTPUT.elf [FLAG...]
# The Arduino library's example, built for an Uno (ATmega328P, 16 MHz) as the Arduino IDE does it.
set -eu
link=$1
core=$2
output=$3
shift 3

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The core takes DECIMAL_DIG for granted, which Debian's avr-gcc gives to C alone.
flags="-mmcu=atmega328p -Os -ffunction-sections -fdata-sections -DF_CPU=16000000L -DARDUINO=10819 \
    -DARDUINO_AVR_UNO -DARDUINO_ARCH_AVR -DDECIMAL_DIG=__DECIMAL_DIG__ \
    -I$core/cores/arduino -I$core/variants/standard"
warnings="-Wall -Wextra -Wshadow -Werror"

cd "$work"
# shellcheck disable=SC2086 # words of $flags are options
{
    avr-gcc $flags -std=gnu11 -w -c "$core"/cores/arduino/*.c
    avr-gcc $flags -x assembler-with-cpp -c "$core"/cores/arduino/*.S
    avr-g++ $flags -std=gnu++11 -fno-exceptions -fno-threadsafe-statics -w -c "$core"/cores/arduino/*.cpp
    avr-gcc $flags $warnings -std=c99 "$@" -c "$link/src/tapemark_receiver.c"
    avr-g++ $flags $warnings -std=gnu++11 -fno-exceptions "$@" "-I$link/src" -include Arduino.h -x c++ \
        -c "$link/examples/PrintMarkers/PrintMarkers.ino" -o sketch.o
    avr-gcc -mmcu=atmega328p -Os -Wl,--gc-sections ./*.o -o sketch.elf
}
mv sketch.elf "$output"
