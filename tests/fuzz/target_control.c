/* What comes back to tapemark-stream on the line: commands among any bytes, and the answers to them. */
#include <string.h>

#include "byte_script.h"
#include "camera_mode.h"
#include "commands.h"
#include "tapemark_sender.h"

typedef struct controlled {
    stream_settings settings;
    camera_watch camera;  /* none is open */
    command_target target;
} controlled;

/* The answer goes out in either encoding, and tells what the command said. */
static void claim_answer(const tapemark_command_record *command, const tapemark_answer_record *answer,
                         tapemark_encoding encoding)
{
    uint8_t bytes[TAPEMARK_SENTENCE_MAX_BYTES];
    const tapemark_record record = {.type = TAPEMARK_RECORD_ANSWER, .as.answer = *answer};
    tapemark_receiver receiver = {.damaged = 0};
    tapemark_record_type type = TAPEMARK_RECORD_NONE;
    const size_t size = tapemark_record_write(&record, encoding, bytes, sizeof bytes);
    CLAIM(size > 0 && answer->number == command->number);
    for (size_t i = 0; i < size && type == TAPEMARK_RECORD_NONE; i++)
        type = tapemark_receiver_push(&receiver, bytes[i]);
    CLAIM(type == TAPEMARK_RECORD_ANSWER && strcmp(receiver.record.as.answer.text, answer->text) == 0);
    CLAIM(strcmp(answer->result, "OK") == 0 || strcmp(answer->result, "ERR") == 0);
    CLAIM(answer->text[0] != '\0' || strcmp(command->verb, "PING") == 0);
}

static void claim_settings(const controlled *all)
{
    error_text error = {""};
    const camera_wishes wishes = settings_camera_wishes(&all->settings);
    const camera_region *roi = &all->settings.roi;
    CLAIM(settings_check(&all->settings, &error));
    CLAIM(camera_wishes_valid(&wishes, &error));
    CLAIM(all->settings.encoding == TAPEMARK_SENTENCES || all->settings.encoding == TAPEMARK_PACKETS);
    CLAIM(roi->x_px >= 0 && roi->y_px >= 0 && roi->width_px >= 0 && roi->height_px >= 0);
    CLAIM(all->target.width_px == 0 || (roi->x_px + roi->width_px <= all->target.width_px &&
                                        roi->y_px + roi->height_px <= all->target.height_px));
}

/* The same setting asked for tells what was set. */
static void claim_kept(const controlled *all, const tapemark_command_record *command,
                       const tapemark_answer_record *answer)
{
    tapemark_command_record question = *command;
    tapemark_answer_record again;
    if (strcmp(command->verb, "SET") != 0 || strcmp(answer->result, "OK") != 0)
        return;
    memcpy(question.verb, "GET", sizeof "GET");
    command_answer(&all->target, &question, &again);
    CLAIM(strcmp(again.result, "OK") == 0 && strcmp(again.text, answer->text) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static controlled all;
    tapemark_receiver receiver = {.damaged = 0};
    all = (controlled){.settings = settings_usual()};
    all.target = (command_target){&all.settings, &all.camera, size % 2 ? 640 : 0, size % 2 ? 480 : 0};
    for (size_t i = 0; i < size; i++) {
        if (tapemark_receiver_push(&receiver, bytes[i]) != TAPEMARK_RECORD_COMMAND)
            continue;
        tapemark_answer_record answer;
        command_answer(&all.target, &receiver.record.as.command, &answer);
        claim_answer(&receiver.record.as.command, &answer, TAPEMARK_SENTENCES);
        claim_answer(&receiver.record.as.command, &answer, TAPEMARK_PACKETS);
        claim_settings(&all);
        claim_kept(&all, &receiver.record.as.command, &answer);
    }
    return 0;
}
