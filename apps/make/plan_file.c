/* plan.schema.json beside this file says what a plan may hold: the same keys, limits and messages' paths as here. */
#include "json_file.h"
#include "plan.h"
#include "plan_values.h"
#include "tapemark.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Seven of the smallest and of the largest modules. */
#define HEIGHT_MIN_MM 0.7
#define HEIGHT_MAX_MM 1050
#define ABOVE_FLOOR_MAX_M 20

/* Height and module may differ by what is lost when a seventh is written with three decimals. */
#define MODULE_AGREEMENT 5e-4

/* A point may miss the room by a nanometre: sums of decimals are not exact. */
#define ROOM_GRACE_M 1e-9

static const char *const plan_keys[] = {
    "$schema", "room_m", "tape_height_mm", "module_mm", "first_id", "tm_cms", "tm_cms_max", "camera_upright",
    "background", "on", "above_floor_m", "lines", NULL};
static const char *const line_keys[] = {"from_m", "to_m", "on", "above_floor_m", NULL};

static const number_rule room_rule = {"room_m", " m", PLAN_SIDE_MIN_M, PLAN_SIDE_MAX_M};
static const number_rule height_rule = {"tape_height_mm", " mm", HEIGHT_MIN_MM, HEIGHT_MAX_MM};
static const number_rule module_rule = {"module_mm", " mm", PLAN_MODULE_MIN_MM, PLAN_MODULE_MAX_MM};
static const number_rule first_id_rule = {"first_id", "", 0, TAPEMARK_MAX_ID};
static const number_rule tm_cms_rule = {"tm_cms", "", TAPEMARK_TM_MIN_CMS, TAPEMARK_TM_MAX_CMS};
static const number_rule above_floor_rule = {"above_floor_m", " m", 0, ABOVE_FLOOR_MAX_M};

/* What lines take over that do not say it themselves. */
typedef struct line_defaults {
    plan_mount mount;
    double above_floor_m;
} line_defaults;

static const cJSON *member(const cJSON *object, const char *key)
{
    return cJSON_GetObjectItemCaseSensitive(object, key);
}

/* ---- Lines --------------------------------------------------------------------------------------------------- */

static bool read_coordinate(const cJSON *item, const json_path *path, double most, double *value, error_text *error)
{
    number_rule rule = {"", " m", 0, most + ROOM_GRACE_M};
    if (cJSON_IsNumber(item) && !plan_within(item->valuedouble, &rule)) {
        char hint[80];
        plan_unit_hint(item->valuedouble, &rule, hint, sizeof hint);
        error_text_set(error, "%s: %.10g m is outside of the room, 0 to %.10g%s", path->text, item->valuedouble, most,
                       hint);
        return false;
    }
    return plan_read_number(item, path, &rule, value, error);
}

static bool read_point(const cJSON *line, const json_path *place, const char *key, const plan *room,
                       plan_point *point, error_text *error)
{
    const cJSON *item = member(line, key);
    json_path path = path_of_member(place, key);
    if (item == NULL)
        return plan_refuse_missing(place, key, "a point of the plan, [x, y] in metres", error);
    if (!plan_check_pair(item, &path, "x, y", error))
        return false;
    json_path x = path_of_element(&path, 0), y = path_of_element(&path, 1);
    return read_coordinate(item->child, &x, room->width_m, &point->x_m, error) &&
           read_coordinate(item->child->next, &y, room->height_m, &point->y_m, error);
}

static bool read_mount(const cJSON *object, const json_path *place, plan_mount *mount, error_text *error)
{
    const cJSON *item = member(object, "on");
    const char *text = cJSON_GetStringValue(item);
    json_path path = path_of_member(place, "on");
    if (item == NULL)
        return true;
    if (text != NULL && (strcmp(text, "wall") == 0 || strcmp(text, "floor") == 0)) {
        *mount = strcmp(text, "wall") == 0 ? PLAN_ON_WALL : PLAN_ON_FLOOR;
        return true;
    }
    error_text_set(error, "%s: expected \"wall\" or \"floor\"", path.text);
    return false;
}

static bool check_line(const plan *wanted, const plan_line *line, const json_path *place, error_text *error)
{
    error_text reason;
    if (line->from.x_m == line->to.x_m && line->from.y_m == line->to.y_m) {
        error_text_set(error, "%s: from_m and to_m are the same point", place->text);
        return false;
    }
    if (plan_line_holds_cm(wanted, line, &reason))
        return true;
    error_text_set(error, "%s: %s", place->text, reason.text);
    return false;
}

static bool read_line(const cJSON *item, const json_path *place, const line_defaults *defaults, const plan *wanted,
                      plan_line *line, error_text *error)
{
    *line = (plan_line){.mount = defaults->mount};
    if (!plan_check_keys(item, place, line_keys, error) ||
        !read_point(item, place, "from_m", wanted, &line->from, error) ||
        !read_point(item, place, "to_m", wanted, &line->to, error) ||
        !read_mount(item, place, &line->mount, error))
        return false;
    line->above_floor_m = line->mount == PLAN_ON_WALL ? defaults->above_floor_m : 0;
    if (!plan_read_optional(item, place, &above_floor_rule, &line->above_floor_m, error))
        return false;
    if (line->mount == PLAN_ON_FLOOR && line->above_floor_m != 0) {
        error_text_set(error, "%s.above_floor_m: must be 0 or left out for a tape on the floor", place->text);
        return false;
    }
    return check_line(wanted, line, place, error);
}

static bool read_lines(const cJSON *root, const json_path *top, const line_defaults *defaults, plan *wanted,
                       error_text *error)
{
    const cJSON *items = member(root, "lines");
    int count = cJSON_GetArraySize(items);
    json_path place = path_of_member(top, "lines");
    if (items == NULL)
        return plan_refuse_missing(top, "lines", "where the tape goes, in the order of drawing", error);
    if (!cJSON_IsArray(items) || count < 1 || count > PLAN_LINES_MAX) {
        error_text_set(error, "lines: expected an array of 1 to %d lines", PLAN_LINES_MAX);
        return false;
    }
    wanted->lines = calloc((size_t)count, sizeof *wanted->lines);
    if (wanted->lines == NULL) {
        error_text_set(error, "not enough memory for the plan");
        return false;
    }
    const cJSON *item;
    cJSON_ArrayForEach(item, items) {
        json_path path = path_of_element(&place, (int)wanted->line_count);
        if (!read_line(item, &path, defaults, wanted, &wanted->lines[wanted->line_count++], error))
            return false;
    }
    return true;
}

/* ---- The rest of the plan ------------------------------------------------------------------------------------ */

static bool read_room(const cJSON *root, const json_path *top, plan *wanted, error_text *error)
{
    const cJSON *item = member(root, "room_m");
    json_path path = path_of_member(top, "room_m");
    json_path width = path_of_element(&path, 0), height = path_of_element(&path, 1);
    if (item == NULL)
        return plan_refuse_missing(top, "room_m", "the size of the room, [width, height] in metres", error);
    return plan_check_pair(item, &path, "width, height", error) &&
           plan_read_number(item->child, &width, &room_rule, &wanted->width_m, error) &&
           plan_read_number(item->child->next, &height, &room_rule, &wanted->height_m, error);
}

static bool read_module(const cJSON *root, const json_path *top, plan *wanted, error_text *error)
{
    double height_mm = 0;
    if (!plan_read_optional(root, top, &height_rule, &height_mm, error) ||
        !plan_read_optional(root, top, &module_rule, &wanted->module_mm, error))
        return false;
    if (height_mm == 0 && wanted->module_mm == 0)
        return plan_refuse_missing(top, "tape_height_mm", "how tall the ink of the tape is, 60 for instance (or "
                              "module_mm, a seventh of it)", error);
    double height_module_mm = height_mm / TAPEMARK_HEIGHT_MODULES;
    if (wanted->module_mm == 0)
        wanted->module_mm = height_module_mm;
    if (height_mm == 0 || fabs(height_module_mm / wanted->module_mm - 1) <= MODULE_AGREEMENT)
        return true;
    error_text_set(error, "tape_height_mm: %.6g mm are not 7 modules of module_mm, %.6g mm: those make %.6g mm; give "
                   "one of them", height_mm, wanted->module_mm, wanted->module_mm * TAPEMARK_HEIGHT_MODULES);
    return false;
}

static bool read_ids(const cJSON *root, const json_path *top, plan *wanted, error_text *error)
{
    double first_id = 0, cms = PLAN_TM_CMS, most = TAPEMARK_TM_MAX_CMS;
    if (!plan_read_optional(root, top, &first_id_rule, &first_id, error) ||
        !plan_read_optional(root, top, &tm_cms_rule, &cms, error))
        return false;
    number_rule most_rule = {"tm_cms_max", "", cms, TAPEMARK_TM_MAX_CMS};
    if (!plan_read_optional(root, top, &most_rule, &most, error))
        return false;
    wanted->first_id = (int32_t)first_id;
    wanted->tm_cms = (unsigned)cms;
    wanted->tm_cms_max = (unsigned)most;
    wanted->tm_required = member(root, "tm_cms_max") != NULL;
    return true;
}

static bool read_upright(const cJSON *root, plan *wanted, error_text *error)
{
    const cJSON *item = member(root, "camera_upright");
    if (item != NULL && !cJSON_IsBool(item)) {
        error_text_set(error, "camera_upright: expected true or false");
        return false;
    }
    wanted->camera_upright = cJSON_IsTrue(item);
    return true;
}

/* The path of the picture is relative to the folder that the plan lies in. */
static bool read_background(const cJSON *root, const char *plan_path, plan *wanted, error_text *error)
{
    const cJSON *item = member(root, "background");
    const char *name = cJSON_GetStringValue(item), *slash = strrchr(plan_path, '/');
    if (item == NULL)
        return true;
    if (name == NULL || name[0] == '\0') {
        error_text_set(error, "background: expected the name of a picture file");
        return false;
    }
    int folder_length = name[0] == '/' || slash == NULL ? 0 : (int)(slash - plan_path) + 1;
    size_t size = strlen(plan_path) + strlen(name) + 1;
    wanted->background_path = malloc(size);
    if (wanted->background_path == NULL) {
        error_text_set(error, "not enough memory for the plan");
        return false;
    }
    snprintf(wanted->background_path, size, "%.*s%s", folder_length, plan_path, name);
    return true;
}

static bool read_schema_name(const cJSON *root, error_text *error)
{
    const cJSON *item = member(root, "$schema");
    if (item == NULL || cJSON_IsString(item))
        return true;
    error_text_set(error, "$schema: expected the name of the schema, which is not looked at");
    return false;
}

static bool read_root(const cJSON *root, const char *path, plan *wanted, error_text *error)
{
    json_path top = {""};
    line_defaults defaults = {PLAN_ON_WALL, 0};
    return plan_check_keys(root, &top, plan_keys, error) && read_schema_name(root, error) &&
           read_room(root, &top, wanted, error) && read_module(root, &top, wanted, error) &&
           read_ids(root, &top, wanted, error) && read_upright(root, wanted, error) &&
           read_background(root, path, wanted, error) && read_mount(root, &top, &defaults.mount, error) &&
           plan_read_optional(root, &top, &above_floor_rule, &defaults.above_floor_m, error) &&
           read_lines(root, &top, &defaults, wanted, error);
}

bool plan_read(const char *path, plan *wanted, error_text *error)
{
    *wanted = (plan){0};
    cJSON *root = json_file_read(path, error);
    bool done = root != NULL && read_root(root, path, wanted, error);
    if (!done)
        plan_release(wanted);
    cJSON_Delete(root);
    return done;
}
