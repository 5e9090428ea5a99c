/* Drive over a half-sine hump and print time and outputs as CSV: @prefix@_main [SPEED [LENGTH [HEIGHT [DURATION]]]], SI units. */
#include "@prefix@.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;
static const double HUMP_START = 0.3; /* ahead of the first axle at the beginning [m] */
static const double TIME_STEP = @DT@; /* [s] */
static const double MOST_STEPS = 1e9;

static double speed = 2.0, length = 0.5, height = 0.03, duration = 3.0;

/* Set the drives at a time: the road under every axle; the ground ends of links and the forces rest. */
static void drives_at(double time, double *drives)
{
    int i;

    for (i = 0; i < @PREFIX@_N_DRIVES; i++) {
        drives[i] = 0.0;
    }
    for (i = 0; i < @PREFIX@_N_AXLES; i++) {
        const double s = speed * time - HUMP_START - @prefix@_axle_offsets[i];

        if (s > 0.0 && s < length) {
            drives[i] = height * sin(PI * s / length);
            drives[@PREFIX@_N_INPUTS + i] = speed * height * PI / length * cos(PI * s / length);
        }
    }
}

static void print_outputs(const @prefix@_model *model, double time, const double *drives)
{
    double outputs[@PREFIX@_N_OUTPUTS + 1];
    int i;

    @prefix@_outputs(model, drives, outputs);
    printf("%.17g", time);
    for (i = 0; i < @PREFIX@_N_OUTPUTS; i++) {
        printf(",%.17g", outputs[i]);
    }
    printf("\n");
}

/* Read a whole text as a finite number; return whether it is one. */
static int read_number(const char *text, double *number)
{
    char *end;

    *number = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*number);
}

int main(int argc, char **argv)
{
    static @prefix@_model model;
    double before[@PREFIX@_N_DRIVES + 1], after[@PREFIX@_N_DRIVES + 1], mean[@PREFIX@_N_DRIVES + 1];
    double *const options[] = {&speed, &length, &height, &duration};
    const char *const names[] = {"the speed [m/s]", "the length [m]", "the height [m]", "the duration [s]"};
    long n, n_steps;
    int i, failed;

    for (i = 1; i < argc && i <= 4; i++) {
        if (!read_number(argv[i], options[i - 1])) {
            fprintf(stderr, "expected %s as a finite number, found '%s'\n", names[i - 1], argv[i]);
            return 2;
        }
    }
    if (argc > 5) {
        fprintf(stderr, "at most 4 numbers were expected: speed, length, height, duration\n");
        return 2;
    }
    if (!(speed > 0.0)) {
        fprintf(stderr, "expected a speed above 0 m/s, found %g\n", speed);
        return 2;
    }
    failed = @prefix@_setup(&model, NULL, TIME_STEP);
    if (failed || !(length > 0.0) || !(duration >= 0.0) || !(duration / TIME_STEP < MOST_STEPS)) {
        fprintf(stderr, "the vehicle or the hump cannot be used (code %d)\n", failed);
        return 2;
    }
    @prefix@_reset(&model);
    printf("t");
    for (i = 0; i < @PREFIX@_N_OUTPUTS; i++) {
        printf(",%s", @prefix@_output_names[i]);
    }
    printf("\n");
    n_steps = (long)(duration / TIME_STEP + 0.5);
    drives_at(0.0, before);
    print_outputs(&model, 0.0, before);
    for (n = 1; n <= n_steps; n++) {
        const double time = (double)n * TIME_STEP;

        drives_at(time, after);
        for (i = 0; i < @PREFIX@_N_DRIVES; i++) {
            mean[i] = 0.5 * (before[i] + after[i]);
            before[i] = after[i];
        }
        @prefix@_step(&model, mean);
        print_outputs(&model, time, after);
    }
    failed = @prefix@_check(&model);
    if (failed) {
        fprintf(stderr, "the response cannot be used (code %d)\n", failed);
    }
    return failed ? 1 : 0;
}
