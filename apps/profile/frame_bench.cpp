// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/frame_bench.h"

#include "engine/gpu/commands.h"
#include "engine/reference/classify.h"
#include "engine/reference/surface.h"

#include <algorithm>
#include <numeric>

namespace fathom::profile {

namespace {

constexpr double kSamePoint = 2e-5; // [m] float32 chain against float64, at up to 4 m

double millis(std::chrono::steady_clock::duration d) {
    return std::chrono::duration<double, std::milli>(d).count();
}

template <class T>
std::vector<T> readBack(gpu::Device& device, const gpu::Buffer& buffer) {
    const gpu::Buffer landing(device, buffer.bytes(), gpu::MemoryKind::Readback, "landing");
    gpu::Commands commands(device);
    const gpu::Timeline timeline(device);
    commands.begin();
    commands.copy(buffer, landing, buffer.bytes());
    commands.end();
    device.submit(commands.handle(), timeline.handle(), 0, 1);
    timeline.wait(1);
    const auto view = landing.as<T>();
    return {view.begin(), view.end()};
}

} // namespace

void FrameSamples::add(const FrameReport& report, const Clocks& clocks) {
    gpu.push_back(std::accumulate(report.passMs.begin(), report.passMs.end(), 0.0));
    submit.push_back(millis(report.times.landed - report.times.submitted));
    cpu.push_back(clocks.cpuMs());
    total.push_back(millis(report.times.published - report.times.started));
    upload.push_back(report.uploadMs);
    publish.push_back(report.publishMs);
    passes.resize(report.passMs.size());
    for (size_t i = 0; i < report.passMs.size(); ++i) {
        passes[i].push_back(report.passMs[i]);
    }
}

FrameBench::FrameBench(gpu::Device& device, Scene scene, const CameraInfo& camera, const Change& change,
                       uint32_t toolLeaves)
    : device_(device)
    , scene_(std::move(scene))
    , camera_(camera)
    , plan_(makePlan(scene_, camera_, toolLeaves, device.facts())) {
    if (change) {
        change(plan_);
    }
    cycle_ = std::make_unique<FrameCycle>(device, scene_, camera_, plan_, 1);
}

FrameReport FrameBench::run(const Shot& shot) {
    lease_ = {};
    Frame::Content content;
    content.index = frames_;
    content.sourceNumber = frames_;
    content.captureTime = frames_++ / 30.0;
    content.depth = shot.depth;
    content.colour = shot.colour;
    content.baseTcamera = shot.baseTcamera;
    FrameReport report = cycle_->process(Frame(content, nullptr));
    lease_ = cycle_->sets().newest();
    return report;
}

void FrameBench::sample(const std::vector<Shot>& shots, const Effort& effort, FrameSamples& samples) {
    size_t next = 0;
    FrameReport report;
    repeat(
        effort, [&] { report = run(shots[next++ % shots.size()]); },
        [&](const Clocks& clocks) { samples.add(report, clocks); });
}

FrameCost FrameBench::measure(const std::vector<Shot>& shots, const Effort& effort) {
    FrameSamples samples;
    sample(shots, effort, samples);
    return costOf(samples);
}

FrameCost FrameBench::costOf(const FrameSamples& samples) const {
    FrameCost cost;
    const bool timed = device_.facts().timestampPeriodNs > 0.0;
    cost.frame = {timed ? spreadOf(samples.gpu) : Spread{}, spreadOf(samples.submit), spreadOf(samples.cpu)};
    cost.total = spreadOf(samples.total);
    cost.upload = spreadOf(samples.upload);
    cost.publish = spreadOf(samples.publish);
    for (size_t i = 0; timed && i < samples.passes.size(); ++i) {
        cost.passes[cycle_->passNames()[i]] = spreadOf(samples.passes[i]);
    }
    return cost;
}

std::vector<uint32_t> FrameBench::masks() const {
    const auto slots = readBack<uint32_t>(device_, cycle_->work().masks);
    std::vector<uint32_t> out;
    for (uint32_t v = 0; v < camera_.depth.height; ++v) {
        for (uint32_t u = 0; u < camera_.depth.width; ++u) {
            out.push_back(slots[slotOfPixel(u, v, cycle_->layout().across)]);
        }
    }
    return out;
}

reference::PointPicture FrameBench::points() const {
    const auto slots = readBack<glm::vec4>(device_, cycle_->work().points);
    const auto listed = readBack<uint32_t>(device_, cycle_->work().listed);
    reference::PointPicture out;
    for (uint32_t v = 0; v < camera_.depth.height; ++v) {
        for (uint32_t u = 0; u < camera_.depth.width; ++u) {
            const uint32_t slot = slotOfPixel(u, v, cycle_->layout().across);
            const glm::vec4 p = listed[slot / 256] != 0 ? slots[slot] : glm::vec4(0.0f);
            out.at.push_back(p.w != 0.0f ? dvec3(p) + lease_->host.origin : dvec3(0.0));
            out.z.push_back(p.w);
        }
    }
    return out;
}

std::string FrameBench::differsFromTwins(const Shot& shot) const {
    const reference::FrameView view(scene_, camera_, shot.baseTcamera, shot.depth, shot.colour);
    const auto ours = masks();
    if (plan_.occlusion) {
        return ""; // the cells' own bounds are compared by the tests: a point on a cell border has two truths
    }
    const reference::ClassPicture classes = reference::classify(view, nullptr);
    for (size_t i = 0; i < ours.size(); ++i) {
        if (ours[i] != classes.masks[i] && classes.unsure[i] == 0) {
            return "class bits of pixel " + std::to_string(i);
        }
    }
    const reference::SurfacePicture twin = reference::surface(view, ours);
    const reference::PointPicture mine = points();
    for (size_t i = 0; i < ours.size(); ++i) {
        const bool same = (mine.z[i] == 0.0) == (twin.points.z[i] == 0.0) &&
                          glm::length(mine.at[i] - twin.points.at[i]) <= kSamePoint;
        if (!same && twin.unsure[i] == 0) {
            return "point of pixel " + std::to_string(i);
        }
    }
    return "";
}

uint64_t bytesOf(const Plan& plan) {
    uint64_t bytes = 0;
    for (const Plan::Item& item : plan.items) {
        bytes += item.in ? item.bytes : 0;
    }
    return bytes;
}

} // namespace fathom::profile
