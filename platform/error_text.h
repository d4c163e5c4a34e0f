/* One line that tells a user what went wrong, without the name of the program or the input: the caller puts
 * those in front. */
#ifndef PLATFORM_ERROR_TEXT_H
#define PLATFORM_ERROR_TEXT_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct error_text {
    char text[400];
} error_text;

/* Formats as printf does; what does not fit is cut. */
#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
void error_text_set(error_text *error, const char *format, ...);

#ifdef __cplusplus
}
#endif

#endif
