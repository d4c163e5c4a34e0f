/* Internet addresses as users write them. */
#ifndef PLATFORM_NET_ADDRESS_H
#define PLATFORM_NET_ADDRESS_H

#include <netdb.h>

/* HOST:PORT, or PORT alone for this machine's own 127.0.0.1. HOST is a number, 192.168.4.1 or [::1], or "localhost":
 * other names would have to be looked up, which takes as long as it likes. For freeaddrinfo(); NULL when it is
 * none. */
struct addrinfo *net_address_parse(const char *text, int socket_type);

#endif
