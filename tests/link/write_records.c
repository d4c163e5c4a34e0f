/* Usage: write_records SEED COUNT STREAM TEXT
 * Random records, in an encoding drawn for each, as bytes into one file and as lines into another: for a second
 * opinion to compare. */
#include "records.h"

#include <stdlib.h>

int main(int argc, char **argv)
{
    if (argc != 5) {
        fprintf(stderr, "write_records: expected SEED COUNT STREAM TEXT\n");
        return 2;
    }
    uint32_t random = (uint32_t)strtoul(argv[1], NULL, 10);
    FILE *stream = fopen(argv[3], "wb");
    FILE *text = fopen(argv[4], "w");
    if (stream == NULL || text == NULL) {
        fprintf(stderr, "write_records: %s or %s cannot be written\n", argv[3], argv[4]);
        return 1;
    }
    for (unsigned long left = strtoul(argv[2], NULL, 10); left > 0; left--) {
        const tapemark_record record = random_record(&random, (uint8_t)(1 + left % RECORD_TYPES));
        const tapemark_encoding encoding = random_below(&random, 2) ? TAPEMARK_PACKETS : TAPEMARK_SENTENCES;
        uint8_t bytes[TAPEMARK_SENTENCE_MAX_BYTES];
        char line[RECORD_TEXT_BYTES];
        const size_t size = tapemark_record_write(&record, encoding, bytes, sizeof bytes);
        record_to_text(&record, line);
        if (size == 0 || fwrite(bytes, 1, size, stream) != size || fprintf(text, "%s\n", line) < 0) {
            fprintf(stderr, "write_records: %s was not written\n", line);
            return 1;
        }
    }
    const bool closed = fclose(stream) == 0;
    return fclose(text) == 0 && closed ? 0 : 1;
}
