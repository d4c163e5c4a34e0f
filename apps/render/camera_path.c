#include "camera_path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "byte_reader.h"

enum { COLUMNS = 7, REQUIRED_COLUMNS = 5, WAYPOINTS_MAX = 100000 };

static const char *const column_names[COLUMNS] = {"time_s",      "x_m",       "y_m",     "height_m",
                                                  "heading_deg", "pitch_deg", "roll_deg"};

/* What is read, line by line. */
typedef struct table {
    char *rest;                  /* of the text */
    unsigned line;
    size_t columns[COLUMNS];     /* of the file, in its order, as indices of column_names */
    size_t column_count;
} table;

static double *field_of(camera_waypoint *place, size_t column)
{
    double *const fields[COLUMNS] = {&place->time_s,      &place->x_m,       &place->y_m,     &place->height_m,
                                     &place->heading_deg, &place->pitch_deg, &place->roll_deg};
    return fields[column];
}

/* ---- Lines and cells ----------------------------------------------------------------------------------- */

/* The next line that says something, NULL at the end. Comments begin with '#'. */
static char *next_line(table *source)
{
    while (source->rest != NULL && *source->rest != '\0') {
        char *line = source->rest, *end = strchr(line, '\n');
        source->rest = end != NULL ? end + 1 : NULL;
        source->line++;
        if (end != NULL)
            *end = '\0';
        line[strcspn(line, "\r")] = '\0';
        line += strspn(line, " \t");
        if (*line != '\0' && *line != '#')
            return line;
    }
    return NULL;
}

/* Takes a cell off the line, without the blanks around it; NULL when there is none left. */
static char *next_cell(char **line)
{
    char *cell = *line;
    if (cell == NULL)
        return NULL;
    char *end = strchr(cell, ',');
    *line = end != NULL ? end + 1 : NULL;
    if (end != NULL)
        *end = '\0';
    cell += strspn(cell, " \t");
    for (size_t length = strlen(cell); length > 0 && strchr(" \t", cell[length - 1]) != NULL; length--)
        cell[length - 1] = '\0';
    return cell;
}

/* ---- Columns and waypoints ----------------------------------------------------------------------------- */

static size_t column_of(const char *name)
{
    size_t column = 0;
    while (column < COLUMNS && strcmp(column_names[column], name) != 0)
        column++;
    return column;
}

static bool add_column(table *source, const char *name, error_text *error)
{
    size_t column = column_of(name);
    if (column == COLUMNS) {
        error_text_set(error, "line %u: column \"%.40s\" is none of time_s, x_m, y_m, height_m, heading_deg, "
                       "pitch_deg, roll_deg", source->line, name);
        return false;
    }
    for (size_t i = 0; i < source->column_count; i++) {
        if (source->columns[i] == column) {
            error_text_set(error, "line %u: column %s is there twice", source->line, name);
            return false;
        }
    }
    source->columns[source->column_count++] = column;
    return true;
}

static bool read_columns(table *source, error_text *error)
{
    char *line = next_line(source), *cell;
    if (line == NULL) {
        error_text_set(error, "is empty; its first line names the columns: time_s,x_m,y_m,height_m,heading_deg");
        return false;
    }
    while ((cell = next_cell(&line)) != NULL) {
        if (!add_column(source, cell, error))
            return false;
    }
    for (size_t column = 0; column < REQUIRED_COLUMNS; column++) {
        bool found = false;
        for (size_t i = 0; i < source->column_count; i++)
            found = found || source->columns[i] == column;
        if (!found) {
            error_text_set(error, "line %u: there is no column %s", source->line, column_names[column]);
            return false;
        }
    }
    return true;
}

static bool read_waypoint(const table *source, char *line, camera_waypoint *place, error_text *error)
{
    *place = (camera_waypoint){0};
    for (size_t i = 0; i < source->column_count; i++) {
        const char *name = column_names[source->columns[i]], *cell = next_cell(&line);
        char *end = NULL;
        double number = cell != NULL ? strtod(cell, &end) : 0;
        if (cell == NULL || end == cell || *end != '\0' || !isfinite(number)) {
            error_text_set(error, "line %u: %s: expected a number, not \"%.40s\"", source->line, name,
                           cell != NULL ? cell : "");
            return false;
        }
        *field_of(place, source->columns[i]) = number;
    }
    const char *problem = line != NULL ? "there are more cells than columns" : camera_waypoint_problem(place);
    if (problem != NULL)
        error_text_set(error, "line %u: %s", source->line, problem);
    return problem == NULL;
}

static bool read_waypoints(table *source, camera_path *way, error_text *error)
{
    size_t capacity = 0;
    for (char *line; (line = next_line(source)) != NULL; way->count++) {
        if (way->count == WAYPOINTS_MAX) {
            error_text_set(error, "line %u: there are more than %d waypoints", source->line, WAYPOINTS_MAX);
            return false;
        }
        if (way->count == capacity) {
            capacity = 2 * capacity + 64;
            camera_waypoint *more = realloc(way->waypoints, capacity * sizeof *more);
            if (more == NULL) {
                error_text_set(error, "not enough memory");
                return false;
            }
            way->waypoints = more;
        }
        camera_waypoint *place = &way->waypoints[way->count];
        if (!read_waypoint(source, line, place, error))
            return false;
        if (way->count > 0 && place->time_s <= place[-1].time_s) {
            error_text_set(error, "line %u: time_s does not ascend: %g after %g", source->line, place->time_s,
                           place[-1].time_s);
            return false;
        }
    }
    if (way->count == 0)
        error_text_set(error, "has no waypoint");
    return way->count > 0;
}

const char *camera_waypoint_problem(const camera_waypoint *place)
{
    if (!(fabs(place->time_s) <= 1e6))
        return "the time is out of range, -1000000 to 1000000 s";
    if (!(fabs(place->x_m) <= 1e5) || !(fabs(place->y_m) <= 1e5))
        return "the place is out of range, -100000 to 100000 m";
    if (!(place->height_m > 0 && place->height_m <= 1000))
        return "the height is out of range, above 0 to 1000 m";
    if (!(fabs(place->heading_deg) <= 36000))
        return "the heading is out of range, -36000 to 36000 degrees";
    if (!(fabs(place->pitch_deg) <= 90) || !(fabs(place->roll_deg) <= 360))
        return "the pitch is out of range, -90 to 90 degrees, or the roll is, -360 to 360";
    return NULL;
}

bool camera_path_read(const char *path, camera_path *way, error_text *error)
{
    const size_t most_bytes = (size_t)16 << 20;
    *way = (camera_path){0};
    byte_reader *reader = byte_reader_open(path, error);
    size_t size = 0;
    char *text = reader != NULL ? (char *)byte_reader_read_all(reader, most_bytes, &size, error) : NULL;
    byte_reader_close(reader);
    if (text == NULL)
        return false;

    table source = {.rest = text};
    bool done = strlen(text) == size;
    if (!done)
        error_text_set(error, "is no text: it holds a zero byte");
    done = done && read_columns(&source, error) && read_waypoints(&source, way, error);
    free(text);
    if (!done)
        camera_path_release(way);
    return done;
}

void camera_path_release(camera_path *way)
{
    free(way->waypoints);
    *way = (camera_path){0};
}

/* ---- Between waypoints --------------------------------------------------------------------------------- */

/* Through less than half a turn. */
static double turned(double from_deg, double to_deg, double share)
{
    return from_deg + share * remainder(to_deg - from_deg, 360);
}

static camera_waypoint between(const camera_waypoint *a, const camera_waypoint *b, double time_s)
{
    double share = (time_s - a->time_s) / (b->time_s - a->time_s);
    return (camera_waypoint){
        .time_s = time_s,
        .x_m = a->x_m + share * (b->x_m - a->x_m),
        .y_m = a->y_m + share * (b->y_m - a->y_m),
        .height_m = a->height_m + share * (b->height_m - a->height_m),
        .heading_deg = turned(a->heading_deg, b->heading_deg, share),
        .pitch_deg = a->pitch_deg + share * (b->pitch_deg - a->pitch_deg),
        .roll_deg = turned(a->roll_deg, b->roll_deg, share),
    };
}

camera_waypoint camera_path_at(const camera_path *way, double time_s)
{
    size_t low = 0, high = way->count - 1;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (way->waypoints[middle].time_s < time_s)
            low = middle + 1;
        else
            high = middle;
    }
    /* The first waypoint not before the time, or the last of all. */
    const camera_waypoint *next = &way->waypoints[low];
    if (low > 0 && time_s < next->time_s)
        return between(next - 1, next, time_s);
    camera_waypoint place = *next;
    place.time_s = time_s;
    return place;
}
