// SPDX-License-Identifier: Apache-2.0
// summary.json: the whole run in one object, and the values from which it is written.
#pragma once

#include "apps/replay/percentiles.h"
#include "engine/types/pose.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

class TickTotals;

// An empty optional and a number that is not finite are both written as null, because an unmeasured value is
// unknown, not zero.
struct ReplaySummary {
    struct Frames {
        uint64_t count = 0;          // processed frames, static ones included
        uint64_t skipped = 0;        // count + skipped = lines of associations.txt
        std::optional<double> first; // [s] from the start of the program to the first fixture set
        Percentiles gpuMs, uploadMs, latencyMs;
        std::optional<Percentiles> exposureMs; // live cameras: start of exposure to published set
        Percentiles answerableMs; // of new sets: start of the upload to the first possible contact answer
    } frames;

    struct Haptic {
        uint64_t ticks = 0, late = 0;
        Percentiles stepMicros;
        uint64_t stalledTicks = 0, trappedTicks = 0, escapeTicks = 0, waitingTicks = 0;
        uint32_t regionsVanished = 0;     // times that regions disappeared while they pressed
        std::optional<double> indexShift; // [m] net displacement of the hand map
        uint64_t notFiniteTicks = 0;      // ticks without force because a number was not finite
        std::optional<double> maxPenetration, maxEscapeDepth;       // [m] from the penetration audit
        double maxForce = 0.0, maxTorque = 0.0, maxForceStep = 0.0; // [N], [N m], [N]
        std::optional<double> stiffness, rotationalStiffness;       // [N/m], [N m/rad]
        std::optional<double> marginPassiveMin, marginUncoupledMin;
        std::optional<double> solvesMean; // linearisations per tick
        uint64_t infeasible = 0;          // ticks with an infeasible solve

        // Fills in what the ticks alone determine; audit and stiffness stay as they are.
        void take(TickTotals totals);
    } haptic;

    struct Contact {
        uint64_t queries = 0, spheresMax = 0, overflows = 0;
        Percentiles queryMicros;
        std::string where = "none"; // cpu, gpu, none
    } contact;

    struct FixtureRow { // in scene order
        std::string name;
        std::string role;                                           // forbidden, guidance
        std::optional<double> pointsMean, spheresMean, patchesMean; // per frame, zeros included
    };
    std::vector<FixtureRow> fixtures;

    struct GuidanceRow { // from the last frame with at least min_count points
        std::string name;
        std::optional<dvec3> position; // [m] base frame, mean of the points
        std::optional<dvec3> normal;   // unit vector towards the camera; empty when the points are not planar
        std::optional<Pose> target;    // base_T_tool
        uint64_t count = 0;
    };
    std::vector<GuidanceRow> guidance;

    struct Arm {
        struct Joint {
            std::string name;
            double lower, upper, speed;  // limits: [rad] or [m], [rad/s] or [m/s]
            double least, most, fastest; // reached in the run
        };
        std::vector<Joint> joints;            // base to tip
        std::vector<std::string> description; // of describeArm()
        struct Link {
            std::string name;
            uint64_t leaves = 0;
            std::optional<double> penetration; // [m] largest depth beyond the allowance; empty = not audited
        };
        std::vector<Link> links;
        uint64_t leaves = 0;
        double limitViolation = 0.0; // largest violation of a position or speed limit [rad], [m]
        Percentiles residual;        // [m] part of the hand's motion that the arm cannot follow
        uint64_t limitedTicks = 0, singularTicks = 0, graspHeldTicks = 0, flips = 0;
        struct Driven { // a real arm that follows
            std::string description, lastState;
            std::vector<std::pair<std::string, uint64_t>> ticks; // in each state of armStateName()
            uint64_t damaged = 0, reopened = 0; // damaged frames; times that the line reopened
            double oldest = 0.0;                // [s] largest age of the feedback used
            Percentiles tipLag; // [m] distance of the measured tip from the tool while the arm follows
        };
        std::optional<Driven> driven; // empty = no real arm
    };
    std::optional<Arm> arm; // empty = the tool moves freely

    std::string device;
    bool lockstep = true;
    std::string digest;                // hexadecimal
    std::vector<std::string> warnings; // protection that the run did not give, a sentence each
};

// The text of summary.json. Keys and their order are part of the contract of `replay --out`.
std::string toJson(const ReplaySummary& summary);

} // namespace fathom
