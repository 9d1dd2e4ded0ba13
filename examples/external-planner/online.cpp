// An external in-loop planner in C++17, without libraries: flies to the goal in a straight line, and stops before the first
// obstacle that it knows.
//
//     c++ -std=c++17 -O2 -o online online.cpp
//     harness run online.toml --planner-command ./online --in-loop
//
// The protocol is described in docs/external-planners.md. Standard output holds replies only; write logs to std::cerr.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "json.hpp"

using Point = std::array<double, 3>;

struct Disc {  // a cylinder of the world, or a moving obstacle
    double x, y, radius;
};
using Polygon = std::vector<std::array<double, 2>>;  // corners of a prism, counterclockwise

struct Vehicle {
    Point goal;
    double room, speed, acceleration;
    std::vector<Disc> discs;  // obstacles known so far
    std::vector<Polygon> polygons;
};

constexpr double STEP = 0.1;  // spacing of the points that are tested along the line, m

Point point(const Json& json) { return {json[0].number(), json[1].number(), json[2].number()}; }

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

// Distance from a point of the plane to a convex polygon, m; 0 inside.
double distance(const Point& p, const Polygon& corners) {
    double best = INFINITY;
    bool inside = true;
    for (size_t k = 0; k < corners.size(); ++k) {
        const auto &a = corners[k], &b = corners[(k + 1) % corners.size()];
        const double ux = b[0] - a[0], uy = b[1] - a[1], px = p[0] - a[0], py = p[1] - a[1];
        const double share = std::clamp((px * ux + py * uy) / (ux * ux + uy * uy), 0.0, 1.0);
        best = std::min(best, std::hypot(px - share * ux, py - share * uy));
        inside = inside && ux * py - uy * px >= 0;
    }
    return inside ? 0 : best;
}

// Adds the cylinders and prisms of `world` or `added` to what a vehicle knows.
void learn(Vehicle& vehicle, const Json& obstacles) {
    for (const Json& it : obstacles["cylinders"].items()) {
        vehicle.discs.push_back({it["center_m"][0].number(), it["center_m"][1].number(), it["radius_m"].number()});
    }
    for (const Json& it : obstacles["prisms"].items()) {
        Polygon corners;
        for (const Json& corner : it["corners_m"].items()) corners.push_back({corner[0].number(), corner[1].number()});
        vehicle.polygons.push_back(corners);
    }
}

bool is_free(const Vehicle& vehicle, const Json& moving, const Point& p) {
    const auto clear = [&](double x, double y, double radius) {
        return std::hypot(p[0] - x, p[1] - y) > radius + vehicle.room;
    };
    for (const Disc& disc : vehicle.discs) {
        if (!clear(disc.x, disc.y, disc.radius)) return false;
    }
    for (const Json& it : moving.items()) {
        if (!clear(it["position_m"][0].number(), it["position_m"][1].number(), it["radius_m"].number())) return false;
    }
    return std::all_of(vehicle.polygons.begin(), vehicle.polygons.end(),
                       [&](const Polygon& polygon) { return distance(p, polygon) > vehicle.room; });
}

std::string node(double t, const Point& p, const Point& v) {
    char text[400];
    std::snprintf(text, sizeof text,
                  R"({"t_s": %.17g, "position_m": [%.17g, %.17g, %.17g], "velocity_mps": [%.17g, %.17g, %.17g]})",
                  t, p[0], p[1], p[2], v[0], v[1], v[2]);
    return text;
}

// Nodes from rest to rest along a line: speed up, cruise, brake.
std::string ramp(const Point& start, const Point& end, double t0, const Vehicle& vehicle) {
    const double length = distance(start, end), a = vehicle.acceleration;
    const double v = std::min(vehicle.speed, std::sqrt(a * length));
    std::vector<std::array<double, 3>> along = {  // time, distance, speed
        {0, 0, 0}, {v / a, v * v / 2 / a, v}, {length / v, length - v * v / 2 / a, v}, {length / v + v / a, length, 0}};
    if (along[2][0] - along[1][0] < 1e-6) along.erase(along.begin() + 2);
    std::string nodes;
    for (const auto& [t, d, speed] : along) {
        Point p, velocity;
        for (int axis = 0; axis < 3; ++axis) {
            const double unit = (end[axis] - start[axis]) / length;
            p[axis] = start[axis] + d * unit;
            velocity[axis] = speed * unit;
        }
        nodes += (nodes.empty() ? "" : ", ") + node(t0 + t, p, velocity);
    }
    return "\"fly\": [" + nodes + "]";
}

// A new reference once the one in force is flown, as far towards the goal as the way is free.
std::string reply(const Json& request, const Vehicle& vehicle) {
    const Json& last = request["in_force"].items().back();
    const Point here = point(last["position_m"]);
    const double length = distance(here, vehicle.goal);
    if (request["t_s"].number() < last["t_s"].number() || length < 0.01) {
        return R"("keep": "the reference is still valid")";
    }
    Point end = here;
    const int steps = static_cast<int>(length / STEP);
    for (int k = 1; k <= steps + 1; ++k) {
        const double share = k <= steps ? k * STEP / length : 1.0;
        Point next;
        for (int axis = 0; axis < 3; ++axis) next[axis] = here[axis] + (vehicle.goal[axis] - here[axis]) * share;
        if (!is_free(vehicle, request["moving"], next)) break;
        end = next;
    }
    if (end == here) return R"("keep": "an obstacle is in the way")";
    return ramp(here, end, request["takes_effect_s"].number(), vehicle);
}

int main() {
    std::map<std::string, Vehicle> vehicles;
    for (std::string line; std::getline(std::cin, line);) {
        const Json request = Json::parse(line);
        const std::string& kind = request["request"].text();
        if (kind == "end") break;
        if (kind == "begin") {
            for (const Json& it : request["vehicles"].items()) {
                const Json& limits = it["planning_limits"];
                Vehicle vehicle{point(it["goal"]["position_m"]), it["body_radius_m"].number() + 0.2,
                                limits["speed_mps"].number(), limits["acceleration_mps2"].number(), {}, {}};
                learn(vehicle, request["world"]);
                vehicles[it["name"].text()] = vehicle;
            }
            continue;
        }
        Vehicle& vehicle = vehicles.at(request["vehicle"].text());
        learn(vehicle, request["added"]);
        std::printf("{\"id\": %.0f, %s}\n", request["id"].number(), reply(request, vehicle).c_str());
        std::fflush(stdout);
    }
}
