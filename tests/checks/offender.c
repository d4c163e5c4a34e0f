/* Breaks every promise that the checks of this folder are about, so that they can be seen to notice. */
#include <stdlib.h>
#include <string.h>

enum { LARGE_BYTES = 3000 };

int offend_by_data = 1;
int offend_by_bss[16];

void *offend_by_malloc(size_t size);
int offend_by_recursion(const char *text);
int offend_by_indirect_call(int (*callback)(void));
int offend_by_dynamic_frame(size_t size, int (*fill)(char *));
int offend_by_large_frame(int (*fill)(char *));
int offend_by_depth(int (*fill)(char *));

void *offend_by_malloc(size_t size)
{
    return malloc(size);
}

static int balance(const char *text, int open);

static int balance_inner(const char *text, int open)
{
    return open * balance(text + 1, open - 1) + balance(text + 2, open);
}

static int balance(const char *text, int open)
{
    if (*text == '\0')
        return open;
    return balance_inner(text, open + 1) - balance_inner(text + 1, open);
}

int offend_by_recursion(const char *text)
{
    return balance(text, 0);
}

int offend_by_indirect_call(int (*callback)(void))
{
    return callback() + 1;
}

int offend_by_dynamic_frame(size_t size, int (*fill)(char *))
{
    char buffer[size];
    return fill(buffer);
}

__attribute__((noinline)) int offend_by_large_frame(int (*fill)(char *))
{
    char buffer[LARGE_BYTES];
    return fill(buffer) + offend_by_data + offend_by_bss[0];
}

__attribute__((noinline)) static int deeper(int (*fill)(char *))
{
    char buffer[LARGE_BYTES];
    return fill(buffer) + offend_by_large_frame(fill);
}

int offend_by_depth(int (*fill)(char *))
{
    char buffer[LARGE_BYTES];
    return fill(buffer) + deeper(fill);
}
