/* A user's program in C99, built against the installed library through pkg-config: describes a short string, compiles
 * it and reads the counts back. */
#include <drillmbd/drillmbd.h>

#include <stdio.h>

static int fails(const char *what, int32_t status, const dmb_model *model)
{
    if (status >= 0) return 0;
    fprintf(stderr, "%s: %s (%s): %s\n", what, dmb_status_name(status), dmb_status_text(status),
            dmb_model_message(model));
    return 1;
}

static int describe(dmb_model *model)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment step = dmb_segment_default();
    dmb_id string;

    wall.diameter = 0.094;
    pipe.outer_diameter = 0.073;
    pipe.inner_diameter = 0.061;
    bit.mass = 5.0;
    step.kind = DMB_SEGMENT_STEP;
    step.h1 = 0.01;
    drive.component = DMB_X;
    return fails("wall", dmb_model_add_wall(model, &wall, NULL), model) ||
           fails("pipes", dmb_model_add_pipes(model, &pipe, 3, &string), model) ||
           fails("bit", dmb_model_add_bit(model, &bit, NULL), model) ||
           fails("time_function", dmb_model_add_time_function(model, &step, 1, &drive.time_function), model) ||
           fails("drive", dmb_model_add_drive(model, &drive, NULL), model) ||
           fails("compile", dmb_model_compile(model, NULL), model);
}

int main(void)
{
    const uint32_t header = 10000u * DMB_VERSION_MAJOR + 100u * DMB_VERSION_MINOR + DMB_VERSION_PATCH;
    dmb_model *model = NULL;
    dmb_model_info info = dmb_model_info_default();
    int32_t status;
    int failed;

    if (dmb_version() != header) {
        fprintf(stderr, "library %lu, header %lu\n", (unsigned long)dmb_version(), (unsigned long)header);
        return 1;
    }
    status = dmb_model_create(NULL, &model);
    if (status < 0) {
        fprintf(stderr, "create: %s\n", dmb_status_name(status));
        return 1;
    }
    failed = describe(model) || fails("info", dmb_model_get_info(model, &info), model);
    if (!failed && (info.strings != 1 || info.pipes != 3 || info.degrees_of_freedom == 0 || !(info.mass > 5.0))) {
        fprintf(stderr, "strings %lu, pipes %lu, degrees_of_freedom %lu, mass %g\n", (unsigned long)info.strings,
                (unsigned long)info.pipes, (unsigned long)info.degrees_of_freedom, info.mass);
        failed = 1;
    }
    dmb_model_destroy(&model);
    return failed || model != NULL;
}
