/* Written by vehgen @VERSION@; see the header. Names of variables are numbered: p_ parameters, q_ what follows from them, u and v
 * displacements and rates of the coordinates, M, C, K the matrices, A = 2/h M + C + h/2 K factorised, f forces of laws.
 */
#include "@prefix@.h"

#include <math.h>
#include <string.h>

@TABLES@

@HELPERS@
static void compute_constants(const double *parameters, double dt, double *constants)
{
@SETUP@
}

int @prefix@_setup(@prefix@_model *model, const double *parameters, double dt)
{
    const double *const given = parameters != NULL ? parameters : @prefix@_default_parameters;
    const int bound = @BOUND@;
    int i;

    if (!(dt > 0.0) || !isfinite(dt)) {
        return @prefix@_bad_step;
    }
    for (i = 0; i < @PREFIX@_N_PARAMETERS; i++) {
        if (!isfinite(given[i])) {
            return @prefix@_bad_parameter;
        }
        if (i < bound && (given[i] < @prefix@_default_parameters[i] || given[i] > @prefix@_default_parameters[i])) {
            return @prefix@_fixed_parameter;
        }
    }
    for (i = 0; i < @PREFIX@_N_PARAMETERS; i++) {
        model->parameters[i] = given[i];
    }@TRAVELS@
    model->dt = dt;
    compute_constants(model->parameters, dt, model->constants);
    for (i = 0; i < @PREFIX@_CONSTANTS_LENGTH; i++) {
        if (!isfinite(model->constants[i])) {
            return @prefix@_bad_parameter;
        }
    }
    return @prefix@_ok;
}

void @prefix@_reset(@prefix@_model *model)
{
    memset(model->state, 0, sizeof model->state);
}

void @prefix@_step(@prefix@_model *model, const double *drives)
{
@STEP@
}

void @prefix@_outputs(const @prefix@_model *model, const double *drives, double *outputs)
{
@OUTPUTS@
}

double @prefix@_residual(const @prefix@_model *model)
{
    (void)model;
    return @RESIDUAL@;
}

int @prefix@_check(const @prefix@_model *model)
{
    int i;

    for (i = 0; i < @PREFIX@_N_STATES; i++) {
        if (!isfinite(model->state[i])) {
            return @prefix@_diverged;
        }
    }
    return @prefix@_residual(model) > @RESIDUAL_LIMIT@ ? @prefix@_not_converged : @prefix@_ok;
}
