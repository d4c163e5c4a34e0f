/* A record goes from one end of the link to the other, as they were installed. */
#include <stdio.h>
#include <tapemark_receiver.h>
#include <tapemark_sender.h>

int main(void)
{
    const tapemark_record sent = {.type = TAPEMARK_RECORD_CM, .as.cm = {.seq = 7, .id = -17}};
    uint8_t bytes[TAPEMARK_SENTENCE_MAX_BYTES];
    tapemark_receiver receiver = {0};
    int records = 0;
    for (tapemark_encoding encoding = TAPEMARK_SENTENCES; encoding <= TAPEMARK_PACKETS; encoding++) {
        const size_t size = tapemark_record_write(&sent, encoding, bytes, sizeof bytes);
        for (size_t i = 0; i < size; i++)
            if (tapemark_receiver_push(&receiver, bytes[i]) == TAPEMARK_RECORD_CM)
                records += receiver.record.as.cm.id == -17;
    }
    printf("%d records\n", records);
    return records != 2;
}
