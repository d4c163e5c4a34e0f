/* What a viewer of the preview asks for. Not for others. */
#ifndef PLATFORM_PREVIEW_REQUEST_H
#define PLATFORM_PREVIEW_REQUEST_H

#include <stdbool.h>

typedef enum preview_wish {
    PREVIEW_PAGE,
    PREVIEW_STREAM,
    PREVIEW_PICTURE,
    PREVIEW_NO_SUCH_PATH,
    PREVIEW_NO_SUCH_METHOD,
    PREVIEW_FOREIGN_HOST  /* asked for by a name that is not ours: another site's page may be behind it */
} preview_wish;

typedef struct preview_request {
    preview_wish wish;
    bool head_only;
} preview_request;

/* Of the whole head of a request. Names are foreign, but for numbers, "localhost" and this machine's own name: a site
 * that has its name point here could otherwise have our pictures read by its page (DNS rebinding). */
preview_request preview_request_parse(const char *text);

#endif
