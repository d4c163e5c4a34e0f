/* Configuration files of tapemark-stream, and the same settings as words on its command line. */
#include <string.h>

#include "camera_mode.h"
#include "config_file.h"
#include "content_file.h"
#include "stream_options.h"

enum { WORDS_MAX = 40, WORDS_BYTES = 4096 };

static void claim_settings(const stream_settings *settings)
{
    error_text error = {""};
    if (!settings_check(settings, &error)) {
        CLAIM(error.text[0] != '\0');
        return;
    }
    const camera_wishes wishes = settings_camera_wishes(settings);
    CLAIM(camera_wishes_valid(&wishes, &error) || error.text[0] != '\0');
    CLAIM(settings->markers_max <= MARKERS_MAX && settings->roi.width_px >= 0 && settings->roi.height_px >= 0);
    CLAIM(settings->decoder.confidence_min >= 0 && settings->decoder.confidence_min <= 1);
}

static void read_as_file(const uint8_t *bytes, size_t size)
{
    const content_file file = content_file_open(bytes, size);
    stream_settings settings = settings_usual();
    error_text error = {""};
    if (config_file_read(file.path, &settings, &error))
        claim_settings(&settings);
    else
        CLAIM(error.text[0] != '\0');
    content_file_close(&file);
}

/* A line is a word. No file is opened: what follows --config is not there. */
static void read_as_words(const uint8_t *bytes, size_t size)
{
    char text[WORDS_BYTES] = "tapemark-stream\n";
    char *words[WORDS_MAX + 1];
    int count = 0;
    const size_t begin = strlen(text), most = sizeof text - 1 - begin;
    memcpy(text + begin, bytes, size < most ? size : most);
    char *rest = text;
    for (char *word = strtok_r(text, "\n", &rest); word != NULL && count < WORDS_MAX;
         word = strtok_r(NULL, "\n", &rest))
        words[count++] = word;
    words[count] = NULL;
    stream_settings settings = settings_usual();
    error_text error = {""};
    const options_answer answer = stream_options_read((command_line){count, words}, &settings, &error);
    CLAIM(answer >= OPTIONS_RUN && answer <= OPTIONS_BAD_CONFIG);
    if (answer == OPTIONS_RUN)
        claim_settings(&settings);
    else if (answer == OPTIONS_WRONG || answer == OPTIONS_BAD_CONFIG)
        CLAIM(error.text[0] != '\0');
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (size > 2 && bytes[0] == '-' && bytes[1] == '-')
        read_as_words(bytes, size);
    else
        read_as_file(bytes, size);
    return 0;
}
