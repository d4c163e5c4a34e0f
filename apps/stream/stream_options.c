#include "stream_options.h"

#include <stdio.h>
#include <string.h>

#include "config_file.h"

const char stream_options_help[] =
    "usage: tapemark-stream [OPTION...]\n"
    "Reads a tape through a camera and sends what is in each frame to a microcontroller.\n"
    "\n"
    "  --camera NAME        auto (default), v4l2:/dev/video0, libcamera:0, file:PATH[@RATE] or\n"
    "                       raw:LAYOUT,PATH[@RATE]; RATE is in frames a second, or max. --list tells what there is\n"
    "  --serial PORT[:BAUD] where records go: a serial port, at 115200 baud unless told\n"
    "  --output NAME        or - (standard output, default), file:PATH, pty:PATH, udp:HOST:PORT, serial:PORT[:BAUD]\n"
    "  --encoding KIND      nmea (default), sentences to read; or cobs, packets of a third of their length\n"
    "  --map FILE           the map of the tape: reads only ids that are on it, and sends places\n"
    "  --markers N          that are sent of a frame, the largest ones, 1 to 100 (default 16)\n"
    "\n"
    "  --format NAME        pixel format of the camera, such as GREY, YUYV, NV12 or MJPEG\n"
    "  --size WxH           of its pictures\n"
    "  --rate HZ            frames a second, or max (default: about 30)\n"
    "  --exposure US        in microseconds, or auto (default)\n"
    "  --gain GAIN          a factor, for Video4Linux the device's own steps; or auto (default)\n"
    "  --roi WxH+X+Y        looks only there, in pixels of the whole picture; or full (default)\n"
    "\n"
    "  --gpio-seen LINE     a GPIO line that is on while a marker is in view: CHIP:LINE[:low], such as gpiochip0:17\n"
    "  --gpio-strobe LINE   a line that is on around each exposure\n"
    "  --gpio-trigger LINE  a line that saves a frame when it goes on: CHIP:LINE[:low][:pull-up|:pull-down]\n"
    "  --snapshots DIR      where those frames go, as PGM\n"
    "  --preview PORT       a page with the live picture, on this computer alone; HOST:PORT for others, too\n"
    "  --record PATH        writes what the camera gives: PATH.y4m, or raw with its times beside it\n"
    "  --repeat yes         a recording begins again at its end\n"
    "  --still yes          the camera's picture may stand still to the last bit, as a test pattern does\n"
    "\n"
    "  --inverted yes       the tape is printed light on dark\n"
    "  --roll DEG           upright tapes read in this direction, clockwise from the x axis of the image\n"
    "  --max-id N           the largest id in use, without its sign\n"
    "  --confidence-min C   leaves out code markers read with less confidence, 0 to 1\n"
    "\n"
    "  --config FILE        settings of the same names, a line each: name = value; SIGHUP reads it and the map\n"
    "                       again\n"
    "  --list               tells what cameras, serial ports and GPIO chips there are\n"
    "  --help, --version    print this text or the version\n"
    "\n"
    "SIGTERM and SIGINT end it. Exit status: 0 it was told to end, or a recording has ended; 1 a file could not be\n"
    "read, or the output takes no more at the end of a recording or for good; 2 wrong usage.\n";

/* A word of the command line is "--name", "--name=value" or, after the first one, its value. */
typedef struct option_word {
    char name[32];
    const char *value;  /* NULL: none was given */
} option_word;

static bool takes_value(const char *name)
{
    return settings_know(name) || strcmp(name, "config") == 0;
}

/* Takes the option at *index, and moves on to the next one. */
static bool next_option(command_line line, int *index, option_word *option, error_text *error)
{
    const char *word = line.words[(*index)++];
    if (strncmp(word, "--", 2) != 0 || word[2] == '\0') {
        error_text_set(error, "expected an option, not \"%.60s\"; --help lists them", word);
        return false;
    }
    const char *equals = strchr(word, '=');
    size_t length = equals != NULL ? (size_t)(equals - word) - 2 : strlen(word + 2);
    if (length >= sizeof option->name) {
        error_text_set(error, "there is no option \"%.60s\"; --help lists them", word);
        return false;
    }
    memcpy(option->name, word + 2, length);
    option->name[length] = '\0';
    option->value = equals != NULL ? equals + 1 : NULL;
    if (option->value == NULL && takes_value(option->name) && *index < line.count)
        option->value = line.words[(*index)++];
    return true;
}

static options_answer answer_of(const char *name)
{
    if (strcmp(name, "list") == 0)
        return OPTIONS_LIST;
    if (strcmp(name, "help") == 0)
        return OPTIONS_HELP;
    return strcmp(name, "version") == 0 ? OPTIONS_VERSION : OPTIONS_RUN;
}

static bool apply(const option_word *option, stream_settings *settings, error_text *error)
{
    error_text reason;
    if (option->value == NULL)
        error_text_set(&reason, "needs a value");
    else if (strcmp(option->name, "config") == 0 || settings_set(settings, option->name, option->value, &reason))
        return true;
    error_text_set(error, "--%s: %.300s", option->name, reason.text);
    return false;
}

/* Settings that the file must not undo are set after it. The first round finds the file, and what is wrong. */
static options_answer read_options(command_line line, stream_settings *settings, const char **config,
                                   error_text *error)
{
    for (int index = 1; index < line.count;) {
        option_word option;
        if (!next_option(line, &index, &option, error))
            return OPTIONS_WRONG;
        options_answer answer = answer_of(option.name);
        if (answer != OPTIONS_RUN && option.value == NULL)
            return answer;
        if (!takes_value(option.name)) {
            bool known = answer != OPTIONS_RUN;
            error_text_set(error, known ? "--%s takes no value" : "there is no option \"--%s\"; --help lists them",
                           option.name);
            return OPTIONS_WRONG;
        }
        if (!apply(&option, settings, error))
            return OPTIONS_WRONG;
        if (strcmp(option.name, "config") == 0)
            *config = option.value;
    }
    return OPTIONS_RUN;
}

options_answer stream_options_read(command_line line, stream_settings *settings, error_text *error)
{
    const char *config = NULL;
    error_text reason;
    *settings = settings_usual();
    options_answer answer = read_options(line, settings, &config, error);
    if (answer != OPTIONS_RUN)
        return answer;
    if (config != NULL) {
        *settings = settings_usual();
        if (!config_file_read(config, settings, &reason)) {
            error_text_set(error, "%.100s: %.290s", config, reason.text);
            return OPTIONS_BAD_CONFIG;
        }
        read_options(line, settings, &config, &reason);
    }
    if (settings_check(settings, &reason))
        return OPTIONS_RUN;
    error_text_set(error, "%.100s%s%.290s", config != NULL ? config : "", config != NULL ? ": " : "", reason.text);
    return config != NULL ? OPTIONS_BAD_CONFIG : OPTIONS_WRONG;
}
