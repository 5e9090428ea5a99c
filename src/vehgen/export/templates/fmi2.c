/* The functions of FMI 2.0 for co-simulation over an instance. Types and names are those of the standard (fmi-standard.org). */
#include "instance.h"
#include "token.h"

#include <stdlib.h>
#include <string.h>

#if defined _WIN32
#define EXPORTED __declspec(dllexport)
#elif defined __GNUC__
#define EXPORTED __attribute__((visibility("default")))
#else
#define EXPORTED
#endif

typedef void *fmi2Component;
typedef void *fmi2ComponentEnvironment;
typedef void *fmi2FMUstate;
typedef unsigned int fmi2ValueReference;
typedef double fmi2Real;
typedef int fmi2Integer;
typedef int fmi2Boolean;
typedef char fmi2Char;
typedef const fmi2Char *fmi2String;
typedef char fmi2Byte;

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum { fmi2DoStepStatus, fmi2PendingStatus, fmi2LastSuccessfulTime, fmi2Terminated } fmi2StatusKind;

typedef struct {
    void (*logger)(fmi2ComponentEnvironment, fmi2String, fmi2Status, fmi2String, fmi2String, ...);
    void *(*allocateMemory)(size_t, size_t);
    void (*freeMemory)(void *);
    void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
    fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

typedef struct {
    instance_state state;
    fmi2CallbackFunctions callbacks;
    char name[64];
} component_t;

/* Say what is wrong, and return the status of a code. */
static fmi2Status status_of(component_t *c, int code)
{
    if (code == 0) {
        return fmi2OK;
    }
    if (c->callbacks.logger != NULL) {
        c->callbacks.logger(c->callbacks.componentEnvironment, c->name, fmi2Error, "logStatusError", instance_message(code));
    }
    return fmi2Error;
}

EXPORTED const char *fmi2GetTypesPlatform(void) { return "default"; }

EXPORTED const char *fmi2GetVersion(void) { return "2.0"; }

EXPORTED fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String categories[])
{
    (void)c, (void)on, (void)n, (void)categories;
    return fmi2OK;
}

EXPORTED fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                                       const fmi2CallbackFunctions *callbacks, fmi2Boolean visible, fmi2Boolean logging)
{
    component_t *c;

    (void)resources, (void)visible, (void)logging;
    if (type != fmi2CoSimulation || guid == NULL || strcmp(guid, FMU_TOKEN) != 0 || (c = calloc(1, sizeof *c)) == NULL) {
        return NULL;
    }
    if (callbacks != NULL) {
        c->callbacks = *callbacks;
    }
    strncpy(c->name, name != NULL ? name : "", sizeof c->name - 1);
    instance_reset(&c->state);
    return c;
}

EXPORTED void fmi2FreeInstance(fmi2Component c) { free(c); }

EXPORTED fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance, fmi2Real start,
                                        fmi2Boolean stop_defined, fmi2Real stop)
{
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
    ((component_t *)c)->state.time = start;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    ((component_t *)c)->state.phase = phase_initialising;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return status_of(c, instance_begin(&((component_t *)c)->state));
}

EXPORTED fmi2Status fmi2Terminate(fmi2Component c)
{
    ((component_t *)c)->state.phase = phase_terminated;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2Reset(fmi2Component c)
{
    instance_reset(&((component_t *)c)->state);
    return fmi2OK;
}

EXPORTED fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference references[], size_t n, fmi2Real values[])
{
    return status_of(c, instance_get(&((component_t *)c)->state, references, n, values));
}

EXPORTED fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference references[], size_t n, const fmi2Real values[])
{
    size_t i;
    int failed = 0;

    for (i = 0; i < n; i++) {
        failed |= instance_set(&((component_t *)c)->state, references[i], values[i]);
    }
    return status_of(c, failed);
}

/* There are no variables of other types. */
#define NO_VARIABLES(NAME, TYPE)                                                                                              \
    EXPORTED fmi2Status fmi2Get##NAME(fmi2Component c, const fmi2ValueReference references[], size_t n, TYPE values[])        \
    {                                                                                                                         \
        (void)references, (void)values;                                                                                       \
        return status_of(c, n != 0);                                                                                          \
    }                                                                                                                         \
    EXPORTED fmi2Status fmi2Set##NAME(fmi2Component c, const fmi2ValueReference references[], size_t n, const TYPE values[])  \
    {                                                                                                                         \
        (void)references, (void)values;                                                                                       \
        return status_of(c, n != 0);                                                                                          \
    }

NO_VARIABLES(Integer, fmi2Integer)
NO_VARIABLES(Boolean, fmi2Boolean)
NO_VARIABLES(String, fmi2String)

EXPORTED fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *kept)
{
    if (*kept == NULL && (*kept = malloc(sizeof(instance_state))) == NULL) {
        return fmi2Error;
    }
    memcpy(*kept, &((component_t *)c)->state, sizeof(instance_state));
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate kept)
{
    memcpy(&((component_t *)c)->state, kept, sizeof(instance_state));
    return fmi2OK;
}

EXPORTED fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *kept)
{
    (void)c;
    free(*kept);
    *kept = NULL;
    return fmi2OK;
}

EXPORTED fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate kept, size_t *size)
{
    (void)c, (void)kept, (void)size;
    return fmi2Error;
}

EXPORTED fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate kept, fmi2Byte data[], size_t size)
{
    (void)c, (void)kept, (void)data, (void)size;
    return fmi2Error;
}

EXPORTED fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte data[], size_t size, fmi2FMUstate *kept)
{
    (void)c, (void)data, (void)size, (void)kept;
    return fmi2Error;
}

EXPORTED fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[], size_t n_unknowns,
                                                 const fmi2ValueReference knowns[], size_t n_knowns, const fmi2Real seeds[],
                                                 fmi2Real found[])
{
    (void)c, (void)unknowns, (void)n_unknowns, (void)knowns, (void)n_knowns, (void)seeds, (void)found;
    return fmi2Error;
}

EXPORTED fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference references[], size_t n,
                                                const fmi2Integer orders[], const fmi2Real values[])
{
    (void)c, (void)references, (void)n, (void)orders, (void)values;
    return fmi2Error;
}

EXPORTED fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference references[], size_t n,
                                                 const fmi2Integer orders[], fmi2Real values[])
{
    (void)c, (void)references, (void)n, (void)orders, (void)values;
    return fmi2Error;
}

EXPORTED fmi2Status fmi2DoStep(fmi2Component c, fmi2Real now, fmi2Real duration, fmi2Boolean no_return)
{
    (void)no_return;
    return status_of(c, instance_advance(&((component_t *)c)->state, now, duration));
}

EXPORTED fmi2Status fmi2CancelStep(fmi2Component c)
{
    (void)c;
    return fmi2Error;
}

EXPORTED fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value)
{
    if (kind != fmi2LastSuccessfulTime) {
        return fmi2Discard;
    }
    *value = ((component_t *)c)->state.time;
    return fmi2OK;
}

#define NO_STATUS(NAME, TYPE)                                                                               \
    EXPORTED fmi2Status fmi2Get##NAME(fmi2Component c, const fmi2StatusKind kind, TYPE *value)              \
    {                                                                                                       \
        (void)c, (void)kind, (void)value;                                                                   \
        return fmi2Discard;                                                                                 \
    }

NO_STATUS(Status, fmi2Status)
NO_STATUS(IntegerStatus, fmi2Integer)
NO_STATUS(BooleanStatus, fmi2Boolean)
NO_STATUS(StringStatus, fmi2String)
