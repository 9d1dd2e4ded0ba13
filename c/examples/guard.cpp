// A guard in C++17: which of two candidates may be published? Prints one line per check, and exits with 0 if the answers are
// those that they should be.
//
//   c++ -std=c++17 -Ic/include c/examples/guard.cpp -o guard -Ltarget/release -luav_harness -Wl,-rpath,target/release

#include <uav_harness.h>

#include <cstdio>
#include <memory>
#include <vector>

namespace {

struct Free {
    void operator()(uav_harness_guard *guard) const { uav_harness_guard_free(guard); }
};

int judge(uav_harness_guard *guard, const char *name, const std::vector<uav_harness_knot> &candidate) {
    uav_harness_assessment assessment;
    const int status = uav_harness_guard_judge(guard, candidate.data(), candidate.size(), &candidate[0], &assessment);
    for (int i = 0; i < assessment.checks; ++i) {
        const uav_harness_margin &m = assessment.margins[i];
        std::printf("%s %-20s %d %+9.3f %s %s\n", name, m.check, m.status, m.margin, m.unit, m.of);
    }
    return status;
}

}  // namespace

int main() {
    char error[1000];
    const std::unique_ptr<uav_harness_guard, Free> guard(
        uav_harness_guard_new("shipped:paper-map", "uav-1", error, sizeof error));
    if (!guard) {
        std::fprintf(stderr, "%s\n", error);
        return 2;
    }
    const std::vector<uav_harness_knot> hover = {{0, {25, 0, 2}, {0, 0, 0}}, {5, {25, 0, 2}, {0, 0, 0}}};
    const std::vector<uav_harness_knot> rush = {{0, {25, 0, 2}, {0, 0, 0}}, {1, {-25, -3, 2}, {0, 0, 0}}};
    const bool is_right = judge(guard.get(), "hover", hover) == UAV_HARNESS_PASS &&
                          judge(guard.get(), "rush ", rush) == UAV_HARNESS_FAIL;
    return is_right ? 0 : 1;
}
