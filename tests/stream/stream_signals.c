/*
 * Usage: stream_signals PROGRAM WALK.y4m WALK.jsonl [TIMES [SEED]]
 * Runs tapemark-stream so many times (200 unless told) and sends it signals at random moments, from its first
 * instruction on: SIGHUP and SIGPIPE in passing, SIGTERM or SIGKILL as the last. It has to end, as told and in time;
 * what came over the line has to be right; what it recorded has to be played up to the last whole frame, each frame
 * as it was.
 */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "recorded_walk.h"
#include "stream_host.h"
#include "walk_check.h"

enum { SOON_MS = 15000, TIMES = 200, PASSING_MAX = 3, PAUSE_MAX_MS = 60, PATH_BYTES = 200 };

typedef struct tally {
    unsigned runs, terms, kills, hangups, pipes;
    unsigned unborn;          /* ended before they said anything */
    uint64_t frames, recorded;
    unsigned recordings, cut; /* cut: that held a piece of a frame */
} tally;

typedef struct run {
    stream_host host;
    walk_check check;
    const char *program, *walk_path;
    recorded_walk reference;
    char folder[PATH_BYTES], config[PATH_BYTES], recording[PATH_BYTES];
    uint32_t dice;
    tally all;
} run;

static uint32_t roll(run *self, uint32_t below)
{
    self->dice = self->dice * 1664525 + 1013904223;
    return (self->dice >> 12) % below;
}

static bool complain(const run *self, const char *what)
{
    printf("run %u: %s; the program said: %s\n", self->all.runs, what, self->host.said);
    return false;
}

/* ---- The program --------------------------------------------------------------------------------------------- */

static bool begin(run *self)
{
    char camera_name[PATH_BYTES + 20];
    const bool sentences = roll(self, 2) > 0, raw = roll(self, 2) > 0;
    FILE *config = fopen(self->config, "w");
    if (config == NULL || fprintf(config, "repeat = yes\n") < 0 || fclose(config) != 0 || !host_open(&self->host))
        return false;
    snprintf(self->recording, sizeof self->recording, "%.150s/seen.%s", self->folder, raw ? "raw" : "y4m");
    snprintf(camera_name, sizeof camera_name, "file:%s@200", self->walk_path);
    self->check = (walk_check){.walk = self->check.walk};
    const char *const words[] = {"--config", self->config, "--camera", camera_name, "--serial", "LINE:921600",
                                 "--encoding", sentences ? "nmea" : "cobs", "--record", self->recording, NULL};
    return host_start(&self->host, self->program, words);
}

/* What comes within this time. */
static void take_records(run *self, int time_ms)
{
    const int64_t end_ns = host_clock_ns() + INT64_C(1000000) * time_ms;
    tapemark_record record;
    for (int64_t now_ns = host_clock_ns(); now_ns < end_ns; now_ns = host_clock_ns())
        if (host_record(&self->host, (int)((end_ns - now_ns) / 1000000) + 1, &record))
            walk_check_record(&self->check, &record);
}

static bool has_begun(run *self)
{
    tapemark_record record;
    if (!host_record(&self->host, SOON_MS, &record))
        return false;
    walk_check_record(&self->check, &record);
    return true;
}

static void send_in_passing(run *self)
{
    const bool hangup = roll(self, 2) > 0;
    kill(self->host.program, hangup ? SIGHUP : SIGPIPE);
    self->all.hangups += hangup;
    self->all.pipes += !hangup;
}

static bool is_passing(int number)
{
    return number == SIGHUP || number == SIGPIPE;
}

/* Ends with status 0, or by the signal where it had not begun to listen. */
static bool ends(run *self, int last_signal)
{
    const int64_t deadline_ns = host_clock_ns() + INT64_C(1000000) * SOON_MS;
    int status = 0;
    pid_t ended = 0;
    while (ended == 0 && host_clock_ns() < deadline_ns) {
        take_records(self, 5);
        ended = waitpid(self->host.program, &status, WNOHANG);
    }
    if (ended == 0)
        return complain(self, "it does not end");
    self->host.program = 0;
    take_records(self, 20);
    const bool unborn = self->check.frames + self->check.lost == 0;
    const int by_signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    self->all.unborn += unborn;
    if (last_signal == SIGKILL ? by_signal == SIGKILL : WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    if (unborn && (by_signal == last_signal || is_passing(by_signal)))
        return true;
    return complain(self, WIFEXITED(status) ? "wrong exit status" : "ended by another signal");
}

/* ---- What it leaves ------------------------------------------------------------------------------------------ */

/* Frames that the program sent, and those that it told of as dropped, up to its last word. */
static uint64_t count_played(FILE *output)
{
    tapemark_receiver receiver = {0};
    uint64_t sent = 0, dropped = 0;
    rewind(output);
    for (int byte = getc(output); byte != EOF; byte = getc(output)) {
        const tapemark_record_type type = tapemark_receiver_push(&receiver, (uint8_t)byte);
        sent += type == TAPEMARK_RECORD_FRAME;
        if (type == TAPEMARK_RECORD_STATUS)
            dropped = receiver.record.as.status.frames_dropped;
    }
    return sent + dropped;
}

/* By the program itself, as far as the recording goes. */
static bool is_played(run *self, uint64_t span)
{
    char camera_name[PATH_BYTES + 20], path[PATH_BYTES];
    stream_host player;
    snprintf(camera_name, sizeof camera_name, "file:%s@max", self->recording);
    snprintf(path, sizeof path, "%.150s/played", self->folder);
    FILE *output = fopen(path, "w+");
    if (output == NULL || !host_open(&player))
        return false;
    player.output = fileno(output);
    const char *const words[] = {"--camera", camera_name, NULL};
    const bool good = host_start(&player, self->program, words) && host_wait(&player, SOON_MS) == 0;
    const uint64_t played = count_played(output);
    fclose(output);
    host_close(&player);
    if (good && player.said_size == 0 && played == span)
        return true;
    printf("played %llu frames of %llu; the player said: %s\n", (unsigned long long)played, (unsigned long long)span,
           player.said);
    return complain(self, "the recording is not played as it is");
}

static bool recording_is_right(run *self)
{
    recorded_walk_state state;
    if (!recorded_walk_look(&self->reference, self->recording, &state))
        return complain(self, "the recording holds what was not in the walk");
    self->all.recordings += state.frames > 0;
    self->all.recorded += state.frames;
    self->all.cut += state.cut;
    return state.frames == 0 || is_played(self, state.span);
}

static void remove_recording(const run *self)
{
    char times[PATH_BYTES + 10];
    snprintf(times, sizeof times, "%s.times", self->recording);
    unlink(self->recording);
    unlink(times);
}

static bool run_once(run *self)
{
    const int last_signal = roll(self, 2) > 0 ? SIGTERM : SIGKILL;
    const unsigned passing = roll(self, PASSING_MAX + 1);
    self->all.runs++;
    if (!begin(self))
        return complain(self, "cannot begin");
    /* Mostly when it is at work; else at any time from its loading on. */
    if (roll(self, 5) > 0 && !has_begun(self))
        return complain(self, "it says nothing");
    for (unsigned i = 0; i < passing; i++) {
        take_records(self, (int)roll(self, PAUSE_MAX_MS));
        send_in_passing(self);
    }
    take_records(self, (int)roll(self, roll(self, 3) > 0 ? 5 * PAUSE_MAX_MS : 5));
    kill(self->host.program, last_signal);
    *(last_signal == SIGTERM ? &self->all.terms : &self->all.kills) += 1;
    bool good = ends(self, last_signal);
    if (self->check.wrong + self->check.misplaced + self->check.unexplained > 0)
        good = complain(self, self->check.wrong > 0 ? self->check.complaint : "records are missing or misplaced");
    good = recording_is_right(self) && good;
    self->all.frames += self->check.frames;
    host_close(&self->host);
    remove_recording(self);
    return good;
}

static void tell(const tally *all)
{
    printf("%u runs: %u times SIGTERM, %u SIGKILL, %u SIGHUP, %u SIGPIPE; %u ended before they said anything; "
           "%llu frames, none wrong; %u recordings of %llu frames, %u of them with a piece of one more, all played\n",
           all->runs, all->terms, all->kills, all->hangups, all->pipes, all->unborn, (unsigned long long)all->frames,
           all->recordings, (unsigned long long)all->recorded, all->cut);
}

int main(int argc, char **argv)
{
    static run self;
    truth walk;
    bool good = true;
    if (argc < 4) {
        fprintf(stderr, "stream_signals: expected PROGRAM WALK.y4m WALK.jsonl [TIMES [SEED]]\n");
        return 2;
    }
    const unsigned times = argc > 4 ? (unsigned)strtoul(argv[4], NULL, 10) : TIMES;
    self.program = argv[1];
    self.walk_path = argv[2];
    self.dice = argc > 5 ? (uint32_t)strtoul(argv[5], NULL, 10) : 1;
    snprintf(self.folder, sizeof self.folder, "/tmp/tapemark-signals-XXXXXX");
    if (!truth_read(argv[3], &walk) || !recorded_walk_read(&self.reference, argv[2]) ||
        mkdtemp(self.folder) == NULL) {
        fprintf(stderr, "stream_signals: cannot begin\n");
        return 1;
    }
    snprintf(self.config, sizeof self.config, "%.150s/stream.conf", self.folder);
    self.check.walk = &walk;
    while (self.all.runs < times)
        good = run_once(&self) && good;
    tell(&self.all);
    char played[PATH_BYTES];
    snprintf(played, sizeof played, "%.150s/played", self.folder);
    unlink(played);
    unlink(self.config);
    rmdir(self.folder);
    recorded_walk_release(&self.reference);
    truth_release(&walk);
    return good && self.all.frames > 0 && self.all.recordings > 0 ? 0 : 1;
}
