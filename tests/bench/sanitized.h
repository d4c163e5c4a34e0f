/* BENCH_SANITIZED: a sanitizer has put its own allocator in, and times say nothing. */
#ifndef BENCH_SANITIZED_H
#define BENCH_SANITIZED_H

#if defined(__SANITIZE_ADDRESS__)
#define BENCH_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define BENCH_SANITIZED 1
#endif
#endif

#ifndef BENCH_SANITIZED
#define BENCH_SANITIZED 0
#endif

#endif
