/* Files that come into being only when they are whole. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <dirent.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "output_file.h"

static char folder[] = "/tmp/tapemark-output-XXXXXX";
static error_text error;

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder + strlen(folder) - 6, "XXXXXX");
    return mkdtemp(folder) != NULL && chdir(folder) == 0 ? 0 : -1;
}

static size_t files_in_folder(void)
{
    size_t count = 0;
    DIR *here = opendir(folder);
    assert_non_null(here);
    for (struct dirent *entry; (entry = readdir(here)) != NULL;)
        count += entry->d_name[0] != '.';
    closedir(here);
    return count;
}

static int remove_folder(void **state)
{
    (void)state;
    DIR *here = opendir(folder);
    assert_non_null(here);
    for (struct dirent *entry; (entry = readdir(here)) != NULL;)
        unlink(entry->d_name);
    closedir(here);
    return rmdir(folder);
}

static void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void assert_content(const char *path, const char *text)
{
    char content[64] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    content[fread(content, 1, sizeof content - 1, file)] = '\0';
    fclose(file);
    assert_string_equal(content, text);
}

static output_file *begin(const char *path, const char *text)
{
    output_file *file = output_file_open(path, &error);
    assert_non_null(file);
    fputs(text, output_file_stream(file));
    return file;
}

static void a_file_stays_as_it_was_until_the_new_one_is_whole(void **state)
{
    (void)state;
    put("map", "old");
    output_file *file = begin("map", "new");
    assert_true(output_file_complete(file, &error));
    assert_content("map", "old");
    assert_true(output_file_publish(file, &error));
    assert_content("map", "new");
    assert_int_equal(files_in_folder(), 1);
}

static void discarded_files_leave_nothing(void **state)
{
    (void)state;
    output_file *first = begin("a", "a"), *second = begin("b", "b"), *third = begin("c", "c");
    assert_int_equal(files_in_folder(), 3);
    output_file_discard(second);
    output_file_discard(first);
    assert_true(output_file_publish(third, &error));
    assert_int_equal(files_in_folder(), 1);
    assert_content("c", "c");
    output_file_discard(NULL);
}

static void new_files_have_the_usual_permissions(void **state)
{
    (void)state;
    struct stat status;
    mode_t before = umask(027);
    assert_true(output_file_publish(begin("a", "a"), &error));
    umask(before);
    assert_int_equal(stat("a", &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
}

static void links_stay_links(void **state)
{
    (void)state;
    struct stat status;
    put("target", "old");
    assert_int_equal(symlink("target", "link"), 0);
    assert_true(output_file_publish(begin("link", "new"), &error));
    assert_int_equal(lstat("link", &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_content("target", "new");
}

static void pipes_are_written_at_once(void **state)
{
    (void)state;
    char got[4] = "";
    int ends[2];
    char path[64];
    assert_int_equal(pipe(ends), 0);
    snprintf(path, sizeof path, "/dev/fd/%d", ends[1]);
    output_file *file = begin(path, "now");
    assert_true(output_file_complete(file, &error));
    assert_int_equal(read(ends[0], got, 3), 3);
    assert_string_equal(got, "now");
    assert_true(output_file_publish(file, &error));
    close(ends[0]);
    close(ends[1]);
}

static void a_full_disk_is_noticed(void **state)
{
    (void)state;
    output_file *file = begin("/dev/full", "x");
    assert_false(output_file_publish(file, &error));
    assert_non_null(strstr(error.text, "No space left"));
    file = output_file_open("/dev/full", &error);
    assert_non_null(file);
    for (int i = 0; i < 100000; i++)
        fputs("much more than a buffer", output_file_stream(file));
    assert_false(output_file_complete(file, &error));
    assert_non_null(strstr(error.text, "cannot be written"));
    assert_false(output_file_publish(file, &error));
}

static void what_cannot_be_written_is_told(void **state)
{
    (void)state;
    assert_null(output_file_open("nowhere/a", &error));
    assert_non_null(strstr(error.text, "No such file"));
    assert_null(output_file_open(".", &error));
    assert_non_null(strstr(error.text, "is a directory"));
    assert_null(output_file_open("", &error));
    assert_non_null(strstr(error.text, "empty name"));
    assert_int_equal(files_in_folder(), 0);
}

static void signals_remove_what_is_unfinished(void **state)
{
    (void)state;
    put("a", "old");
    pid_t child = fork();
    if (child == 0) {
        begin("a", "new");
        begin("b", "new");
        raise(SIGTERM);
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
    assert_int_equal(WTERMSIG(status), SIGTERM);
    assert_content("a", "old");
    assert_int_equal(files_in_folder(), 1);
}

#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, make_folder, remove_folder)

int main(void)
{
    static const struct CMUnitTest tests[] = {
        IN_FOLDER(a_file_stays_as_it_was_until_the_new_one_is_whole),
        IN_FOLDER(discarded_files_leave_nothing),
        IN_FOLDER(new_files_have_the_usual_permissions),
        IN_FOLDER(links_stay_links),
        IN_FOLDER(pipes_are_written_at_once),
        IN_FOLDER(a_full_disk_is_noticed),
        IN_FOLDER(what_cannot_be_written_is_told),
        IN_FOLDER(signals_remove_what_is_unfinished),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
