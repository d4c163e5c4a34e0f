#!/bin/sh
# Usage: build_sketch.sh LINK_FOLDER ARDUINO_CORE OUTPUT_FOLDER
# The Arduino library's example, built for an Uno (ATmega328P, 16 MHz) as the Arduino IDE does it: both.elf, and with
# one encoding compiled out packets.elf and sentences.elf.
set -eu
link=$1
core=$2
output=$3

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The core takes DECIMAL_DIG for granted, which Debian's avr-gcc gives to C alone.
flags="-mmcu=atmega328p -Os -ffunction-sections -fdata-sections -DF_CPU=16000000L -DARDUINO=10819 \
    -DARDUINO_AVR_UNO -DARDUINO_ARCH_AVR -DDECIMAL_DIG=__DECIMAL_DIG__ \
    -I$core/cores/arduino -I$core/variants/standard"
cxx_flags="-std=gnu++11 -fno-exceptions -fno-threadsafe-statics"
warnings="-Wall -Wextra -Wshadow -Werror"

# shellcheck disable=SC2086 # words of $flags are options
build_core()
{
    avr-gcc $flags -std=gnu11 -w -c "$core"/cores/arduino/*.c
    avr-gcc $flags -x assembler-with-cpp -c "$core"/cores/arduino/*.S
    avr-g++ $flags $cxx_flags -w -c "$core"/cores/arduino/*.cpp
}

# shellcheck disable=SC2086
build_sketch()
{
    name=$1
    shift
    avr-gcc $flags $warnings -std=c99 "$@" -c "$link/src/tapemark_receiver.c" -o receiver
    avr-g++ $flags $cxx_flags $warnings "$@" "-I$link/src" -include Arduino.h -x c++ \
        -c "$link/examples/PrintMarkers/PrintMarkers.ino" -o sketch
    avr-gcc -mmcu=atmega328p -Os -Wl,--gc-sections ./*.o sketch receiver -o "$output/$name.elf"
}

cd "$work"
build_core
build_sketch both
build_sketch packets -DTAPEMARK_RECEIVER_NO_SENTENCES
build_sketch sentences -DTAPEMARK_RECEIVER_NO_PACKETS
