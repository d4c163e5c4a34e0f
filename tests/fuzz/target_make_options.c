/* The command line of tapemark-make. */
#include <math.h>

#include "make_options.h"
#include "option_words.h"

static void claim_quick_plan(const make_options *options)
{
    const plan *quick = &options->quick;
    CLAIM(isfinite(quick->module_mm) && quick->module_mm > 0);
    CLAIM(quick->first_id >= 0);
    CLAIM(quick->tm_cms >= 3 && quick->tm_cms <= quick->tm_cms_max && quick->tm_cms_max <= 32);
    CLAIM(isfinite(options->quick_length_m) && options->quick_length_m >= 0);
    CLAIM(options->quick_length_m > 0 || quick->cms_wanted > 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static option_words line;
    make_options options;
    error_text error = {""};
    option_words_read(&line, "tapemark-make", bytes, size);
    const make_answer answer = make_options_parse(line.count, line.words, &options, &error);
    if (answer == MAKE_WRONG)
        CLAIM(error.text[0] != '\0');
    if (answer == MAKE_RUN) {
        CLAIM(options.output_path != NULL && isfinite(options.png_dpi) && isfinite(options.pgm_dpi));
        if (options.plan_path == NULL)
            claim_quick_plan(&options);
    }
    make_options_release(&options);
    return 0;
}
