/* Sets of files that appear all at once or not at all. */
#include "make_test.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "output_directory.h"
#include "own_folder.h"

static void write_text(const char *folder, const char *name, const char *text)
{
    char path[400];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static void expect_text(const char *path, const char *expected)
{
    char text[100] = "";
    FILE *file = fopen(path, "r");
    if (file == NULL)
        fail_msg("there is no %s", path);
    size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[length] = '\0';
    assert_string_equal(text, expected);
}

static int count_entries(const char *folder)
{
    struct dirent **entries;
    int count = scandir(folder, &entries, NULL, NULL);
    assert_true(count >= 2);
    for (int i = 0; i < count; i++)
        free(entries[i]);
    free(entries);
    return count - 2;
}

static output_directory *open_output(const char *path)
{
    error_text error = {""};
    output_directory *directory = output_directory_open(path, &error);
    if (directory == NULL)
        fail_msg("%s: %s", path, error.text);
    return directory;
}

static void expect_refusal(const char *path, const char *reason)
{
    error_text error;
    assert_null(output_directory_open(path, &error));
    assert_string_equal(error.text, reason);
}

static void a_new_directory_appears_whole(void **state)
{
    error_text error;
    struct stat status;
    (void)state;
    umask(027);
    output_directory *directory = open_output("new//");
    write_text(output_directory_path(directory), "a", "1");
    write_text(output_directory_path(directory), "b", "2");
    assert_int_not_equal(access("new", F_OK), 0);
    assert_true(output_directory_publish(directory, &error));
    expect_text("new/a", "1");
    expect_text("new/b", "2");
    assert_int_equal(count_entries("new"), 2);
    assert_int_equal(stat("new", &status), 0);
    assert_int_equal(status.st_mode & 0777, 0750);
    assert_int_equal(count_entries("."), 1);
}

static void files_of_the_same_name_are_replaced_and_others_stay(void **state)
{
    error_text error;
    (void)state;
    mkdir("old", 0755);
    write_text("old", "a", "before");
    write_text("old", "other", "stays");
    output_directory *directory = open_output("old");
    write_text(output_directory_path(directory), "a", "after");
    write_text(output_directory_path(directory), "b", "new");
    expect_text("old/a", "before");
    assert_true(output_directory_publish(directory, &error));
    expect_text("old/a", "after");
    expect_text("old/b", "new");
    expect_text("old/other", "stays");
    assert_int_equal(count_entries("old"), 3);
}

static void what_is_discarded_leaves_no_trace(void **state)
{
    (void)state;
    mkdir("old", 0755);
    write_text("old", "a", "before");
    const char *const paths[] = {"old", "new", "."};
    for (size_t i = 0; i < COUNT_OF(paths); i++) {
        output_directory *directory = open_output(paths[i]);
        write_text(output_directory_path(directory), "a", "after");
        output_directory_discard(directory);
        expect_text("old/a", "before");
        assert_int_equal(count_entries("old"), 1);
        assert_int_equal(count_entries("."), 1);
    }
}

static void a_file_that_cannot_be_moved_brings_all_back(void **state)
{
    error_text error;
    (void)state;
    mkdir("old", 0755);
    mkdir("old/c", 0755);
    write_text("old/c", "inside", "stays");
    write_text("old", "a", "before");
    output_directory *directory = open_output("old");
    write_text(output_directory_path(directory), "a", "after");
    write_text(output_directory_path(directory), "b", "new");
    write_text(output_directory_path(directory), "c", "no directory");
    assert_false(output_directory_publish(directory, &error));
    assert_string_equal(error.text, "c is a directory, and not to be replaced by a file");
    expect_text("old/a", "before");
    expect_text("old/c/inside", "stays");
    assert_int_equal(count_entries("old"), 2);
}

static void a_place_that_was_taken_meanwhile_stays(void **state)
{
    error_text error;
    (void)state;
    output_directory *directory = open_output("new");
    write_text(output_directory_path(directory), "a", "after");
    mkdir("new", 0755);
    write_text("new", "b", "of someone else");
    assert_false(output_directory_publish(directory, &error));
    assert_non_null(strstr(error.text, "cannot be made: "));
    expect_text("new/b", "of someone else");
    assert_int_equal(count_entries("new"), 1);
    assert_int_equal(count_entries("."), 1);
}

static void places_that_cannot_be(void **state)
{
    (void)state;
    write_text(".", "file", "");
    expect_refusal("", "has no name");
    expect_refusal("file", "is not a directory");
    expect_refusal("nowhere/new", "cannot be made: No such file or directory");
    expect_refusal("file/new", "cannot be made: Not a directory");
    assert_int_equal(symlink("nowhere", "link"), 0);
    expect_refusal("link", "is a link to nothing");
    expect_refusal("link/", "is a link to nothing");
    assert_int_equal(count_entries("."), 2);
}

static void messages_name_the_final_place(void **state)
{
    error_text error;
    (void)state;
    output_directory *directory = open_output("new");
    error_text_set(&error, "%s/tape.pdf: cannot be written", output_directory_path(directory));
    output_directory_rename_in_error(directory, &error);
    assert_string_equal(error.text, "new/tape.pdf: cannot be written");
    error_text_set(&error, "not enough memory");
    output_directory_rename_in_error(directory, &error);
    assert_string_equal(error.text, "not enough memory");
    output_directory_discard(directory);
}

static void *write_for_ever(void *directory)
{
    for (unsigned i = 0; i < UINT_MAX; i++) {
        char path[400];
        snprintf(path, sizeof path, "%s/%u", output_directory_path(directory), i % 50);
        FILE *file = fopen(path, "w");
        if (file != NULL)
            fclose(file);
    }
    return NULL;
}

/* A process that writes files until it is told to stop, in more threads than the one that then removes them. */
static void write_in_threads(int ready)
{
    output_directory *directory = open_output("old");
    pthread_t others[3];
    for (size_t i = 0; i < COUNT_OF(others); i++)
        if (pthread_create(&others[i], NULL, write_for_ever, directory) != 0)
            _exit(1);
    if (write(ready, "", 1) != 1)
        _exit(1);
    write_for_ever(directory);
}

static void a_signal_removes_what_is_unfinished(void **state)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    (void)state;
    mkdir("old", 0755);
    write_text("old", "a", "before");
    for (size_t i = 0; i < 10 * COUNT_OF(signals); i++) {
        int ends[2], status;
        char byte;
        assert_int_equal(pipe(ends), 0);
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            write_in_threads(ends[1]);
        assert_int_equal(read(ends[0], &byte, 1), 1);
        assert_int_equal(kill(child, signals[i % COUNT_OF(signals)]), 0);
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFSIGNALED(status));
        assert_int_equal(WTERMSIG(status), signals[i % COUNT_OF(signals)]);
        assert_int_equal(count_entries("old"), 1);
        expect_text("old/a", "before");
        close(ends[0]);
        close(ends[1]);
    }
}

static void signals_work_as_before_afterwards(void **state)
{
    error_text error;
    sigset_t mask;
    (void)state;
    output_directory *directory = open_output("new");
    assert_true(output_directory_publish(directory, &error));
    assert_int_equal(sigprocmask(SIG_BLOCK, NULL, &mask), 0);
    assert_false(sigismember(&mask, SIGINT));
    assert_false(sigismember(&mask, SIGTERM));
}

#define IN_WORK(test) cmocka_unit_test_setup_teardown(test, enter_own_folder, leave_own_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        IN_WORK(a_new_directory_appears_whole),
        IN_WORK(files_of_the_same_name_are_replaced_and_others_stay),
        IN_WORK(what_is_discarded_leaves_no_trace),
        IN_WORK(a_file_that_cannot_be_moved_brings_all_back),
        IN_WORK(a_place_that_was_taken_meanwhile_stays),
        IN_WORK(places_that_cannot_be),
        IN_WORK(messages_name_the_final_place),
        IN_WORK(a_signal_removes_what_is_unfinished),
        IN_WORK(signals_work_as_before_afterwards),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
