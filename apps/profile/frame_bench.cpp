// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/frame_bench.h"

#include "engine/types/clock.h"

#include <algorithm>
#include <malloc.h>
#include <numeric>

namespace fathom::profile {

namespace {

constexpr uint32_t kStill = 0xffffffffu; // source number that no frame uses

} // namespace

void FrameSamples::add(const FrameReport& report, const Clocks& clocks) {
    if (report.unchanged) { // nothing was submitted or published
        cpu.push_back(clocks.cpuMs());
        total.push_back(report.latencyMs);
        return;
    }
    if (const double sum = std::accumulate(report.passMs.begin(), report.passMs.end(), 0.0); sum > 0.0) {
        gpu.push_back(sum); // 0 means that the passes were not timed
    }
    submit.push_back(millis(report.times.submitted, report.times.completed));
    cpu.push_back(clocks.cpuMs());
    total.push_back(millis(report.times.started, report.times.published));
    upload.push_back(report.uploadMs);
    collected.push_back(millis(report.times.started, report.times.collected));
    answerable.push_back(report.answerableMs);
    publish.push_back(report.publishMs);
    collect.push_back(millis(report.times.completed, report.times.collected));
    grid.push_back(millis(report.times.collected, report.times.published));
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
    plan_.grid = plan_.spheres; // measured whoever answers
    if (change) {
        change(plan_);
    }
    cycle_ = std::make_unique<FrameCycle>(&device, scene_, camera_, plan_, 1);
}

FrameReport FrameBench::run(const SampleFrame& image) {
    place(0, image);
    return process(0);
}

void FrameBench::place(size_t at, const SampleFrame& image) {
    if (at >= memory_.size()) {
        memory_.resize(at + 1);
        placed_.resize(at + 1);
    }
    if (!memory_[at]) {
        memory_[at] = std::make_unique<FrameSlot>(camera_.slotPixels(), true);
    }
    std::copy(image.depth.begin(), image.depth.end(), memory_[at]->depth().begin());
    Frame::Content& content = placed_[at];
    content.depth = memory_[at]->depth().first(image.depth.size());
    content.colour = image.colour;
    if (camera_.colourFormat != ColourFormat::Rgba) {
        content.raw = image.packed.image(), content.colour = {};
    }
    const std::span<const std::byte> colours = content.colourBytes();
    std::ranges::copy(colours, memory_[at]->colourBytes().begin());
    content.setColourBytes(memory_[at]->colourBytes().first(colours.size()));
    content.baseTcamera = image.baseTcamera;
}

double FrameBench::colourBytesPerPixel() const {
    return plan_.colour ? static_cast<double>(camera_.colourBytes()) / camera_.colour.pixels() : 0.0;
}

FrameReport FrameBench::process(size_t at) {
    lease_ = {};
    Frame::Content& content = placed_[at];
    content.index = frames_;
    content.sourceNumber = still_ ? kStill : frames_;
    content.captureTime = frames_++ / 30.0;
    FrameReport report = cycle_->process(memory_[at]->lend(content));
    lease_ = cycle_->sets().newest();
    return report;
}

void FrameBench::sample(const std::vector<SampleFrame>& frames, const Repeats& repeats,
                        FrameSamples& samples) {
    for (size_t i = 0; i < frames.size(); ++i) {
        place(i, frames[i]);
    }
    size_t next = 0;
    FrameReport report;
    repeat(
        repeats, [&] { report = process(next++ % frames.size()); },
        [&](const Clocks& clocks) { samples.add(report, clocks); });
}

FrameCost FrameBench::measure(const std::vector<SampleFrame>& frames, const Repeats& repeats) {
    FrameSamples samples;
    sample(frames, repeats, samples);
    return costOf(samples);
}

FrameCost FrameBench::costOf(const FrameSamples& samples) const {
    FrameCost cost;
    const bool timed = device_.facts().timestampPeriodNs > 0.0;
    cost.frame = {timed ? spreadOf(samples.gpu) : Spread{}, spreadOf(samples.submit), spreadOf(samples.cpu)};
    cost.total = spreadOf(samples.total);
    cost.upload = spreadOf(samples.upload);
    cost.collected = spreadOf(samples.collected);
    cost.answerable = spreadOf(samples.answerable);
    cost.publish = spreadOf(samples.publish);
    cost.collect = spreadOf(samples.collect);
    cost.grid = spreadOf(samples.grid);
    for (size_t i = 0; timed && i < samples.passes.size(); ++i) {
        cost.passes[cycle_->passNames()[i]] = spreadOf(samples.passes[i]);
    }
    return cost;
}

void FrameBench::setArm(cloud::ArmSpheres arm) {
    arm_ = std::move(arm);
    cycle_->setArm(arm_);
}

HostFixtures regionsOf(gpu::Device& device, Scene scene, const CameraInfo& camera, const SampleFrame& image) {
    scene.filter.radius = 0;
    scene.filter.edge = scene.errorBudget = 0.0;
    FrameBench bench(device, std::move(scene), camera);
    bench.run(image);
    return bench.set().host;
}

uint64_t heapBytes() {
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
}

uint64_t bytesOf(const Plan& plan) {
    uint64_t bytes = 0;
    for (const Plan::Item& item : plan.items) {
        bytes += item.in ? item.bytes : 0;
    }
    return bytes;
}

} // namespace fathom::profile
