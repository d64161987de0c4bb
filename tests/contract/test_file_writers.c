/* The writers of files: every call of the system that they make fails once, and the space runs out at every few bytes;
 * the status is DMB_ERR_IO, the old file is as it was, and nothing else is left in the folder. Values that are not
 * numbers are written so that ParaView reads it. The table of a response reads back as dmb_response_transfer answers.
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sim/sim.h"
#include "sim_test.h"

/* ---- Calls that fail: these stand before those of the C library -------------------------------------------------- */

static int fails_at = -1, made; /* number of the call that fails; calls so far */

static int fails(void)
{
    return made++ == fails_at;
}

FILE *fopen(const char *path, const char *mode)
{
    FILE *(*real)(const char *, const char *);
    *(void **)(&real) = dlsym(RTLD_NEXT, "fopen");
    return fails() ? NULL : real(path, mode);
}

int rename(const char *from, const char *to)
{
    int (*real)(const char *, const char *);
    *(void **)(&real) = dlsym(RTLD_NEXT, "rename");
    return fails() ? -1 : real(from, to);
}

int fchmod(int file, mode_t mode)
{
    int (*real)(int, mode_t);
    *(void **)(&real) = dlsym(RTLD_NEXT, "fchmod");
    return fails() ? -1 : real(file, mode);
}

/* The bytes go nowhere, and those that follow are written: only the call itself tells. */
size_t fwrite(const void *from, size_t size, size_t count, FILE *file)
{
    size_t (*real)(const void *, size_t, size_t, FILE *);
    *(void **)(&real) = dlsym(RTLD_NEXT, "fwrite");
    return count > 0 && fails() ? 0 : real(from, size, count, file);
}

/* The stream lost something that it had buffered. */
int ferror(FILE *file)
{
    int (*real)(FILE *);
    *(void **)(&real) = dlsym(RTLD_NEXT, "ferror");
    return fails() ? 1 : real(file);
}

int fclose(FILE *file)
{
    int (*real)(FILE *);
    *(void **)(&real) = dlsym(RTLD_NEXT, "fclose");
    const int refused = fails();
    const int status = real(file);
    return refused ? EOF : status;
}

/* ---- A scene and its writers -------------------------------------------------------------------------------- */

typedef struct scene {
    rig r;
    dmb_sim *sim;
    dmb_modes *modes;
    dmb_response *response;
    dmb_recorder recorder;
    dmb_output outputs[2];
    double table[9];
    dmb_profile_recorder profiles;
    dmb_profile profile;
    double profile_table[2 * (1 + 3)];
    char folder[64], path[96];
} scene;

static dmb_response *respond(scene *s)
{
    dmb_response_options options = dmb_response_options_default();
    dmb_excitation input = dmb_excitation_default();
    dmb_output output[2] = {{.quantity = DMB_OUTPUT_VIBRATION}, {.quantity = DMB_OUTPUT_VIBRATION}};
    dmb_response *response = NULL;
    options.points = 5;
    options.equilibrium_tolerance = 1.0;
    options.contact = DMB_CONTACT_OPEN;
    input.place = dmb_station(s->r.string, 2, 1.0);
    input.component = DMB_Y;
    output[0].place = dmb_station(s->r.string, 1, 0.5);
    output[0].quantity += DMB_Y;
    output[1].place = input.place;
    output[1].quantity = DMB_OUTPUT_VIBRATION_VELOCITY;
    output[1].quantity += DMB_Y;
    if (dmb_analysis_response(s->sim, &options, &input, 1, output, 2, &response) < 0)
        fail_msg("%s", dmb_sim_message(s->sim));
    return response;
}

static void record(scene *s)
{
    s->outputs[0].place = dmb_station(s->r.string, 2, 1.0);
    s->outputs[0].quantity = DMB_OUTPUT_POSITION_Y;
    s->outputs[1].place.part = s->r.feed;
    s->outputs[1].quantity = DMB_OUTPUT_DRIVE_FORCE;
    s->recorder = dmb_recorder_default();
    s->recorder.output_count = 2;
    s->recorder.outputs = s->outputs;
    s->recorder.table = s->table;
    s->recorder.capacity = 3;
    for (int i = 0; i < 3; i++) rig_run(s->sim, 1), must(dmb_recorder_take(&s->recorder, s->sim));
}

static void record_profile(scene *s)
{
    static const int32_t quantities[1] = {DMB_PROFILE_Y};
    s->profile = dmb_profile_default();
    s->profile.string = s->r.string;
    s->profile.station_count = 3;
    s->profile.quantities = quantities;
    s->profile.quantity_count = 1;
    s->profiles = dmb_profile_recorder_default();
    s->profiles.profile = &s->profile;
    s->profiles.table = s->profile_table;
    s->profiles.capacity = 2;
    must(dmb_profile_recorder_take(&s->profiles, s->sim));
}

static void open_scene(scene *s)
{
    dmb_modes_options options = dmb_modes_options_default();
    memset(s, 0, sizeof *s);
    s->r = rig_of(&plain_rig);
    s->sim = rig_sim(&s->r);
    record(s);
    record_profile(s);
    s->response = respond(s);
    options.count = 1;
    options.contact = DMB_CONTACT_OPEN;
    options.equilibrium_tolerance = 1.0;
    if (dmb_analysis_modes(s->sim, &options, &s->modes) < 0) fail_msg("%s", dmb_sim_message(s->sim));
    (void)snprintf(s->folder, sizeof s->folder, "%.40s/dmb_XXXXXX",
                   getenv("TMPDIR") != NULL ? getenv("TMPDIR") : "/tmp");
    assert_non_null(mkdtemp(s->folder));
    (void)snprintf(s->path, sizeof s->path, "%s/file", s->folder);
}

static void close_scene(scene *s)
{
    (void)remove(s->path);
    assert_int_equal(rmdir(s->folder), 0); /* nothing else is in it */
    dmb_modes_destroy(&s->modes);
    dmb_response_destroy(&s->response);
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->r.model);
}

enum { STRINGS, HOLE, MODE, TABLE, PROFILES, RESPONSE, WRITERS };

static int32_t write_to(int writer, scene *s, const char *path)
{
    switch (writer) {
    case STRINGS: return dmb_write_vtk_strings(s->sim, 2, path);
    case HOLE: return dmb_write_vtk_hole(s->r.model, 0.0, 5.0, 0.5, 8, path);
    case MODE: return dmb_write_vtk_mode(s->modes, 0, 1.0, 0.0, 1, path);
    case TABLE: return dmb_recorder_write_csv(&s->recorder, NULL, path);
    case PROFILES: return dmb_profile_recorder_write_csv(&s->profiles, path);
    default: return dmb_response_write_csv(s->response, NULL, path);
    }
}

/* ---- The folder -------------------------------------------------------------------------------------------------- */

static const char old[] = "what was there before\n";

static void put_old(const char *path)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(old, 1, sizeof old, file), sizeof old);
    assert_int_equal(fclose(file), 0);
}

static size_t content(const char *path, char *text, size_t room)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) return 0;
    const size_t length = fread(text, 1, room, file);
    (void)fclose(file);
    return length;
}

static int files_in(const char *folder)
{
    DIR *dir = opendir(folder);
    int count = 0;
    assert_non_null(dir);
    for (const struct dirent *entry = readdir(dir); entry != NULL; entry = readdir(dir))
        count += entry->d_name[0] != '.';
    (void)closedir(dir);
    return count;
}

static void check_untouched(scene *s, int with_old)
{
    char text[64];
    const size_t length = content(s->path, text, sizeof text);
    assert_int_equal(length, with_old ? sizeof old : 0);
    assert_true(!with_old || memcmp(text, old, sizeof old) == 0);
    assert_int_equal(files_in(s->folder), with_old);
}

/* ---- Tests ------------------------------------------------------------------------------------------------------- */

enum { AT_ENDS = 30, BETWEEN = 40 };

/* 1: the call was reached, and failed. A name beside that is taken is no failure: another one is found. */
static int fails_at_call(scene *s, int writer, int with_old, int n)
{
    (void)remove(s->path);
    if (with_old) put_old(s->path);
    made = 0, fails_at = n;
    const int32_t status = write_to(writer, s, s->path);
    assert_true(made > n);
    fails_at = -1;
    if (status == DMB_OK) return 0;
    assert_int_equal(status, DMB_ERR_IO);
    check_untouched(s, with_old);
    return 1;
}

/* All but those in the midst of a long file, of which some are taken. */
static void every_call_fails_once(void **state)
{
    (void)state;
    scene s;
    open_scene(&s);
    for (int writer = 0; writer < WRITERS; writer++)
        for (int with_old = 0; with_old < 2; with_old++) {
            int tried = 0, failed = 0;
            (void)remove(s.path);
            if (with_old) put_old(s.path);
            made = 0;
            must(write_to(writer, &s, s.path));
            const int calls = made, stride = 1 + calls / BETWEEN;
            for (int n = 0; n < calls; n += n < AT_ENDS || n + stride > calls - AT_ENDS ? 1 : stride, tried++)
                failed += fails_at_call(&s, writer, with_old, n);
            assert_true(tried > 10 && tried - failed <= 1);
            must(write_to(writer, &s, s.path));
            assert_int_equal(files_in(s.folder), 1);
        }
    close_scene(&s);
}

/* The space ends after so many bytes, as on a full disk. */
static void space_runs_out(void **state)
{
    (void)state;
    static char text[1 << 20];
    scene s;
    struct rlimit before, limit;
    open_scene(&s);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    (void)signal(SIGXFSZ, SIG_IGN);
    for (int writer = 0; writer < WRITERS; writer++) {
        (void)remove(s.path);
        must(write_to(writer, &s, s.path));
        const size_t whole = content(s.path, text, sizeof text);
        assert_true(whole > sizeof old && whole < sizeof text);
        put_old(s.path);
        for (size_t room = 0; room < whole; room += 1 + whole / 20) {
            limit = before;
            limit.rlim_cur = room;
            assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
            const int32_t status = write_to(writer, &s, s.path);
            assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
            assert_int_equal(status, DMB_ERR_IO);
            check_untouched(&s, 1);
        }
        must(write_to(writer, &s, s.path));
        assert_int_equal(content(s.path, text, sizeof text), whole);
    }
    close_scene(&s);
}

/* A failing writer is a failing call on its sim or model: dmb_sim_message, dmb_model_message and dmb_last_error agree.
 */
static void objects_have_the_message(void **state)
{
    (void)state;
    scene s;
    dmb_error error = dmb_error_default();
    open_scene(&s);
    assert_int_equal(dmb_write_vtk_strings(s.sim, 1, "/proc/none"), DMB_ERR_IO);
    assert_non_null(strstr(dmb_sim_message(s.sim), "/proc/none"));
    must(dmb_last_error(&error));
    assert_string_equal(dmb_sim_message(s.sim), error.message);
    assert_int_equal(dmb_write_vtk_hole(s.r.model, 0.0, 1.0, 0.5, 8, "/proc/hole"), DMB_ERR_IO);
    assert_non_null(strstr(dmb_model_message(s.r.model), "/proc/hole"));
    assert_int_equal(dmb_response_write_csv(s.response, s.sim, "/proc/response"), DMB_ERR_IO);
    assert_non_null(strstr(dmb_sim_message(s.sim), "/proc/response"));
    close_scene(&s);

    dmb_model *bare = NULL;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    must(dmb_model_create(NULL, &bare));
    must(dmb_model_add_pipes(bare, &pipe, 1, NULL));
    assert_int_equal(dmb_write_vtk_hole(bare, 0.0, 1.0, 0.5, 8, "/proc/hole"), DMB_ERR_ORDER);
    assert_non_null(strstr(dmb_model_message(bare), "compile it first"));
    must(dmb_model_compile(bare, NULL));
    assert_int_equal(dmb_write_vtk_hole(bare, 0.0, 1.0, 0.5, 8, "/proc/hole"), DMB_ERR_UNSUPPORTED);
    assert_non_null(strstr(dmb_model_message(bare), "has no wall; add one"));
    dmb_model_destroy(&bare);
}

/* Devices are written to, links and modes stay, folders and what stands in none are refused. */
static void places_of_all_kinds(void **state)
{
    (void)state;
    scene s;
    char link_name[128], part[128], text[64];
    struct stat found;
    open_scene(&s);
    (void)snprintf(link_name, sizeof link_name, "%s/link", s.folder);
    (void)snprintf(part, sizeof part, "%s.part0", s.path);
    for (int writer = 0; writer < WRITERS; writer++) {
        assert_int_equal(write_to(writer, &s, "/dev/full"), DMB_ERR_IO);
        must(write_to(writer, &s, "/dev/null"));
        assert_int_equal(write_to(writer, &s, s.folder), DMB_ERR_IO);
        assert_int_equal(write_to(writer, &s, "/nonexistent/x"), DMB_ERR_IO);
        assert_int_equal(write_to(writer, &s, ""), DMB_ERR_IO);
        put_old(s.path);
        assert_int_equal(chmod(s.path, 0640), 0);
        assert_int_equal(symlink("file", link_name), 0);
        must(write_to(writer, &s, link_name));
        assert_int_equal(lstat(link_name, &found), 0);
        assert_true(S_ISLNK(found.st_mode));
        assert_int_equal(stat(s.path, &found), 0);
        assert_int_equal(found.st_mode & 0777, 0640);
        assert_true((size_t)found.st_size > sizeof old);
        (void)remove(link_name);
        put_old(part); /* somebody's: it stays, whatever it is called */
        must(write_to(writer, &s, s.path));
        assert_int_equal(content(part, text, sizeof text), sizeof old);
        (void)remove(part);
        assert_int_equal(files_in(s.folder), 1);
    }
    assert_int_equal(stat("/dev/null", &found), 0);
    assert_true(S_ISCHR(found.st_mode));
    close_scene(&s);
}

/* ---- Places where nothing can be written ------------------------------------------------------------------------- */

/* Runs with the rights of nobody where it has those of root, whom a read-only folder does not stop. */
static int give_up_rights(void)
{
    return geteuid() == 0 && seteuid(65534) == 0;
}

static void take_rights_back(int given_up)
{
    if (given_up) assert_int_equal(seteuid(0), 0);
}

/* In a folder in which no file may be made, a writable file that is there stays whole too: its place cannot be
 * taken. */
static void read_only_folders(void **state)
{
    (void)state;
    scene s;
    open_scene(&s);
    for (int writer = 0; writer < WRITERS; writer++)
        for (int with_old = 0; with_old < 2; with_old++) {
            (void)remove(s.path);
            if (with_old) put_old(s.path);
            if (with_old) assert_int_equal(chmod(s.path, 0666), 0);
            assert_int_equal(chmod(s.folder, 0555), 0);
            const int given_up = give_up_rights();
            if (geteuid() == 0)
                print_message("root may write anywhere: not checked\n");
            else
                assert_int_equal(write_to(writer, &s, s.path), DMB_ERR_IO);
            take_rights_back(given_up);
            assert_int_equal(chmod(s.folder, 0755), 0);
            check_untouched(&s, with_old);
        }
    close_scene(&s);
}

/* Below what is a file, in folders of the kernel's, where a folder has its name, behind a link to nowhere or to
 * itself. */
static void places_that_are_none(void **state)
{
    (void)state;
    scene s;
    char path[160], name[160];
    open_scene(&s);
    put_old(s.path);
    for (int writer = 0; writer < WRITERS; writer++) {
        (void)snprintf(path, sizeof path, "%s/below", s.path);
        assert_int_equal(write_to(writer, &s, path), DMB_ERR_IO);
        /* in a bare root these are empty folders like others, unless the kernel's file systems are mounted there */
        if (access("/proc/self", F_OK) == 0) assert_int_equal(write_to(writer, &s, "/proc/none"), DMB_ERR_IO);
        if (access("/sys/kernel", F_OK) == 0) assert_int_equal(write_to(writer, &s, "/sys/none"), DMB_ERR_IO);
        assert_int_equal(write_to(writer, &s, "/proc/self/fd/none"), DMB_ERR_IO);
        (void)snprintf(path, sizeof path, "%s/nowhere/", s.folder);
        assert_int_equal(write_to(writer, &s, path), DMB_ERR_IO);
        (void)snprintf(name, sizeof name, "%s/loop", s.folder);
        assert_int_equal(symlink("loop", name), 0);
        const int32_t status = write_to(writer, &s, name); /* a link that leads nowhere gives way to the file */
        struct stat found;
        assert_int_equal(status, DMB_OK);
        assert_int_equal(lstat(name, &found), 0);
        assert_true(S_ISREG(found.st_mode));
        assert_int_equal(remove(name), 0);
        check_untouched(&s, 1);
    }
    close_scene(&s);
}

/* Names as long as the system allows are written, though there is no room for more letters beside them; longer ones are
 * refused. */
static void long_names(void **state)
{
    (void)state;
    scene s;
    char path[400];
    struct stat found;
    open_scene(&s);
    for (int writer = 0; writer < WRITERS; writer++)
        for (size_t length = 240; length <= 257; length++) {
            const int start = snprintf(path, sizeof path, "%s/", s.folder);
            memset(path + start, 'n', length);
            path[(size_t)start + length] = '\0';
            assert_int_equal(write_to(writer, &s, path), length <= 255 ? DMB_OK : DMB_ERR_IO);
            if (length <= 255) assert_int_equal(stat(path, &found), 0);
            (void)remove(path);
            assert_int_equal(files_in(s.folder), 0);
        }
    close_scene(&s);
}

/* ---- What is not a number ---------------------------------------------------------------------------------------- */

static uint32_t digit_of(char c)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *found = strchr(digits, c);
    return c != '\0' && found != NULL ? (uint32_t)(found - digits) : 64;
}

static size_t decode(const char *from, unsigned char *to)
{
    size_t count = 0;
    for (; digit_of(from[0]) < 64; from += 4) {
        uint32_t bytes = 0;
        for (int i = 0; i < 4; i++) bytes = bytes << 6 | (digit_of(from[i]) & 63) * (digit_of(from[i]) < 64);
        for (int i = 0; i < 3 && (i == 0 || from[i + 1] != '='); i++)
            to[count++] = (unsigned char)(bytes >> (16 - 8 * i));
    }
    return count;
}

static void what_is_no_number(void **state)
{
    (void)state;
    static char text[1 << 20];
    static unsigned char bytes[1 << 20];
    scene s;
    uint64_t length;
    open_scene(&s);
    s.sim->now.velocity[0] = (double)NAN;
    must(dmb_write_vtk_strings(s.sim, 1, s.path));
    text[content(s.path, text, sizeof text - 1)] = '\0';
    assert_null(strstr(text, "nan")); /* readers stop there */
    const char *array = strstr(text, "Name=\"velocity\"");
    assert_non_null(array);
    array = strchr(array, '>');
    assert_int_equal(strncmp(array - strlen("format=\"binary\""), "format=\"binary\"", strlen("format=\"binary\"")), 0);
    const size_t found = decode(array + 2, bytes);
    memcpy(&length, bytes, sizeof length); /* this test runs on little-endian machines */
    assert_int_equal(found, 8 + length);
    assert_int_equal(length, 4 * 3 * sizeof(double)); /* four points of three pipes */
    double velocity[12];
    memcpy(velocity, bytes + 8, sizeof velocity);
    assert_true(isnan(velocity[0]));
    for (int i = 0; i < 4; i++) {
        dmb_motion motion = dmb_motion_default();
        must(dmb_query_motion(s.sim, dmb_station(s.r.string, i < 3 ? (uint32_t)i : 2, i < 3 ? 0.0 : 1.0), &motion));
        for (int k = 0; k < 3; k++)
            assert_true(isnan(motion.velocity[k]) ? isnan(velocity[3 * i + k])
                                                  : motion.velocity[k] == velocity[3 * i + k]);
    }
    assert_non_null(strstr(text, "Name=\"displacement\" NumberOfComponents=\"3\" format=\"ascii\""));
    s.table[4] = (double)NAN;
    must(dmb_recorder_write_csv(&s.recorder, NULL, s.path));
    text[content(s.path, text, sizeof text - 1)] = '\0';
    assert_non_null(strstr(text, ",nan,"));
    close_scene(&s);
}

/* ---- The table of a response ------------------------------------------------------------------------------------- */

static void response_reads_back(void **state)
{
    (void)state;
    static char text[1 << 16];
    scene s;
    uint32_t shape[3];
    double frequencies[8], values[3][2][16];
    open_scene(&s);
    must(dmb_response_dimensions(s.response, shape));
    assert_true(shape[0] == 5 && shape[1] == 1 && shape[2] == 2);
    must(dmb_response_frequencies(s.response, frequencies));
    for (uint32_t k = 0; k < 2; k++) {
        must(dmb_response_transfer(s.response, 0, k, values[0][k]));
        must(dmb_response_transfer(s.response, DMB_COMBINED, k, values[1][k]));
    }
    must(dmb_response_write_csv(s.response, NULL, s.path));
    text[content(s.path, text, sizeof text - 1)] = '\0';
    char *at = strchr(text, '\n');
    assert_non_null(at);
    uint32_t columns = 1;
    for (const char *c = text; c < at; c++) columns += *c == ',';
    assert_int_equal(columns, 1 + 2 * 2 * 2);
    assert_int_equal(strncmp(text, "frequency [Hz]", 14), 0);
    for (uint32_t i = 0; i < shape[0]; i++) {
        assert_true(strtod(at + 1, &at) == frequencies[i]);
        for (uint32_t of = 0; of < 2; of++)
            for (uint32_t k = 0; k < 2; k++) {
                const double *v = values[of][k] + 2 * i;
                const double size = strtod(at + 1, &at), phase = strtod(at + 1, &at);
                assert_true(fabs(size - hypot(v[0], v[1])) <= 1e-15 * size);
                assert_true(fabs(phase - atan2(v[1], v[0])) <= 1e-15);
                assert_true(size > 0.0);
            }
        assert_true(*at == '\n');
    }
    assert_int_equal(at[1], '\0');
    close_scene(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_call_fails_once),    cmocka_unit_test(space_runs_out),
        cmocka_unit_test(places_of_all_kinds),      cmocka_unit_test(read_only_folders),
        cmocka_unit_test(places_that_are_none),     cmocka_unit_test(long_names),
        cmocka_unit_test(objects_have_the_message), cmocka_unit_test(what_is_no_number),
        cmocka_unit_test(response_reads_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
