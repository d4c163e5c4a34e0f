/* The command line of tapemark-decode. What it lets pass, the decoder takes. */
#include "option_words.h"
#include "options.h"

static void claim_config(const tapemark_config *config)
{
    static const uint8_t pixels[16 * 16];
    static uint8_t workspace[TAPEMARK_WORKSPACE_BYTES(16, 16)];
    const tapemark_image image = {pixels, 16, 16, 16};
    tapemark_result result = {.cm_capacity = 0};
    CLAIM(tapemark_decode(&image, config, workspace, sizeof workspace, &result) >= TAPEMARK_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static option_words line;
    decode_options options;
    error_text error = {""};
    option_words_read(&line, "tapemark-decode", bytes, size);
    const options_answer answer = options_parse(line.count, line.words, &options, &error);
    if (answer == OPTIONS_WRONG)
        CLAIM(error.text[0] != '\0');
    if (answer != OPTIONS_RUN)
        return 0;
    claim_config(&options.config);
    CLAIM(options.input_count > 0 && options.inputs[options.input_count - 1] != NULL);
    CLAIM(!options.raw_given || frame_layout_size_bytes(&options.raw) > 0);
    return 0;
}
