// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/frame_bench.h"

#include "apps/verify/pass_rig.h"
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

} // namespace

void FrameSamples::add(const FrameReport& report, const Clocks& clocks) {
    gpu.push_back(std::accumulate(report.passMs.begin(), report.passMs.end(), 0.0));
    submit.push_back(millis(report.times.landed - report.times.submitted));
    cpu.push_back(clocks.cpuMs());
    total.push_back(millis(report.times.published - report.times.started));
    upload.push_back(report.uploadMs);
    collected.push_back(millis(report.times.collected - report.times.started));
    publish.push_back(report.publishMs);
    collect.push_back(millis(report.times.collected - report.times.landed));
    grid.push_back(millis(report.times.published - report.times.collected));
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
    place(0, shot);
    return process(0);
}

void FrameBench::place(size_t at, const Shot& shot) {
    if (at >= memory_.size()) {
        memory_.resize(at + 1), placed_.resize(at + 1);
    }
    if (!memory_[at]) {
        const auto most = static_cast<uint32_t>(std::max(shot.depth.size(), shot.colour.size()));
        memory_[at] = std::make_unique<FrameSlot>(most, true);
    }
    std::copy(shot.depth.begin(), shot.depth.end(), memory_[at]->depth().begin());
    std::copy(shot.colour.begin(), shot.colour.end(), memory_[at]->colour().begin());
    Frame::Content& content = placed_[at];
    content.depth = memory_[at]->depth().first(shot.depth.size());
    content.colour = memory_[at]->colour().first(shot.colour.size());
    content.baseTcamera = shot.baseTcamera;
}

FrameReport FrameBench::process(size_t at) {
    lease_ = {};
    Frame::Content& content = placed_[at];
    content.index = frames_;
    content.sourceNumber = frames_;
    content.captureTime = frames_++ / 30.0;
    FrameReport report = cycle_->process(memory_[at]->lend(content));
    lease_ = cycle_->sets().newest();
    return report;
}

void FrameBench::sample(const std::vector<Shot>& shots, const Effort& effort, FrameSamples& samples) {
    for (size_t i = 0; i < shots.size(); ++i) {
        place(i, shots[i]);
    }
    size_t next = 0;
    FrameReport report;
    repeat(
        effort, [&] { report = process(next++ % shots.size()); },
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
    cost.collected = spreadOf(samples.collected);
    cost.publish = spreadOf(samples.publish);
    cost.collect = spreadOf(samples.collect);
    cost.grid = spreadOf(samples.grid);
    for (size_t i = 0; timed && i < samples.passes.size(); ++i) {
        cost.passes[cycle_->passNames()[i]] = spreadOf(samples.passes[i]);
    }
    return cost;
}

std::vector<uint32_t> FrameBench::masks() const {
    return verify::masksOf(device_, *cycle_, camera_);
}

reference::PointPicture FrameBench::points() const {
    return verify::pointsOf(device_, *cycle_, camera_, lease_->host.origin);
}

namespace {

// `most` patches of the layout, evenly in row-major order but never column by column, and the four corners.
std::vector<uint8_t> samplePatches(const PatchLayout& layout, size_t most) {
    const size_t count = layout.patches();
    std::vector<uint8_t> chosen(count, most >= count ? 1 : 0);
    size_t stride = std::max<size_t>(1, (count + most - 1) / most);
    while (std::gcd(stride, size_t{layout.across}) != 1) {
        ++stride;
    }
    for (size_t p = 0; p < count; p += stride) {
        chosen[p] = 1;
    }
    for (const size_t corner : {size_t{0}, size_t{layout.across} - 1, count - layout.across, count - 1}) {
        chosen[corner] = 1;
    }
    return chosen;
}

} // namespace

std::string FrameBench::differsFromTwins(const Shot& shot, size_t mostPatches) const {
    const reference::FrameView view(scene_, camera_, shot.baseTcamera, shot.depth, shot.colour);
    std::vector<uint32_t> looked = masks();
    if (plan_.occlusion) {
        return ""; // the cells' own bounds are compared by the tests: a point on a cell border has two truths
    }
    const reference::ClassPicture classes = reference::classify(view, nullptr);
    for (size_t i = 0; i < looked.size(); ++i) {
        if (looked[i] != classes.masks[i] && classes.unsure[i] == 0) {
            return "class bits of pixel " + std::to_string(i);
        }
    }
    const std::vector<uint8_t> sample = samplePatches(cycle_->layout(), mostPatches);
    const uint32_t width = camera_.depth.width;
    const auto sampled = [&](size_t i) {
        return sample[i / width / 16 * cycle_->layout().across + i % width / 16] != 0;
    };
    for (size_t i = 0; i < looked.size(); ++i) {
        looked[i] = sampled(i) ? looked[i] : 0; // the twin makes no point there
    }
    const reference::SurfacePicture twin = reference::surface(view, looked);
    const reference::PointPicture mine = points();
    for (size_t i = 0; i < looked.size(); ++i) {
        const bool same = (mine.z[i] == 0.0) == (twin.points.z[i] == 0.0) &&
                          glm::length(mine.at[i] - twin.points.at[i]) <= kSamePoint;
        if (sampled(i) && !same && twin.unsure[i] == 0) {
            return "point of pixel " + std::to_string(i);
        }
    }
    return "";
}

std::string FrameBench::spheresDiffer() const {
    const RegionSpheres& spheres = set().host.spheres;
    const std::vector<uint32_t> bits = masks();
    const reference::PointPicture mine = points();
    std::vector<uint8_t> taken(bits.size(), 0);
    for (size_t i = 0; i < spheres.size(); ++i) {
        const uint32_t pixel = spheres.source[i];
        if (pixel >= bits.size()) {
            continue; // held from an earlier frame: no point of this one
        }
        const FixtureClass& f = scene_.fixtures[spheres.fixture[i]];
        const dvec3 centre = set().host.origin + dvec3(spheres.x[i], spheres.y[i], spheres.z[i]);
        const bool holds = mine.z[pixel] != 0.0 && bits[pixel] != 0 && f.role == Role::Forbidden &&
                           glm::length(centre - mine.at[pixel]) <= kSamePoint &&
                           spheres.radius[i] >= static_cast<float>(f.radius) * (1.0f - 1e-6f) &&
                           taken[pixel] == 0;
        if (!holds) {
            return "region sphere " + std::to_string(i);
        }
        taken[pixel] = 1;
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
