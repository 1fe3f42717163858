// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/realtime_replay.h"

#include "apps/binding/open_hand.h"
#include "apps/binding/raw_path.h"
#include "apps/binding/spooled_camera.h"
#include "apps/replay/replay_report.h"
#include "apps/session/path_hand.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/frame.h"
#include "engine/types/log.h"

namespace fathom {

// Measures the time from a live frame's exposure to its published set.
class RealtimeReplay::Feed final : public SessionFeed {
public:
    using SessionFeed::SessionFeed;

    void publish(double t, PublishedFrame& out) override {
        SessionFeed::publish(t, out);
        if (const auto taken = captured()) {
            using Millis = std::chrono::duration<float, std::milli>;
            exposureMs.push_back(Millis(out.report.times.published - *taken).count());
        }
    }

    std::vector<float> exposureMs;
};

RealtimeReplay::RealtimeReplay(Session& session, const ReplayOptions& options, ReplayRecorder& recorder,
                               const ThreadPlacement& placement, CadenceTrace* trace)
    : ReplayParts(session, options, recorder)
    , placement_(placement)
    , faults_(recorder.folder(), haptics_.period, *this)
    , observers_(options.observers, session.arm.get())
    , feed_(std::make_unique<Feed>(session, [this](const std::vector<Shape>& shapes) { takeShapes(shapes); }))
    , run_(std::make_unique<RealtimeRun>(*feed_, session.contacts(), runOptions(trace))) {
    observers_.setShapes(shapes_);
    if (options.source.empty() && session.scene.source.kind == CameraSource::Kind::Simulated) {
        spool();
    }
}

RealtimeReplay::~RealtimeReplay() = default;

// Frame thread. The first frame comes before the run exists; the scene then already has that frame's shapes.
void RealtimeReplay::takeShapes(const std::vector<Shape>& shapes) {
    if (run_) {
        run_->setShapes(shapes);
    }
    observers_.setShapes(shapes);
}

RealtimeOptions RealtimeReplay::runOptions(CadenceTrace* trace) {
    RealtimeOptions o;
    o.placement = placement_;
    o.hapticPeriod = haptics_.period;
    o.framePeriod = options_.frameRate > 0.0 ? 1.0 / options_.frameRate : kLockstepFramePeriod;
    o.trace = trace;
    o.arm = session_.realArm ? &session_.realArm->link() : nullptr;
    o.progress = [this](double t, uint64_t frames) { progress_.update({frames, 0, t}); };
    return o;
}

// Uses all CPUs, because no other thread runs yet. Placed shapes use no pixel, so one frame is enough.
void RealtimeReplay::spool() {
    if (session_.scene.source.showsArm) {
        log::warn("the simulated camera's frames are taken beforehand: they do not show the arm");
    }
    const CpuConfinement everywhere(placement_.all);
    const uint32_t all = session_.scene.source.images;
    const std::optional<uint32_t> still = session_.scene.hasPoints() ? std::nullopt : std::optional(all);
    bool noted = false;
    const Clock::time_point begun = Clock::now();
    session_.camera = std::make_unique<SpooledCamera>(
        std::move(session_.camera), recorder_.folder(), signals_.requested(),
        [&](uint64_t frames) {
            progress_.update({.framesDone = frames});
            if (const std::string notice = spoolNotice(frames, all, secondsSince(begun));
                !noted && !still && !notice.empty()) {
                log::warn("{}", notice);
                noted = true;
            }
        },
        still);
}

ReplayRecorder::Ending RealtimeReplay::run() {
    if (session_.realArm) {
        feed_->armAtCapture(session_.awaitArm(signals_.requested()));
    }
    session_.requireFrame(run_->firstFrame());
    const HandPath path = session_.path();
    if (session_.liveHand) {
        runLive(path);
    } else {
        const std::unique_ptr<HapticDevice> hand =
            openPathHand(path, session_.scene, options_.yields(session_.scene));
        makeCycle(hand->read(0.0).deviceThandle, nullptr);
        run_->run(*cycle_, *hand, path.duration(), faults_, signals_.requested());
    }
    progress_.finish();
    figures_.wokenLateMicros = percentilesOf(std::move(wokenLateMicros_));
    figures_.framesLost = session_.camera->live() ? session_.camera->lost() : run_->framesLost();
    figures_.exposureMs = percentilesOf(std::move(feed_->exposureMs));
    figures_.live = session_.camera->live();
    figures_.periodsMissed = run_->periodsMissed();
    figures_.staleTicks = run_->staleTicks();
    figures_.recordsLost = run_->recordsLost();
    figures_.renewals = session_.cycles.renewals();
    figures_.stopped = signals_.requested().load();
    if (figures_.stopped) {
        recorder_.warnings().add("signal", "ended by a signal at " + decimal(lastTick_) + " s of the run");
    }
    return ending();
}

// The tool starts where the scene's path starts, wherever the hand is.
void RealtimeReplay::runLive(const HandPath& path) {
    LiveHand& hand = *session_.liveHand;
    awaitHand(hand, signals_.requested(), options_.seconds);
    const Pose start = startOf(path, session_.scene);
    makeCycle(hand.read(0.0).deviceThandle, &start);
    watched_.emplace(hand);
    run_->run(*cycle_, *watched_, options_.seconds, faults_, signals_.requested());
}

ReplayRecorder::Ending RealtimeReplay::ending() {
    ReplayRecorder::Ending ending(session_, *cycle_);
    ending.exposureMs = figures_.live ? std::optional(figures_.exposureMs) : std::nullopt;
    if (audited_ && figures_.recordsLost == 0) {
        ending.maxPenetration = audit_.figures().maxPenetration();
        ending.maxEscapeDepth = audit_.figures().maxEscapeDepth();
        ending.linkPenetration = audit_.linkPenetration();
    }
    ending.lockstep = false;
    if (const PublishedFrame* last = run_->lastFrame()) {
        ending.colour = last->colour;
        ending.lastSet = &last->fixtures;
    }
    return ending;
}

void RealtimeReplay::rethrowFailure() const {
    if (run_->failure()) {
        std::rethrow_exception(run_->failure());
    }
}

void RealtimeReplay::frame(const PublishedFrame& frame, const HostFixtures& set) {
    recorder_.frame(frame.report, frame.t, set, frame.colour);
    figures_.framesInPlace += frame.report.inPlace ? 1 : 0;
    observers_.frame(set);
}

void RealtimeReplay::query(const QueryNote& note) {
    recorder_.query(note.micros);
}

void RealtimeReplay::step(const TickRow& row, const ObeyedSet& obeyed) {
    wokenLateMicros_.push_back(static_cast<float>(row.wokenLate * 1e6));
    recorder_.tick(row);
    lastTick_ = row.record.t;
    observers_.step(row);
    if (const std::string change = watched_ ? watched_->change() : ""; !change.empty()) {
        log::warn("{}", change);
    }
    audit(row, obeyed);
    if (obeyed.frame != nullptr && recorder_.wantsMoment()) {
        recorder_.moment(obeyed.frame->fixtures, obeyed.frame->colour);
    }
}

void RealtimeReplay::audit(const TickRow& row, const ObeyedSet& obeyed) {
    if (!session_.cycles.plan().spheres) {
        return;
    }
    audited_ = audited_ && obeyed.known;
    if (row.placed) {
        audit_.retake();
    }
    if (obeyed.frame != nullptr && audited_) {
        audit_.tick(obeyed.frame->fixtures, obeyed.frame->grid, row.start,
                    {row.record.tool, row.record.arm.posture}, obeyed.behind);
    }
}

} // namespace fathom
