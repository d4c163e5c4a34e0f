#include "preview_request.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { HOST_MAX_BYTES = 256 };

/* The path in the request's first line, without what follows a question mark. */
static bool asks_for(const char *target, const char *path)
{
    size_t length = strcspn(target, " ?\r");
    return length == strlen(path) && memcmp(target, path, length) == 0;
}

static preview_wish wish_of(const char *target)
{
    if (asks_for(target, "/"))
        return PREVIEW_PAGE;
    if (asks_for(target, "/stream"))
        return PREVIEW_STREAM;
    return asks_for(target, "/frame.jpg") ? PREVIEW_PICTURE : PREVIEW_NO_SUCH_PATH;
}

static bool is_number(const char *host)
{
    struct in6_addr ignored;
    char inside[HOST_MAX_BYTES];
    size_t length = strlen(host);
    if (inet_pton(AF_INET, host, &ignored) == 1)
        return true;
    if (length < 2 || host[0] != '[' || host[length - 1] != ']')
        return false;
    snprintf(inside, sizeof inside, "%.*s", (int)strcspn(host + 1, "%]"), host + 1);
    return inet_pton(AF_INET6, inside, &ignored) == 1;
}

static bool is_this_machine(const char *host)
{
    static const char local[] = ".local";
    char own[HOST_MAX_BYTES] = "";
    if (strcasecmp(host, "localhost") == 0)
        return true;
    if (gethostname(own, sizeof own - 1) != 0 || own[0] == '\0')
        return false;
    size_t length = strlen(own);
    return strncasecmp(host, own, length) == 0 &&
           (host[length] == '\0' || strcasecmp(host + length, local) == 0);
}

/* `value` is what follows "Host:", up to the end of the line. */
static bool is_own_host(const char *value)
{
    char host[HOST_MAX_BYTES];
    size_t length;
    value += strspn(value, " \t");
    length = strcspn(value, " \t\r\n");
    if (length >= sizeof host)
        return false;
    snprintf(host, sizeof host, "%.*s", (int)length, value);
    char *colon = strrchr(host, ':');
    if (colon != NULL && strspn(colon + 1, "0123456789") == strlen(colon + 1))
        *colon = '\0';
    return is_number(host) || is_this_machine(host);
}

/* Programs that are no browsers may send none. */
static bool hosts_are_own(const char *text)
{
    static const char header[] = "Host:";
    for (const char *line = strchr(text, '\n'); line != NULL; line = strchr(line + 1, '\n'))
        if (strncasecmp(line + 1, header, sizeof header - 1) == 0 && !is_own_host(line + sizeof header))
            return false;
    return true;
}

preview_request preview_request_parse(const char *text)
{
    static const char get[] = "GET ", head[] = "HEAD ";
    bool head_only = strncmp(text, head, sizeof head - 1) == 0;
    if (!head_only && strncmp(text, get, sizeof get - 1) != 0)
        return (preview_request){PREVIEW_NO_SUCH_METHOD, false};
    if (!hosts_are_own(text))
        return (preview_request){PREVIEW_FOREIGN_HOST, head_only};
    return (preview_request){wish_of(strchr(text, ' ') + 1), head_only};
}
