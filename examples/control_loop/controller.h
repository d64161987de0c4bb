/* The control unit: it drills with a wanted push, sees that the bit is stuck, winds the string down, pulls it free and
 * drills on. It knows nothing of the model, only readings and commands. */
#ifndef CONTROL_LOOP_CONTROLLER_H
#define CONTROL_LOOP_CONTROLLER_H

#include "rig.h"

#define CYCLE 1e-3 /* [s] */

typedef enum phase { STARTING, DRILLING, WINDING_DOWN, PULLING, CLEARING, GIVEN_UP, PHASES } phase;

typedef struct controller {
    phase phase;
    double since;    /* [s] in this phase */
    double stalled;  /* [s] at the torque limit without turning */
    double held;     /* [m] position of the carriage when the bit got stuck */
    double most;     /* [N] hook load since the pull began */
    readings smooth; /* readings through a filter of 20 ms */
} controller;

const char *phase_name(phase p);
/* One cycle: what to command after what was read; 1 where the phase has changed. */
int controller_decide(controller *c, const readings *seen, commands *wanted);

#endif
