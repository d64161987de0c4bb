/* libdrillmbd - status codes, versions, memory, log and names of parts. Everything in this library is in SI units; angles are in
 * radians. A 6-vector is (translation; rotation). */
#ifndef DRILLMBD_BASE_H
#define DRILLMBD_BASE_H
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define DMB_C_BEGIN extern "C" {
#define DMB_C_END }
#else
#define DMB_C_BEGIN
#define DMB_C_END
#endif
DMB_C_BEGIN

#if defined(_WIN32) && defined(DMB_BUILDING)
#define DMB_API __declspec(dllexport)
#elif defined(__GNUC__) && !defined(_WIN32) && !defined(DMB_STATIC)
#define DMB_API __attribute__((visibility("default")))
#else
#define DMB_API
#endif
/* The one place where the version is written; the build reads it from here. */
#define DMB_VERSION_MAJOR 0
#define DMB_VERSION_MINOR 1
#define DMB_VERSION_PATCH 0
/* Version of the linked library, 10000 major + 100 minor + patch. Cannot fail. */
DMB_API uint32_t dmb_version(void);
/* The abilities of this build. LAPACK: without it the library solves dense eigenproblems, slower, equal to rounding. FILES:
 * recorders and VTK write files. HEAP: malloc and free are the default allocator; else each model needs its own. */
enum { DMB_HAS_LAPACK = 0, DMB_HAS_FILES = 1, DMB_HAS_HEAP = 2 };
/* 1: yes, 0: no; a library that is loaded when needed is loaded by this call. DMB_ERR_VALUE: none of the above. Thread-safe. */
DMB_API int32_t dmb_has(int32_t what);
/* One line: version, and where eigenproblems, files and memory come from. Never NULL. */
DMB_API const char *dmb_build_info(void);

/* ---- Status ------------------------------------------------------------------------------------------------------
 * Every function that can fail returns an int32_t: 0 done, > 0 done with a note, < 0 refused or failed with nothing changed.
 * dmb_last_error states the part, the field, the value and the bound. */
/* clang-format off */
#define DMB_STATUS_LIST(X)                                                                                            \
    X(DMB_OK, 0, "done")                                                                                              \
    X(DMB_NOTE_STEP_CUT, 1, "done; the step was divided to converge")                                                 \
    X(DMB_NOTE_WORK_LIMITED, 2, "done; the bounded number of iterations was used up above the tolerance")             \
    X(DMB_NOTE_PROJECTED, 3, "done; poses or velocities were projected onto the allowed motion")                       \
    X(DMB_NOTE_STOPPED, 4, "done; stopped early: bound on steps, or function of accepted steps")                     \
    X(DMB_NOTE_FULL, 5, "done; the caller's memory is full, nothing more is recorded")                                \
    X(DMB_NOTE_TOLERANCE, 6, "done; the smallest step allowed was too long for the error tolerance")                  \
    X(DMB_NOTE_UNSTABLE, 7, "done; the equilibrium that was found is not stable")                                     \
    X(DMB_NOTE_NOT_STEADY, 8, "done; drives move but no steady state was found: only their components have a speed")     \
    X(DMB_NOTE_EXTRAPOLATED, 9, "done; some of the results are extrapolations that were not confirmed")               \
    X(DMB_NOTE_CANCELLED, 10, "done up to where the caller's progress function ended it")                             \
    X(DMB_NOTE_INCOMPLETE, 11, "done; the scene or the range leaves something out: see the message")                     \
    X(DMB_NOTE_FLUTTER, 12, "done; a mode grows before the stiffness is singular, the message states from where on")     \
    X(DMB_NOTE_CLAMPED, 13, "done; a value beyond its bounds was taken for the bound")                                \
    X(DMB_NOTE_NOT_SMOOTH, 14, "done; a derivative is the mean of both sides of a breakpoint")                              \
    X(DMB_NOTE_EVENT, 15, "done up to an event, the message names it")                                                  \
    X(DMB_ERR_NULL, -1, "a required pointer is NULL")                                                                 \
    X(DMB_ERR_HANDLE, -2, "not a live object of this kind")                                                           \
    X(DMB_ERR_STRUCT_SIZE, -3, "struct_size is not a size of this library; fill structs by their _default first")     \
    X(DMB_ERR_ID, -4, "the id does not name a part of this model")                                                    \
    X(DMB_ERR_VALUE, -5, "a value lies outside its bounds")                                                           \
    X(DMB_ERR_NOT_FINITE, -6, "a value is NaN or infinite")                                                           \
    X(DMB_ERR_ORDER, -7, "the call does not fit the state of the object")                                             \
    X(DMB_ERR_NO_MEMORY, -8, "memory could not be allocated")                                                         \
    X(DMB_ERR_TOO_LARGE, -9, "a size overflows or exceeds its limit")                                                 \
    X(DMB_ERR_SINGULAR, -10, "a stiffness or iteration matrix is singular")                                           \
    X(DMB_ERR_NO_CONVERGENCE, -11, "the iteration did not converge")                                                  \
    X(DMB_ERR_CALLBACK, -12, "a callback failed or returned a value beyond +-1e30")                              \
    X(DMB_ERR_IO, -13, "a file could not be written")                                                                 \
    X(DMB_ERR_ROTATION, -14, "relative rotation in one element exceeds 2.5 rad")                                      \
    X(DMB_ERR_GEOMETRY, -15, "parts do not fit together")                                                             \
    X(DMB_ERR_UNSUPPORTED, -16, "a combination that this version does not offer")                                     \
    X(DMB_ERR_CANCELLED, -17, "the caller's progress function ended the call")
/* clang-format on */
#define DMB_STATUS_ENUM_ENTRY(name, value, text) name = (value),
enum { DMB_STATUS_LIST(DMB_STATUS_ENUM_ENTRY) DMB_STATUS_END_ = -1000 };
#undef DMB_STATUS_ENUM_ENTRY
/* Name ("DMB_ERR_VALUE") and text of a status, of an unknown one "DMB_UNKNOWN". Never NULL. Thread-safe. */
DMB_API const char *dmb_status_name(int32_t status);
DMB_API const char *dmb_status_text(int32_t status);

/* ---- Values that mean "not given" ---------------------------------------------------------------------------------
 *   DMB_NONE       no number of a part, pipe, section or component (uint32_t)
 *   DMB_COMBINED   all excitations together (dmb_response_transfer)
 *   {0, 0}         of an id no part: the first string, the ground or none, as the field says
 *   DMB_FREE_NONE  the empty set of components; 0 is refused
 *   NULL           default options, no callback, no table, no report
 *   DMB_NOT_GIVEN  of numbers >= 0: as described elsewhere (the wall, the fluid outside, the pipes), as the field says
 *   DMB_UNLIMITED  no limit, stop or end; -DMB_UNLIMITED at the low side
 *   0              of numbers > 0: off, or computed from others, as the field says
 *   NaN            of an input or a drive its time function; of a result: it is not there
 *   infinity       of a result: nothing limits it */
#define DMB_NONE UINT32_MAX
#define DMB_NOT_GIVEN (-1)
#define DMB_UNLIMITED 1e30

/* ---- Names of parts and places -----------------------------------------------------------------------------------
 * Structs without a struct_size are frozen: their size and members stay as they are in all of a series of versions. */
/* Frozen. Given out by the dmb_model_add_ functions and checked at every use: kind, index and model. {0, 0} names nothing. */
typedef struct dmb_id {
    uint32_t index; /* [-] kind in the upper 8 bits, number of the part within its kind in the lower 24 */
    uint32_t generation; /* [-] stamp of the model that gave it out; 0 only in the id that names nothing */
} dmb_id;
/* 1 if both name the same part of the same model, or nothing. */
static inline int dmb_id_equal(dmb_id a, dmb_id b)
{
    return a.index == b.index && a.generation == b.generation;
}
/* Frozen. A place on a part: a station of a string, or the reference point of a body. Made by dmb_station. */
typedef struct dmb_place {
    dmb_id part; /* a string, a body or a bit */
    uint32_t pipe; /* [-] pipe of the string, 0 at the rig end; 0 for a body */
    uint32_t reserved; /* [-] 0 */
    double fraction; /* [-] 0 at the rig end of the pipe .. 1 at its far end; 0 for a body */
} dmb_place;
/* The place at `fraction` of a pipe of a string; of a body: pipe 0, fraction 0. Nothing is checked here. */
static inline dmb_place dmb_station(dmb_id part, uint32_t pipe, double fraction)
{
    dmb_place place = {part, pipe, 0, fraction};
    return place;
}

/* ---- Structs that cross the border --------------------------------------------------------------------------------
 * Each begins with struct_size and is filled by its T_init, which writes no more than the given size: a caller compiled against
 * an older header still works. T_default() returns a filled struct by value. A longer struct than the library's is accepted if
 * the additional bytes are zero. T_init is pure; errors: DMB_ERR_NULL, _STRUCT_SIZE (size below that of the first release, not a
 * multiple of 8, or more than 1024 bytes above the size in this library). */
#define DMB_SIZED_STRUCT(T)                          \
    DMB_API int32_t T##_init(T *out, uint32_t size); \
    static inline T T##_default(void)                \
    {                                                \
        T out;                                       \
        (void)T##_init(&out, sizeof(T));             \
        return out;                                  \
    }

/* ---- Memory and log ---------------------------------------------------------------------------------------------- */
typedef struct dmb_allocator {
    uint32_t struct_size, reserved;
    void *context; /* handed to both functions */
    void *(*allocate)(void *context, size_t size, size_t alignment); /* [byte]; NULL on failure */
    void (*release)(void *context, void *block, size_t size, size_t alignment); /* a block of allocate, same sizes */
} dmb_allocator;
DMB_SIZED_STRUCT(dmb_allocator) /* malloc and free of the C library */
/* An allocator that uses only the caller's memory: for firmware without a heap. memory: the pool itself takes 64 bytes of it; it
 * must remain valid while a model or sim uses it. One thread at a time. First fit, neighbouring gaps join, blocks begin on 64
 * bytes. *allocator may be uninitialised. Calling it again on the same memory forgets all that was given out. In a full pool,
 * calls that need memory give DMB_ERR_NO_MEMORY and change nothing. Errors, which leave *allocator unchanged: DMB_ERR_NULL,
 * _VALUE (size < 256, or beyond the end of the addresses). */
DMB_API int32_t dmb_pool_allocator(void *memory, size_t size, dmb_allocator *allocator);
/* [byte] from the start of such a pool to the end of its highest block so far: a pool of that size suffices for the same calls. 0
 * for any other allocator. Cannot fail. */
DMB_API size_t dmb_pool_peak(const dmb_allocator *allocator);

/* ---- Errors as data ---------------------------------------------------------------------------------------------- */
/* dmb_last_error gives the last call of this thread that failed, on any object; a call that succeeds leaves it unchanged.
 * dmb_model_message and dmb_sim_message give the message alone. */
typedef struct dmb_error {
    uint32_t struct_size;
    int32_t status; /* DMB_ERR_...; 0: no call of this thread has failed */
    uint32_t number, component; /* [-] number of the part in its kind; index in an array field (DMB_NONE: there is none) */
    double value, low, high; /* [unit of the field] refused value and its range; NaN: no number, no range */
    char part[128]; /* "string 0 (main), pipe 12 (collars)", as in the message. All texts end with 0; "": there is none */
    char kind[32], name[24]; /* "pipe", "collars": of the innermost part */
    char field[64]; /* "outer_diameter" */
    char given[96]; /* the value as text: "0.07", "(1, 2, 3)" */
    char bound[256]; /* "be finite and > inner_diameter (0.08)"; a bound after > or < is not in the range */
    char advice[384]; /* the remedy */
    char message[512]; /* all of it in one sentence */
} dmb_error;
DMB_SIZED_STRUCT(dmb_error)
/* The last failing call of this thread. Errors: DMB_ERR_NULL, DMB_ERR_STRUCT_SIZE. */
DMB_API int32_t dmb_last_error(dmb_error *error);
/* Sees each failing call on a model and its sims, at its end and in its thread; may not change them. */
typedef void (*dmb_error_fn)(void *context, const dmb_error *error);
enum { DMB_LOG_ERROR = 0, DMB_LOG_WARNING = 1, DMB_LOG_INFO = 2 };
/* Called with a line of text, never during a step. The text lives only for the call. */
typedef void (*dmb_log_fn)(void *context, int32_t level, const char *text);
DMB_C_END
#endif
