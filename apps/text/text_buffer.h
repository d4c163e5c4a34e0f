/* Text that grows: a whole line is put together before it is written. */
#ifndef TEXT_TEXT_BUFFER_H
#define TEXT_TEXT_BUFFER_H

#include <stdbool.h>
#include <stddef.h>

/* Zeroed before the first use. */
typedef struct text_buffer {
    char *text;
    size_t length;
    size_t capacity;
    bool failed;  /* memory ran out: what has been added since is missing */
} text_buffer;

void text_buffer_clear(text_buffer *buffer);
void text_buffer_release(text_buffer *buffer);

__attribute__((format(printf, 2, 3)))
void text_buffer_add(text_buffer *buffer, const char *format, ...);

/* Adds a JSON string with its quotes. Bytes that are no UTF-8 become U+FFFD. */
void text_buffer_add_json_string(text_buffer *buffer, const char *text);

/* Adds text for a terminal: what is no UTF-8 or a control character, C1 included, becomes a question mark. */
void text_buffer_add_printable(text_buffer *buffer, const char *text);

/* Adds a number with so many decimals; null for those that JSON does not know. */
void text_buffer_add_json_number(text_buffer *buffer, double number, int decimals);

/* Adds one field of a CSV row, quoted where it must be. */
void text_buffer_add_csv_field(text_buffer *buffer, const char *text);

#endif
