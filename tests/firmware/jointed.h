/* A scene with joints whose state has the same bits in every build, with LAPACKE and without, on every machine and in
 * the browser: strings side by side, and a row of four-bars with redundant equations. Requires the library's header. */
#ifndef JOINTED_H
#define JOINTED_H

/* Of the state after JOINTED_STEPS steps of 1 ms. */
#define JOINTED_HASH UINT64_C(0x59273ac8ca3ad707)

enum { JOINTED_STEPS = 100, JOINTED_PIPES = 6, JOINTED_LOOPS = 6 };

/* A string of its own along x, below the first by 0.1 m each. */
static int32_t jointed_string(dmb_model *of, uint32_t number, dmb_id *string)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    def.position[2] = -0.1 * number;
    const int32_t status = dmb_model_add_string(of, &def, string);
    pipe.string = *string;
    pipe.length = 1.0;
    pipe.outer_diameter = 0.09 - 0.02 * number;
    pipe.inner_diameter = 0.05 - 0.01 * number;
    return status < 0 ? status : dmb_model_add_pipes(of, &pipe, JOINTED_PIPES, NULL);
}

/* Three strings, joined at every second pipe: the upper two by balls, the lower two by universal joints. */
static int32_t jointed_strings(dmb_model *of)
{
    dmb_id string[3];
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k < 3 && status >= 0; k++) status = jointed_string(of, k, &string[k]);
    for (uint32_t i = 0; i < JOINTED_PIPES && status >= 0; i++) {
        const uint32_t k = i % 2;
        dmb_joint_def joint = dmb_joint_def_default();
        joint.kind = k == 0 ? DMB_JOINT_SPHERICAL : DMB_JOINT_UNIVERSAL;
        joint.place_a = dmb_station(string[k], i, 1.0);
        joint.place_b = dmb_station(string[k + 1], i, 1.0);
        joint.match = 1;
        status = dmb_model_add_joint(of, &joint, NULL);
    }
    return status;
}

/* Of 1 m and 1 kg from a corner, turned about -y. */
static int32_t jointed_bar(dmb_model *of, double x, double z, double angle, dmb_id *bar)
{
    dmb_body_def body = dmb_body_def_default();
    body.position[0] = x;
    body.position[1] = 2.0;
    body.position[2] = z;
    body.rotation[1] = -angle;
    body.mass = 1.0;
    body.centre[0] = 0.5;
    body.inertia[0] = 0.001;
    body.inertia[1] = body.inertia[2] = 0.08;
    return dmb_model_add_body(of, &body, bar);
}

/* About y at a corner of a, where a corner of b is. */
static int32_t jointed_hinge(dmb_model *of, dmb_id a, double x, double y, double z, dmb_id b)
{
    dmb_joint_def hinge = dmb_joint_def_default();
    hinge.kind = DMB_JOINT_REVOLUTE;
    hinge.place_a = dmb_station(a, 0, 0.0);
    hinge.place_b = dmb_station(b, 0, 0.0);
    hinge.origin_a[0] = x;
    hinge.origin_a[1] = y;
    hinge.origin_a[2] = z;
    hinge.axis_a[0] = 0.0;
    hinge.axis_a[1] = 1.0;
    hinge.match = 1;
    return dmb_model_add_joint(of, &hinge, NULL);
}

/* Cranks on the ground, and couplers between their tips: the bars of JOINTED_LOOPS parallelograms in a row. */
static int32_t jointed_four_bars(dmb_model *of)
{
    const double angle = 1.25, across = 0.3153223623952687, up = 0.9489846193555862;
    const dmb_id ground = {0, 0};
    dmb_id crank[JOINTED_LOOPS + 1], coupler;
    int32_t status = DMB_OK;
    for (uint32_t k = 0; k <= JOINTED_LOOPS && status >= 0; k++) {
        status = jointed_bar(of, k, 0.0, angle, &crank[k]);
        if (status >= 0) status = jointed_hinge(of, ground, k, 2.0, 0.0, crank[k]);
    }
    for (uint32_t k = 0; k < JOINTED_LOOPS && status >= 0; k++) {
        status = jointed_bar(of, k + across, up, 0.0, &coupler);
        if (status >= 0) status = jointed_hinge(of, crank[k], 1.0, 0.0, 0.0, coupler);
        if (status >= 0) status = jointed_hinge(of, crank[k + 1], 1.0, 0.0, 0.0, coupler);
    }
    return status;
}

/* DMB_OK, with the model compiled. */
static int32_t jointed_describe(dmb_model *of)
{
    int32_t status = jointed_strings(of);
    if (status >= 0) status = jointed_four_bars(of);
    return status < 0 ? status : dmb_model_compile(of, NULL);
}

/* DMB_OK, with the hash after JOINTED_STEPS steps. */
static int32_t jointed_run(const dmb_model_options *options, uint64_t *hash)
{
    dmb_model *of = NULL;
    dmb_sim *stepped = NULL;
    int32_t status = dmb_model_create(options, &of);
    if (status >= 0) status = jointed_describe(of);
    if (status >= 0) status = dmb_sim_create(of, NULL, &stepped);
    for (int i = 0; i < JOINTED_STEPS && status >= 0; i++) status = dmb_sim_step(stepped, 1e-3, NULL);
    if (status >= 0) status = dmb_sim_hash(stepped, hash);
    dmb_sim_destroy(&stepped);
    dmb_model_destroy(&of);
    return status;
}

#endif
