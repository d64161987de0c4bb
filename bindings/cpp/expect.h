// EXPECT of the C++ tests: a condition that is not so is told with its line, and counted.
#ifndef DRILLMBD_TESTS_EXPECT_H
#define DRILLMBD_TESTS_EXPECT_H

#include <iostream>

namespace {

int failures = 0;

} // namespace

#define EXPECT(condition)                                                                                              \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            std::cerr << "line " << __LINE__ << ": not so: " << #condition << '\n';                                    \
            ++failures;                                                                                                \
        }                                                                                                              \
    } while (0)

#endif
