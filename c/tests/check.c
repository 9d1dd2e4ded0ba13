/* The C interface with good and bad input. Every line that is wrong is printed; the exit code is their number. */

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <uav_harness.h>

static int wrong = 0;

static void expect(int is_right, const char *what) {
    if (!is_right) {
        printf("wrong: %s\n", what);
        wrong += 1;
    }
}

static void judges(void) {
    char error[1000] = "";
    uav_harness_knot knots[2] = {{0, {25, 0, 2}, {0, 0, 0}}, {4, {24.5, 0, 2}, {0, 0, 0}}};
    uav_harness_assessment judged;
    uav_harness_guard *guard = uav_harness_guard_new("shipped:paper-map", "uav-1", error, sizeof error);
    expect(guard != NULL, "a guard");
    expect(uav_harness_guard_judge(guard, knots, 2, NULL, &judged) == UAV_HARNESS_PASS, "a short step passes");
    expect(judged.checks == UAV_HARNESS_CHECKS && judged.status == UAV_HARNESS_PASS, "the assessment");
    expect(judged.margins[0].status == UAV_HARNESS_SKIP && isnan(judged.margins[0].value), "nothing was measured");
    expect(strcmp(judged.margins[2].check, "plan.clearance") == 0 && judged.margins[2].margin > 0, "the clearance");
    expect(strcmp(judged.margins[2].of, "map frame") == 0, "the nearest is the frame");
    expect(strcmp(judged.margins[3].of, "speed") == 0 || judged.margins[3].of[0] != '\0', "the limited quantity");
    expect(strcmp(judged.margins[5].unit, "m/s") == 0, "the unit");
    knots[1].position_m[0] = NAN;
    expect(uav_harness_guard_judge(guard, knots, 2, NULL, &judged) == UAV_HARNESS_FAIL, "NaN fails");
    expect(uav_harness_guard_judge(guard, NULL, 0, NULL, &judged) == UAV_HARNESS_FAIL, "nothing fails");
    expect(uav_harness_guard_judge(NULL, knots, 2, NULL, &judged) == UAV_HARNESS_INVALID, "no guard");
    expect(uav_harness_guard_set_world(guard, "nowhere.toml", error, sizeof error) == UAV_HARNESS_INVALID, "no world");
    expect(strstr(error, "nowhere.toml") != NULL, "the error names the file");
    uav_harness_guard_free(guard);
    uav_harness_guard_free(NULL);
}

static void refuses(void) {
    char error[12] = "";
    expect(uav_harness_guard_new("shipped:paper-map", "uav-9", error, sizeof error) == NULL, "no such vehicle");
    expect(strlen(error) == sizeof error - 1, "the error is cut to its room");
    expect(uav_harness_guard_new(NULL, "uav-1", error, sizeof error) == NULL, "no scenario");
    expect(uav_harness_guard_new("shipped:rendezvous-7", "uav-1", NULL, 0) == NULL, "not a multirotor");
}

static void checks(void) {
    char error[1000] = "", *report = NULL;
    FILE *file = fopen("c-interface-plan.csv", "w");
    expect(file != NULL, "a file");
    fputs("t_s,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps\n0,25,0,2,0,0,0\n60,-25,-3,2,0,0,0\n", file);
    fclose(file);
    expect(uav_harness_check("shipped:paper-map", "c-interface-plan.csv", &report, error, sizeof error) == UAV_HARNESS_FAIL,
           "a straight line through the blocks fails");
    expect(report != NULL && strstr(report, "\"plan.clearance\"") != NULL, "the report");
    uav_harness_text_free(report);
    remove("c-interface-plan.csv");
    expect(uav_harness_check("shipped:paper-map", "nowhere.csv", &report, error, sizeof error) == UAV_HARNESS_INVALID &&
               report == NULL && strstr(error, "nowhere.csv") != NULL,
           "a missing plan");
}

int main(void) {
    expect(offsetof(uav_harness_margin, check) == 36 && sizeof(uav_harness_margin) == 144, "the layout of a margin");
    expect(sizeof(uav_harness_knot) == 56 && sizeof(uav_harness_assessment) == 8 + 6 * 144, "the layouts");
    judges();
    refuses();
    checks();
    printf("%s\n", wrong == 0 ? "the C interface is right" : "the C interface is wrong");
    return wrong;
}
