#include "text_buffer.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void text_buffer_clear(text_buffer *buffer)
{
    buffer->length = 0;
    buffer->failed = false;
}

void text_buffer_release(text_buffer *buffer)
{
    free(buffer->text);
    *buffer = (text_buffer){0};
}

static bool reserve(text_buffer *buffer, size_t extra)
{
    if (buffer->failed)
        return false;
    if (buffer->length + extra < buffer->capacity)
        return true;
    size_t capacity = 2 * buffer->capacity + extra + 1024;
    char *text = realloc(buffer->text, capacity);
    if (text == NULL) {
        buffer->failed = true;
        return false;
    }
    buffer->text = text;
    buffer->capacity = capacity;
    return true;
}

void text_buffer_add(text_buffer *buffer, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0 || !reserve(buffer, (size_t)length + 1))
        return;
    va_start(arguments, format);
    vsnprintf(buffer->text + buffer->length, (size_t)length + 1, format, arguments);
    va_end(arguments);
    buffer->length += (size_t)length;
}

/* Length of the UTF-8 sequence at the start of the text, 0 when there is none: overlong forms, surrogates and
 * values beyond U+10FFFF count as none. */
static size_t utf8_length(const unsigned char *text)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    size_t length = text[0] < 0x80 ? 1 : text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : text[0] >= 0xc0 ? 2 : 0;
    if (length < 2)
        return length;
    if (text[0] >= 0xf8)
        return 0;
    uint32_t value = text[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((text[i] & 0xc0) != 0x80)
            return 0;
        value = value << 6 | (text[i] & 0x3fu);
    }
    if (value < least[length] || (value >= 0xd800 && value <= 0xdfff) || value > 0x10ffff)
        return 0;
    return length;
}

static bool is_control(char c)
{
    return (unsigned char)c < 0x20 || c == 0x7f;
}

/* Of two bytes, U+0080 to U+009F: some terminals obey U+009B as they do ESC [. */
static bool is_far_control(const unsigned char *text)
{
    return text[0] == 0xc2 && text[1] < 0xa0;
}

void text_buffer_add_json_string(text_buffer *buffer, const char *text)
{
    text_buffer_add(buffer, "\"");
    while (*text != '\0') {
        size_t length = utf8_length((const unsigned char *)text);
        if (length == 0)
            text_buffer_add(buffer, "\\ufffd");
        else if (*text == '"' || *text == '\\')
            text_buffer_add(buffer, "\\%c", *text);
        else if (is_control(*text))
            text_buffer_add(buffer, "\\u%04x", (unsigned)*text);
        else
            text_buffer_add(buffer, "%.*s", (int)length, text);
        text += length > 0 ? length : 1;
    }
    text_buffer_add(buffer, "\"");
}

void text_buffer_add_printable(text_buffer *buffer, const char *text)
{
    while (*text != '\0') {
        size_t length = utf8_length((const unsigned char *)text);
        if (length == 0 || is_control(*text) || is_far_control((const unsigned char *)text))
            text_buffer_add(buffer, "?");
        else
            text_buffer_add(buffer, "%.*s", (int)length, text);
        text += length > 0 ? length : 1;
    }
}

void text_buffer_add_json_number(text_buffer *buffer, double number, int decimals)
{
    if (isfinite(number))
        text_buffer_add(buffer, "%.*f", decimals, number);
    else
        text_buffer_add(buffer, "null");
}

void text_buffer_add_csv_field(text_buffer *buffer, const char *text)
{
    if (strpbrk(text, ",\"\r\n") == NULL) {
        text_buffer_add(buffer, "%s", text);
        return;
    }
    text_buffer_add(buffer, "\"");
    for (; *text != '\0'; text++)
        text_buffer_add(buffer, *text == '"' ? "\"\"" : "%c", *text);
    text_buffer_add(buffer, "\"");
}
