/* An instance of a co-simulation unit: the vehicle, the values of its variables, and how a communication step is made of time steps.
 *
 * Value references count parameters, then drives (road heights, their rates, forces), then outputs.
 */
#ifndef INSTANCE_H
#define INSTANCE_H

#include "model.h"

#include <stddef.h>

#define FIRST_DRIVE MODEL_N_PARAMETERS
#define FIRST_OUTPUT (FIRST_DRIVE + MODEL_N_DRIVES)
#define N_VARIABLES (FIRST_OUTPUT + MODEL_N_OUTPUTS)

enum { phase_instantiated, phase_initialising, phase_stepping, phase_terminated };

typedef struct {
    model_model model;
    double parameters[MODEL_N_PARAMETERS + 1];
    double drives[MODEL_N_DRIVES + 1];  /* as they were set last */
    double heights[MODEL_N_INPUTS + 1]; /* of the displacement inputs now */
    double left[MODEL_N_INPUTS + 1];    /* where the last step left them */
    double time;
    int phase;
    int changed; /* whether a parameter was set since the constants were computed */
} instance_state;

/* Set start values and put the vehicle at rest. */
void instance_reset(instance_state *state);
/* Begin to step: 0, or a code of model.h. */
int instance_begin(instance_state *state);
/* Set a variable: 0, or 1 where it cannot be set now. */
int instance_set(instance_state *state, unsigned int reference, double value);
/* Get variables: 0, or a code of model.h; 1 for a reference that there is not. */
int instance_get(instance_state *state, const unsigned int *references, size_t count, double *values);
/* Advance from a time by a communication step [s]: 0, or a code of model.h. */
int instance_advance(instance_state *state, double now, double duration);
/* Return what a code means. */
const char *instance_message(int code);

#endif
