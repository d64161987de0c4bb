/* Random numbers of a sample: a stream by the study's seed and the sample's number. */
#ifndef FAILURE_PROBABILITY_STREAM_H
#define FAILURE_PROBABILITY_STREAM_H

#include <stdint.h>

typedef struct stream {
    uint64_t key[2], counter, buffer[4];
    int used;
} stream;

stream stream_of(uint64_t seed, uint64_t number);
double stream_uniform(stream *s); /* 0 <= u < 1 */
double stream_normal(stream *s);

#endif
