#include "handmade.h"

uint16_t slow_crc(const uint8_t *bytes, size_t count)
{
    uint16_t crc = 0xffff;
    for (size_t i = 0; i < 8 * count; i++) {
        const bool out = (crc & 0x8000) != 0;
        const bool in = (bytes[i / 8] & 0x80 >> i % 8) != 0;
        crc = (uint16_t)(crc << 1);
        if (out != in)
            crc ^= 0x1021;
    }
    return crc;
}

message sentence_with_crc(const char *fields, const char *crc)
{
    char body[200];
    snprintf(body, sizeof body, "%s,%s", fields, crc);
    unsigned sum = 0;
    for (const char *at = body; *at != '\0'; at++)
        sum ^= (uint8_t)*at;
    message made;
    made.size = (size_t)snprintf((char *)made.bytes, sizeof made.bytes, "$%s*%02X\r\n", body, sum);
    assert_true(made.size < sizeof made.bytes);
    return made;
}

message sentence_of(const char *fields)
{
    char checked[200];
    char crc[8];
    snprintf(checked, sizeof checked, "%s,", fields);
    snprintf(crc, sizeof crc, "%04X", slow_crc((const uint8_t *)checked, strlen(checked)));
    return sentence_with_crc(fields, crc);
}

message packet_of(const uint8_t *fields, size_t size)
{
    uint8_t payload[70];
    memcpy(payload, fields, size);
    const uint16_t crc = slow_crc(payload, size);
    payload[size] = (uint8_t)crc;
    payload[size + 1] = (uint8_t)(crc >> 8);
    message made = {.bytes = {0}, .size = 2};
    size_t block = 1;
    for (size_t i = 0; i < size + 2; i++) {
        if (payload[i] == 0) {
            made.bytes[block] = (uint8_t)(made.size - block);
            block = made.size;
        }
        made.bytes[made.size++] = payload[i];
    }
    made.bytes[block] = (uint8_t)(made.size - block);
    made.bytes[made.size++] = 0;
    return made;
}
