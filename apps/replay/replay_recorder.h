// SPDX-License-Identifier: Apache-2.0
// Collects the results of a replay and writes the files of `replay --out`.
#pragma once

#include "apps/output/haptics_csv.h"
#include "apps/output/output_folder.h"
#include "apps/replay/arm_report.h"
#include "apps/replay/frames_csv.h"
#include "apps/replay/run_watch.h"
#include "apps/replay/summary.h"
#include "apps/replay/tick_totals.h"
#include "apps/replay/trace_history.h"
#include "apps/session/session.h"
#include "engine/contact/query_loop.h"
#include "engine/contact/tool.h"
#include "engine/cycle/frame_cycle.h"
#include "engine/cycle/haptic_cycle.h"

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

namespace fathom {

// One thread. finish() makes the files appear; after an exception before that, files of an earlier run are
// unchanged, except fixtures/ and fault files (prepareReplayFolder()).
class ReplayRecorder {
public:
    // saveFixtures: also saves fixture sets as fixtures/NNNNNN.ply. realArm: description of the real arm that
    // follows; empty = none. edits: of the recording that is replayed; outlive this; null = none. Throws
    // Error that names the file or folder that cannot be written.
    ReplayRecorder(std::filesystem::path out, const Scene& scene, const RunSource& source,
                   const std::vector<std::string>& passes, bool saveFixtures, const ArmSetup* arm = nullptr,
                   const std::string& realArm = "", const SceneEdits* edits = nullptr);

    // A processed frame at t [s] of the run with its set; also when the set is unchanged.
    void frame(const FrameReport& report, double t, const HostFixtures& set,
               std::span<const uint32_t> colour);
    void tick(const TickRow& row);
    // overlay.png shows the moment of the largest force. True when the last tick is the largest so far, by a
    // clear margin or in a new frame; then call moment() with that tick's set and image.
    bool wantsMoment() const;
    void moment(const HostFixtures& set, std::span<const uint32_t> colour);
    void query(double micros) { queryMicros_.push_back(static_cast<float>(micros)); }

    // Results that only the caller knows.
    struct Ending {
        Ending() = default;
        // Takes all that session and cycle know at the end of a run; the caller adds audit, times and last
        // frame.
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
        std::span<const uint32_t> colour; // of the last frame, used when no force occurred; may be empty
        const HostFixtures* lastSet = nullptr;
        std::span<const Sphere> leaves;
        std::vector<std::string> warnings;   // of the camera
        std::vector<double> linkPenetration; // [m] from ToolAudit; empty = no arm or no audit
    };
    // Writes all files, or none and throws; returns the content of summary.json. Removes the arm.csv and the
    // empty fixtures/ of an earlier run where this run writes none.
    ReplaySummary finish(const Ending& ending);

    RunWarnings& warnings() { return watch_.warnings(); }
    const std::filesystem::path& folder() const { return out_; }

private:
    struct ClassSums {
        double points = 0.0, spheres = 0.0, patches = 0.0;
    };
    void takeEdit(uint32_t image);
    void takeFixtures(const std::vector<FixtureClass>& fixtures);
    ReplaySummary::GuidanceRow& guidanceOf(uint32_t row);
    void addGuidance(const HostFixtures& set);
    std::vector<ReplaySummary::FixtureRow> fixtureRows() const;
    void writeImages(const Ending& ending, OutputFile& tracesFile, OutputFile& overlayFile) const;
    ReplaySummary summarise(const Ending& ending); // once

    std::filesystem::path out_;
    OutputLock lock_;
    const Scene& scene_;
    bool saveFixtures_;
    HapticsCsv haptics_;
    FramesCsv frames_;
    const ArmSetup* arm_;
    std::unique_ptr<ArmReport> armReport_; // null without an arm
    RunWatch watch_;
    TickTotals totals_;
    TraceHistory history_;
    StepRecord lastTick_;
    struct Moment {
        double force = 0.0; // [N]
        StepRecord tick;
        HostFixtures set;
        std::vector<uint32_t> colour;
    } moment_;
    uint64_t frameCount_ = 0;
    std::optional<double> first_; // [s] ReplaySummary::Frames::first
    const SceneEdits* edits_;
    const SceneEdit* edit_ = nullptr;                         // the active one
    std::vector<FixtureClass> fixtures_;                      // with edits; a class that was removed stays
    std::vector<ClassSums> sums_;                             // one per row of fixtures_
    std::map<uint32_t, ReplaySummary::GuidanceRow> guidance_; // by row of fixtures_
    std::vector<float> gpuMs_, uploadMs_, latencyMs_, answerableMs_, queryMicros_;
};

} // namespace fathom
