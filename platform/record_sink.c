#include "record_sink.h"

#include "camera.h"
#include "record_channel.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

enum { INPUT_BYTES = 1024, MAY_BE_UNMOVED_BYTES = 256 };

static const int64_t millisecond_ns = 1000000;
static const int64_t first_retry_ns = 100 * 1000000;
static const int64_t longest_retry_ns = INT64_C(2000) * 1000000;
static const int64_t stalled_after_ns = 200 * 1000000;
static const int64_t probe_interval_ns = 100 * 1000000;
static const int64_t unpolled_interval_ns = 200 * 1000000;

static const record_channel_kind *const kinds[] = {
    &record_channel_serial, &record_channel_file, &record_channel_pty, &record_channel_udp, &record_channel_stdout,
};

struct record_sink {
    char *name;
    const record_channel_kind *kind;
    const char *target;         /* the name without the kind */
    record_channel *channel;    /* NULL while there is none */
    record_sink_state state;
    bool has_news;
    error_text news;
    record_sink_counts counts;
    int64_t retry_ns;           /* when to open again */
    int64_t retry_interval_ns;
    int64_t line_free_ns;       /* when the line will have carried all that was taken */
    int64_t moved_ns;           /* when bytes were last seen to leave */
    size_t unmoved_bytes;       /* as of then */
    bool probing;               /* a stalled port was given a byte */
    uint8_t group[RECORD_GROUP_MAX_BYTES];
    size_t group_bytes;
    size_t group_sent_bytes;
    unsigned group_records;
    uint8_t input[INPUT_BYTES];
    size_t input_bytes;
};

ptrdiff_t record_channel_moved(ptrdiff_t count, error_text *error)
{
    if (count >= 0)
        return count;
    if (errno == EAGAIN || errno == EINTR)
        return 0;
    if (errno == EPIPE)
        error_text_set(error, "is read by nobody any more");
    else
        error_text_set(error, "cannot be written to: %s", strerror(errno));
    return -1;
}

static const record_channel_kind *kind_of(const char *name)
{
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (strncmp(name, kinds[i]->prefix, strlen(kinds[i]->prefix)) == 0)
            return kinds[i];
    }
    return NULL;
}

static void change_state(record_sink *sink, record_sink_state state, const char *what)
{
    if (sink->state == state)
        return;
    sink->state = state;
    sink->has_news = true;
    error_text_set(&sink->news, "%.150s %s", sink->kind == &record_channel_stdout ? "standard output" : sink->name,
                   what);
}

static bool is_group_under_way(const record_sink *sink)
{
    return sink->group_sent_bytes < sink->group_bytes;
}

static void abandon_group(record_sink *sink)
{
    if (is_group_under_way(sink))
        sink->counts.records_lost += sink->group_records;
    sink->group_bytes = 0;
    sink->group_sent_bytes = 0;
}

static void lose(record_sink *sink, const error_text *reason)
{
    abandon_group(sink);
    if (sink->channel != NULL)
        sink->channel->methods->close(sink->channel);
    sink->channel = NULL;
    sink->input_bytes = 0;
    sink->line_free_ns = 0;
    if (sink->state == RECORD_SINK_OPEN || sink->state == RECORD_SINK_STALLED)
        sink->counts.failures++;
    sink->retry_ns = camera_clock_ns() + sink->retry_interval_ns;
    sink->retry_interval_ns *= 2;
    if (sink->retry_interval_ns > longest_retry_ns)
        sink->retry_interval_ns = longest_retry_ns;
    change_state(sink, sink->kind->ends ? RECORD_SINK_ENDED : RECORD_SINK_LOST, reason->text);
}

static void open_channel(record_sink *sink)
{
    error_text reason;
    sink->channel = sink->kind->open(sink->target, &reason);
    if (sink->channel == NULL)
        lose(sink, &reason);
}

bool record_sink_check(const char *name, error_text *error)
{
    const record_channel_kind *kind = kind_of(name);
    error_text problem;
    if (kind != NULL && kind->check(name + strlen(kind->prefix), &problem))
        return true;
    error_text_set(error, "%.150s %s", name, kind != NULL ? problem.text
        : "is no output: it takes serial:DEVICE:BAUD, -, file:PATH, pty:PATH or udp:HOST:PORT");
    return false;
}

record_sink *record_sink_open(const char *name, error_text *error)
{
    const record_channel_kind *kind = kind_of(name);
    if (!record_sink_check(name, error))
        return NULL;
    record_sink *sink = calloc(1, sizeof *sink);
    char *own_name = strdup(name);
    if (sink == NULL || own_name == NULL) {
        error_text_set(error, "not enough memory");
        free(own_name);
        free(sink);
        return NULL;
    }
    signal(SIGPIPE, SIG_IGN);
    sink->name = own_name;
    sink->kind = kind;
    sink->target = own_name + strlen(kind->prefix);
    sink->state = RECORD_SINK_OPEN;
    sink->retry_interval_ns = first_retry_ns;
    open_channel(sink);
    return sink;
}

const char *record_sink_name(const record_sink *sink)
{
    return sink->name;
}

record_sink_state record_sink_state_of(const record_sink *sink)
{
    return sink->state;
}

bool record_sink_news(record_sink *sink, error_text *message)
{
    if (!sink->has_news)
        return false;
    *message = sink->news;
    sink->has_news = false;
    return true;
}

static size_t waiting_bytes(const record_sink *sink)
{
    const record_channel *channel = sink->channel;
    return channel != NULL && channel->methods->waiting_bytes != NULL ? channel->methods->waiting_bytes(channel) : 0;
}

static int64_t earlier(int64_t a_ns, int64_t b_ns)
{
    return a_ns < b_ns ? a_ns : b_ns;
}

static int64_t later(int64_t a_ns, int64_t b_ns)
{
    return a_ns > b_ns ? a_ns : b_ns;
}

/* When to look again although nothing that can be polled happened. */
static int64_t wake_ns(const record_sink *sink, int descriptor, int64_t now_ns)
{
    if (sink->state == RECORD_SINK_ENDED)
        return INT64_MAX;
    if (sink->channel == NULL)
        return sink->retry_ns;
    if (sink->state == RECORD_SINK_STALLED)
        return sink->moved_ns + probe_interval_ns;
    int64_t wake = descriptor < 0 ? now_ns + unpolled_interval_ns : INT64_MAX;
    if (is_group_under_way(sink))
        return earlier(wake, later(sink->line_free_ns, sink->moved_ns) + stalled_after_ns);
    if (sink->line_free_ns > now_ns)
        return earlier(wake, sink->line_free_ns);
    size_t waiting = waiting_bytes(sink);
    return waiting > 0 ? now_ns + later(millisecond_ns, (int64_t)waiting * sink->channel->byte_ns) : wake;
}

void record_sink_wants(const record_sink *sink, record_sink_wait *wait)
{
    const record_channel *channel = sink->channel;
    int descriptor = channel != NULL ? channel->methods->descriptor(channel) : -1;
    short events = 0;
    if (channel != NULL && channel->methods->read != NULL && sink->input_bytes < sizeof sink->input)
        events |= POLLIN;
    if (is_group_under_way(sink))
        events |= POLLOUT;
    wait->descriptor = (struct pollfd){descriptor, events, 0};
    wait->wake_ns = wake_ns(sink, descriptor, camera_clock_ns());
}

static void came_through(record_sink *sink)
{
    sink->retry_interval_ns = first_retry_ns;
    change_state(sink, RECORD_SINK_OPEN, "is back");
}

static void go_on_with_group(record_sink *sink)
{
    error_text reason;
    if (!is_group_under_way(sink))
        return;
    ptrdiff_t taken = sink->channel->methods->write(sink->channel, sink->group + sink->group_sent_bytes,
                                                    sink->group_bytes - sink->group_sent_bytes, &reason);
    if (taken < 0) {
        lose(sink, &reason);
        return;
    }
    if (taken == 0)
        return;
    int64_t now_ns = camera_clock_ns();
    sink->line_free_ns = later(now_ns, sink->line_free_ns) + taken * sink->channel->byte_ns;
    sink->group_sent_bytes += (size_t)taken;
    if (!is_group_under_way(sink))
        sink->counts.records_sent += sink->group_records;
    came_through(sink);
}

/* An outdated frame in the port's memory would arrive as if it were a fresh one. */
static void stall(record_sink *sink)
{
    if (!is_group_under_way(sink)) {
        sink->counts.records_sent -= sink->group_records;
        sink->counts.records_lost += sink->group_records;
    }
    abandon_group(sink);
    if (sink->channel->methods->flush != NULL)
        sink->channel->methods->flush(sink->channel);
    sink->counts.failures++;
    sink->line_free_ns = 0;
    sink->probing = false;
    change_state(sink, RECORD_SINK_STALLED, "takes no bytes");
}

static void notice_stall(record_sink *sink, int64_t now_ns)
{
    size_t waiting = waiting_bytes(sink);
    size_t unmoved = waiting + sink->group_bytes - sink->group_sent_bytes;
    int64_t patience_ns = stalled_after_ns + MAY_BE_UNMOVED_BYTES * sink->channel->byte_ns;
    if (unmoved == 0 || unmoved < sink->unmoved_bytes || sink->line_free_ns > now_ns)
        sink->moved_ns = now_ns;
    else if (now_ns - sink->moved_ns > patience_ns)
        stall(sink);
    sink->unmoved_bytes = unmoved;
}

/* Whether a stalled port moves again shows with a byte that says nothing in either encoding. */
static void probe(record_sink *sink, int64_t now_ns)
{
    static const uint8_t delimiter = 0;
    error_text reason;
    if (now_ns - sink->moved_ns < probe_interval_ns)
        return;
    sink->moved_ns = now_ns;
    if (waiting_bytes(sink) > 0)
        return;
    if (sink->probing) {
        came_through(sink);
        return;
    }
    ptrdiff_t taken = sink->channel->methods->write(sink->channel, &delimiter, 1, &reason);
    sink->probing = taken > 0;
    if (taken < 0)
        lose(sink, &reason);
}

static bool is_gone(const record_channel *channel)
{
    struct pollfd look = {channel->methods->descriptor(channel), 0, 0};
    return channel->gone_events != 0 && poll(&look, 1, 0) > 0 && (look.revents & channel->gone_events) != 0;
}

static void take_in(record_sink *sink)
{
    error_text reason;
    size_t room = sizeof sink->input - sink->input_bytes;
    if (sink->channel->methods->read == NULL || room == 0)
        return;
    ptrdiff_t count = sink->channel->methods->read(sink->channel, sink->input + sink->input_bytes, room, &reason);
    if (count < 0)
        lose(sink, &reason);
    else
        sink->input_bytes += (size_t)count;
}

void record_sink_step(record_sink *sink)
{
    int64_t now_ns = camera_clock_ns();
    if (sink->state == RECORD_SINK_ENDED)
        return;
    if (sink->channel == NULL && now_ns >= sink->retry_ns)
        open_channel(sink);
    if (sink->channel != NULL && is_gone(sink->channel))
        lose(sink, &(error_text){"is gone: unplugged, or closed at its other end"});
    if (sink->channel != NULL)
        take_in(sink);
    if (sink->channel != NULL)
        go_on_with_group(sink);
    if (sink->channel != NULL && sink->state == RECORD_SINK_STALLED)
        probe(sink, now_ns);
    else if (sink->channel != NULL)
        notice_stall(sink, now_ns);
}

bool record_sink_ready(const record_sink *sink)
{
    return sink->channel != NULL && sink->state != RECORD_SINK_STALLED && !is_group_under_way(sink) &&
           camera_clock_ns() >= sink->line_free_ns && waiting_bytes(sink) == 0;
}

void record_sink_send(record_sink *sink, const uint8_t *group, size_t size, unsigned record_count)
{
    if (!record_sink_ready(sink) || size > sizeof sink->group) {
        sink->counts.records_lost += record_count;
        return;
    }
    memcpy(sink->group, group, size);
    sink->group_bytes = size;
    sink->group_sent_bytes = 0;
    sink->group_records = record_count;
    sink->moved_ns = camera_clock_ns();
    sink->unmoved_bytes = size;
    go_on_with_group(sink);
}

int64_t record_sink_last_byte_ns(const record_sink *sink)
{
    return is_group_under_way(sink) ? INT64_MAX : sink->line_free_ns;
}

size_t record_sink_read(record_sink *sink, uint8_t *bytes, size_t size)
{
    size_t count = size < sink->input_bytes ? size : sink->input_bytes;
    memcpy(bytes, sink->input, count);
    memmove(sink->input, sink->input + count, sink->input_bytes - count);
    sink->input_bytes -= count;
    return count;
}

record_sink_counts record_sink_counts_of(const record_sink *sink)
{
    return sink->counts;
}

void record_sink_close(record_sink *sink)
{
    if (sink == NULL)
        return;
    if (sink->channel != NULL)
        sink->channel->methods->close(sink->channel);
    free(sink->name);
    free(sink);
}
