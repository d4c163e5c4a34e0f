/* The configuration file: a setting a line, `name = value`, with the names of the command line. Empty lines and those
 * that begin with # say nothing. A name stands there once; serial and output are one. */
#ifndef STREAM_CONFIG_FILE_H
#define STREAM_CONFIG_FILE_H

#include "settings.h"

/* Sets what the file tells and leaves the rest alone. False, with the place, when anything in it is wrong; what
 * `settings` holds is undefined then. */
bool config_file_read(const char *path, stream_settings *settings, error_text *error);

#endif
