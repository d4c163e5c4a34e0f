/* Who can reach the program: its sockets are this machine's alone unless it is told otherwise, and nobody else's
 * datagrams are commands. */
#include "stream_test.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <sys/socket.h>

enum { SOCKETS_MAX = 16 };

typedef struct socket_list {
    unsigned long inodes[SOCKETS_MAX];
    unsigned count;
} socket_list;

static socket_list sockets_of_program(void)
{
    char path[300], target[100];
    socket_list all = {.count = 0};
    snprintf(path, sizeof path, "/proc/%d/fd", (int)host.program);
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        snprintf(path, sizeof path, "/proc/%d/fd/%.20s", (int)host.program, entry->d_name);
        const ssize_t length = readlink(path, target, sizeof target - 1);
        if (length <= 0)
            continue;
        target[length] = '\0';
        assert_true(all.count < SOCKETS_MAX);
        all.count += sscanf(target, "socket:[%lu]", &all.inodes[all.count]) == 1;
    }
    closedir(folder);
    return all;
}

/* Of the program's sockets in one of the kernel's tables, as hexadecimal addresses; how many there are. */
static unsigned local_addresses(const char *table, char addresses[SOCKETS_MAX][40])
{
    const socket_list all = sockets_of_program();
    char line[300], local[40];
    unsigned long inode;
    unsigned count = 0;
    FILE *file = fopen(table, "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        if (sscanf(line, " %*[^:]: %39[^:]:%*x %*s %*s %*s %*s %*s %*s %*s %lu", local, &inode) != 2)
            continue;
        for (unsigned i = 0; i < all.count; i++)
            if (all.inodes[i] == inode && count < SOCKETS_MAX)
                memcpy(addresses[count++], local, sizeof local);
    }
    if (file != NULL)
        fclose(file);
    return count;
}

static void expect_addresses(const char *table, unsigned count, const char *address)
{
    char addresses[SOCKETS_MAX][40];
    assert_int_equal(local_addresses(table, addresses), count);
    for (unsigned i = 0; i < count; i++)
        assert_string_equal(addresses[i], address);
}

/* As the kernel writes it: in this machine's order of bytes. */
static const char *in_hex(const char *address)
{
    static char text[16];
    struct in_addr parsed;
    assert_int_equal(inet_pton(AF_INET, address, &parsed), 1);
    snprintf(text, sizeof text, "%08X", (unsigned)parsed.s_addr);
    return text;
}

static void start_with(const char *option, const char *value)
{
    start(ARGUMENTS("--camera", WALK "@20", "--repeat", "yes", "--serial", "LINE:921600", option, value));
    expect_record(TAPEMARK_RECORD_FRAME);
}

static void without_being_told_it_has_no_sockets(void **state)
{
    (void)state;
    start_with("--markers", "16");
    assert_int_equal(sockets_of_program().count, 0);
}

static void the_preview_is_for_this_machine(void **state)
{
    (void)state;
    static const char *const values[] = {"0", "localhost:0", "127.0.0.1:0"};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        start_with("--preview", values[i]);
        assert_int_equal(sockets_of_program().count, 1);
        expect_addresses("/proc/net/tcp", 1, in_hex("127.0.0.1"));
        assert_true(host_says(&host, "http://127.0.0.1:", SOON_MS));
        close_host(NULL);
        assert_int_equal(open_host(NULL), 0);
    }
}

static void the_preview_is_for_others_when_told(void **state)
{
    (void)state;
    start_with("--preview", "0.0.0.0:0");
    expect_addresses("/proc/net/tcp", 1, in_hex("0.0.0.0"));
}

/* It sends to a place that is named, and is bound to the way there: loopback has no other. */
static void udp_is_bound_to_the_way_to_its_receiver(void **state)
{
    (void)state;
    start(ARGUMENTS("--camera", WALK "@20", "--repeat", "yes", "--output", "udp:127.0.0.1:9"));
    /* It gets its address when it is connected. */
    char addresses[SOCKETS_MAX][40];
    for (int i = 0; i < SOON_MS / 10 && (local_addresses("/proc/net/udp", addresses) == 0 ||
                                         strcmp(addresses[0], in_hex("0.0.0.0")) == 0); i++)
        host_sleep_ms(10);
    expect_addresses("/proc/net/udp", 1, in_hex("127.0.0.1"));
    close_host(NULL);
    assert_int_equal(open_host(NULL), 0);
    start(ARGUMENTS("--camera", WALK "@20", "--output", "udp:9"));
    assert_int_equal(host_wait(&host, SOON_MS), 2);
}

static int open_udp(uint16_t *port)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_addr = {htonl(INADDR_LOOPBACK)}};
    socklen_t size = sizeof address;
    const int end = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    assert_int_equal(bind(end, (const struct sockaddr *)&address, size), 0);
    assert_int_equal(getsockname(end, (struct sockaddr *)&address, &size), 0);
    *port = ntohs(address.sin_port);
    return end;
}

/* Answers that come until there is one with this number. */
static unsigned count_answers(int end, uint16_t last_number)
{
    static tapemark_receiver receiver;
    const int64_t deadline_ns = host_clock_ns() + INT64_C(1000000) * SOON_MS;
    uint8_t bytes[2048];
    unsigned answers = 0;
    bool last = false;
    while (!last && host_clock_ns() < deadline_ns) {
        const ssize_t count = recv(end, bytes, sizeof bytes, MSG_DONTWAIT);
        for (ssize_t i = 0; i < count; i++) {
            const bool answer = tapemark_receiver_push(&receiver, bytes[i]) == TAPEMARK_RECORD_ANSWER;
            answers += answer;
            last = last || (answer && receiver.record.as.answer.number == last_number);
        }
        if (count <= 0)
            host_sleep_ms(2);
    }
    return answers;
}

/* Commands are taken from where the records go, and from nowhere else. */
static void strangers_give_no_commands(void **state)
{
    (void)state;
    uint16_t port, other_port;
    char output[40], sentence[TAPEMARK_SENTENCE_MAX_BYTES], first[2048];
    struct sockaddr_in program;
    socklen_t size = sizeof program;
    const int end = open_udp(&port), stranger = open_udp(&other_port);
    snprintf(output, sizeof output, "udp:127.0.0.1:%u", port);
    start(ARGUMENTS("--camera", WALK "@20", "--repeat", "yes", "--output", output));
    assert_true(recvfrom(end, first, sizeof first, 0, (struct sockaddr *)&program, &size) > 0);
    size_t length = tapemark_command_write(sentence, sizeof sentence, 5, "PING", NULL, "there");
    for (int i = 0; i < 20; i++)
        assert_int_equal(sendto(stranger, sentence, length, 0, (const struct sockaddr *)&program, size), length);
    /* What was sent before it, was seen or refused before it. */
    for (uint16_t number = 6; number < 8; number++) {
        length = tapemark_command_write(sentence, sizeof sentence, number, "PING", NULL, "there");
        assert_int_equal(sendto(end, sentence, length, 0, (const struct sockaddr *)&program, size), length);
        assert_int_equal(count_answers(end, number), 1);
    }
    close(end);
    close(stranger);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(without_being_told_it_has_no_sockets, open_host, close_host),
        cmocka_unit_test_setup_teardown(the_preview_is_for_this_machine, open_host, close_host),
        cmocka_unit_test_setup_teardown(the_preview_is_for_others_when_told, open_host, close_host),
        cmocka_unit_test_setup_teardown(udp_is_bound_to_the_way_to_its_receiver, open_host, close_host),
        cmocka_unit_test_setup_teardown(strangers_give_no_commands, open_host, close_host),
    };
    return cmocka_run_group_tests(tests, read_truth, NULL);
}
