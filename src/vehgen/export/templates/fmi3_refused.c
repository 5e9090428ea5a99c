/* What a unit of FMI 3.0 for co-simulation refuses: other interfaces, clocks, events, derivatives. Importers ask for every name. */
#include "fmi3_types.h"

EXPORTED void *fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                            void *environment, log_t log)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment, (void)log;
    return NULL;
}

EXPORTED void *fmi3InstantiateScheduledExecution(const char *name, const char *token, const char *resources, bool visible, bool logging,
                                                 void *environment, log_t log, clock_t3 clock, lock_t lock, lock_t unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment, (void)log, (void)clock, (void)lock;
    (void)unlock;
    return NULL;
}

EXPORTED fmi3Status fmi3SerializedFMUStateSize(void *c, void *kept, size_t *size)
{
    (void)c, (void)kept, (void)size;
    return fmi3Error;
}

EXPORTED fmi3Status fmi3SerializeFMUState(void *c, void *kept, uint8_t data[], size_t size)
{
    (void)c, (void)kept, (void)data, (void)size;
    return fmi3Error;
}

EXPORTED fmi3Status fmi3DeserializeFMUState(void *c, const uint8_t data[], size_t size, void **kept)
{
    (void)c, (void)data, (void)size, (void)kept;
    return fmi3Error;
}

EXPORTED fmi3Status fmi3GetNumberOfVariableDependencies(void *c, reference_t reference, size_t *n)
{
    (void)c, (void)reference, (void)n;
    return fmi3Error;
}

EXPORTED fmi3Status fmi3GetVariableDependencies(void *c, reference_t dependent, size_t places[], reference_t independents[],
                                                size_t of_independents[], fmi3DependencyKind kinds[], size_t n)
{
    (void)c, (void)dependent, (void)places, (void)independents, (void)of_independents, (void)kinds, (void)n;
    return fmi3Error;
}

#define NO_DERIVATIVE(NAME)                                                                                                    \
    EXPORTED fmi3Status fmi3Get##NAME##Derivative(void *c, const reference_t unknowns[], size_t n_unknowns,                    \
                                                  const reference_t knowns[], size_t n_knowns, const double seed[],            \
                                                  size_t n_seed, double found[], size_t n_found)                               \
    {                                                                                                                          \
        (void)c, (void)unknowns, (void)n_unknowns, (void)knowns, (void)n_knowns, (void)seed, (void)n_seed, (void)found;         \
        (void)n_found;                                                                                                         \
        return fmi3Error;                                                                                                      \
    }

NO_DERIVATIVE(Directional)
NO_DERIVATIVE(Adjoint)

EXPORTED fmi3Status fmi3GetOutputDerivatives(void *c, const reference_t references[], size_t n, const int32_t orders[], double values[],
                                             size_t m)
{
    (void)c, (void)references, (void)n, (void)orders, (void)values, (void)m;
    return fmi3Error;
}

#define NO_MODE(NAME)                              \
    EXPORTED fmi3Status fmi3##NAME(void *c)        \
    {                                              \
        (void)c;                                   \
        return fmi3Error;                          \
    }

NO_MODE(EnterEventMode)
NO_MODE(EnterStepMode)
NO_MODE(EnterConfigurationMode)
NO_MODE(ExitConfigurationMode)
NO_MODE(EvaluateDiscreteStates)
NO_MODE(EnterContinuousTimeMode)

EXPORTED fmi3Status fmi3UpdateDiscreteStates(void *c, bool *again, bool *terminate, bool *nominals, bool *values, bool *timed, double *next)
{
    (void)c, (void)again, (void)terminate, (void)nominals, (void)values, (void)timed, (void)next;
    return fmi3Error;
}

EXPORTED fmi3Status fmi3ActivateModelPartition(void *c, reference_t clock, double time)
{
    (void)c, (void)clock, (void)time;
    return fmi3Error;
}

EXPORTED fmi3Status fmi3GetIntervalDecimal(void *c, const reference_t clocks[], size_t n, double intervals[], fmi3IntervalQualifier kinds[])
{
    (void)c, (void)clocks, (void)n, (void)intervals, (void)kinds;
    return fmi3Error;
}

EXPORTED fmi3Status fmi3GetIntervalFraction(void *c, const reference_t clocks[], size_t n, uint64_t counters[], uint64_t resolutions[],
                                            fmi3IntervalQualifier kinds[])
{
    (void)c, (void)clocks, (void)n, (void)counters, (void)resolutions, (void)kinds;
    return fmi3Error;
}

#define NO_CLOCK(NAME, TYPE, KIND)                                                                           \
    EXPORTED fmi3Status fmi3##NAME##Decimal(void *c, const reference_t clocks[], size_t n, KIND double values[]) \
    {                                                                                                        \
        (void)c, (void)clocks, (void)n, (void)values;                                                        \
        return fmi3Error;                                                                                    \
    }                                                                                                        \
    EXPORTED fmi3Status fmi3##NAME##Fraction(void *c, const reference_t clocks[], size_t n, KIND uint64_t counters[], TYPE resolutions[]) \
    {                                                                                                        \
        (void)c, (void)clocks, (void)n, (void)counters, (void)resolutions;                                   \
        return fmi3Error;                                                                                    \
    }

NO_CLOCK(GetShift, uint64_t, )
NO_CLOCK(SetShift, const uint64_t, const)
NO_CLOCK(SetInterval, const uint64_t, const)

EXPORTED fmi3Status fmi3CompletedIntegratorStep(void *c, bool no_return, bool *event, bool *terminate)
{
    (void)c, (void)no_return, (void)event, (void)terminate;
    return fmi3Error;
}

EXPORTED fmi3Status fmi3SetTime(void *c, double time)
{
    (void)c, (void)time;
    return fmi3Error;
}

EXPORTED fmi3Status fmi3SetContinuousStates(void *c, const double states[], size_t n)
{
    (void)c, (void)states, (void)n;
    return fmi3Error;
}

#define NO_VECTOR(NAME)                                                        \
    EXPORTED fmi3Status fmi3Get##NAME(void *c, double values[], size_t n)      \
    {                                                                          \
        (void)c, (void)values, (void)n;                                        \
        return fmi3Error;                                                      \
    }

NO_VECTOR(ContinuousStateDerivatives)
NO_VECTOR(EventIndicators)
NO_VECTOR(ContinuousStates)
NO_VECTOR(NominalsOfContinuousStates)

#define NO_COUNT(NAME)                                                         \
    EXPORTED fmi3Status fmi3GetNumberOf##NAME(void *c, size_t *n)              \
    {                                                                          \
        (void)c, (void)n;                                                      \
        return fmi3Error;                                                      \
    }

NO_COUNT(EventIndicators)
NO_COUNT(ContinuousStates)
