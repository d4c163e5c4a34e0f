/* Commands from the line, and what is answered. */
#ifndef STREAM_COMMANDS_H
#define STREAM_COMMANDS_H

#include "camera_watch.h"

typedef struct command_target {
    stream_settings *settings;
    camera_watch *camera;
    int32_t width_px;   /* of the last frame; 0: none yet */
    int32_t height_px;
} command_target;

/* Does what was asked. A setting that is refused stays as it was. The encoding is only noted in the settings. */
void command_answer(const command_target *target, const tapemark_command_record *command,
                    tapemark_answer_record *answer);

#endif
