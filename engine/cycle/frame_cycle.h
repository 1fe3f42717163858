// SPDX-License-Identifier: Apache-2.0
// The frame cadence: from a frame to a published fixture set. Owns the passes and the pool of sets; knows no
// cameras or threads.
//
// Where the device answers contact queries, a set is published early, once its passes have completed
// (sets().newestEarly()). The host's copy follows: spheres, guidance, forbiddenBits and grid. Only
// sets().newest() has it. Elsewhere both are the same.
#pragma once

#include "engine/cloud/collect.h"
#include "engine/cloud/estimate_frames.h"
#include "engine/cloud/frozen_classes.h"
#include "engine/cloud/guidance_estimates.h"
#include "engine/cloud/self_filter.h"
#include "engine/cycle/frame_device.h"
#include "engine/cycle/leak_warnings.h"
#include "engine/types/clock.h"
#include "engine/types/frame.h"
#include "engine/types/thread_pool.h"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// Result of one frame.
struct FrameReport {
    uint32_t index = 0;
    bool unchanged = false; // a repeated frame (same source number): no work, only a new capture time
    bool inPlace = false;   // the device read depth in the camera's memory
    cloud::FrameCounts counts;
    uint32_t guidanceCount = 0; // pixels in guidance classes, as counted by `classify`
    double uploadMs = 0.0, publishMs = 0.0, latencyMs = 0.0; // [ms]
    double answerableMs = 0.0;     // [ms] from the start of the upload until contact queries can be answered
    std::vector<double> passMs;    // [ms] in the order of FrameCycle::passNames(); device time, zeros without
                                   // Plan::passTimes
    struct Times {                 // on the host's monotonic clock, in order
        Clock::time_point started; // of the upload
        Clock::time_point uploaded, submitted;
        Clock::time_point completed; // the device has finished
        Clock::time_point collected; // the host has the results
        Clock::time_point published; // the host's copy is complete, and its grid if any
        // Contact queries can be answered: after `completed` on a GPU, else with `published`.
        Clock::time_point answerable;
    } times;
};

// Frame thread only, except sets() and captureTime(), which any reader may call.
class FrameCycle {
public:
    // device: null is allowed if the plan has no passes. readers: largest number of leases held at once.
    // Compiles every pipeline and runs an empty frame.
    FrameCycle(gpu::Device* device, const Scene& scene, const CameraInfo& camera, const Plan& plan,
               uint32_t readers);

    // State with which a cycle on another device resumes: generations continue, positions keep their origin,
    // fixtures keep the last setScene(), and frozen classes keep their spheres.
    struct ResumeState {
        uint64_t generation = 0;
        std::optional<dvec3> origin; // [m] base frame; empty = not chosen yet
        std::optional<Scene> scene;  // empty = the scene of the constructor
        cloud::FrozenClasses frozen;
    };
    ResumeState resumeState() const { return {generation_, origin_, scene_, frozen_}; }
    void resumeFrom(const ResumeState& state); // before the first frame

    // Processes one frame from upload to publish. A camera farther than kMaxAway from the origin makes its
    // own position the origin, and drops held points as forget() does.
    FrameReport process(Frame frame);
    // Report of a frame that is not processed, because all fixtures are frozen.
    FrameReport unprocessedReport(uint32_t index) const;
    // Changes gates, radii, roles, boxes and frozen classes from the next frame on. Throws Error if the
    // number of point classes or the plan would change.
    void setScene(const Scene& scene);
    // Drops the held points of earlier frames, so that the next frame may have any time (a jump in a
    // recording). Waits for the device; no frame may be in flight.
    void forget();
    // Sets the arm's spheres for the self-filter from the next upload() on. No effect without a self-filter
    // in the plan.
    void setArm(cloud::ArmSpheres arm) { arm_ = std::move(arm); }
    // process() in steps. Frames do not overlap: with a slower camera there is nothing to upload early, and
    // with a slower device an early upload would delay the newest frame.
    void upload(Frame frame);
    void submit();
    // Waits for the device, and publishes the set early, for contact queries on the device.
    void waitForDevice();
    // Calls waitForDevice() if you did not, makes the host copy and publishes it. Needs no device after the
    // wait.
    FrameReport finish();

    cloud::FixturePool& sets() { return pool_; }
    // Capture time [s] of the newest published frame, repeated ones included.
    double captureTime() const { return captureTime_.load(std::memory_order_acquire); }

    const std::vector<std::string>& passNames() const; // empty without passes
    // [m] At this distance rounding to float32 moves a point by up to 0.1 mm (depth up to 100 m).
    static constexpr double kMaxAway = 1000.0;
    const PatchLayout& layout() const { return layout_; }
    const CameraInfo& camera() const { return camera_; }
    uint32_t dispatches() const { return dispatches_; } // in the last frame
    // For tests that compare passes with their CPU twins; only if the plan has passes.
    const cloud::WorkBuffers& work() const { return device_->work(); }

private:
    struct InFlight {
        Frame frame;
        uint32_t slot = 0;
        bool unchanged = false, completed = false;
        uint32_t valid = 0; // readings in near..far
        double uploadMs = 0.0;
        FrameReport::Times times;
        Pose pose;
        shared::FrameParams params{}; // parameters of the passes
    };

    void placeOrigin(const dvec3& origin);
    shared::FrameParams paramsAt(const dvec3& origin) const;
    void updateParams();
    void warmUp();
    void uploadArm(uint32_t slot, const dvec3& origin) const;
    void fillHost(InFlight& f);
    void copyToHost(InFlight& f);
    void describe(cloud::FixtureSet& set) const;
    void readTimes(const InFlight& f, FrameReport& report) const;

    Scene scene_;
    CameraInfo camera_;
    Plan plan_;
    PatchLayout layout_;
    cloud::FixturePool pool_;
    std::unique_ptr<FrameDevice> device_;         // null: the plan has no passes
    std::optional<cloud::SeenPoints> seenPoints_; // if the plan packs depths
    ThreadPool workers_;                          // lay out a set for the host

    cloud::ArmSpheres arm_;
    cloud::FrozenClasses frozen_;
    cloud::EstimateFrames estimateFrames_;
    cloud::GuidanceEstimates guidanceEstimates_;
    std::optional<dvec3> origin_;
    shared::FrameParams params_{};
    std::optional<InFlight> inFlight_;
    uint64_t generation_ = 0;
    std::optional<uint64_t> lastSource_;
    std::optional<double> lastCapture_; // [s]
    cloud::FrameCounts lastCounts_;
    uint32_t dispatches_ = 0;
    LeakWarnings leaks_;
    std::atomic<double> captureTime_{0.0};
};

} // namespace fathom
