/* Types of FMI 3.0 (fmi-standard.org) under names of our own. */
#ifndef FMI3_TYPES_H
#define FMI3_TYPES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined _WIN32
#define EXPORTED __declspec(dllexport)
#elif defined __GNUC__
#define EXPORTED __attribute__((visibility("default")))
#else
#define EXPORTED
#endif

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;
typedef enum { fmi3Independent, fmi3Constant, fmi3Fixed, fmi3Tunable, fmi3Discrete, fmi3Dependent } fmi3DependencyKind;
typedef enum { fmi3IntervalNotYetKnown, fmi3IntervalUnchanged, fmi3IntervalChanged } fmi3IntervalQualifier;
typedef uint32_t reference_t;
typedef void (*log_t)(void *environment, fmi3Status status, const char *category, const char *message);
typedef void (*update_t)(void *environment, double time, bool set, bool get, bool finished, bool early, bool *wanted, double *until);
typedef void (*clock_t3)(void *environment);
typedef void (*lock_t)(void);

#endif
