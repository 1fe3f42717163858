// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/frame_cycle.h"

#include "engine/cloud/frame_params.h"
#include "engine/cloud/frame_upload.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <chrono>

namespace fathom {

namespace {

// On a GPU workers spin while the passes run, for less than a millisecond. A CPU device needs the processors
// itself.
std::chrono::microseconds spinTimeOf(const Plan& plan) {
    return std::chrono::microseconds(plan.onCpu ? 100 : 1000);
}

} // namespace

FrameCycle::FrameCycle(gpu::Device* device, const Scene& scene, const CameraInfo& camera, const Plan& plan,
                       uint32_t readers)
    : scene_(scene)
    , camera_(camera)
    , plan_(plan)
    , layout_(patchLayout(camera.depth.width, camera.depth.height))
    , pool_(readers,
            [&] {
                return plan_.passes ? std::make_unique<cloud::FixtureSet>(*device, plan_, layout_)
                                    : std::make_unique<cloud::FixtureSet>();
            })
    , device_(plan_.passes ? std::make_unique<FrameDevice>(*device, plan_, layout_, camera_, pool_) : nullptr)
    , workers_(plan.publishers, spinTimeOf(plan)) {
    if (plan.packsDepths()) {
        seenPoints_.emplace(camera.depth, layout_);
    }
    if (device_) {
        warmUp();
    }
}

const std::vector<std::string>& FrameCycle::passNames() const {
    static const std::vector<std::string> kNone;
    return device_ ? device_->passNames() : kNone;
}

void FrameCycle::resumeFrom(const ResumeState& state) {
    generation_ = state.generation;
    frozen_ = state.frozen;
    if (state.scene) {
        setScene(*state.scene);
    }
    if (state.origin) {
        placeOrigin(*state.origin);
    }
}

void FrameCycle::placeOrigin(const dvec3& origin) {
    origin_ = origin; // positions stay small however far away the base frame is
    frozen_.placeOrigin(origin);
    updateParams();
}

void FrameCycle::forget() {
    if (device_) {
        device_->clearMemory();
    }
    estimateFrames_.forget();
    guidanceEstimates_.forget();
    lastSource_.reset();
    lastCapture_.reset();
}

void FrameCycle::setScene(const Scene& scene) {
    if (cloud::classFixtures(scene) != cloud::classFixtures(scene_)) {
        throw Error(
            "an active scene keeps its classes of points: only their gates, radii and roles may change");
    }
    scene_ = scene;
    updateParams();
    estimateFrames_.forget();
    guidanceEstimates_.forget();
    lastSource_.reset(); // the same frame gives a different set now
}

shared::FrameParams FrameCycle::paramsAt(const dvec3& origin) const {
    const cloud::WorkBuffers& work = device_->work();
    return cloud::sceneParams(scene_, camera_, layout_, origin, work.cellEdge, work.cellsAcross);
}

void FrameCycle::updateParams() {
    if (device_ && origin_) {
        params_ = paramsAt(*origin_);
    }
}

// Some drivers compile a pipeline at its first use, so run each one now. A frame of zero depth selects
// nothing.
void FrameCycle::warmUp() {
    device_->clearMemory();
    const std::vector<uint16_t> depth(camera_.depth.pixels(), 0);
    const std::vector<uint32_t> colour(plan_.colour ? (camera_.colourBytes() + 3) / 4 : 0, 0);
    Frame::Content content;
    content.depth = depth;
    content.raw = {camera_.colourFormat, camera_.colour.width, camera_.colour.height, {}};
    content.setColourBytes(std::as_bytes(std::span(colour)));
    constexpr uint32_t kSlot = cloud::UploadSlots::kCopied;
    cloud::uploadFrame(device_->upload(kSlot), Frame(content, nullptr), paramsAt(dvec3(0.0)));
    uploadArm(kSlot, dvec3(0.0));
    device_->submit(device_->frame(kSlot, 0));
    device_->wait();
}

void FrameCycle::uploadArm(uint32_t slot, const dvec3& origin) const {
    if (plan_.selfFilter) {
        cloud::uploadArm(device_->upload(slot), arm_, origin);
    }
}

FrameReport FrameCycle::process(Frame frame) {
    upload(std::move(frame));
    submit();
    return finish();
}

void FrameCycle::upload(Frame frame) {
    InFlight f;
    f.times.started = Clock::now();
    f.pose = frame->baseTcamera.value_or(scene_.baseTcamera);
    f.unchanged = lastSource_ == frame->sourceNumber;
    if (origin_ && !f.unchanged && glm::distance(*origin_, f.pose.position) > kMaxAway) {
        forget(); // what is held is about the old origin
        origin_.reset();
    }
    if (!origin_) {
        placeOrigin(f.pose.position);
    }
    if (!f.unchanged && device_) {
        f.slot = device_->slotFor(frame);
        cloud::setFrame(params_, f.pose, *origin_, frame->captureTime,
                        lastCapture_.value_or(frame->captureTime));
        estimateFrames_.next(params_, scene_, frame->baseTcamera, *origin_, frame->captureTime);
        cloud::uploadFrame(device_->upload(f.slot), frame, params_);
        f.params = params_;
        uploadArm(f.slot, *origin_);
    }
    lastSource_ = frame->sourceNumber;
    lastCapture_ = frame->captureTime;
    f.frame = std::move(frame);
    f.times.uploaded = Clock::now();
    f.uploadMs = millis(f.times.started, f.times.uploaded);
    inFlight_ = std::move(f);
}

void FrameCycle::submit() {
    inFlight_->times.submitted = Clock::now();
    dispatches_ = 0;
    if (inFlight_->unchanged || !device_) {
        return;
    }
    pool_.back();
    const gpu::Commands& commands = device_->frame(inFlight_->slot, pool_.backIndex());
    dispatches_ = commands.dispatches();
    inFlight_->times.submitted = Clock::now();
    device_->submit(commands);
}

// The parts of the host copy that need no device, while it works. A CPU device uses the same processors.
void FrameCycle::fillHost(InFlight& f) {
    ThreadPool* const meanwhile = plan_.onCpu ? nullptr : &workers_;
    if (meanwhile != nullptr && workers_.size() > 1) {
        workers_.wake();
    }
    HostFixtures& host = pool_.back().host;
    host.frame = f.frame->index;
    host.captureTime = f.frame->captureTime;
    host.generation = ++generation_;
    host.origin = *origin_;
    host.camera = camera_;
    host.baseTcamera = f.pose;
    if (seenPoints_) {
        seenPoints_->setFrame(f.params);
    }
    f.valid = cloud::copyDepth(host, f.frame->depth, scene_, meanwhile);
}

void FrameCycle::describe(cloud::FixtureSet& set) const {
    if (device_) {
        set.describeDevice(scene_, frozen_, device_->completed());
    }
}

FrameReport FrameCycle::unprocessedReport(uint32_t index) const {
    FrameReport report;
    report.index = index;
    report.unchanged = true;
    report.passMs.assign(passNames().size(), 0.0);
    return report;
}

void FrameCycle::waitForDevice() {
    InFlight& f = *inFlight_;
    if (f.unchanged || f.completed) {
        return;
    }
    fillHost(f);
    if (device_) {
        device_->wait();
    }
    f.times.completed = Clock::now();
    f.completed = true;
    // Spheres of a class that has just been frozen come from the host's copy of this set.
    if (plan_.query == Plan::Query::Gpu && frozen_.covers(scene_)) {
        describe(pool_.back());
        pool_.publishEarly();
        f.times.answerable = Clock::now();
    }
}

// Readers may lease the set already, so only parts are written that no answer of the device reads.
void FrameCycle::copyToHost(InFlight& f) {
    cloud::FixtureSet& set = pool_.back();
    const bool early = f.times.answerable != Clock::time_point();
    if (device_) {
        lastCounts_ = cloud::collect(
            set, scene_, {device_->work(), seenPoints_ ? &*seenPoints_ : nullptr, plan_, layout_}, workers_);
    }
    guidanceEstimates_.apply(set.host.guidance, scene_, f.pose.position, f.frame->captureTime);
    lastCounts_.valid = f.valid;
    frozen_.apply(set.host, scene_);
    if (!early) {
        describe(set);
    }
    f.times.collected = Clock::now();
    if (plan_.spheres && plan_.grid) {
        set.grid.build(set.host.spheres, &workers_);
    } else {
        set.grid.buildLater(set.host.spheres);
    }
    if (plan_.grid && !plan_.tree) { // no pass finds it
        set.largestRadius = set.grid.get().maxRadius();
    }
    pool_.publish();
    f.times.published = Clock::now();
    f.times.answerable = early ? f.times.answerable : f.times.published;
}

FrameReport FrameCycle::finish() {
    waitForDevice();
    InFlight f = std::move(*inFlight_);
    inFlight_.reset();
    FrameReport report;
    report.index = f.frame->index;
    report.unchanged = f.unchanged;
    report.uploadMs = f.uploadMs;
    report.passMs.assign(passNames().size(), 0.0);
    if (!f.unchanged) {
        report.inPlace = device_ && device_->upload(f.slot).depth.imported();
        copyToHost(f);
        readTimes(f, report);
        report.publishMs = millis(f.times.completed, f.times.published);
        report.answerableMs = millis(f.times.started, f.times.answerable);
        leaks_.check(lastCounts_, scene_);
    }
    report.counts = lastCounts_;
    const std::vector<uint32_t> fixtures = cloud::classFixtures(scene_);
    for (size_t c = 0; c < report.counts.classPixels.size(); ++c) {
        report.guidanceCount +=
            scene_.fixtures[fixtures[c]].role == Role::Guidance ? report.counts.classPixels[c] : 0;
    }
    captureTime_.store(f.frame->captureTime, std::memory_order_release);
    report.latencyMs = millis(f.times.started, Clock::now());
    report.times = f.times;
    return report;
}

// Called after publish, so a lost device must not fail the frame: the next submission reports the loss, and
// the times stay zero.
void FrameCycle::readTimes(const InFlight& f, FrameReport& report) const {
    if (!device_ || !plan_.passTimes) {
        return;
    }
    try {
        report.passMs = device_->passMs(f.slot);
    } catch (const DeviceFailed& e) {
        log::debug("the times of frame {}: {}", report.index, e.what());
    }
}

} // namespace fathom
