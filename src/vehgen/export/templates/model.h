/* A road vehicle in the pitch plane, stepped by average-acceleration Newmark. Written by vehgen @VERSION@.
 *
 * SI units; z up, pitch nose-down, travels and forces of springs positive in compression; motions count from static equilibrium.
 * Drives are, in order: the displacement inputs (heights of the road under the axles, of the ground ends of links), the rates of these
 * inputs, the applied forces. A step takes their mean over the step, the outputs their values at the instant.
 */
#ifndef @PREFIX@_H
#define @PREFIX@_H

#ifdef __cplusplus
extern "C" {
#endif

@COUNTS@
@SIZES@

/* Places in the arrays of parameters, drives and outputs. */
@PLACES@

/* What the functions return. */
enum {
    @prefix@_ok = 0,
    @prefix@_bad_step = 1,         /* the time step is no positive number */
    @prefix@_bad_parameter = 2,    /* a parameter is no finite number, or the masses are none */
    @prefix@_fixed_parameter = 3,  /* a parameter was changed on which the exported static equilibrium depends: export again */
    @prefix@_not_converged = 4,    /* the forces of the laws did not converge: take a smaller step */
    @prefix@_diverged = 5          /* the state is not finite */
};

typedef struct {
    double dt;
    double parameters[@PREFIX@_ALL_PARAMETERS_LENGTH];
    double constants[@PREFIX@_CONSTANTS_LENGTH];
    double state[@PREFIX@_N_STATES];
} @prefix@_model;

extern const char *const @prefix@_parameter_names[];
extern const char *const @prefix@_parameter_units[];
extern const double @prefix@_default_parameters[];
extern const char *const @prefix@_drive_names[];
extern const char *const @prefix@_drive_units[];
extern const char *const @prefix@_output_names[];
extern const char *const @prefix@_output_units[];
extern const double @prefix@_axle_offsets[]; /* how far each axle runs behind the first [m], at the default parameters */

/* Compute what depends on parameters (NULL: the default ones) and time step [s] alone; the state stays as it is. */
int @prefix@_setup(@prefix@_model *model, const double *parameters, double dt);
/* Put the vehicle at rest in static equilibrium. */
void @prefix@_reset(@prefix@_model *model);
/* Advance by one time step under the means of the drives over it. */
void @prefix@_step(@prefix@_model *model, const double *drives);
/* Compute the outputs of the present state under the drives at this instant. */
void @prefix@_outputs(const @prefix@_model *model, const double *drives, double *outputs);
/* Return the largest change of a force law's force in the last sweep of any step since the reset [N]. */
double @prefix@_residual(const @prefix@_model *model);
/* Return whether the state can be used. */
int @prefix@_check(const @prefix@_model *model);

#ifdef __cplusplus
}
#endif

#endif
