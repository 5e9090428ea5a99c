/* The functions of FMI 3.0 for co-simulation over an instance. Types and names are those of the standard (fmi-standard.org). */
#include "fmi3_types.h"
#include "instance.h"
#include "token.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    instance_state state;
    log_t log;
    void *environment;
} component_t;

/* Say what is wrong, and return the status of a code. */
static fmi3Status status_of(component_t *c, int code)
{
    if (code == 0) {
        return fmi3OK;
    }
    if (c->log != NULL) {
        c->log(c->environment, fmi3Error, "logStatusError", instance_message(code));
    }
    return fmi3Error;
}

EXPORTED const char *fmi3GetVersion(void) { return "3.0"; }

EXPORTED fmi3Status fmi3SetDebugLogging(void *c, bool on, size_t n, const char *const categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi3OK;
}

EXPORTED void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                           bool events, bool early, const reference_t intermediate[], size_t n, void *environment,
                                           log_t log, update_t update)
{
    component_t *c;

    (void)name, (void)resources, (void)visible, (void)logging, (void)events, (void)early, (void)intermediate, (void)n, (void)update;
    if (token == NULL || strcmp(token, FMU_TOKEN) != 0 || (c = calloc(1, sizeof *c)) == NULL) {
        return NULL;
    }
    c->log = log;
    c->environment = environment;
    instance_reset(&c->state);
    return c;
}

EXPORTED void fmi3FreeInstance(void *c) { free(c); }

EXPORTED fmi3Status fmi3EnterInitializationMode(void *c, bool tolerance_defined, double tolerance, double start, bool stop_defined,
                                                double stop)
{
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
    ((component_t *)c)->state.time = start;
    ((component_t *)c)->state.phase = phase_initialising;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3ExitInitializationMode(void *c)
{
    return status_of(c, instance_begin(&((component_t *)c)->state));
}

EXPORTED fmi3Status fmi3Terminate(void *c)
{
    ((component_t *)c)->state.phase = phase_terminated;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3Reset(void *c)
{
    instance_reset(&((component_t *)c)->state);
    return fmi3OK;
}

/* The independent variable comes after all others. */
EXPORTED fmi3Status fmi3GetFloat64(void *c, const reference_t references[], size_t n, double values[], size_t n_values)
{
    instance_state *const state = &((component_t *)c)->state;
    size_t i;

    if (n_values != n) {
        return status_of(c, 1);
    }
    for (i = 0; i < n; i++) {
        if (references[i] == N_VARIABLES) {
            values[i] = state->time;
        }
    }
    for (i = 0; i < n; i++) {
        const size_t first = i;
        int code;

        while (i < n && references[i] != N_VARIABLES) {
            i++;
        }
        code = instance_get(state, references + first, i - first, values + first);
        if (code != 0) {
            return status_of(c, code);
        }
    }
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFloat64(void *c, const reference_t references[], size_t n, const double values[], size_t n_values)
{
    size_t i;
    int failed = n_values != n;

    for (i = 0; i < n && !failed; i++) {
        failed = instance_set(&((component_t *)c)->state, references[i], values[i]);
    }
    return status_of(c, failed);
}

/* There are no variables of other types. */
#define NO_VARIABLES(NAME, TYPE)                                                                                      \
    EXPORTED fmi3Status fmi3Get##NAME(void *c, const reference_t references[], size_t n, TYPE values[], size_t m)     \
    {                                                                                                                 \
        (void)references, (void)values, (void)m;                                                                      \
        return status_of(c, n != 0);                                                                                  \
    }                                                                                                                 \
    EXPORTED fmi3Status fmi3Set##NAME(void *c, const reference_t references[], size_t n, TYPE const values[], size_t m) \
    {                                                                                                                 \
        (void)references, (void)values, (void)m;                                                                      \
        return status_of(c, n != 0);                                                                                  \
    }

NO_VARIABLES(Float32, float)
NO_VARIABLES(Int8, int8_t)
NO_VARIABLES(UInt8, uint8_t)
NO_VARIABLES(Int16, int16_t)
NO_VARIABLES(UInt16, uint16_t)
NO_VARIABLES(Int32, int32_t)
NO_VARIABLES(UInt32, uint32_t)
NO_VARIABLES(Int64, int64_t)
NO_VARIABLES(UInt64, uint64_t)
NO_VARIABLES(Boolean, bool)
NO_VARIABLES(String, const char *)

EXPORTED fmi3Status fmi3GetBinary(void *c, const reference_t references[], size_t n, size_t sizes[], const uint8_t *values[], size_t m)
{
    (void)references, (void)sizes, (void)values, (void)m;
    return status_of(c, n != 0);
}

EXPORTED fmi3Status fmi3SetBinary(void *c, const reference_t references[], size_t n, const size_t sizes[],
                                  const uint8_t *const values[], size_t m)
{
    (void)references, (void)sizes, (void)values, (void)m;
    return status_of(c, n != 0);
}

EXPORTED fmi3Status fmi3GetClock(void *c, const reference_t references[], size_t n, bool values[])
{
    (void)references, (void)values;
    return status_of(c, n != 0);
}

EXPORTED fmi3Status fmi3SetClock(void *c, const reference_t references[], size_t n, const bool values[])
{
    (void)references, (void)values;
    return status_of(c, n != 0);
}

EXPORTED fmi3Status fmi3GetFMUState(void *c, void **kept)
{
    if (*kept == NULL && (*kept = malloc(sizeof(instance_state))) == NULL) {
        return fmi3Error;
    }
    memcpy(*kept, &((component_t *)c)->state, sizeof(instance_state));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3SetFMUState(void *c, void *kept)
{
    memcpy(&((component_t *)c)->state, kept, sizeof(instance_state));
    return fmi3OK;
}

EXPORTED fmi3Status fmi3FreeFMUState(void *c, void **kept)
{
    (void)c;
    free(*kept);
    *kept = NULL;
    return fmi3OK;
}

EXPORTED fmi3Status fmi3DoStep(void *c, double now, double duration, bool no_return, bool *event, bool *terminate, bool *early,
                               double *last)
{
    component_t *const own = c;
    const fmi3Status status = status_of(own, instance_advance(&own->state, now, duration));

    (void)no_return;
    *event = *terminate = *early = false;
    *last = own->state.time;
    return status;
}
