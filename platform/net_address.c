#include "net_address.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>

static bool is_port(const char *text)
{
    size_t length = strlen(text);
    return length > 0 && length <= 5 && strspn(text, "0123456789") == length && strtol(text, NULL, 10) <= 65535;
}

/* Without brackets the colons of an IPv6 address cannot be told from the one before the port. */
static bool take_host(const char *text, size_t length, char *host, size_t size)
{
    bool bracketed = length > 2 && text[0] == '[' && text[length - 1] == ']';
    if (bracketed) {
        text++;
        length -= 2;
    }
    if (length == 0 || length >= size || (!bracketed && memchr(text, ':', length) != NULL))
        return false;
    snprintf(host, size, "%.*s", (int)length, text);
    if (strcmp(host, "localhost") == 0)
        snprintf(host, size, "127.0.0.1");
    return true;
}

struct addrinfo *net_address_parse(const char *text, int socket_type)
{
    char host[64] = "127.0.0.1";
    const char *colon = strrchr(text, ':');
    const char *port = colon != NULL ? colon + 1 : text;
    if (!is_port(port) || (colon != NULL && !take_host(text, (size_t)(colon - text), host, sizeof host)))
        return NULL;
    struct addrinfo hints = {.ai_socktype = socket_type, .ai_flags = AI_NUMERICHOST | AI_NUMERICSERV};
    struct addrinfo *found;
    return getaddrinfo(host, port, &hints, &found) == 0 ? found : NULL;
}
