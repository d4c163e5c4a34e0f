#include "decode_call.h"

#include <math.h>

/* ---- Out of a script ------------------------------------------------------------------------------------------ */

static int32_t *read_known_ids(byte_script *script, size_t count)
{
    int32_t *ids = exact_memory(count * sizeof *ids);
    int32_t id = script_byte(script) % 2 == 0 ? script_within(script, -20, 20) : script_i32(script);
    for (size_t i = 0; i < count; i++) {
        ids[i] = id;
        const uint8_t step = script_byte(script);
        id = step == 0 ? script_i32(script) : (int32_t)((int64_t)id + step > INT32_MAX ? 0 : id + step % 4);
    }
    return ids;
}

/* Half of the fields keep their default, so that one that is refused does not hide all others. */
static tapemark_config read_config(byte_script *script, int32_t **known_ids)
{
    const uint16_t given = script_u16(script);
    tapemark_config config = {0};
    if (given & 1)
        config.vote_min = script_float(script);
    if (given & 2)
        config.roll_deg = script_float(script) * 360;
    if (given & 4)
        config.confidence_min = script_float(script);
    if (given & 8)
        config.contrast_min = script_byte(script);
    if (given & 16)
        config.id_max = script_byte(script) % 2 ? script_i32(script) : script_byte(script);
    if (given & 32)
        config.work_budget = script_byte(script) % 2 ? script_u32(script) : 64u * script_u16(script);
    if (given & 64)
        config.polarity = (tapemark_polarity)(given >> 8 & 3);
    config.roll_known = given & 128;
    if (given & 1024) {
        config.known_id_count = script_byte(script) % DECODE_KNOWN_IDS;
        config.known_ids = *known_ids = read_known_ids(script, config.known_id_count);
    }
    if ((given & 0xf800) == 0xf800)
        config.known_ids = NULL;
    return config;
}

/* Some capacities are 0, and few arrays are missing. */
static size_t read_capacity(byte_script *script, size_t most)
{
    const uint8_t kind = script_byte(script);
    return kind % 4 == 0 ? most : kind % 4 == 1 ? 0 : kind % most;
}

static tapemark_result read_result(byte_script *script)
{
    tapemark_result result = {.cm_capacity = read_capacity(script, DECODE_CMS),
                              .tm_capacity = read_capacity(script, DECODE_TMS),
                              .finder_capacity = read_capacity(script, DECODE_FINDERS)};
    const uint8_t missing = script_byte(script);
    result.cms = missing == 251 ? NULL : exact_memory(result.cm_capacity * sizeof *result.cms);
    result.tms = missing == 252 ? NULL : exact_memory(result.tm_capacity * sizeof *result.tms);
    result.finders = missing == 253 ? NULL : exact_memory(result.finder_capacity * sizeof *result.finders);
    return result;
}

decode_call decode_call_read(byte_script *script)
{
    decode_call call = {.known_ids = NULL};
    const uint8_t kind = script_byte(script);
    call.default_config = kind % 8 == 7;
    call.config = read_config(script, &call.known_ids);
    call.result = read_result(script);
    call.misalignment = kind / 8 % 8;
    call.no_workspace = kind == 255;
    const uint16_t missing = script_u16(script);
    call.missing_bytes = missing > 0xf000 ? missing : 0;
    return call;
}

void decode_call_release(decode_call *call)
{
    free(call->known_ids);
    free(call->result.cms);
    free(call->result.tms);
    free(call->result.finders);
}

static size_t workspace_bytes(const decode_call *call, const tapemark_image *image)
{
    const size_t needed = tapemark_workspace_bytes(image->width_px, image->height_px);
    return needed > call->missing_bytes ? needed - call->missing_bytes : 0;
}

/* ---- What has to be refused ----------------------------------------------------------------------------------- */

static bool is_within(float value, float least, float most)
{
    return value >= least && value <= most;
}

static bool ids_are_in_order(const tapemark_config *config)
{
    if (config->known_ids == NULL)
        return config->known_id_count == 0;
    for (size_t i = 1; i < config->known_id_count; i++)
        if (config->known_ids[i] <= config->known_ids[i - 1])
            return false;
    return true;
}

static bool config_is_allowed(const tapemark_config *config)
{
    return (config->vote_min == 0 || (config->vote_min > 0.5f && config->vote_min <= 1)) &&
           is_within(config->roll_deg, -360, 360) && is_within(config->confidence_min, 0, 1) &&
           config->id_max >= 0 && config->id_max <= TAPEMARK_MAX_ID &&
           (config->polarity == TAPEMARK_DARK_ON_LIGHT || config->polarity == TAPEMARK_LIGHT_ON_DARK) &&
           ids_are_in_order(config);
}

static tapemark_status refusal_of(const decode_call *call, const tapemark_image *image)
{
    const tapemark_result *result = &call->result;
    if ((result->cms == NULL && result->cm_capacity > 0) || (result->tms == NULL && result->tm_capacity > 0) ||
        (result->finders == NULL && result->finder_capacity > 0) || image->pixels == NULL || image->width_px < 1 ||
        image->width_px > 65535 || image->height_px < 1 || image->height_px > 65535 ||
        image->stride_bytes < image->width_px)
        return TAPEMARK_BAD_CALL;
    if (!call->default_config && !config_is_allowed(&call->config))
        return TAPEMARK_BAD_CONFIG;
    if (call->no_workspace || call->missing_bytes > 0)
        return TAPEMARK_BAD_WORKSPACE;
    return TAPEMARK_OK;
}

/* ---- What may be reported ------------------------------------------------------------------------------------- */

static void claim_corners(const tapemark_point corners[4])
{
    for (int i = 0; i < 4; i++)
        CLAIM(isfinite(corners[i].x_px) && isfinite(corners[i].y_px));
}

static bool is_known(const tapemark_config *config, int32_t id)
{
    for (size_t i = 0; i < config->known_id_count; i++)
        if (config->known_ids[i] == id)
            return true;
    return config->known_ids == NULL;
}

static void claim_cm(const tapemark_result *result, const tapemark_cm *cm, const tapemark_config *config)
{
    tapemark_word word;
    const int32_t id_max = config->id_max > 0 ? config->id_max : TAPEMARK_MAX_ID;
    CLAIM(tapemark_word_from_id(cm->id, &word) == TAPEMARK_OK);
    CLAIM(memcmp(&word, &cm->word, sizeof word) == 0);
    CLAIM(cm->id >= -id_max && cm->id <= id_max && is_known(config, cm->id));
    CLAIM(is_within(cm->confidence, config->confidence_min, 1));
    CLAIM(cm->doubtful_cells <= TAPEMARK_CELLS && cm->corrected_cells <= TAPEMARK_CELLS);
    CLAIM((cm->tm == -1 && cm->slot == -1) ||
          (cm->tm >= 0 && (size_t)cm->tm < result->tm_count && cm->slot >= 0 &&
           cm->slot < result->tms[cm->tm].length));
    claim_corners(cm->corners);
}

static void claim_tm(const tapemark_tm *tm, const tapemark_config *config)
{
    CLAIM(tm->length >= TAPEMARK_TM_MIN_CMS && tm->length <= TAPEMARK_TM_MAX_CMS);
    CLAIM(memchr(tm->code, '\0', sizeof tm->code) != NULL);
    CLAIM(strlen(tm->code) == tm->length && strspn(tm->code, "01") == tm->length);
    CLAIM(is_within(tm->vote, config->vote_min, 1) && is_within(tm->confidence, 0, 1));
    claim_corners(tm->corners);
}

static void claim_finder(const tapemark_finder *finder)
{
    CLAIM(isfinite(finder->centre.x_px) && isfinite(finder->centre.y_px));
    CLAIM(isfinite(finder->along.x_px) && isfinite(finder->along.y_px));
    CLAIM(isfinite(finder->across.x_px) && isfinite(finder->across.y_px));
    CLAIM(is_within(finder->score, -1.001f, 1.001f));
}

/* Beyond the budget goes only what was underway when it was spent, what was read, and what finders add to it. */
static void claim_work(const tapemark_stats *stats, const tapemark_config *config, const tapemark_image *image)
{
    enum { WORK_OF_A_CM_READ = 2500, WORK_OF_FINDERS = 20 * 1500, WORK_UNDERWAY = 120000 };
    const uint64_t budget = config->work_budget > 0
                                ? config->work_budget
                                : tapemark_default_work_budget(image->width_px, image->height_px);
    CLAIM(stats->work <=
          budget + (uint64_t)WORK_OF_A_CM_READ * stats->cms_read + WORK_OF_FINDERS + WORK_UNDERWAY);
    CLAIM(stats->tiles_active <= stats->tiles);
}

static void claim_result(const tapemark_result *result, tapemark_status status, const tapemark_config *config)
{
    const bool full = result->stats.limits & (TAPEMARK_LIMIT_CMS | TAPEMARK_LIMIT_TMS);
    const bool any = result->cm_count + result->tm_count > 0;
    CLAIM(result->cm_count <= result->cm_capacity && result->tm_count <= result->tm_capacity &&
          result->finder_count <= result->finder_capacity);
    CLAIM(status == (full                       ? TAPEMARK_NO_ROOM
                     : any                      ? TAPEMARK_OK
                     : result->stats.limits > 0 ? TAPEMARK_UNFINISHED
                                                : TAPEMARK_NOTHING_FOUND));
    for (size_t i = 0; i < result->cm_count; i++)
        claim_cm(result, &result->cms[i], config);
    for (size_t i = 0; i < result->tm_count; i++)
        claim_tm(&result->tms[i], config);
    for (size_t i = 0; i < result->finder_count; i++)
        claim_finder(&result->finders[i]);
}

/* ---- Calling -------------------------------------------------------------------------------------------------- */

static tapemark_status decode_in(const decode_call *call, const tapemark_image *image, uint8_t content,
                                 size_t misalignment, tapemark_result *result)
{
    const size_t size = workspace_bytes(call, image);
    uint8_t *const block = exact_memory(misalignment + size);
    memset(block, content, misalignment + size);
    void *const workspace = call->no_workspace ? NULL : block + misalignment;
    const tapemark_status status =
        tapemark_decode(image, call->default_config ? NULL : &call->config, workspace, size, result);
    free(block);
    return status;
}

static void claim_same(const tapemark_result *one, const tapemark_result *other)
{
    CLAIM(one->cm_count == other->cm_count && one->tm_count == other->tm_count &&
          one->finder_count == other->finder_count);
    CLAIM(memcmp(&one->stats, &other->stats, sizeof one->stats) == 0);
    for (size_t i = 0; i < one->cm_count; i++)
        CLAIM(one->cms[i].id == other->cms[i].id && one->cms[i].confidence == other->cms[i].confidence &&
              memcmp(one->cms[i].corners, other->cms[i].corners, sizeof one->cms[i].corners) == 0);
    for (size_t i = 0; i < one->tm_count; i++)
        CLAIM(strcmp(one->tms[i].code, other->tms[i].code) == 0 && one->tms[i].vote == other->tms[i].vote &&
              memcmp(one->tms[i].corners, other->tms[i].corners, sizeof one->tms[i].corners) == 0);
}

static void decode_elsewhere(const decode_call *call, const tapemark_image *image, tapemark_status status)
{
    tapemark_result again = call->result;
    again.cms = exact_memory(again.cm_capacity * sizeof *again.cms);
    again.tms = exact_memory(again.tm_capacity * sizeof *again.tms);
    again.finders = exact_memory(again.finder_capacity * sizeof *again.finders);
    CLAIM(decode_in(call, image, 0xa5, (call->misalignment + 5) % 8, &again) == status);
    claim_same(&call->result, &again);
    free(again.cms);
    free(again.tms);
    free(again.finders);
}

tapemark_status decode_call_run(decode_call *call, const tapemark_image *image)
{
    static const tapemark_config defaults = {0};
    const tapemark_config *config = call->default_config ? &defaults : &call->config;
    const tapemark_status refusal = refusal_of(call, image);
    const tapemark_status status = decode_in(call, image, 0, call->misalignment, &call->result);
    CLAIM(tapemark_status_text(status)[0] != '\0');
    if (refusal != TAPEMARK_OK) {
        CLAIM(status == refusal);
        return status;
    }
    claim_result(&call->result, status, config);
    claim_work(&call->result.stats, config, image);
    if (call->misalignment % 2 == 1)
        decode_elsewhere(call, image, status);
    return status;
}
