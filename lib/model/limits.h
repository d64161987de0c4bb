/* Bounds on what may be described, besides those that the public header states. They are far from any drill string, and
 * they keep every product that the compile step forms finite: no stiffness, mass or length can overflow. */
#ifndef DMB_MODEL_LIMITS_H
#define DMB_MODEL_LIMITS_H

#define DMB_LENGTH_MIN 1e-6      /* [m] of lengths and diameters that must be > 0 */
#define DMB_LENGTH_MAX 1e6       /* [m] */
#define DMB_DEPTH_MIN 1e-12      /* [m] of depths over which a force is taken up */
#define DMB_POSITION_MAX 1e9     /* [m] coordinates and measured depths; map coordinates fit in */
#define DMB_ANGLE_MAX 1e9        /* [rad] */
#define DMB_CURVATURE_MAX 1e6    /* [rad/m] */
#define DMB_SPEED_MIN 1e-12      /* [m/s] of regularisation speeds */
#define DMB_SPEED_MAX 1e9        /* [m/s, rad/s] */
#define DMB_ACCELERATION_MAX 1e9 /* [m/s2] of gravity */
#define DMB_TIME_MIN 1e-12       /* [s] width of a ramp */
#define DMB_TIME_MAX 1e12        /* [s] */
#define DMB_DENSITY_MIN 1e-9     /* [kg/m3] */
#define DMB_DENSITY_MAX 1e9
#define DMB_MODULUS_MIN 1e-6 /* [Pa] */
#define DMB_MODULUS_MAX 1e15
#define DMB_MASS_MIN 1e-12 /* [kg, kg/m] */
#define DMB_MASS_MAX 1e15
#define DMB_INERTIA_MIN 1e-18 /* [kg m2, kg m] */
#define DMB_INERTIA_MAX 1e18
#define DMB_STIFFNESS_MIN 1e-12 /* [N, N m2] of a section; [N/m^(n+1)] of the wall */
#define DMB_STIFFNESS_MAX 1e30
#define DMB_DAMPING_MAX 1e15     /* [N s/m2, N s] */
#define DMB_FLOW_MAX 1e6         /* [m3/s], [m2] of nozzles */
#define DMB_AREA_MIN 1e-12       /* [m2] of nozzles */
#define DMB_CONSISTENCY_MIN 1e-9 /* [Pa s^n] */
#define DMB_CONSISTENCY_MAX 1e9
#define DMB_NUMBER_MIN 1e-6 /* [-] of ratios and factors that must be > 0 */
#define DMB_NUMBER_MAX 1e6
#define DMB_RATIO_MIN 1e-12 /* [-, m/rad, rad/m] of coupled coordinates */
#define DMB_RATIO_MAX 1e12
#define DMB_STOP_MAX 1e30  /* [m, rad] of stops; as far away as that there is none */
#define DMB_FORCE_MAX 1e30 /* [N, N m, unit of a programme] */

/* [rad] largest unstressed bend of one element, as of DMB_BEAM_ROTATION_MAX */
#define DMB_REST_ROTATION_MAX 2.5

enum {
    DMB_PARTS_MAX = (1 << 24) - 1, /* of one kind: their numbers have 24 bits in an id */
    DMB_NODES_MAX = 1 << 24,       /* so that the storage of 6x6 blocks is counted in 32 bits */
    DMB_SPARSE_NODES = 6, /* nodes from which on a cluster is not solved by dense matrices: where both cost alike */
    DMB_CLUSTER_COLUMNS_MAX = 1200, /* coordinates of a cluster with dense matrices: analyses make them of any */
    DMB_CLUSTER_ROWS_MAX = 4800     /* equations on them, room for locking included */
};

#endif
