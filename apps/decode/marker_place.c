#include "marker_place.h"

#include <math.h>

static marker_place place_of(bool placed, float x_m, float y_m, float dx, float dy)
{
    const double degrees_per_radian = 57.29577951308232, just_below_0 = -0.005;
    double direction_deg = atan2((double)dy, (double)dx) * degrees_per_radian;
    direction_deg = direction_deg < just_below_0 ? direction_deg + 360 : fabs(direction_deg);
    return (marker_place){placed, (double)x_m, (double)y_m, placed && (dx != 0 || dy != 0), direction_deg};
}

/* A TM in which a CM was read either agrees with the map or contradicts it. */
static bool is_in_doubt(const tapemark_map *map, const tapemark_result *result, const tapemark_cm *cm)
{
    tapemark_tm_place located = {.agreement = TAPEMARK_AGREES};
    if (cm->tm < 0)
        return false;
    tapemark_map_locate_tm(map, result, (size_t)cm->tm, &located);
    return located.agreement != TAPEMARK_AGREES;
}

marker_place marker_place_of_cm(const tapemark_map *map, const tapemark_result *result, size_t index)
{
    const tapemark_cm *read = &result->cms[index];
    size_t found;
    if (map == NULL || tapemark_map_find_cm(map, read->id, &found) != TAPEMARK_OK || is_in_doubt(map, result, read))
        return (marker_place){0};
    const tapemark_map_cm *cm = &map->cms[found];
    return place_of(true, cm->x_m, cm->y_m, cm->dx, cm->dy);
}

marker_place marker_place_of_tm(const tapemark_map *map, const tapemark_result *result, size_t index,
                                tapemark_tm_place *located)
{
    tapemark_map_locate_tm(map, result, index, located);
    if (located->tm < 0)
        return (marker_place){0};
    const tapemark_map_tm *tm = &map->tms[located->tm];
    return place_of(tm->placed, tm->x_m, tm->y_m, tm->dx, tm->dy);
}

const char *agreement_name(tapemark_agreement agreement)
{
    static const char *const names[] = {
        [TAPEMARK_AGREES] = "agrees",
        [TAPEMARK_CODE_ALONE] = "no_cms",
        [TAPEMARK_CODE_AMBIGUOUS] = "ambiguous_code",
        [TAPEMARK_CODE_UNKNOWN] = "unknown_code",
        [TAPEMARK_CODE_OF_OTHER_TM] = "other_code",
        [TAPEMARK_CM_UNKNOWN] = "unknown_cm",
        [TAPEMARK_CM_WITHOUT_TM] = "cm_without_tm",
        [TAPEMARK_CMS_OF_SEVERAL_TMS] = "cms_of_several_tms",
        [TAPEMARK_CM_IN_OTHER_SLOT] = "other_slot",
        [TAPEMARK_RUNS_BACKWARDS] = "backwards",
    };
    return names[agreement];
}

const char *agreement_answer(tapemark_agreement agreement)
{
    if (agreement == TAPEMARK_CODE_ALONE || agreement == TAPEMARK_CODE_AMBIGUOUS)
        return "null";
    return agreement == TAPEMARK_AGREES ? "true" : "false";
}

const char *agreement_phrase(tapemark_agreement agreement)
{
    switch (agreement) {
    case TAPEMARK_AGREES: return "its CMs agree";
    case TAPEMARK_CODE_ALONE: return "by its code alone";
    case TAPEMARK_CODE_AMBIGUOUS: return "its code alone does not tell where";
    case TAPEMARK_CODE_UNKNOWN: return "its code is not on the map";
    case TAPEMARK_CODE_OF_OTHER_TM: return "its CMs are those of a TM with another code";
    case TAPEMARK_CM_UNKNOWN: return "a CM of it is not on the map";
    case TAPEMARK_CM_WITHOUT_TM: return "a CM of it is in no TM on the map";
    case TAPEMARK_CMS_OF_SEVERAL_TMS: return "its CMs are of several TMs";
    case TAPEMARK_CM_IN_OTHER_SLOT: return "its CMs are in other places than on the map";
    case TAPEMARK_RUNS_BACKWARDS: return "it runs the other way than on the map";
    }
    return "";
}
