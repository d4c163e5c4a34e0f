#include "net_address.h"
#include "record_channel.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

typedef struct udp_channel {
    record_channel base;
    int descriptor;
} udp_channel;

static int descriptor_of(const record_channel *channel)
{
    return ((const udp_channel *)channel)->descriptor;
}

/* Whether somebody listens is not the sender's business, and a datagram that finds no room is lost as one that the
 * network loses: counted, where anybody counts, by the receiver. */
static bool is_passing(int reason)
{
    return reason == ECONNREFUSED || reason == EAGAIN || reason == ENOBUFS || reason == EINTR;
}

static ptrdiff_t udp_write(record_channel *channel, const uint8_t *bytes, size_t size, error_text *error)
{
    ssize_t sent = send(descriptor_of(channel), bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (sent >= 0 || is_passing(errno))
        return (ptrdiff_t)size;
    error_text_set(error, "cannot be sent to: %s", strerror(errno));
    return -1;
}

static ptrdiff_t udp_read(record_channel *channel, uint8_t *bytes, size_t size, error_text *error)
{
    ssize_t count = recv(descriptor_of(channel), bytes, size, MSG_DONTWAIT);
    if (count < 0 && is_passing(errno))
        return 0;
    return record_channel_moved(count, error);
}

static void udp_close(record_channel *channel)
{
    close(descriptor_of(channel));
    free(channel);
}

static const record_channel_methods udp_methods = {udp_write, udp_read, NULL, NULL, descriptor_of, udp_close};

static bool udp_check(const char *target, error_text *error)
{
    const char *colon = strrchr(target, ':');
    struct addrinfo *found = colon != NULL ? net_address_parse(target, SOCK_DGRAM) : NULL;
    bool usable = found != NULL && strspn(colon + 1, "0") != strlen(colon + 1);
    if (!usable)
        error_text_set(error, "is no address and port, such as udp:192.168.4.1:5005");
    if (found != NULL)
        freeaddrinfo(found);
    return usable;
}

static record_channel *udp_open(const char *target, error_text *error)
{
    struct addrinfo *found = net_address_parse(target, SOCK_DGRAM);
    udp_channel *self = calloc(1, sizeof *self);
    int descriptor = -1;
    if (found != NULL && self != NULL) {
        descriptor = socket(found->ai_family, SOCK_DGRAM, 0);
        if (descriptor >= 0 && connect(descriptor, found->ai_addr, found->ai_addrlen) == 0 &&
            fcntl(descriptor, F_SETFD, FD_CLOEXEC) == 0) {
            self->base = (record_channel){&udp_methods, 0, 0};
            self->descriptor = descriptor;
            freeaddrinfo(found);
            return &self->base;
        }
    }
    error_text_set(error, "cannot be sent to: %s", found == NULL || self == NULL ? "not enough memory"
                                                                                : strerror(errno));
    if (descriptor >= 0)
        close(descriptor);
    if (found != NULL)
        freeaddrinfo(found);
    free(self);
    return NULL;
}

const record_channel_kind record_channel_udp = {"udp:", false, udp_check, udp_open};
