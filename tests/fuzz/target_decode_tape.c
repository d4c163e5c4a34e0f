/* tapemark_decode() over pictures of tapes that are drawn, and damaged, as the bytes say. */
#include "decode_call.h"
#include "tape_sketch.h"

static bool is_drawn(const tape_sketch *picture, int32_t id)
{
    for (size_t i = 0; i < picture->cm_count; i++)
        if (picture->ids[i] == id)
            return true;
    return false;
}

/* Whether the code that was read is that of the tape. */
static bool is_code(const tape_sketch *picture, const tapemark_tm *tm, bool backwards)
{
    if (!picture->bars || tm->length != picture->cm_count)
        return false;
    for (size_t i = 0; i < picture->cm_count; i++)
        if ((tm->code[backwards ? picture->cm_count - 1 - i : i] == '1') != (picture->ids[i] >= 0))
            return false;
    return true;
}

/* Of one tape that nothing was done to, all that is read is right. */
static void claim_no_lie(const tape_sketch *picture, const tapemark_result *result)
{
    for (size_t i = 0; i < result->cm_count; i++)
        CLAIM(is_drawn(picture, result->cms[i].id));
    for (size_t i = 0; i < result->tm_count; i++) {
        const tapemark_tm *tm = &result->tms[i];
        CLAIM(is_code(picture, tm, false) || (!tm->directed && is_code(picture, tm, true)));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    byte_script script = {bytes, size};
    decode_call call = decode_call_read(&script);
    const tape_sketch picture = tape_sketch_draw(&script);
    const tapemark_image image = {picture.pixels, picture.width_px, picture.height_px, picture.width_px};
    const bool as_drawn = call.default_config || (call.config.polarity == TAPEMARK_DARK_ON_LIGHT &&
                                                  !call.config.roll_known);
    if (decode_call_run(&call, &image) >= TAPEMARK_OK && picture.cm_count > 0 && as_drawn)
        claim_no_lie(&picture, &call.result);
    decode_call_release(&call);
    free(picture.pixels);
    return 0;
}
