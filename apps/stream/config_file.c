#include "config_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "byte_reader.h"

enum { FILE_MAX_BYTES = 1024 * 1024, NAMES_MAX = 32 };

typedef struct config_reading {
    stream_settings *settings;
    unsigned set_in_line[NAMES_MAX];  /* by the index of its name; 0: not yet */
    unsigned line;
} config_reading;

static bool is_blank(char character)
{
    return character == ' ' || character == '\t' || character == '\r';
}

/* Without blanks at both ends. */
static char *trim(char *text)
{
    while (is_blank(*text))
        text++;
    size_t length = strlen(text);
    while (length > 0 && is_blank(text[length - 1]))
        text[--length] = '\0';
    return text;
}

/* "serial" says no more than "output". */
static size_t key_of(const char *name)
{
    const char *const *names = settings_names();
    const char *key = strcmp(name, "serial") == 0 ? "output" : name;
    size_t i = 0;
    while (strcmp(names[i], key) != 0)
        i++;
    return i;
}

static bool set(config_reading *reading, const char *name, const char *value, error_text *error)
{
    if (!settings_know(name)) {
        error_text_set(error, "there is no setting of this name; --help lists them");
        return false;
    }
    unsigned *set_before = &reading->set_in_line[key_of(name)];
    if (*set_before > 0) {
        error_text_set(error, "was set in line %u already", *set_before);
        return false;
    }
    *set_before = reading->line;
    return settings_set(reading->settings, name, value, error);
}

static bool read_line(config_reading *reading, char *line, error_text *error)
{
    error_text reason;
    char *name = trim(line);
    if (*name == '\0' || *name == '#')
        return true;
    char *equals = strchr(name, '=');
    if (equals == NULL) {
        error_text_set(error, "line %u: expected \"name = value\", not \"%.40s\"", reading->line, name);
        return false;
    }
    *equals = '\0';
    name = trim(name);
    if (set(reading, name, trim(equals + 1), &reason))
        return true;
    error_text_set(error, "line %u: %.40s: %.300s", reading->line, name, reason.text);
    return false;
}

static bool read_lines(config_reading *reading, char *text, error_text *error)
{
    char *line = text;
    while (line != NULL) {
        char *end = strchr(line, '\n');
        if (end != NULL)
            *end = '\0';
        reading->line++;
        if (!read_line(reading, line, error))
            return false;
        line = end != NULL ? end + 1 : NULL;
    }
    return true;
}

bool config_file_read(const char *path, stream_settings *settings, error_text *error)
{
    byte_reader *file = byte_reader_open(path, error);
    if (file == NULL)
        return false;
    size_t size = 0;
    char *text = (char *)byte_reader_read_all(file, FILE_MAX_BYTES, &size, error);
    byte_reader_close(file);
    if (text == NULL)
        return false;
    /* Some editors begin a file with a mark that says that it is UTF-8. */
    static const char mark[] = "\xef\xbb\xbf";
    size_t begin = strncmp(text, mark, strlen(mark)) == 0 ? strlen(mark) : 0;
    config_reading reading = {.settings = settings};
    bool done = false;
    if (strlen(text) != size)
        error_text_set(error, "is no text: it holds bytes of 0");
    else
        done = read_lines(&reading, text + begin, error);
    free(text);
    return done;
}
