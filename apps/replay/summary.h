// SPDX-License-Identifier: Apache-2.0
// summary.json: the whole run in one object, and the plain values it is made from.
#pragma once

#include "apps/replay/percentiles.h"
#include "engine/types/pose.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

class TickTotals;

// An empty optional and a number that is not finite are both written as null: what was not measured is
// unknown, not zero.
struct ReplaySummary {
    struct Frames {
        uint64_t count = 0;   // used, static ones included
        uint64_t skipped = 0; // count + skipped = lines read
        Percentiles gpuMs, uploadMs, latencyMs;
        std::optional<Percentiles> exposureMs; // live cameras: start of exposure to published set
    } frames;

    struct Haptic {
        uint64_t ticks = 0, late = 0;
        Percentiles stepMicros;
        uint64_t stalledTicks = 0, trappedTicks = 0, escapeTicks = 0;
        uint64_t notFiniteTicks = 0;                          // without force, because some number was none
        std::optional<double> maxPenetration, maxEscapeDepth; // [m], of the penetration audit
        double maxForce = 0.0, maxTorque = 0.0, maxForceStep = 0.0; // [N], [N m], [N]
        std::optional<double> stiffness, rotationalStiffness;       // [N/m], [N m/rad]
        std::optional<double> marginPassiveMin, marginUncoupledMin;
        std::optional<double> solvesMean; // linearisations a turn
        uint64_t infeasible = 0;          // turns with an infeasible solve

        // Fills what follows from the ticks alone; leaves audit and stiffness as they are.
        void take(TickTotals totals);
    } haptic;

    struct Contact {
        uint64_t queries = 0, spheresMax = 0, overflows = 0;
        Percentiles queryMicros;
        std::string where = "none"; // cpu, gpu, none
    } contact;

    struct FixtureRow { // in order of the scene
        std::string name;
        std::string role;                                           // forbidden, guidance
        std::optional<double> pointsMean, spheresMean, patchesMean; // over used frames, zeros included
    };
    std::vector<FixtureRow> fixtures;

    struct GuidanceRow { // of the last frame with at least min_count
        std::string name;
        std::optional<dvec3> position; // [m] base frame, plain mean
        std::optional<dvec3> normal;   // unit, towards the camera; empty when not planar
        std::optional<Pose> target;    // base_T_tool
        uint64_t count = 0;
    };
    std::vector<GuidanceRow> guidance;

    struct Arm {
        struct Joint {
            std::string name;
            double lower, upper, speed;  // limits [rad], [m]; [rad/s], [m/s]
            double least, most, fastest; // of the run
        };
        std::vector<Joint> joints; // base to tip
        struct Link {
            std::string name;
            uint64_t leaves = 0;
            std::optional<double> penetration; // [m] deepest beyond the allowance; empty = not audited
        };
        std::vector<Link> links;
        uint64_t leaves = 0;
        double limitViolation = 0.0; // [rad], [m] worst, of places and speeds
        Percentiles residual;        // [m] what the arm could not follow
        uint64_t limitedTicks = 0, singularTicks = 0, graspHeldTicks = 0;
        struct Driven { // a real arm that follows
            std::string description, lastState;
            std::vector<std::pair<std::string, uint64_t>> turns; // in each state of armStateName()
            uint64_t damaged = 0, reopened = 0;                  // frames; times that the line came back
            double oldest = 0.0;                                 // [s] of the feedback that was used
            Percentiles tipLag; // [m] measured tip from the tool, while it follows
        };
        std::optional<Driven> driven; // empty = nothing follows
    };
    std::optional<Arm> arm; // empty = the tool moves freely

    std::string device;
    bool lockstep = true;
    std::string digest; // hex
};

// The text of summary.json: keys and their order as the contract of `replay --out` has them.
std::string toJson(const ReplaySummary& summary);
// Throws Error that names the file.
void writeSummary(const std::filesystem::path& file, const ReplaySummary& summary);

} // namespace fathom
