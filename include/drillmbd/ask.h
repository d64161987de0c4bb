/* libdrillmbd - state and results of a simulation: queries, outputs, recorders, windows, files. */
#ifndef DRILLMBD_ASK_H
#define DRILLMBD_ASK_H
#include "run.h"
DMB_C_BEGIN

/* ---- Queries -----
 * Results of the last accepted state; the sim is not changed. Errors of every function that has a sim and a result: DMB_ERR_NULL,
 * _HANDLE, _STRUCT_SIZE, _ORDER (a result that this state does not have yet); _ID, _VALUE (part, pipe, fraction or number that is
 * not there); nothing is written then. O(1) if not stated. Several threads may query one sim while no thread steps it. */

typedef struct dmb_pose {
    uint32_t struct_size, reserved;
    double position[3]; /* [m] of the section's centre, world frame; between the nodes of an element by its shape, without its sag
        under its own weight, w L^4/(384 EI) at most */
    double rotation[9]; /* [-] columns are the section's axes in the world frame, row-major, shape (3, 3) */
    double displacement[3]; /* [m] position less that at time 0 as described, world frame */
    double depth; /* [m] measured depth of the closest point of the hole's axis; 0 without a hole */
} dmb_pose;
DMB_SIZED_STRUCT(dmb_pose)
/* Pose of a place; the axes of a body or bit are its own. */
DMB_API int32_t dmb_query_pose(const dmb_sim *sim, dmb_place place, dmb_pose *pose);
typedef struct dmb_motion {
    uint32_t struct_size;
    int32_t frame; /* in: DMB_FRAME_WORLD (default) or DMB_FRAME_BODY */
    double velocity[6]; /* [m/s, rad/s] of the section's centre, in `frame` */
    double acceleration[6]; /* [m/s2, rad/s2] there, in `frame`; BODY: rate of velocity in that frame */
} dmb_motion;
DMB_SIZED_STRUCT(dmb_motion)
DMB_API int32_t dmb_query_motion(const dmb_sim *sim, dmb_place place, dmb_motion *motion);
/* [rad] rotation about the pipe's own axis since time 0, revolutions counted. */
DMB_API int32_t dmb_query_rotation(const dmb_sim *sim, dmb_place place, double *angle);
typedef struct dmb_section {
    uint32_t struct_size, reserved;
    double force[6]; /* [N, N m] on the near side from the far side: axial (tension > 0), shear y, z; torque, bending moment y, z;
        section frame. It balances all that acts between two sections: weight and inertia along the pipe and its tool joint,
        eccentric mass too, and wall forces, loads, springs at their points (axial-torsional pipes: mean of the element) */
    double strain[6]; /* [-, -, -, rad/m, rad/m, rad/m] mean of element: stretch, shear; twist, curvature */
} dmb_section;
DMB_SIZED_STRUCT(dmb_section)
/* Section loads of a flexible or axial-torsional pipe; DMB_ERR_UNSUPPORTED on rigid ones. */
DMB_API int32_t dmb_query_section(const dmb_sim *sim, dmb_place place, dmb_section *section);
typedef struct dmb_contact {
    uint32_t struct_size;
    int32_t closed, sticks; /* 1 when touching; 1 when the bristle law holds it */
    uint32_t number; /* [-] of the contact point, 0 .. info.contact_points - 1 */
    dmb_id part; /* string or body the contact point belongs to */
    uint32_t pipe, reserved; /* [-] pipe whose far end it is, or that it is on; DMB_NONE for the rig end of the string */
    double length; /* [m] of pipe it represents */
    double gap; /* [m] to the wall, < 0 when penetrating */
    double normal[3]; /* [-] outward, from the axis to the wall, world frame */
    double normal_force, approach; /* [N; m/s] on the wall, >= 0; normal speed towards the wall */
    double friction[2]; /* [N] on the pipe: along its axis, along axis x normal; after a static start that assumed a slip
        (dmb_static_options) that of the equilibrium, until the next step */
    double slip[2]; /* [m/s] of the contact point on the wall, same directions */
    double along; /* [N] on the pipe along its axis where the wall's diameter or stiffness changes (scene.h) */
} dmb_contact;
DMB_SIZED_STRUCT(dmb_contact)
/* Contact of contact point `number`, counted along the strings (stabilisers before the pipe at their nodes), then the bodies,
 * then points along elements (contact_points), then axial-torsional pipes. */
DMB_API int32_t dmb_query_contact(const dmb_sim *sim, uint32_t number, dmb_contact *contact);
typedef struct dmb_contact_total {
    uint32_t struct_size, closed; /* [-] contact points that touch */
    double normal_force, friction[2], deepest; /* [N; N; m] sum over points; sum by component; largest penetration, >= 0 */
} dmb_contact_total;
DMB_SIZED_STRUCT(dmb_contact_total)
/* O(contact points). */
DMB_API int32_t dmb_query_contact_total(const dmb_sim *sim, dmb_contact_total *sum);
/* [J] kinetic energy of one pipe of a string with half of the parts fixed to its two ends, or of a body. */
DMB_API int32_t dmb_query_kinetic_energy(const dmb_sim *sim, dmb_id part, uint32_t pipe, double *energy);
typedef struct dmb_energy {
    uint32_t struct_size, reserved;
    double kinetic, strain; /* [J] now; now, of flexible pipes, springs and stops of joints */
    double gravity, contact; /* [J] now; gravity 0 at time 0 as described; contact stored in the wall's stiffness */
    double drives; /* [J] work put in by all drives since the start */
    double loads; /* [J] work of described loads, the bottom-hole load, the caller's constraints that move */
    double friction; /* [J] taken by friction on the wall and in joints, energy stored in bristles included */
    double impact; /* [J] dissipated by the damping of the normal law and of stops, and by dmb_sim_set_joint: impulses, springs
        released less those engaged, so it may be negative */
    double damping, rock; /* [J] dissipated by material and external damping and dampers of joints; spent at the bit */
    double scheme; /* [J] taken out by the integration: work of its discrete forces less change of energies (eq:motion.work) */
    double input; /* [J] integral of the sum of each drive's |power| and of |power| of all loads */
    double balance; /* [J] input and changes of energy that physics leaves open: scheme + unexplained */
    double unexplained; /* [J] balance - scheme: from unconverged iterations only */
    double error; /* [-] |balance| / scale; 0 only if nothing is missing */
    double scale; /* [J] largest of the energies supplied, dissipated, exchanged with gravity, present (without gravity) */
    double growth; /* [-] change of the balance over the last tenth of the time since the start, over scale */
} dmb_energy;
DMB_SIZED_STRUCT(dmb_energy)
/* Energy ledger since the start; DMB_ERR_UNSUPPORTED where the options left it out. O(nodes). */
DMB_API int32_t dmb_query_energy(const dmb_sim *sim, dmb_energy *energy);
typedef struct dmb_momentum {
    uint32_t struct_size, reserved;
    double linear[3], angular[3]; /* [kg m/s; kg m2/s] with added mass of mud; angular about the world's origin; world frame */
    double mass, centre[3]; /* [kg; m] of all parts, without mud; centre of mass, world frame */
} dmb_momentum;
DMB_SIZED_STRUCT(dmb_momentum)
/* O(nodes). */
DMB_API int32_t dmb_query_momentum(const dmb_sim *sim, dmb_momentum *momentum);
typedef struct dmb_drive_state {
    uint32_t struct_size, reserved;
    double target; /* [unit of the time function] now, excitation included */
    double position, speed; /* [m, rad; m/s, rad/s] of the component since time 0, unwrapped */
    double force; /* [N, N m] that the drive exerts on the part, along the component */
    double power, work; /* [W; J] since the start, 0 without the energy ledger */
    double command; /* [N, N m] commanded by a LOAD or CONTROL drive now; of MOTION its force */
    double made; /* [N, N m] command after delay, rate limit and lag of the actuator, before its curve and drag */
} dmb_drive_state;
DMB_SIZED_STRUCT(dmb_drive_state)
DMB_API int32_t dmb_query_drive(const dmb_sim *sim, dmb_id drive, dmb_drive_state *state);
/* [N, N m] force and moment of the support and the motion drives on the rig end of a string or on a supported body, body frame,
 * shape (6); 0 in components that are free. */
DMB_API int32_t dmb_query_reaction(const dmb_sim *sim, dmb_id part, double reaction[6]);
typedef struct dmb_joint_state {
    uint32_t struct_size;
    int32_t frame; /* in: frame of `reaction`: DMB_FRAME_WORLD (default) or DMB_FRAME_BODY, which is frame b of the joint; none
        for frame a (DMB_ERR_VALUE) */
    int32_t state; /* DMB_JOINT_... */
    uint32_t constraint_rows, redundant, reserved; /* [-] equations it holds now; of them dropped because others imply them */
    double position[6], speed[6]; /* [m, rad; m/s, rad/s] coordinates, RX and RY over full turns, and their rates */
    double acceleration[6]; /* [m/s2, rad/s2] rate of `speed` */
    double reaction[6]; /* [N, N m] force and moment of the constraint on b from a, at b's origin; redundant: of least norm */
    double action[6]; /* [N, N m] generalised force of springs, dampers, stops and friction on the coordinates */
    double violation; /* [m, -] largest violation of its equations of position */
} dmb_joint_state;
DMB_SIZED_STRUCT(dmb_joint_state)
DMB_API int32_t dmb_query_joint(const dmb_sim *sim, dmb_id joint, dmb_joint_state *state);
/* Multipliers of a joint, coupling, constraint or joint drive: count of its rows (at most 6), in the units of a force per unit of
 * its value. *count on return is the number of rows. */
DMB_API int32_t dmb_query_multipliers(const dmb_sim *sim, dmb_id part, double multipliers[6], uint32_t *count);
typedef struct dmb_bit_state {
    uint32_t struct_size;
    int32_t on_bottom; /* 1 while cutting or touching */
    double advance, bottom; /* [m] along the hole's axis since time 0; advance at which rock begins */
    double depth_of_cut; /* [m] per revolution, all blades */
    double weight, torque; /* [N; N m] weight on bit, >= 0; torque on bit, against the rotation, from the rock law */
    double load; /* [N] bottom-hole load of the time function */
    double side_force[3]; /* [N] of the rock on the bit across its axis (side_cutting), world frame */
    double side_speed; /* [m/s] of the lateral cut, across its axis */
} dmb_bit_state;
DMB_SIZED_STRUCT(dmb_bit_state)
DMB_API int32_t dmb_query_bit(const dmb_sim *sim, dmb_id bit, dmb_bit_state *state);
typedef struct dmb_statistics {
    uint32_t struct_size, most_iterations; /* [-] of an accepted step */
    uint64_t steps, rejected, iterations; /* [-] accepted; steps tried and not accepted; iterations in all */
    uint64_t limited_steps, bytes; /* [-; byte] steps accepted above the tolerance in bounded-work mode; of the sim */
    double largest_residual; /* [-] relative, of an accepted step */
    double projection[2]; /* [m/s, rad/s] largest correction of initial velocities */
    double assembly[2]; /* [m, rad] largest correction of the described pose when joints were closed */
    uint64_t switches; /* [-] times the independent coordinates of a cluster were chosen again */
    uint32_t dependent, redundant; /* [-] coordinates that constraints determine now, equations that are dropped now */
    double violation; /* [m, -] largest violation of a joint's equation of position now, not of couplings, drives, constraints */
    uint64_t bounces; /* [-] contacts with the wall, stops of joints and springs that opened within fewer than ten steps after
        they closed: steps do not resolve them, and their speeds after it are uncertain. Lasting contacts are not counted. */
} dmb_statistics;
DMB_SIZED_STRUCT(dmb_statistics)
/* O(number of joints, couplings and constraints). */
DMB_API int32_t dmb_query_statistics(const dmb_sim *sim, dmb_statistics *statistics);

/* ---- The hole at a depth ----------------------------------------------------------------------------------------- */
enum { DMB_HOLE_ABOVE = -1, DMB_HOLE_SURVEYED = 0, DMB_HOLE_BELOW = 1 };
typedef struct dmb_hole_point {
    uint32_t struct_size;
    int32_t beyond; /* DMB_HOLE_ABOVE the first station or _BELOW the last one, where the axis goes straight on; a hole without
        survey is DMB_HOLE_SURVEYED everywhere */
    double position[3]; /* [m] of the axis, world frame */
    double tangent[3], normal[3]; /* [-] unit, to greater depth; to the centre of curvature, 0 where straight; world frame */
    double curvature, dogleg_severity; /* [rad/m; deg/30m] >= 0; the same in the drillers' unit */
    double inclination, azimuth; /* [rad] from downward vertical, 0 .. pi; from +x (north) to -y (east), -pi .. pi, vertical: 0 */
    double diameter, stiffness; /* [m; N/m^(n+1)] of the hole; per metre of pipe (and the wall's other constants: scene.h) */
    double restitution, damping; /* [-; N s/m2] per metre of pipe */
    double mu_static, mu_dynamic; /* [-] */
    double strength; /* [Pa] of a section; 0: not given */
    uint32_t section, reserved; /* number of the last section that begins at or above the depth; DMB_NONE: none */
    char section_name[24]; /* of that section, ends with 0; "" without one */
} dmb_hole_point;
DMB_SIZED_STRUCT(dmb_hole_point)
/* The axis at a measured depth [m], by minimum curvature (Taylor, Mason 1972) between stations. A compiled model; DMB_ERR_ORDER
 * before, DMB_ERR_UNSUPPORTED without a hole, _NOT_FINITE. O(log stations). */
DMB_API int32_t dmb_query_hole(const dmb_model *model, double depth, dmb_hole_point *point);
/* The same with the diameter that the cutters have left up to now (cut_spacing of dmb_wall_def). */
DMB_API int32_t dmb_query_hole_now(const dmb_sim *sim, double depth, dmb_hole_point *point);

/* ---- Flow of mud ------------------------------------------------------------------------------------------------- */
typedef struct dmb_flow_state {
    uint32_t struct_size, reserved;
    double rate; /* [m3/s] flow_rate of the environment */
    double pump_pressure; /* [Pa] at the rig end, inside over outside: losses, motors and difference of columns */
    double bore_loss, bit_loss; /* [Pa] down the string, by friction; through nozzle_area (eq:mud.nozzle) */
    double annulus_loss, column; /* [Pa] up the annulus, by friction; mud outside over that inside, far end under rig end */
    double drag, thrust; /* [N] of the flow along the string, towards the rig, in its effective axial force; rho Q V of nozzles or
        open end, on the far end towards the rig */
    double pressure_stretch; /* [m] by true axial force and pressures on the walls, beyond that of N_e and of poses */
    double bore_reynolds, annulus_reynolds; /* [-] largest; laminar up to 3470 - 1370 n, by 16/f (Metzner, Reed 1955); beyond 1e5
        the smooth wall's law is low in the annulus: 7 % at 3e5, 15 % at 1e6 */
    double motor_loss; /* [Pa] through mud motors at the far end at their present torque; in pump_pressure */
} dmb_flow_state;
DMB_SIZED_STRUCT(dmb_flow_state)
/* Pressures and forces of the mud that flows, at the present position of the string; all 0 without a flow_rate but for
 * pressure_stretch of mud at rest. Kinetic heads, steps between diameters, bodies, bits and stabilisers in the annulus and the
 * motion of the string are neglected. The annulus has the flow_eccentricity wherever the string lies. O(elements). */
DMB_API int32_t dmb_query_flow(const dmb_sim *sim, dmb_flow_state *flow);

/* ---- Profiles: a string's state over its length -------------------------------------------------------------------
 * Forces are of the section, tension > 0. Section forces of the library are effective ones, which bend, buckle and yield: N_e = N
 * + p_o A_o - p_i A_i (eq:mud.effective), p the pressure of `fluid_density` under the start of the hole, or the rig end without a
 * hole, >= 0, and of its flow; with flow N_e is less by rho Q V of the mud inside. Shares are load over limit: 1 is the limit, 1
 * - share the margin. */
/* clang-format off */
enum {
    DMB_PROFILE_DISTANCE = 0, /* [m] along the string from its rig end */
    DMB_PROFILE_DEPTH = 1, /* [m] measured depth; 0 without a hole */
    DMB_PROFILE_X = 2, DMB_PROFILE_Y = 3, DMB_PROFILE_Z = 4, /* [m] position, world frame */
    DMB_PROFILE_DEVIATION = 5, /* [m] distance from the hole's axis */
    DMB_PROFILE_DEVIATION_SIDE = 6, /* [m] its horizontal part, along z_world x tangent: left looking ahead */
    DMB_PROFILE_DEVIATION_UP = 7, /* [m] its other part: towards the high side */
    DMB_PROFILE_AXIAL_FORCE = 8, /* [N] true axial force N */
    DMB_PROFILE_EFFECTIVE_FORCE = 9, /* [N] effective force N_e, as dmb_query_section */ DMB_PROFILE_TORQUE = 10, /* [N m] */
    DMB_PROFILE_BENDING_MOMENT = 11, /* [N m] magnitude; of axial-torsional pipes EI times the curvature of eq:drilling.bending */
    DMB_PROFILE_SHEAR_FORCE = 12, /* [N] magnitude */
    DMB_PROFILE_CURVATURE = 13, /* [rad/m] of bending, magnitude, less the unstressed one; 0 in tool joints */
    DMB_PROFILE_NORMAL_FORCE = 14, /* [N/m] of the wall on the string, >= 0; that of the nearest contact point */
    DMB_PROFILE_FRICTION_AXIAL = 15, /* [N/m] of the wall on the string along its axis */
    DMB_PROFILE_FRICTION_AROUND = 16, /* [N/m] of the wall on the string along axis x outward normal */
    DMB_PROFILE_VON_MISES = 17, /* [Pa] largest at the outer surface, by the diameters (eq:drilling.von-mises); with an
        inner_density or flow_rate of both surfaces, hoop stress too */
    DMB_PROFILE_YIELD_SHARE = 18, /* [-] of `yield_strength`; NaN where the pipe has none */
    DMB_PROFILE_SINUSOIDAL_SHARE = 19, /* [-] -N_e over the load of sinusoidal buckling; 0 in tension; NaN without a hole, and in
        compression where nothing presses the pipe to the wall */
    DMB_PROFILE_HELICAL_SHARE = 20, /* [-] compression over the helical buckling load */
    DMB_PROFILE_VELOCITY_AXIAL = 21, /* [m/s] along the pipe */ DMB_PROFILE_VELOCITY_LATERAL = 22, /* [m/s] across, magnitude */
    DMB_PROFILE_SPIN = 23, /* [rad/s] about the pipe's axis */
    DMB_PROFILE_ACCELERATION_AXIAL = 24, /* [m/s2] of the section's centre, along the pipe's axis */
    DMB_PROFILE_ACCELERATION_LATERAL = 25, /* [m/s2] across, magnitude */
    DMB_PROFILE_ROTATION = 26, /* [rad] about the pipe's axis since time 0, unwrapped */
    DMB_PROFILE_DISPLACEMENT_X = 27, DMB_PROFILE_DISPLACEMENT_Y = 28, /* [m] since time 0 as described, world frame */
    DMB_PROFILE_DISPLACEMENT_Z = 29, /* [m] the same */
    DMB_PROFILE_SHEAR_Y = 30, DMB_PROFILE_SHEAR_Z = 31, /* [N] section frame, as dmb_query_section */
    DMB_PROFILE_MOMENT_Y = 32, DMB_PROFILE_MOMENT_Z = 33, /* [N m] bending about y, z; section frame */
    DMB_PROFILE_GAP = 34, /* [m] of the nearest contact point, < 0 when penetrating; NaN without one */
};
/* clang-format on */
typedef struct dmb_profile {
    uint32_t struct_size, station_count; /* [-] 1 .. 2^24 */
    dmb_id string; /* {0, 0}: the model's first string */
    const double *distance; /* [m] of the stations along the string, 0 .. its length, any order, shape (station_count); NULL:
        spread evenly from the rig end to the far end */
    const int32_t *quantities; /* DMB_PROFILE_..., shape (quantity_count) */
    uint32_t quantity_count, reserved; /* [-] 1 .. the number of them; repetitions allowed */
    double *values; /* the caller's; value of quantity q at station i is values[i * station_stride + q * quantity_stride] */
    uint64_t station_stride, quantity_stride; /* [-] in doubles, both 0 (default): quantity_count and 1 */
} dmb_profile;
DMB_SIZED_STRUCT(dmb_profile)
/* Fills profile->values. Section forces, stresses and shares are NaN on rigid pipes. Buckling loads are those of a long pipe that
 * lies on the wall without friction, with the contact force per metre that the unbuckled pipe would have (Dawson, Paslay 1984;
 * He, Kyllingstad 1995; Chen, Lin, Cheatham 1990; in a vertical hole Wu, Juvkam-Wold 1995: eq:drilling.sinusoidal,
 * eq:drilling.helical). Errors: DMB_ERR_VALUE too for strides that overlap, _NOT_FINITE. O(station_count). */
DMB_API int32_t dmb_query_profile(const dmb_sim *sim, const dmb_profile *profile);
/* extremes, shape (quantity_count, 4): least value, its distance [m], largest, its distance; NaN: no value. Ignores `values`. */
DMB_API int32_t dmb_query_profile_extremes(const dmb_sim *sim, const dmb_profile *profile, double *extremes);
/* Name of a quantity ("axial_force") and its unit in *unit (may be NULL); NULL for another number; from 0 without gaps. */
DMB_API const char *dmb_profile_name(int32_t quantity, const char **unit);

/* ---- Recorder -----------------------------------------------------------------------------------------------------
 * Chosen outputs at a chosen rate into the caller's memory: a table of rows (time, outputs...). */
/* clang-format off */
enum {
    DMB_OUTPUT_DISPLACEMENT_X = 0, DMB_OUTPUT_DISPLACEMENT_Y = 1, DMB_OUTPUT_DISPLACEMENT_Z = 2, /* [m] world */
    DMB_OUTPUT_VELOCITY_X = 3, DMB_OUTPUT_VELOCITY_Y = 4, DMB_OUTPUT_VELOCITY_Z = 5, /* [m/s] world */
    DMB_OUTPUT_POSITION_X = 6, DMB_OUTPUT_POSITION_Y = 7, DMB_OUTPUT_POSITION_Z = 8, /* [m] world */
    DMB_OUTPUT_ROTATION = 9, /* [rad] unwrapped */ DMB_OUTPUT_SPIN = 10, /* [rad/s] about the pipe's axis */
    DMB_OUTPUT_AXIAL_FORCE = 11, /* [N] tension > 0 */ DMB_OUTPUT_TORQUE = 12, /* [N m] */
    DMB_OUTPUT_BENDING_MOMENT = 13, /* [N m] magnitude */ DMB_OUTPUT_KINETIC_ENERGY = 14, /* [J] of the pipe or body */
    DMB_OUTPUT_NORMAL_FORCE = 15, /* [N] at the pipe's far end, or of the body */
    DMB_OUTPUT_DRIVE_FORCE = 16, /* [N, N m] place.part is a drive */
    DMB_OUTPUT_DRIVE_SPEED = 17, /* [m/s, rad/s] place.part is a drive */
    DMB_OUTPUT_BIT_WEIGHT = 18, /* [N] place.part is a bit, bottom-hole load included */
    DMB_OUTPUT_ENERGY_ERROR = 19 /* [-] of the ledger; place is ignored */
};
/* clang-format on */
typedef struct dmb_window dmb_window; /* a window over outputs, below */
typedef struct dmb_recorder {
    uint32_t struct_size, output_count; /* [-] 1 .. 4096 */
    const dmb_output *outputs; /* shape (output_count); the caller's, kept alive by it */
    double *table; /* shape (capacity, 1 + output_count); the caller's */
    uint64_t capacity, row_count; /* [-] rows of table; rows written, start with 0 */
    double interval; /* [s] between samples, 0: every call */
    const dmb_window *window; /* of outputs of a window; dmb_window_take comes before dmb_recorder_take; default NULL */
} dmb_recorder;
DMB_SIZED_STRUCT(dmb_recorder)
/* Call it after every step: writes a row if its time has come. DMB_NOTE_FULL when the table has no room; DMB_ERR_ORDER before the
 * time of the last row, as after a restore: set row_count to the number of rows to keep. Other errors: DMB_ERR_NULL, _HANDLE,
 * _STRUCT_SIZE, _VALUE, _NOT_FINITE, those of dmb_query_output. O(outputs). */
DMB_API int32_t dmb_recorder_take(dmb_recorder *recorder, const dmb_sim *sim);
/* Writes the table as CSV: comma, '.', a line of heads as of dmb_output_text with part names of `sim` (NULL: numbers of parts),
 * 17 digits, nan. Errors: DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _VALUE, _NOT_FINITE; _IO: this and all that write files write
 * beside path (path.part0) and rename, so that the old file stays, unless path is a device. */
DMB_API int32_t dmb_recorder_write_csv(const dmb_recorder *recorder, const dmb_sim *sim, const char *path);
/* VTK XML poly-data for ParaView: the strings as lines with fields (displacement, velocity, diameter, axial force, torque,
 * bending moment, normal force), `per_element` points an element (1 .. 64). DMB_ERR_IO on failure. */
DMB_API int32_t dmb_write_vtk_strings(const dmb_sim *sim, uint32_t per_element, const char *path);
/* The hole as a tube of `around` facets (3 .. 360), circles each `spacing` [m]; errors as dmb_query_hole, DMB_ERR_TOO_LARGE. */
DMB_API int32_t dmb_write_vtk_hole(const dmb_model *model, double depth0, double depth1, double spacing, uint32_t around,
                                   const char *path);

/* ---- Points off a place, springs, stuck places ------------------------------------------------------------------ */
/* Pose and motion of a point off a place: offset [m] in the axes of the place. Errors too: DMB_ERR_NOT_FINITE. */
DMB_API int32_t dmb_query_pose_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_pose *pose);
DMB_API int32_t dmb_query_motion_at(const dmb_sim *sim, dmb_place place, const double offset[3], dmb_motion *motion);
typedef struct dmb_spring_state {
    uint32_t struct_size, reserved;
    double length, elongation; /* [m] between its points, and beyond its free length */
    double speed, force; /* [m/s; N] rate of the elongation; tension > 0: sum of the next two */
    double elastic, damper; /* [N] */
    double energy; /* [J] stored, from the free length on, or from where a one-sided one is slack */
    double direction[3]; /* [-] from a to b, world frame */
    double point_a[3], point_b[3]; /* [m] world */
} dmb_spring_state;
DMB_SIZED_STRUCT(dmb_spring_state)
DMB_API int32_t dmb_query_spring(const dmb_sim *sim, dmb_id spring, dmb_spring_state *state);
typedef struct dmb_stuck_state {
    uint32_t struct_size;
    int32_t stuck; /* 1: held */
    double offset[4]; /* [m, m, m, rad] from where it got stuck: along, sideways y and z, turned; 0 where it is not */
    double force[4]; /* [N, N, N, N m] that holds it, on the string, in the same order */
    double share, energy; /* [-; J] largest of |axial force|/overpull and |torque|/overtorque, released at 1; stored */
} dmb_stuck_state;
DMB_SIZED_STRUCT(dmb_stuck_state)
DMB_API int32_t dmb_query_stuck(const dmb_sim *sim, dmb_id stuck, dmb_stuck_state *state);

/* ---- Outputs ------------------------------------------------------------------------------------------------------
 * Numbers of dmb_output.quantity that continue those of recorders. Where six follow each other, the number is the one given plus
 * DMB_X .. DMB_RZ. Each is the result of the query it is named after. Numbers 520 .. 999 and from 3000 on are kept free; a
 * stretch of numbers may grow at its end. */
/* clang-format off */
enum {
    /* Readings of a driller; place.part is a string, {0, 0}: the model's first. O(pipes) of stretch and wind-up. */
    DMB_OUTPUT_HOOK_LOAD = 100, /* [N] effective axial force at the rig end, as dmb_query_section: > 0 pull, < 0 thrust */
    DMB_OUTPUT_ROTATION_TORQUE = 101, /* [N m] that the rig puts into that section, > 0 along the string's x axis */
    DMB_OUTPUT_WEIGHT_ON_BIT = 102, /* [N] of all bits on the string: rock law and bottom-hole load */
    DMB_OUTPUT_TORQUE_ON_BIT = 103, /* [N m] of all bits on the string: rock law, against the rotation */
    DMB_OUTPUT_RATE_OF_PENETRATION = 104, /* [m/s] of the string's first bit into the hole; with a rock law 0 while off bottom.
        The rate of dmb_bit_state.advance */
    DMB_OUTPUT_BIT_SPEED = 105, /* [rad/s] about its axis, of the string's far end */
    DMB_OUTPUT_BIT_DEPTH = 106, /* [m] measured depth of the string's far end; 0 without a hole */
    DMB_OUTPUT_ROTARY_SPEED = 107, /* [rad/s] about its axis, of the string's rig end */
    DMB_OUTPUT_FEED_SPEED = 108, /* [m/s] along its axis, of the string's rig end, > 0 into the hole */
    DMB_OUTPUT_STRETCH = 109, /* [m] elastic, > 0 longer: sum of the axial strain over the flexible lengths */
    DMB_OUTPUT_WIND_UP = 110, /* [rad] elastic, of the rig end against the far end: less the sum of the twist */
    DMB_OUTPUT_OFF_BOTTOM = 111, /* [-] 1: no bit with a rock law is on bottom, else 0; its mean in windows: off-bottom share */
    DMB_OUTPUT_RIG_FORCE = 112, /* [N] by support and drives on the rig end, > 0 the rig pulls: hook load, and inertia, weight and
        friction of the end itself; 0 where a joint holds it */
    DMB_OUTPUT_RIG_TORQUE = 113, /* [N m] by support and drives, > 0 along the string's x axis */
    /* place.part a bit: dmb_query_bit */
    DMB_OUTPUT_BIT_ADVANCE = 120, DMB_OUTPUT_BIT_BOTTOM = 121, DMB_OUTPUT_BIT_DEPTH_OF_CUT = 122, /* [m] */
    DMB_OUTPUT_BIT_ROCK_WEIGHT = 123, DMB_OUTPUT_BIT_LOAD = 125, /* [N] of the rock law alone; bottom-hole load */
    DMB_OUTPUT_BIT_TORQUE = 124, /* [N m] */ DMB_OUTPUT_BIT_ON_BOTTOM = 126, /* [-] 1 or 0 */
    /* place.part a stuck place: dmb_query_stuck */
    DMB_OUTPUT_STUCK = 127, /* [-] 1 or 0 */ DMB_OUTPUT_STUCK_FORCE = 128, /* [N] axial */
    DMB_OUTPUT_STUCK_TORQUE = 129, /* [N m] */
    /* place.part a drive: dmb_query_drive */
    DMB_OUTPUT_DRIVE_TARGET = 130, /* [unit of the time function] */ DMB_OUTPUT_DRIVE_POSITION = 131, /* [m, rad] */
    DMB_OUTPUT_DRIVE_POWER = 132, /* [W] */ DMB_OUTPUT_DRIVE_WORK = 133, /* [J] */
    DMB_OUTPUT_DRIVE_COMMAND = 134, DMB_OUTPUT_DRIVE_MADE = 135, /* [N, N m] */
    /* place.pipe the number of a contact point: dmb_query_contact */
    DMB_OUTPUT_CONTACT_GAP = 140, /* [m] */ DMB_OUTPUT_CONTACT_NORMAL_FORCE = 141, /* [N] */
    DMB_OUTPUT_CONTACT_APPROACH = 142, /* [m/s] */
    DMB_OUTPUT_CONTACT_FRICTION_AXIAL = 143, DMB_OUTPUT_CONTACT_FRICTION_AROUND = 144, /* [N] */
    DMB_OUTPUT_CONTACT_SLIP_AXIAL = 145, DMB_OUTPUT_CONTACT_SLIP_AROUND = 146, /* [m/s] */
    DMB_OUTPUT_CONTACT_CLOSED = 147, DMB_OUTPUT_CONTACT_STICKS = 148, /* [-] 1 or 0 */
    /* place is ignored from here to the statistics; dmb_query_contact_total, O(contact points) */
    DMB_OUTPUT_CONTACTS_CLOSED = 150, /* [-] */
    DMB_OUTPUT_CONTACTS_NORMAL_FORCE = 151, DMB_OUTPUT_CONTACTS_FRICTION_AXIAL = 152, /* [N] */
    DMB_OUTPUT_CONTACTS_FRICTION_AROUND = 153, /* [N] */ DMB_OUTPUT_CONTACTS_DEEPEST = 154, /* [m] */
    /* place is ignored; dmb_query_energy, dmb_query_momentum: O(nodes) */
    DMB_OUTPUT_ENERGY_KINETIC = 160, DMB_OUTPUT_ENERGY_STRAIN = 161, DMB_OUTPUT_ENERGY_GRAVITY = 162, /* [J] */
    DMB_OUTPUT_ENERGY_CONTACT = 163, DMB_OUTPUT_ENERGY_DRIVES = 164, DMB_OUTPUT_ENERGY_LOADS = 165, /* [J] */
    DMB_OUTPUT_ENERGY_FRICTION = 166, DMB_OUTPUT_ENERGY_IMPACT = 167, DMB_OUTPUT_ENERGY_DAMPING = 168, /* [J] */
    DMB_OUTPUT_ENERGY_ROCK = 169, DMB_OUTPUT_ENERGY_SCHEME = 170, DMB_OUTPUT_ENERGY_INPUT = 171, /* [J] */
    DMB_OUTPUT_ENERGY_BALANCE = 172, DMB_OUTPUT_ENERGY_UNEXPLAINED = 173, /* [J] */
    DMB_OUTPUT_MOMENTUM_X = 180, DMB_OUTPUT_MOMENTUM_Y = 181, DMB_OUTPUT_MOMENTUM_Z = 182, /* [kg m/s] linear, world */
    DMB_OUTPUT_ANGULAR_MOMENTUM_X = 183, DMB_OUTPUT_ANGULAR_MOMENTUM_Y = 184, /* [kg m2/s] about the world's origin, world */
    DMB_OUTPUT_ANGULAR_MOMENTUM_Z = 185, /* [kg m2/s] the same */ DMB_OUTPUT_MASS = 186, /* [kg] */
    DMB_OUTPUT_CENTRE_X = 187, DMB_OUTPUT_CENTRE_Y = 188, DMB_OUTPUT_CENTRE_Z = 189, /* [m] of mass, world */
    DMB_OUTPUT_STEPS = 200, DMB_OUTPUT_REJECTED = 201, DMB_OUTPUT_ITERATIONS = 202, /* [-] dmb_query_statistics, O(joints) */
    DMB_OUTPUT_LIMITED_STEPS = 203, DMB_OUTPUT_MOST_ITERATIONS = 204, DMB_OUTPUT_LARGEST_RESIDUAL = 205, /* [-] */
    DMB_OUTPUT_SWITCHES = 206, DMB_OUTPUT_DEPENDENT = 207, DMB_OUTPUT_REDUNDANT = 208, /* [-] */
    DMB_OUTPUT_VIOLATION = 209, /* [m, -] of all joints */
    /* place.part a spring: dmb_query_spring */
    DMB_OUTPUT_SPRING_LENGTH = 220, DMB_OUTPUT_SPRING_ELONGATION = 221, /* [m] */ DMB_OUTPUT_SPRING_SPEED = 222, /* [m/s] */
    DMB_OUTPUT_SPRING_FORCE = 223, /* [N] tension > 0, sum of the next two */
    DMB_OUTPUT_SPRING_ELASTIC = 224, DMB_OUTPUT_SPRING_DAMPER = 225, /* [N] */ DMB_OUTPUT_SPRING_ENERGY = 226, /* [J] */
    /* place.part an input: dmb_sim_get_input */
    DMB_OUTPUT_INPUT_PRESENT = 230, /* [unit of the input] in force now */
    DMB_OUTPUT_INPUT_RATE = 231, /* [unit of the input/s] of that */
    DMB_OUTPUT_INPUT_VALUE = 232, /* [unit of the input] set point */
    /* place.part a joint: dmb_query_joint; six each but for the last three */
    DMB_OUTPUT_JOINT_POSITION = 300, DMB_OUTPUT_JOINT_SPEED = 310, DMB_OUTPUT_JOINT_ACCELERATION = 320, /* [m, rad]; 1/s; 1/s2 */
    DMB_OUTPUT_JOINT_REACTION = 330, DMB_OUTPUT_JOINT_REACTION_BODY = 340, /* [N, N m] world; (_BODY) frame b */
    DMB_OUTPUT_JOINT_ACTION = 350, /* [N, N m] */ DMB_OUTPUT_JOINT_VIOLATION = 360, /* [m, -] */
    DMB_OUTPUT_JOINT_STATE = 361, DMB_OUTPUT_JOINT_ROWS = 362, /* [-] DMB_JOINT_...; equations it holds now */
    DMB_OUTPUT_MULTIPLIER = 370, /* [N, ...] number 0 .. 5 of a joint, coupling, constraint or joint drive; six */
    DMB_OUTPUT_REACTION = 380, /* [N, N m] of a string or body: dmb_query_reaction; six */
    /* any place; six each */
    DMB_OUTPUT_SECTION_FORCE = 400, /* [N, N m] dmb_query_section */ DMB_OUTPUT_SECTION_STRAIN = 410, /* [-, rad/m] */
    DMB_OUTPUT_WORLD_VELOCITY = 420, DMB_OUTPUT_BODY_VELOCITY = 440, /* [m/s, rad/s] dmb_query_motion */
    DMB_OUTPUT_WORLD_ACCELERATION = 430, DMB_OUTPUT_BODY_ACCELERATION = 450, /* [m/s2, rad/s2] */
    /* Small motion of any place about the state of a linear analysis, six each; along world axes or (_BODY) those of the section,
     * which turn with it in a state that spins unless the `axes` of the analysis are at rest. Not in runs: take DISPLACEMENT,
     * WORLD_ and BODY_VELOCITY there. */
    DMB_OUTPUT_VIBRATION = 460, DMB_OUTPUT_VIBRATION_BODY = 470, /* [m, rad] displacement from the state */
    DMB_OUTPUT_VIBRATION_VELOCITY = 480, DMB_OUTPUT_VIBRATION_VELOCITY_BODY = 490, /* [m/s, rad/s] its rate */
    DMB_OUTPUT_VIBRATION_ACCELERATION = 500, DMB_OUTPUT_VIBRATION_ACCELERATION_BODY = 510, /* [m/s2, rad/s2] */
    DMB_OUTPUT_PROFILE = 1000, /* + DMB_PROFILE_...: at a place of a string; as dmb_query_profile, NaN included */
    /* of a window, place.pipe the number of the watched output; in recorders with a window only */
    DMB_OUTPUT_WINDOW_MINIMUM = 2000, DMB_OUTPUT_WINDOW_MAXIMUM = 2001, DMB_OUTPUT_WINDOW_MEAN = 2002, /* [its unit] */
    DMB_OUTPUT_WINDOW_RMS = 2003, /* [its unit] */
    DMB_OUTPUT_STICK_SLIP_INDEX = 2004, DMB_OUTPUT_WINDOW_LOW_SHARE = 2005 /* [-] index, low_share of dmb_window_result */
};
/* clang-format on */
/* [unit of the output] The present value. Errors: those of the query behind it, DMB_ERR_VALUE for an unknown quantity or a
 * multiplier that is not there, DMB_ERR_UNSUPPORTED for a string without the part it needs (a bit, a rock law, a flexible first
 * pipe) and for outputs of a window. */
DMB_API int32_t dmb_query_output(const dmb_sim *sim, const dmb_output *output, double *value);
/* The same as a number, of one DMB_OUTPUT_...; NaN where it fails, dmb_sim_message and dmb_last_error say why. Example:
 * dmb_sim_value(sim, DMB_OUTPUT_DRIVE_FORCE, (dmb_place){.part = drive}). */
DMB_API double dmb_sim_value(const dmb_sim *sim, int32_t quantity, dmb_place place);
/* "bit_speed", and its unit in *unit (may be NULL); NULL for a number that is none. Names do not change. */
DMB_API const char *dmb_output_name(int32_t quantity, const char **unit);
/* The number of a name; DMB_ERR_VALUE where it is none. */
DMB_API int32_t dmb_output_quantity(const char *name, int32_t *quantity);
/* All numbers that have a name, ascending: the one after `quantity`, -1 before the first; -1 after the last. */
DMB_API int32_t dmb_output_next(int32_t quantity);
/* "drive_force of drive table [N m]", "axial_force of string main pipe 3 at 0.5 [N]": into the caller's text of `size` [byte],
 * ends with 0; 128 suffice. sim may be NULL: parts by their numbers. Errors: DMB_ERR_TOO_LARGE (room). */
DMB_API int32_t dmb_output_text(const dmb_sim *sim, const dmb_output *output, char *text, uint32_t size);
/* Checks this sim for each output; dmb_sim_message: the first missing one and a valid place. Errors as dmb_query_output. */
DMB_API int32_t dmb_output_check(dmb_sim *sim, const dmb_output *outputs, uint32_t output_count);

/* ---- A window over outputs ----------------------------------------------------------------------------------------
 * Minimum, maximum and mean of outputs over the last `length` seconds of a run, in memory that does not grow: time is divided
 * into slots, and the oldest slot is dropped as a whole. Means are by time, with straight lines between samples. The stick-slip
 * index of the bit speed and the off-bottom share are numbers of such windows. */
typedef struct dmb_window_options {
    uint32_t struct_size, slots; /* [-] 2 .. 65536; the window covers (slots - 1)/slots to all of `length`; default 100 */
    double length; /* [s] >= 0; 0 (default): all since the first sample */
    const double *levels; /* [unit of the output] of low_share, shape (output_count), >= 0; NULL (default): 0 */
} dmb_window_options;
DMB_SIZED_STRUCT(dmb_window_options)
typedef struct dmb_window_result {
    uint32_t struct_size, reserved;
    uint64_t samples; /* [-] in the window */
    double time; /* [s] that it spans; 0 with one sample: means are the sample then */
    double minimum, maximum; /* [unit of the output] of the samples, NaN without one, as are the members below */
    double mean, rms; /* [unit of the output] over time; root of the mean of the squares over time */
    double index; /* [-] (maximum - minimum)/(2 |mean|): of the bit speed the stick-slip index, 1 where the bit comes to rest; 0
        where nothing varies, infinite about a mean of 0 */
    double low_share; /* [-] of the time, |value| <= its level, by the sample at the end of each interval */
} dmb_window_result;
DMB_SIZED_STRUCT(dmb_window_result)
/* outputs, shape (output_count), 1 .. 4096, are copied. Memory from the model's allocator: 48 bytes per output and slot. options
 * may be NULL. Errors: those of dmb_output_check, DMB_ERR_VALUE, _NOT_FINITE, _NO_MEMORY; *window is NULL then. */
DMB_API int32_t dmb_window_create(dmb_sim *sim, const dmb_window_options *options, const dmb_output *outputs,
                                  uint32_t output_count, dmb_window **window);
/* Takes a sample; call it after each step. A second one at the same time is ignored; DMB_ERR_ORDER for an earlier time:
 * dmb_window_reset; _NOT_FINITE (an output). The sim may be another one of the same model. Allocates nothing. O(outputs). */
DMB_API int32_t dmb_window_take(dmb_window *window, const dmb_sim *sim);
/* O(slots). DMB_ERR_NULL, _HANDLE, _STRUCT_SIZE, _VALUE (no such output). */
DMB_API int32_t dmb_window_get(const dmb_window *window, uint32_t output, dmb_window_result *result);
/* Forgets all samples. */
DMB_API int32_t dmb_window_reset(dmb_window *window);
/* Sets *window to NULL. NULL-safe. */
DMB_API void dmb_window_destroy(dmb_window **window);

/* ---- Profiles over time -------------------------------------------------------------------------------------------
 * Rows of whole profiles, at a coarser rate, in the caller's memory. */
typedef struct dmb_profile_recorder {
    uint32_t struct_size, reserved;
    const dmb_profile *profile; /* quantities of a row, without `values` and strides; the caller's, kept alive and unchanged */
    double *table; /* time [s], then quantity q at station i at 1 + i quantity_count + q; (capacity, 1 + stations quantities) */
    uint64_t capacity, row_count; /* [-] rows of table; rows written, start with 0 */
    double interval; /* [s] between rows, 0: every call */
} dmb_profile_recorder;
DMB_SIZED_STRUCT(dmb_profile_recorder)
/* As dmb_recorder_take, with the errors of dmb_query_profile. */
DMB_API int32_t dmb_profile_recorder_take(dmb_profile_recorder *recorder, const dmb_sim *sim);
/* CSV, a line for each row and station: time [s], station, then the quantities with their units. DMB_ERR_IO. */
DMB_API int32_t dmb_profile_recorder_write_csv(const dmb_profile_recorder *recorder, const char *path);
DMB_C_END
#endif
