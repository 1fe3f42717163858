// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/precision_rig.h"

#include "apps/stability/dice.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fathom::stability {

namespace {

// Its tree is looked at, too, whoever asks for one.
Plan planWithTree(const Scene& scene, const CameraInfo& camera, const gpu::Device& device) {
    Plan plan = makePlan(scene, camera, 1, device.facts());
    plan.tree = plan.spheres;
    return plan;
}

} // namespace

PrecisionRig::PrecisionRig(gpu::Device& device, Scene scene, const CameraInfo& camera)
    : device_(device)
    , scene_(std::move(scene))
    , camera_(camera)
    , plan_(planWithTree(scene_, camera_, device))
    , cycle_(std::make_unique<FrameCycle>(device, scene_, camera_, plan_, 1)) {}

void PrecisionRig::run(Picture picture, double captureTime) {
    lease_ = {};
    picture_ = std::move(picture);
    Frame::Content content;
    content.index = frames_;
    content.sourceNumber = frames_++;
    content.captureTime = captureTime;
    content.depth = picture_.depth;
    content.colour = picture_.colour;
    cycle_->process(Frame(content, nullptr));
    lease_ = cycle_->sets().newest();
}

template <class T>
std::vector<T> PrecisionRig::read(const gpu::Buffer& buffer) const {
    const gpu::Buffer landing(device_, buffer.bytes(), gpu::MemoryKind::Readback, "landing");
    gpu::Commands commands(device_);
    const gpu::Timeline timeline(device_);
    commands.begin();
    commands.copy(buffer, landing, buffer.bytes());
    commands.end();
    device_.submit(commands.handle(), timeline.handle(), 0, 1);
    timeline.wait(1);
    const auto view = landing.as<T>();
    return {view.begin(), view.end()};
}

reference::FrameView PrecisionRig::view() const {
    return {scene_, camera_, scene_.baseTcamera, picture_.depth, picture_.colour};
}

std::vector<uint32_t> PrecisionRig::masks() const {
    const auto slots = read<uint8_t>(cycle_->work().masks);
    std::vector<uint32_t> out;
    for (int v = 0; v < height(); ++v) {
        for (int u = 0; u < width(); ++u) {
            out.push_back(slots[slot(u, v)]);
        }
    }
    return out;
}

reference::PointPicture PrecisionRig::points() const {
    const auto slots = read<glm::vec4>(cycle_->work().points);
    const auto listed = read<uint32_t>(cycle_->work().listed);
    reference::PointPicture out;
    for (int v = 0; v < height(); ++v) {
        for (int u = 0; u < width(); ++u) {
            const glm::vec4 p = listed[slot(u, v) / 256] != 0 ? slots[slot(u, v)] : glm::vec4(0.0f);
            out.at.push_back(p.w != 0.0f ? dvec3(p) + origin() : dvec3(0.0));
            out.z.push_back(p.w);
        }
    }
    return out;
}

std::vector<int> PrecisionRig::forbidden() const {
    return reference::forbiddenClasses(scene_, masks(), points());
}

std::vector<reference::CellThinning> PrecisionRig::thinning() const {
    const auto cells = read<glm::vec4>(cycle_->work().growth);
    const auto listed = read<uint32_t>(cycle_->work().listed);
    std::vector<reference::CellThinning> out;
    for (int v = 0; v < height(); v += 4) {
        for (int u = 0; u < width(); u += 4) {
            const uint32_t sub = slot(u, v) / 16;
            const glm::vec4 g = listed[sub / 16] != 0 ? cells[sub] : glm::vec4(0.0f);
            reference::CellThinning& cell = out.emplace_back();
            cell.whole = g.x < 0.0f ? -static_cast<double>(g.x) : -1.0;
            for (int q = 0; g.x >= 0.0f && q < 4; ++q) {
                cell.quarters[static_cast<size_t>(q)] = g[q] > 0.0f ? g[q] : -1.0;
            }
        }
    }
    return out;
}

std::vector<reference::RegionSphere> PrecisionRig::spheres(bool held) const {
    const auto slots = read<glm::vec4>(held ? cloud::slotHeld(cycle_->work(), lease_->device)
                                            : cloud::slotSpheres(cycle_->work(), lease_->device));
    const auto classes = read<uint8_t>(cycle_->work().classes);
    const auto listed = read<uint32_t>(cycle_->work().listed);
    std::vector<reference::RegionSphere> out;
    for (int v = 0; v < height(); ++v) {
        for (int u = 0; u < width(); ++u) {
            const uint32_t s = slot(u, v);
            reference::RegionSphere& sphere = out.emplace_back();
            if (listed[s / 256] != 0 && slots[s].w >= 0.0f) {
                sphere = {dvec3(slots[s]) + origin(), slots[s].w,
                          static_cast<int>(classes[s] >> (held ? 4 : 0) & 15)};
            }
        }
    }
    return out;
}

std::vector<std::vector<reference::Bound>> PrecisionRig::tree() const {
    const auto nodes = read<glm::vec4>(lease_->device.nodes);
    const auto counts = read<uint32_t>(lease_->device.nodeCounts);
    const auto listed = read<uint32_t>(cycle_->work().listed);
    std::vector<std::vector<reference::Bound>> levels(layout().levels.size());
    for (size_t l = 0; l < levels.size(); ++l) {
        for (uint32_t i = 0; i < layout().levels[l].across * layout().levels[l].down; ++i) {
            const uint32_t u = i % layout().levels[l].across, v = i / layout().levels[l].across;
            const uint32_t sub =
                (v / 4 * layout().across + u / 4) * 16 + v % 4 * 4 + u % 4; // level 0 is patch-major
            const uint32_t node = l == 0 ? sub : layout().levels[l].first + i;
            const bool stale = l == 0 && listed[sub / 16] == 0;
            levels[l].push_back(
                stale ? reference::Bound{}
                      : reference::Bound{dvec3(nodes[node]) + origin(), nodes[node].w, counts[node]});
        }
    }
    return levels;
}

reference::CellPicture PrecisionRig::cells() const {
    const cloud::WorkBuffers& work = cycle_->work();
    reference::CellPicture out{work.cellEdge, work.cellsAcross, work.cellsDown, {}};
    const auto bits = read<uint32_t>(work.nearest);
    for (size_t i = 0; i < static_cast<size_t>(out.across) * out.down; ++i) {
        out.nearest.push_back(bits[i] == 0xffffffffu ? HUGE_VAL
                                                     : static_cast<double>(std::bit_cast<float>(bits[i])));
    }
    return out;
}

CameraInfo cameraFor(double range, uint32_t width, uint32_t height) {
    CameraInfo camera;
    camera.depth.width = width, camera.depth.height = height;
    camera.depth.fx = 1.1 * width, camera.depth.fy = 1.12 * width;
    camera.depth.cx = 0.49 * width, camera.depth.cy = 0.53 * height;
    camera.colour = camera.depth;
    camera.metresPerUnit = range / 20000.0;
    return camera;
}

Scene sceneFor(double range) {
    Scene scene;
    scene.nearZ = 0.3 * range, scene.farZ = 2.5 * range;
    scene.baseTcamera = {{0.4 * range, -0.3 * range, 0.2 * range}, rotationExp({0.5, -0.7, 0.2})};
    scene.filter = {2, 0.01 * range, 0.03};
    scene.errorBudget = 3e-3 * range;
    scene.holdSeconds = 0.0;
    scene.registrationSigma = 1e-4 * range;
    scene.fixtures.resize(2);
    scene.fixtures[0].name = "red";
    scene.fixtures[0].hue = Band{330.0, 30.0};
    scene.fixtures[0].radius = 0.06 * range;
    scene.fixtures[1].name = "goal";
    scene.fixtures[1].role = Role::Guidance;
    scene.fixtures[1].minCount = 3;
    const dvec3 centre = scene.baseTcamera.apply({-0.1 * range, 0.0, range});
    scene.fixtures[1].box = Box{centre - dvec3(0.4 * range), centre + dvec3(0.4 * range)};
    return scene;
}

Picture pictureFor(const CameraInfo& camera, double range, double noise, uint64_t seed) {
    Dice dice(seed);
    Picture picture;
    const uint32_t w = camera.depth.width, h = camera.depth.height;
    for (uint32_t v = 0; v < h; ++v) {
        for (uint32_t u = 0; u < w; ++u) {
            const double x = (u + 0.5) / w, y = (v + 0.5) / h;
            double z = 0.9 + 0.25 * x + 0.05 * std::sin(9.0 * y) * std::cos(7.0 * x);
            z -= std::hypot(x - 0.6, y - 0.45) < 0.2 ? 0.3 : 0.0;
            z *= 1.0 + noise * dice.normal();
            const bool none = noise > 0.0 && dice.chance(0.04);
            picture.depth.push_back(none ? uint16_t{0}
                                         : static_cast<uint16_t>(std::clamp(
                                               std::round(z * range / camera.metresPerUnit), 0.0, 65535.0)));
        }
    }
    for (uint32_t i = 0; i < camera.colour.pixels(); ++i) {
        const uint32_t column = i % camera.colour.width;
        picture.colour.push_back(column % 16 < 11 ? 0xff2020c0u : 0xff808080u);
    }
    return picture;
}

} // namespace fathom::stability
