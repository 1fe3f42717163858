// SPDX-License-Identifier: Apache-2.0
// Takes everything a replay produces, as it comes, and leaves the files of the output contract.
#pragma once

#include "apps/replay/arm_report.h"
#include "apps/replay/frames_csv.h"
#include "apps/replay/haptics_csv.h"
#include "apps/replay/summary.h"
#include "apps/replay/tick_totals.h"
#include "apps/replay/trace_history.h"
#include "apps/session/session.h"
#include "engine/contact/query_loop.h"
#include "engine/contact/tool.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/cycle/haptic_cycle.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace fathom {

// One thread. Files appear at finish(); an exception before it leaves those of an earlier run untouched.
class ReplayRecorder {
public:
    // fixture sets are saved as fixtures/NNNNNN.ply when saveFixtures. Throws Error that names what cannot be
    // written. realArm: what follows the arm, in words; empty = nothing does.
    ReplayRecorder(std::filesystem::path out, const Scene& scene, std::vector<std::string> passes,
                   bool saveFixtures, const ArmRig* arm = nullptr, const std::string& realArm = "");

    // A used frame, at t [s] of the run, with the set it made; unchanged frames too.
    void frame(const FrameReport& report, double t, const Fixtures& set);
    void tick(const TickRecord& tick);
    // overlay.png shows the strongest moment of the run: true when the last tick was it so far, by a clear
    // margin or on a new frame; then moment() wants what the hand felt (copied) and saw.
    bool wantsMoment() const;
    void moment(const Fixtures& set, std::span<const uint32_t> colour);
    void query(double micros) { queryMicros_.push_back(static_cast<float>(micros)); }

    // What only the caller knows.
    struct Ending {
        Ending() = default;
        // All that session and cycle know at the end of a run; audit, times and last frame stay empty.
        Ending(const Session& session, const HapticCycle& cycle);

        std::optional<Percentiles> exposureMs; // [ms] live cameras: start of exposure to published set
        uint64_t skipped = 0;
        QueryStatistics contact;
        std::string where = "none";                           // cpu, gpu, none
        std::optional<double> maxPenetration, maxEscapeDepth; // [m]
        double stiffness = 0.0, rotationalStiffness = 0.0;    // [N/m], [N m/rad]
        std::string device;
        bool lockstep = true;
        std::string title;                          // scene and source
        double forceLimit = 0.0, torqueLimit = 0.0; // [N], [N m]
        CameraInfo camera;
        std::span<const uint32_t> colour; // of the last frame, for runs without any force; may be empty
        const Fixtures* lastSet = nullptr;
        std::span<const Sphere> leaves;
        std::vector<double> linkPenetration; // [m] of ToolAudit; empty = no arm, or not audited
    };
    // Writes all files and returns what summary.json says.
    ReplaySummary finish(const Ending& ending);

    const std::filesystem::path& folder() const { return out_; }

private:
    struct ClassSums {
        double points = 0.0, spheres = 0.0, patches = 0.0;
    };
    void addGuidance(const Fixtures& set);
    std::vector<ReplaySummary::FixtureRow> fixtureRows() const;
    void writeImages(const Ending& ending) const;

    std::filesystem::path out_;
    const Scene& scene_;
    bool saveFixtures_;
    HapticsCsv haptics_;
    FramesCsv frames_;
    const ArmRig* arm_;
    std::unique_ptr<ArmReport> armReport_; // null without an arm
    std::vector<std::string> passes_;
    TickTotals totals_;
    TraceHistory history_;
    TickRecord lastTick_;
    struct Moment {
        double force = 0.0; // [N]
        TickRecord tick;
        Fixtures set;
        std::vector<uint32_t> colour;
    } moment_;
    uint64_t frameCount_ = 0;
    std::vector<ClassSums> sums_; // rows of the scene
    std::vector<ReplaySummary::GuidanceRow> guidance_;
    std::vector<float> gpuMs_, uploadMs_, latencyMs_, queryMicros_;
};

} // namespace fathom
