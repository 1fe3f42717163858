// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/frame_cycle.h"

#include "engine/cloud/frame_params.h"
#include "engine/cloud/frame_upload.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <chrono>

namespace fathom {

namespace {

using Clock = std::chrono::steady_clock;

double millis(Clock::time_point begin, Clock::time_point end) {
    return std::chrono::duration<double, std::milli>(end - begin).count();
}

std::vector<cloud::SetBuffers*> buffersOf(cloud::FixturePool& pool) {
    std::vector<cloud::SetBuffers*> buffers;
    for (size_t i = 0; i < pool.size(); ++i) {
        buffers.push_back(&pool.at(i).device);
    }
    return buffers;
}

// On a GPU workers spin while the passes run, for less than a millisecond. A CPU device needs the processors
// itself.
std::chrono::microseconds spinTimeOf(const Plan& plan) {
    return std::chrono::microseconds(plan.pack ? 1000 : 100);
}

} // namespace

FrameCycle::FrameCycle(gpu::Device& device, const Scene& scene, const CameraInfo& camera, const Plan& plan,
                       uint32_t readers)
    : device_(device)
    , scene_(scene)
    , camera_(camera)
    , plan_(plan)
    , layout_(patchLayout(camera.depth.width, camera.depth.height))
    , work_(device, plan, layout_, camera)
    , uploads_(device_, plan_, camera_)
    , pool_(readers, [&] { return std::make_unique<cloud::FixtureSet>(device, plan_, layout_); })
    , setBuffers_(buffersOf(pool_))
    , passes_(cloud::CloudContext{device, plan_, layout_, camera_, work_, setBuffers_})
    , timeline_(device)
    , workers_(plan.publishers, spinTimeOf(plan))
    , leakWarned_(shared::kMaxClasses, 0) {
    for (uint32_t slot = 0; slot < cloud::UploadSlots::kCopied; ++slot) {
        passes_.bind(slot, uploads_[slot]);
    }
    if (plan.packsDepths()) {
        seenPoints_.emplace(camera.depth, layout_);
    }
    warmUp();
}

FrameCycle::~FrameCycle() {
    try {
        if (ticket_ != 0) {
            timeline_.wait(ticket_); // the device may still use the buffers
        }
    } catch (const Error&) {
        // A lost device uses no buffer.
    }
}

void FrameCycle::resumeFrom(const Mark& mark) {
    generation_ = mark.generation;
    frozen_ = mark.frozen;
    if (mark.scene) {
        setScene(*mark.scene);
    }
    if (mark.origin) {
        placeOrigin(*mark.origin);
    }
}

void FrameCycle::placeOrigin(const dvec3& origin) {
    origin_ = origin; // positions stay small however far away the base frame is
    params_ = cloud::sceneParams(scene_, camera_, layout_, *origin_, work_.cellEdge, work_.cellsAcross);
}

void FrameCycle::clearMemory() {
    gpu::Commands commands(device_);
    commands.begin();
    if (plan_.cloud) {
        cloud::clearCounters(commands, work_);
    }
    for (const gpu::Buffer* buffer : {&work_.seen, &work_.kept, &work_.keptTime, &work_.live}) {
        if (*buffer) {
            commands.fill(*buffer, 0);
        }
    }
    commands.end();
    device_.submit(commands.handle(), timeline_.handle(), 0, ++ticket_);
    timeline_.wait(ticket_);
}

void FrameCycle::forget() {
    clearMemory();
    lastSource_.reset();
    lastCapture_.reset();
}

void FrameCycle::setScene(const Scene& scene) {
    if (cloud::classRows(scene) != cloud::classRows(scene_)) {
        throw Error("a scene in force keeps its classes of points: only their gates, radii and roles change");
    }
    scene_ = scene;
    if (origin_) {
        params_ = cloud::sceneParams(scene_, camera_, layout_, *origin_, work_.cellEdge, work_.cellsAcross);
    }
    lastSource_.reset(); // the same frame gives a different set now
}

// Some drivers compile a pipeline at its first use, so run each one now. A frame of zero depth selects
// nothing.
void FrameCycle::warmUp() {
    clearMemory();
    if (!plan_.cloud) {
        return;
    }
    const std::vector<uint16_t> depth(camera_.depth.pixels(), 0);
    const std::vector<uint32_t> colour(plan_.colour ? camera_.colourBytes() / 4 : 0, 0);
    const shared::FrameParams params =
        cloud::sceneParams(scene_, camera_, layout_, dvec3(0.0), work_.cellEdge, work_.cellsAcross);
    Frame::Content content;
    content.depth = depth;
    (plan_.yuyv ? content.yuyv : content.colour) = colour;
    for (uint32_t slot = 0; slot < cloud::UploadSlots::kCopied; ++slot) {
        cloud::uploadFrame(uploads_[slot], Frame(content, nullptr), params);
        uploadArm(slot, dvec3(0.0));
        device_.submit(passes_.frame(slot, 0).handle(), timeline_.handle(), ticket_, ticket_ + 1);
        timeline_.wait(++ticket_);
    }
}

void FrameCycle::uploadArm(uint32_t slot, const dvec3& origin) const {
    if (plan_.selfFilter) {
        cloud::uploadArm(uploads_[slot], arm_, origin);
    }
}

uint32_t FrameCycle::slotFor(const Frame& frame) {
    const bool busy = submitted_ && !submitted_->unchanged;
    const auto [slot, isNew] = uploads_.choose(frame, busy ? std::optional(submitted_->slot) : std::nullopt);
    if (isNew) {
        passes_.bind(slot, uploads_[slot]);
    }
    return slot;
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
    if (!origin_) {
        placeOrigin(f.pose.position);
    }
    if (!f.unchanged && plan_.cloud) {
        f.slot = slotFor(frame);
        cloud::setFrame(params_, f.pose, *origin_, frame->captureTime,
                        lastCapture_.value_or(frame->captureTime));
        cloud::uploadFrame(uploads_[f.slot], frame, params_);
        f.params = params_;
        uploadArm(f.slot, *origin_);
    }
    lastSource_ = frame->sourceNumber;
    lastCapture_ = frame->captureTime;
    f.frame = std::move(frame);
    f.times.uploaded = Clock::now();
    f.uploadMs = millis(f.times.started, f.times.uploaded);
    uploaded_ = std::move(f);
}

void FrameCycle::submit() {
    submitted_ = std::move(uploaded_);
    submitted_->times.submitted = Clock::now();
    uploaded_.reset();
    dispatches_ = 0;
    if (submitted_->unchanged || !plan_.cloud) {
        return;
    }
    pool_.back();
    const gpu::Commands& commands = passes_.frame(submitted_->slot, pool_.backIndex());
    dispatches_ = commands.dispatches();
    submitted_->times.submitted = Clock::now();
    device_.submit(commands.handle(), timeline_.handle(), ticket_, ticket_ + 1);
    ++ticket_;
}

// The parts of the host copy that need no device.
void FrameCycle::fillHost(const InFlight& f) {
    Fixtures& host = pool_.back().host;
    host.frame = f.frame->index;
    host.captureTime = f.frame->captureTime;
    host.generation = ++generation_;
    host.origin = *origin_;
    host.camera = camera_;
    host.baseTcamera = f.pose;
}

FrameReport FrameCycle::without(uint32_t index) const {
    FrameReport report;
    report.index = index;
    report.unchanged = true;
    report.passMs.assign(passNames().size(), 0.0);
    return report;
}

FrameReport FrameCycle::finish() {
    InFlight f = std::move(*submitted_);
    submitted_.reset();
    FrameReport report;
    report.index = f.frame->index;
    report.unchanged = f.unchanged;
    report.uploadMs = f.uploadMs;
    report.passMs.assign(passNames().size(), 0.0);
    if (!f.unchanged) {
        ThreadPool* const meanwhile =
            plan_.pack ? &workers_ : nullptr; // a CPU device uses the same processors
        if (meanwhile != nullptr && workers_.size() > 1) {
            workers_.wake();
        }
        fillHost(f); // while the device works
        if (seenPoints_) {
            seenPoints_->setFrame(f.params);
        }
        const uint32_t valid = cloud::copyDepth(pool_.back().host, f.frame->depth, scene_, meanwhile);
        if (plan_.cloud) {
            report.inPlace = uploads_[f.slot].depth.imported();
            timeline_.wait(ticket_);
        }
        f.times.landed = Clock::now();
        cloud::FixtureSet& set = pool_.back();
        lastCounts_ = cloud::collect(set, work_, seenPoints_ ? &*seenPoints_ : nullptr, scene_, plan_,
                                     layout_, workers_);
        lastCounts_.valid = valid;
        if (plan_.query != Plan::Query::Gpu) {
            frozen_.apply(set.host, scene_);
        }
        f.times.collected = Clock::now();
        if (plan_.spheres) {
            set.grid.build(set.host.spheres, &workers_);
        }
        pool_.publish();
        f.times.published = Clock::now();
        readTimes(f, report);
        report.publishMs = millis(f.times.landed, f.times.published);
        warnLeaks(lastCounts_);
    }
    report.counts = lastCounts_;
    const std::vector<uint32_t> rows = cloud::classRows(scene_);
    for (size_t c = 0; c < report.counts.classPixels.size(); ++c) {
        report.guidanceCount +=
            scene_.fixtures[rows[c]].role == Role::Guidance ? report.counts.classPixels[c] : 0;
    }
    captureTime_.store(f.frame->captureTime, std::memory_order_release);
    report.latencyMs = millis(f.times.started, Clock::now());
    report.times = f.times;
    return report;
}

// Called after publish, so a lost device must not fail the frame: the next submission reports the loss, and
// the times stay zero.
void FrameCycle::readTimes(const InFlight& f, FrameReport& report) const {
    if (!plan_.cloud || !plan_.passTimes) {
        return;
    }
    try {
        report.passMs = passes_.watch(f.slot).intervalsMs();
    } catch (const DeviceFailed& e) {
        log::debug("the times of frame {}: {}", report.index, e.what());
    }
}

void FrameCycle::warnLeaks(const cloud::FrameCounts& counts) {
    for (size_t c = 0; c < counts.leakSpacing.size(); ++c) {
        if (counts.leakSpacing[c] > 0.0f && leakWarned_[c] == 0) {
            leakWarned_[c] = 1;
            const FixtureClass& f = scene_.fixtures[cloud::classRows(scene_)[c]];
            log::warn("fixture '{}' leaks: at {:.2f} m its points are {:.1f} mm apart and its spheres "
                      "have a radius of {:.1f} mm",
                      f.name, counts.leakRange[c], counts.leakSpacing[c] * 1e3, f.radius * 1e3);
        }
    }
}

} // namespace fathom
