/* Bounds of what may be described, besides those that the public header states. They are far from any drill string, and
 * they keep every product that the compile step forms finite: no stiffness, mass or length can overflow. */
#ifndef DMB_FIELDS_BOUNDS_H
#define DMB_FIELDS_BOUNDS_H

#define DMB_LENGTH_MIN 1e-6      /* [m] of lengths and diameters that must be > 0 */
#define DMB_LENGTH_MAX 1e6       /* [m] */
#define DMB_DEPTH_MIN 1e-12      /* [m] of depths over which a force is taken up */
#define DMB_POSITION_MAX 1e9     /* [m] coordinates and measured depths; map coordinates fit in */
#define DMB_ANGLE_MAX 1e9        /* [rad] */
#define DMB_ORDER_MIN 1e-6       /* [-] periods a revolution */
#define DMB_ORDER_MAX 1e6        /* [-] */
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
#define DMB_YIELD_STRESS_MAX 1e6 /* [Pa] of mud */
#define DMB_NUMBER_MIN 1e-6      /* [-] of ratios and factors that must be > 0 */
#define DMB_NUMBER_MAX 1e6
#define DMB_RATIO_MIN 1e-12 /* [-, m/rad, rad/m] of coupled coordinates */
#define DMB_RATIO_MAX 1e12
#define DMB_STOP_MAX DMB_UNLIMITED  /* [m, rad] of stops */
#define DMB_FORCE_MAX DMB_UNLIMITED /* [N, N m, unit of a time function] */
#define DMB_ACTUATOR_TIME_MIN 1e-6  /* [s] of delays and lags of actuators */
#define DMB_DELAY_MAX 1e4           /* [s] */
#define DMB_SLIP_MAX 1e6            /* [m/s, rad/s] speeds of analyses */
#define DMB_FREQUENCY_MAX 1e9       /* [Hz] its square times a mass is far from overflow */
#define DMB_FRICTION_MAX 10.0       /* [-] coefficient of torque and drag */
#define DMB_FACTOR_MAX 1e12         /* [unit of the factor] of critical factors by default: far beyond all loads */
#define DMB_OPTION_MAX 1e300        /* of options without another bound */

enum {
    DMB_PIPE_ELEMENTS_MAX = 1024, /* of one pipe */
    DMB_PARALLEL_MAX = 64,        /* parts of a step at once */
    DMB_REFINEMENT_MAX = 40,      /* halvings beside the peaks of a response */
    DMB_STEPPED_SINE_HARMONICS_MAX = 16,
    DMB_CONSTRAINT_PLACES = 4, /* of a constraint or force of the caller */
    DMB_CONSTRAINT_ROWS = 6
};

#endif
