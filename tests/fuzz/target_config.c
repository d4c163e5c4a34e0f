/* Configuration files of tapemark-stream, and the same settings as words on its command line. */
#include "camera_mode.h"
#include "config_file.h"
#include "content_file.h"
#include "option_words.h"
#include "stream_options.h"

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

static void read_as_words(const uint8_t *bytes, size_t size)
{
    static option_words line;
    stream_settings settings = settings_usual();
    error_text error = {""};
    option_words_read(&line, "tapemark-stream", bytes, size);
    const options_answer answer = stream_options_read((command_line){line.count, line.words}, &settings, &error);
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
