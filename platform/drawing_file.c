#include "drawing_file.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

static void tell(const drawing_file *file, const char *reason, error_text *error)
{
    error_text_set(error, "%s: %s", file->path, reason);
}

bool drawing_file_open(drawing_file *file, const char *path, error_text *error)
{
    error_text reason;
    snprintf(file->path, sizeof file->path, "%s", path);
    file->error_number = 0;
    file->output = output_file_open(path, &reason);
    if (file->output == NULL)
        tell(file, reason.text, error);
    return file->output != NULL;
}

bool drawing_file_write(drawing_file *file, const void *bytes, size_t size)
{
    if (file->error_number != 0)
        return false;
    errno = 0;
    if (fwrite(bytes, 1, size, output_file_stream(file->output)) == size)
        return true;
    file->error_number = errno != 0 ? errno : EIO;
    return false;
}

bool drawing_file_publish(drawing_file *file, error_text *error)
{
    error_text reason;
    bool published = output_file_publish(file->output, &reason);
    file->output = NULL;
    if (file->error_number != 0)
        error_text_set(error, "%s: cannot be written: %s", file->path, strerror(file->error_number));
    else if (!published)
        tell(file, reason.text, error);
    return published && file->error_number == 0;
}

void drawing_file_discard(drawing_file *file)
{
    output_file_discard(file->output);
    file->output = NULL;
}
