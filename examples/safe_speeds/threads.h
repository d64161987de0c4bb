#ifndef SAFE_SPEEDS_THREADS_H
#define SAFE_SPEEDS_THREADS_H

enum { THREADS = 64 };

/* Does jobs 0 .. count - 1, `threads` at a time, 1 .. THREADS. */
void share_out(void (*job)(void *context, int number), void *context, int count, int threads);

#endif
