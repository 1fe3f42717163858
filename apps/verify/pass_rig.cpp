// SPDX-License-Identifier: Apache-2.0
#include "apps/verify/pass_rig.h"

#include "apps/verify/read_back.h"
#include "engine/cloud/frame_params.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fathom::verify {

std::vector<uint32_t> masksOf(gpu::Device& device, const FrameCycle& cycle, const CameraInfo& camera) {
    const auto slots = readBack<uint8_t>(device, cycle.work().masks);
    std::vector<uint32_t> out;
    out.reserve(camera.depth.pixels());
    for (uint32_t v = 0; v < camera.depth.height; ++v) {
        for (uint32_t u = 0; u < camera.depth.width; ++u) {
            out.push_back(slots[slotOfPixel(u, v, cycle.layout().across)]);
        }
    }
    return out;
}

reference::CellImage cellsOf(gpu::Device& device, const FrameCycle& cycle) {
    const cloud::WorkBuffers& work = cycle.work();
    reference::CellImage out{work.cellEdge, work.cellsAcross, work.cellsDown, {}};
    const auto bits = readBack<uint32_t>(device, work.nearest);
    for (size_t i = 0; i < static_cast<size_t>(out.across) * out.down; ++i) {
        out.nearest.push_back(bits[i] == 0xffffffffu ? HUGE_VAL
                                                     : static_cast<double>(std::bit_cast<float>(bits[i])));
    }
    return out;
}

reference::PointImage pointsOf(gpu::Device& device, const FrameCycle& cycle, const cloud::FixtureSet& set,
                               const CameraInfo& camera) {
    const auto slots = readBack<glm::vec4>(device, cycle.work().points);
    const auto listed = set.device.listed.as<uint32_t>();
    reference::PointImage out;
    for (uint32_t v = 0; v < camera.depth.height; ++v) {
        for (uint32_t u = 0; u < camera.depth.width; ++u) {
            const uint32_t slot = slotOfPixel(u, v, cycle.layout().across);
            const glm::vec4 p = listed[slot / 256] != 0 ? slots[slot] : glm::vec4(0.0f);
            out.at.push_back(p.w != 0.0f ? dvec3(p) + set.host.origin : dvec3(0.0));
            out.z.push_back(p.w);
        }
    }
    return out;
}

PassRig::PassRig(gpu::Device& device, Scene scene, const CameraInfo& camera, const Change& change,
                 uint32_t readers)
    : device_(device)
    , scene_(std::move(scene))
    , camera_(camera)
    , plan_(makePlan(scene_, camera_, 1, device.facts())) {
    if (change) {
        change(plan_);
    }
    cycle_ = std::make_unique<FrameCycle>(&device_, scene_, camera_, plan_, readers);
}

FrameReport PassRig::run(Image image, double captureTime, const std::optional<Pose>& pose) {
    lease_ = {};
    image_ = std::move(image);
    pose_ = pose.value_or(scene_.baseTcamera);
    Frame::Content content;
    content.index = frames_;
    content.captureTime = captureTime < 0.0 ? frames_ / 30.0 : captureTime;
    content.sourceNumber = frames_++;
    content.depth = image_.depth;
    content.colour = image_.colour;
    if (camera_.colourFormat != ColourFormat::Rgba) {
        packed_ =
            packColour(camera_.colourFormat, camera_.colour.width, camera_.colour.height, image_.colour);
        content.raw = packed_.image(), content.colour = {};
        unpackColour(content.raw, image_.colour);
    }
    content.baseTcamera = pose;
    FrameReport report = cycle_->process(Frame(content, nullptr));
    lease_ = cycle_->sets().newest();
    return report;
}

reference::FrameView PassRig::view() const {
    return {scene_, camera_, pose_, image_.depth, image_.colour};
}

std::vector<uint32_t> PassRig::listed() const {
    const auto listed = set().device.listed.as<uint32_t>();
    return {listed.begin(), listed.end()};
}

std::vector<uint32_t> PassRig::masks() const {
    return masksOf(device_, *cycle_, camera_);
}

reference::PointImage PassRig::points() const {
    return pointsOf(device_, *cycle_, set(), camera_);
}

std::vector<int> PassRig::forbidden() const {
    return reference::forbiddenClasses(scene_, masks(), points());
}

std::vector<reference::CellThinning> PassRig::thinning() const {
    const auto cells = readBack<glm::vec4>(device_, cycle_->work().growth);
    const auto work = listed();
    std::vector<reference::CellThinning> out;
    for (int v = 0; v < height(); v += 4) {
        for (int u = 0; u < width(); u += 4) {
            const uint32_t sub = slot(u, v) / 16;
            const glm::vec4 g = work[sub / 16] != 0 ? cells[sub] : glm::vec4(0.0f);
            reference::CellThinning& cell = out.emplace_back();
            cell.whole = g.x < 0.0f ? -static_cast<double>(g.x) : -1.0;
            for (int q = 0; g.x >= 0.0f && q < 4; ++q) {
                cell.quarters[static_cast<size_t>(q)] = g[q] > 0.0f ? g[q] : -1.0;
            }
        }
    }
    return out;
}

std::vector<reference::RegionSphere> PassRig::spheres(bool held) const {
    const RegionSpheres& all = host().spheres;
    const std::vector<uint32_t> fixtures = cloud::classFixtures(scene_);
    const auto pixels = static_cast<uint32_t>(camera_.depth.pixels());
    std::vector<reference::RegionSphere> out(pixels);
    for (size_t i = 0; i < all.size(); ++i) {
        if ((all.source[i] >= pixels) == held) {
            const auto row = std::ranges::find(fixtures, uint32_t{all.fixture[i]});
            out[all.source[i] % pixels] = {dvec3(all.x[i], all.y[i], all.z[i]) + origin(), all.radius[i],
                                           static_cast<int>(row - fixtures.begin())};
        }
    }
    return out;
}

// Centre about the origin and R of each, R < 0 = none.
std::vector<glm::vec4> PassRig::slots(bool held) const {
    const cloud::WorkBuffers& work = cycle_->work();
    if (plan_.tree) {
        return readBack<glm::vec4>(device_, held ? set().device.held : set().device.spheres);
    }
    auto slots = readBack<glm::vec4>(device_, held ? work.kept : work.points);
    const auto radii = readBack<float>(device_, held ? work.heldRadii : work.radii);
    for (size_t i = 0; i < slots.size(); ++i) {
        slots[i].w = radii[i];
    }
    return slots;
}

std::vector<reference::RegionSphere> PassRig::slotSpheres(bool held) const {
    const auto here = slots(held);
    const auto work = listed();
    const auto classes =
        plan_.pack ? std::vector<uint8_t>() : readBack<uint8_t>(device_, cycle_->work().classes);
    std::vector<reference::RegionSphere> out;
    for (int v = 0; v < height(); ++v) {
        for (int u = 0; u < width(); ++u) {
            const uint32_t s = slot(u, v);
            reference::RegionSphere& sphere = out.emplace_back();
            if (work[s / 256] != 0 && here[s].w >= 0.0f) {
                const int cls = classes.empty() ? -1 : classes[s] >> (held ? 4 : 0) & 15;
                sphere = {dvec3(here[s]) + origin(), here[s].w, cls};
            }
        }
    }
    return out;
}

std::vector<std::vector<reference::Bound>> PassRig::tree() const {
    const auto nodes = readBack<glm::vec4>(device_, set().device.nodes);
    const auto counts = readBack<uint32_t>(device_, set().device.nodeCounts);
    const auto work = listed();
    std::vector<std::vector<reference::Bound>> levels(2);
    for (size_t l = 0; l < levels.size(); ++l) {
        for (uint32_t i = 0; i < layout().levels[l].across * layout().levels[l].down; ++i) {
            const uint32_t u = i % layout().levels[l].across, v = i / layout().levels[l].across;
            const uint32_t sub =
                (v / 4 * layout().across + u / 4) * 16 + v % 4 * 4 + u % 4; // level 0 is patch-major
            const uint32_t node = l == 0 ? sub : layout().levels[l].first + i;
            const bool stale = l == 0 && work[sub / 16] == 0;
            levels[l].push_back(
                stale ? reference::Bound{}
                      : reference::Bound{dvec3(nodes[node]) + origin(), nodes[node].w, counts[node]});
        }
    }
    return levels;
}

shared::FrameCounters PassRig::counters() const {
    return set().device.counters.as<shared::FrameCounters>()[0];
}

reference::CellImage PassRig::cells() const {
    return cellsOf(device_, *cycle_);
}

} // namespace fathom::verify
