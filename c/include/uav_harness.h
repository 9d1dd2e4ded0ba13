/* The C interface of the harness: the judge as a guard, and `harness check`.
 *
 * World frame ENU (x east, y north, z up), SI units. Text is UTF-8 and ends with a zero byte; longer text is cut. Pointers
 * must not be null unless a function says so. No function throws, exits or keeps a pointer that it is given. A guard may be
 * used by one thread at a time; different guards are independent. */
#ifndef UAV_HARNESS_H
#define UAV_HARNESS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Answers. Undecided is not a pass: the margin is smaller than the error of what it is computed from. */
#define UAV_HARNESS_PASS 0
#define UAV_HARNESS_FAIL 1
#define UAV_HARNESS_UNDECIDED 2
#define UAV_HARNESS_SKIP 3
#define UAV_HARNESS_INVALID (-1) /* bad input or a bug: see the error text */

#define UAV_HARNESS_CHECKS 6

/* A state; between two of them a candidate is the cubic with their positions and velocities. */
typedef struct {
    double t_s;
    double position_m[3];
    double velocity_mps[3];
} uav_harness_knot;

/* One check. Numbers that do not exist are NaN. */
typedef struct {
    double value;  /* in `unit`; of a clearance the lower bound */
    double limit;  /* in `unit` */
    double margin; /* in `unit`, positive when the limit is kept */
    double at_s;   /* when, s */
    int32_t status;
    char check[28]; /* start.position, start.velocity, plan.clearance, plan.state_limits, plan.control_limits, plan.rest */
    char unit[16];
    char of[64]; /* the obstacle, or the limited quantity */
} uav_harness_margin;

typedef struct {
    int32_t status; /* fail if a check failed, else undecided if one is, else pass */
    int32_t checks; /* UAV_HARNESS_CHECKS */
    uav_harness_margin margins[UAV_HARNESS_CHECKS];
} uav_harness_assessment;

typedef struct uav_harness_guard uav_harness_guard;

/* A guard for one multirotor of a scenario file (or `shipped:NAME`), which knows all of its obstacles. Null if there is none;
 * `error`, of `error_size` bytes, then says why. */
uav_harness_guard *uav_harness_guard_new(const char *scenario, const char *vehicle, char *error, size_t error_size);

/* Replaces the map and the obstacles by those of another scenario file. Returns UAV_HARNESS_PASS or UAV_HARNESS_INVALID. */
int32_t uav_harness_guard_set_world(uav_harness_guard *guard, const char *scenario, char *error, size_t error_size);

/* Judges the cubics through `count` knots, after which the vehicle hovers. `measured` is the state of the vehicle now, or null.
 * Allocates nothing once a candidate of this length has been judged. Returns the status, also in `assessment`. */
int32_t uav_harness_guard_judge(uav_harness_guard *guard, const uav_harness_knot *knots, size_t count,
                                const uav_harness_knot *measured, uav_harness_assessment *assessment);

/* Ends a guard; null is nothing. */
void uav_harness_guard_free(uav_harness_guard *guard);

/* Flies and judges a plan file (.csv, .json, .parquet) for a scenario file: `harness check`. Returns the status, and in `report`
 * a report.json, to be freed by uav_harness_text_free; null if the input is invalid, which `error` explains. */
int32_t uav_harness_check(const char *scenario, const char *plan, char **report, char *error, size_t error_size);

/* Frees a report; null is nothing. */
void uav_harness_text_free(char *text);

#ifdef __cplusplus
}
#endif

#endif
