#include "instance.h"

#include <math.h>
#include <string.h>

static const double TIME_STEP = @DT@;      /* the longest time step [s] */
static const double LONGEST = 1e7;         /* time steps of a communication step at most */
static const double SAME = 1e-9;           /* time steps that differ by less, relatively, are one */

void instance_reset(instance_state *state)
{
    int i;

    memset(state, 0, sizeof *state);
    for (i = 0; i < MODEL_N_PARAMETERS; i++) {
        state->parameters[i] = model_default_parameters[i];
    }
    state->phase = phase_instantiated;
    state->changed = 1;
    model_reset(&state->model);
}

static int prepare(instance_state *state, double dt)
{
    if (state->changed || fabs(state->model.dt - dt) > SAME * dt) {
        const int code = model_setup(&state->model, state->parameters, dt);

        if (code != model_ok) {
            return code;
        }
        state->changed = 0;
    }
    return model_ok;
}

int instance_begin(instance_state *state)
{
    const int code = prepare(state, TIME_STEP);

    memcpy(state->left, state->heights, sizeof state->left);
    state->phase = phase_stepping;
    return code;
}

int instance_set(instance_state *state, unsigned int reference, double value)
{
    const long place = reference < N_VARIABLES ? (long)reference : N_VARIABLES;

    if (place < FIRST_DRIVE) {
        if (state->phase >= phase_stepping) {
            return 1;
        }
        state->parameters[place] = value;
        state->changed = 1;
        return 0;
    }
    if (place >= FIRST_OUTPUT) {
        return 1;
    }
    state->drives[place - FIRST_DRIVE] = value;
    if (place < FIRST_DRIVE + MODEL_N_INPUTS) {
        state->heights[place - FIRST_DRIVE] = value;
    }
    return 0;
}

int instance_get(instance_state *state, const unsigned int *references, size_t count, double *values)
{
    double drives[MODEL_N_DRIVES + 1], outputs[MODEL_N_OUTPUTS + 1];
    int known = 0;
    size_t i;

    for (i = 0; i < count; i++) {
        const long place = references[i] < N_VARIABLES ? (long)references[i] : N_VARIABLES;

        if (place < FIRST_DRIVE) {
            values[i] = state->parameters[place];
        } else if (place < FIRST_OUTPUT) {
            values[i] = state->drives[place - FIRST_DRIVE];
        } else if (place < N_VARIABLES) {
            if (!known) {
                const int code = prepare(state, state->changed ? TIME_STEP : state->model.dt);

                if (code != model_ok) {
                    return code;
                }
                memcpy(drives, state->drives, sizeof drives);
                memcpy(drives, state->heights, MODEL_N_INPUTS * sizeof(double));
                model_outputs(&state->model, drives, outputs);
                known = 1;
            }
            values[i] = outputs[place - FIRST_OUTPUT];
        } else {
            return 1;
        }
    }
    return model_ok;
}

/* Heights move at the rates that were set. A jump since the last step reaches dampers in the first time step, as its mean rate. */
int instance_advance(instance_state *state, double now, double duration)
{
    double mean[MODEL_N_DRIVES + 1];
    const double count = ceil(duration / TIME_STEP * (1.0 - SAME));
    const double dt = count == 1.0 && fabs(duration - TIME_STEP) <= SAME * TIME_STEP ? TIME_STEP : duration / count;
    double n;
    int i, code;

    if (!(duration > 0.0) || !(count <= LONGEST)) {
        return model_bad_step;
    }
    code = prepare(state, dt);
    if (code != model_ok) {
        return code;
    }
    for (n = 0.0; n < count; n += 1.0) {
        memcpy(mean, state->drives, sizeof mean);
        for (i = 0; i < MODEL_N_INPUTS; i++) {
            const double rate = state->drives[MODEL_N_INPUTS + i];

            mean[i] = state->heights[i] + 0.5 * dt * rate;
            mean[MODEL_N_INPUTS + i] = rate + (state->heights[i] - state->left[i]) / dt;
            state->heights[i] += dt * rate;
            state->left[i] = state->heights[i];
        }
        model_step(&state->model, mean);
    }
    state->time = now + duration;
    return model_check(&state->model);
}

const char *instance_message(int code)
{
    switch (code) {
    case model_bad_step:
        return "the step cannot be used, or there is no such variable to get or set now";
    case model_bad_parameter:
        return "a parameter is not finite, or the masses are none";
    case model_fixed_parameter:
        return "a parameter was changed on which the exported static equilibrium depends; export again";
    case model_not_converged:
        return "the force laws did not converge; a smaller step is needed";
    case model_diverged:
        return "the response is not finite";
    default:
        return "";
    }
}
