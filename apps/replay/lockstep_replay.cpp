// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/lockstep_replay.h"

#include "apps/output/progress.h"
#include "apps/replay/replay_report.h"
#include "apps/session/path_hand.h"
#include "engine/types/clock.h"
#include "engine/types/colour_copy.h"
#include "engine/types/error.h"
#include "engine/types/frame.h"
#include "engine/types/log.h"
#include "engine/types/median.h"

#include <algorithm>

namespace fathom {

namespace {

constexpr double kClockSlack = 1e-9; // [s] tolerance: a frame due exactly at a tick is active in that tick

} // namespace

LockstepReplay::LockstepReplay(Session& session, const ReplayOptions& options, ReplayRecorder& recorder,
                               const std::atomic<bool>& stop, CadenceTrace* trace)
    : ReplayParts(session, options, recorder)
    , stop_(stop)
    , trace_(trace)
    , clearance_(haptics_.period) {}

void LockstepReplay::notePeriod() {
    const uint32_t index = (*next_)->index;
    const double stamp = (*next_)->captureTime;
    if (index > lastIndex_ && stamp > lastStamp_ && framesDone_ > 0) {
        periods_.push_back((stamp - lastStamp_) / (index - lastIndex_));
    }
    lastIndex_ = index;
    lastStamp_ = stamp;
}

// Not one of the run's warnings: in lockstep there is nothing that --strict could ask the user to mend.
void LockstepReplay::warnOfRate() {
    constexpr size_t kLeast = 3;    // periods
    constexpr double kApart = 1.51; // factor between rates: 20 and 45 frames per second are near enough
    constexpr double kStill = 0.5;  // [s] between stills, in which no speed is recorded
    if (session_.camera->frameCount() == 0 || periods_.size() < kLeast) {
        return;
    }
    const double period = medianOf(periods_), factor = period / kLockstepFramePeriod;
    if (period > kStill) {
        return;
    }
    if (factor > kApart || factor < 1.0 / kApart) {
        log::warn("the recording has {:.3g} frames per second and is played at {:.3g}: speeds in it are "
                  "{:.3g} times those recorded",
                  1.0 / period, 1.0 / kLockstepFramePeriod, factor);
    }
}

void LockstepReplay::fetch() {
    if (session_.arm) { // a frame that shows the arm is rendered now, before it is due
        taken_ = cycle_ ? cycle_->place().arm : session_.arm->startPosture();
        if (session_.scene.source.showsArm) {
            session_.camera->showArm(session_.arm->toolAt(taken_).leaves());
        }
    }
    next_ = session_.camera->next();
    if (next_) {
        notePeriod();
        nextTime_ = ((*next_)->index - session_.camera->firstFrame()) * kLockstepFramePeriod;
        next_->retime(nextTime_);
    } else {
        scene_.sourceEnded = true;
    }
}

// Applies the pilot's edit from this frame on. New gates take effect with the frame's set, new shapes at
// once: at most one frame late.
void LockstepReplay::takeEdit(uint32_t image) {
    const SceneEdit* edit = session_.newEdit(image);
    if (edit == nullptr) {
        return;
    }
    session_.cycles.frames().setScene(edit->scene);
    shapes_ = shapesOf(edit->scene);
    if (cycle_) {
        cycle_->setShapes(shapes_);
    }
}

void LockstepReplay::processNext() {
    takeEdit((*next_)->index);
    readColours(**next_, lastColour_);
    if (session_.cycles.plan().selfFilter) { // posture when rendered, or when due
        const bool now = cycle_ && !session_.scene.source.showsArm;
        session_.cycles.frames().setArm(session_.arm->inImage(now ? cycle_->place().arm : taken_));
    }
    if (session_.allFrozen() && !retained_.empty()) {
        ready_ = session_.cycles.frames().unprocessedReport((*next_)->index);
    } else {
        ready_ = session_.cycles.frames().process(std::move(*next_));
    }
    if (trace_ != nullptr) {
        trace_->frame(*ready_);
    }
    next_.reset();
    const auto set = session_.cycles.frames().sets().newest();
    if (!ready_->unchanged) {
        retained_.push_back(std::make_unique<RetainedSet>(RetainedSet{set->host, set->grid.get()}));
    }
}

void LockstepReplay::takeDueFrames(double t) {
    while ((next_ || ready_) && nextTime_ <= t + kClockSlack) {
        if (!ready_) {
            processNext();
        }
        recorder_.frame(*ready_, nextTime_, retained_.back()->fixtures, lastColour_);
        ready_.reset();
        scene_.show(retained_.back()->fixtures);
        scene_.captureTime = nextTime_;
        published_ = true;
        ++framesDone_;
        fetch();
    }
}

bool LockstepReplay::ended(double t) const {
    const double frames = scene_.sourceEnded ? scene_.captureTime + kLockstepFramePeriod : t + 1.0;
    return t >= std::max(frames, pathStart_ + path_->duration()) - kClockSlack;
}

// A run ends with the hand's path or with its recording, whichever is later. 0 = not known beforehand.
double LockstepReplay::expectedEnd(uint64_t frames) const {
    return frames > 0
               ? std::max(static_cast<double>(frames) * kLockstepFramePeriod, pathStart_ + path_->duration())
               : 0.0;
}

void LockstepReplay::query() {
    if (published_) {
        auto answer = std::make_unique<ContactSet>();
        const auto start = Clock::now();
        session_.cycles.answer(cycle_->queryPlace(), *answer);
        recorder_.query(micros(start, Clock::now()));
        if (trace_ != nullptr) {
            trace_->query(start, Clock::now(), answer->size());
        }
        contacts_.push(std::move(answer));
        clearance_.update([this] { return session_.cycles.clearance(cycle_->place()); });
    }
    contacts_.offerDue(session_.scene.contact.delay);
}

const LockstepReplay::RetainedSet* LockstepReplay::retainedSet(uint64_t generation) const {
    const auto found = std::find_if(retained_.begin(), retained_.end(),
                                    [&](const auto& k) { return k->fixtures.generation == generation; });
    return found == retained_.end() ? nullptr : found->get();
}

void LockstepReplay::dropOldSets() {
    const ContactSet* active = contacts_.active();
    while (retained_.size() > 1 && active != nullptr &&
           retained_.front()->fixtures.generation < active->generation) {
        retained_.pop_front();
    }
}

void LockstepReplay::audit(const TickRow& row) {
    const ContactSet* active = contacts_.active();
    const RetainedSet* obeyed = active != nullptr ? retainedSet(active->generation) : nullptr;
    if (obeyed == nullptr || !session_.cycles.plan().spheres) {
        return;
    }
    std::vector<uint32_t> behind;
    active->leavesBehind(behind);
    audit_.tick(obeyed->fixtures, obeyed->grid, row.start, {row.record.tool, row.record.arm.posture}, behind);
}

void LockstepReplay::tick(double t) {
    const StepInput input = stepInput(scene_, hand_->read(std::max(0.0, t - pathStart_)), t);
    TickRow row;
    row.start = cycle_->place();
    const auto began = Clock::now();
    row.record = contacts_.step(*cycle_, input);
    row.record.clearance = clearance_.gap();
    row.micros = micros(began, Clock::now());
    row.late = row.micros > haptics_.period * 1e6;
    if (trace_ != nullptr) {
        trace_->step(began, Clock::now(), 0.0);
        trace_->file().drain();
    }
    if (row.record.adopted) {
        dropOldSets();
    }
    hand_->write(row.record.deviceWrench, haptics_.period);
    audit(row);
    recorder_.tick(row);
    if (contacts_.active() != nullptr && recorder_.wantsMoment()) {
        if (const RetainedSet* obeyed = retainedSet(contacts_.active()->generation)) {
            recorder_.moment(obeyed->fixtures, lastColour_);
        }
    }
    ++ticks_;
}

void LockstepReplay::play() {
    const uint64_t images = session_.camera->frameCount(), first = session_.camera->firstFrame();
    const uint64_t frames = images > first ? images - first : 0;
    const double total = expectedEnd(frames);
    Progress progress;
    double t = 0.0;
    for (; !ended(t) && !(ticks_ > 0 && stop_.load()); t = static_cast<double>(ticks_) * haptics_.period) {
        takeDueFrames(t);
        query();
        tick(t);
        progress.update({framesDone_, frames, t, total});
    }
    progress.finish();
    if (!ended(t)) {
        recorder_.warnings().add("signal", "ended by a signal at " + decimal(t) + " s of the run");
    }
}

ReplayRecorder::Ending LockstepReplay::run() {
    fetch();
    session_.requireFrame(next_.has_value());
    // The built-in path starts when the first set is ready; the times of a CSV path count from the start of
    // the run.
    const bool builtIn = session_.options.operatorCsv.empty() && session_.scene.hand.builtIn;
    pathStart_ = builtIn ? nextTime_ : 0.0;
    processNext(); // early, because the built-in path needs the first set; the set is active only from its
                   // own time on
    path_.emplace(session_.path());
    hand_ = openPathHand(*path_, session_.scene, options_.yields(session_.scene));
    makeCycle(hand_->read(0.0).deviceThandle, nullptr);
    play();
    warnOfRate();

    ReplayRecorder::Ending ending(session_, *cycle_);
    ending.maxPenetration = audit_.figures().maxPenetration();
    ending.maxEscapeDepth = audit_.figures().maxEscapeDepth();
    ending.colour = lastColour_;
    ending.lastSet = &retained_.back()->fixtures;
    ending.linkPenetration = audit_.linkPenetration();
    return ending;
}

} // namespace fathom
