// SPDX-License-Identifier: Apache-2.0
#include "tests/support/cloud_rig.h"

#include <bit>

namespace fathom::test {

CloudRig::CloudRig(Scene scene, CameraInfo camera, const Change& change, uint32_t readers)
    : scene_(std::move(scene))
    , camera_(camera)
    , plan_(makePlan(scene_, camera_, 1, vulkan().device.facts())) {
    if (change) {
        change(plan_);
    }
    cycle_ = std::make_unique<FrameCycle>(vulkan().device, scene_, camera_, plan_, readers);
}

FrameReport CloudRig::run(const Picture& picture, double captureTime, const std::optional<Pose>& pose) {
    lease_ = {};
    picture_ = picture;
    pose_ = pose.value_or(scene_.baseTcamera);
    time_ = captureTime < 0.0 ? frames_ / 30.0 : captureTime;
    Frame::Content content;
    content.index = frames_;
    content.sourceNumber = frames_++;
    content.captureTime = time_;
    content.depth = picture_.depth;
    content.colour = picture_.colour;
    content.baseTcamera = pose;
    FrameReport report = cycle_->process(Frame(content, nullptr));
    lease_ = cycle_->sets().newest();
    return report;
}

reference::FrameView CloudRig::view() const {
    return {scene_, camera_, pose_, picture_.depth, picture_.colour};
}

uint32_t CloudRig::slot(int u, int v) const {
    return slotOfPixel(static_cast<uint32_t>(u), static_cast<uint32_t>(v), cycle_->layout().across);
}

std::vector<uint32_t> CloudRig::listed() const {
    return read<uint32_t>(cycle_->work().listed);
}

std::vector<uint32_t> CloudRig::masks() const {
    const auto slots = read<uint8_t>(cycle_->work().masks);
    std::vector<uint32_t> out;
    for (int v = 0; v < height(); ++v) {
        for (int u = 0; u < width(); ++u) {
            out.push_back(slots[slot(u, v)]);
        }
    }
    return out;
}

reference::PointPicture CloudRig::points() const {
    const auto slots = read<glm::vec4>(cycle_->work().points);
    const auto work = listed();
    reference::PointPicture out;
    for (int v = 0; v < height(); ++v) {
        for (int u = 0; u < width(); ++u) {
            const glm::vec4 p = work[slot(u, v) / 256] != 0 ? slots[slot(u, v)] : glm::vec4(0.0f);
            out.at.push_back(p.w != 0.0f ? dvec3(p) + origin() : dvec3(0.0));
            out.z.push_back(p.w);
        }
    }
    return out;
}

std::vector<int> CloudRig::forbidden() const {
    return reference::forbiddenClasses(scene_, masks(), points());
}

std::vector<reference::CellThinning> CloudRig::thinning() const {
    const auto cells = read<glm::vec4>(cycle_->work().growth);
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

std::vector<reference::RegionSphere> CloudRig::spheres(bool held) const {
    const auto slots = read<glm::vec4>(held ? cloud::slotHeld(cycle_->work(), set().device)
                                            : cloud::slotSpheres(cycle_->work(), set().device));
    const auto classes = read<uint8_t>(cycle_->work().classes);
    const auto work = listed();
    std::vector<reference::RegionSphere> out;
    for (int v = 0; v < height(); ++v) {
        for (int u = 0; u < width(); ++u) {
            const uint32_t s = slot(u, v);
            reference::RegionSphere& sphere = out.emplace_back();
            if (work[s / 256] != 0 && slots[s].w >= 0.0f) {
                sphere = {dvec3(slots[s]) + origin(), slots[s].w,
                          static_cast<int>(classes[s] >> (held ? 4 : 0) & 15)};
            }
        }
    }
    return out;
}

std::vector<std::vector<reference::Bound>> CloudRig::tree() const {
    const PatchLayout& layout = cycle_->layout();
    const auto nodes = read<glm::vec4>(set().device.nodes);
    const auto counts = read<uint32_t>(set().device.nodeCounts);
    const auto work = listed();
    std::vector<std::vector<reference::Bound>> levels(layout.levels.size());
    for (size_t l = 0; l < levels.size(); ++l) {
        for (uint32_t i = 0; i < layout.levels[l].across * layout.levels[l].down; ++i) {
            const uint32_t u = i % layout.levels[l].across, v = i / layout.levels[l].across;
            const uint32_t sub =
                (v / 4 * layout.across + u / 4) * 16 + v % 4 * 4 + u % 4; // level 0 is patch-major
            const uint32_t node = l == 0 ? sub : layout.levels[l].first + i;
            const bool stale = l == 0 && work[sub / 16] == 0;
            levels[l].push_back(
                stale ? reference::Bound{}
                      : reference::Bound{dvec3(nodes[node]) + origin(), nodes[node].w, counts[node]});
        }
    }
    return levels;
}

shared::FrameCounters CloudRig::counters() const {
    return read<shared::FrameCounters>(cycle_->work().counters)[0];
}

reference::CellPicture CloudRig::cells() const {
    const cloud::WorkBuffers& work = cycle_->work();
    reference::CellPicture out{work.cellEdge, work.cellsAcross, work.cellsDown, {}};
    const auto bits = read<uint32_t>(work.nearest);
    for (size_t i = 0; i < static_cast<size_t>(out.across) * out.down; ++i) {
        out.nearest.push_back(bits[i] == 0xffffffffu ? HUGE_VAL
                                                     : static_cast<double>(std::bit_cast<float>(bits[i])));
    }
    return out;
}

} // namespace fathom::test
