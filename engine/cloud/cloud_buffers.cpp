// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/cloud_buffers.h"

#include "engine/cloud/seen_points.h"
#include "engine/cloud/self_filter.h"

#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <cmath>

namespace fathom::cloud {

namespace {

using gpu::Buffer;
using gpu::MemoryKind;

// Memory of the buffers that the host reads when the plan does not pack.
MemoryKind slotMemory(const Plan& plan) {
    return plan.spheres && !plan.pack ? MemoryKind::Readback : MemoryKind::Device;
}

} // namespace

WorkBuffers::WorkBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout,
                         const CameraInfo& camera) {
    const uint64_t slots = layout.slots(), patches = layout.patches(), subs = patches * 16;
    unused = Buffer(device, 16, MemoryKind::Device, "unused");
    if (!plan.passes) {
        return;
    }
    masks = Buffer(device, slots, MemoryKind::Device, "masks");
    listed = Buffer(device, patches * 4, MemoryKind::Device, "listed");
    list = Buffer(device, patches * 4 * 3, MemoryKind::Device, "list");
    counters = Buffer(device, sizeof(shared::FrameCounters), MemoryKind::Device, "counters");
    points = Buffer(device, slots * 16, slotMemory(plan), "points");
    if (plan.keepDepth) {
        depth = Buffer(device, 2ull * camera.depth.pixels(), MemoryKind::Device, "depth on the device");
    }
    if (plan.thin) {
        growth = Buffer(device, subs * 16, MemoryKind::Device, "growth");
    }
    if (plan.spheres) {
        addSpheres(device, plan, slots);
    }
    if (plan.hold) {
        addHold(device, plan, layout);
    }
    if (plan.estimates) {
        estimates = Buffer(device, slots * 32, MemoryKind::Device, "estimates");
    }
    if (plan.occlusion) {
        addOcclusion(device, camera);
    }
    if (plan.rays) {
        rays = Buffer(device, 8ull * camera.depth.pixels(), MemoryKind::Upload, "rays");
        std::ranges::copy(raysOf(camera.depth), rays.as<glm::vec2>().begin());
    }
}

void WorkBuffers::addSpheres(const gpu::Device& device, const Plan& plan, uint64_t slots) {
    if (!plan.pack || plan.classes > 1) {
        classes = Buffer(device, slots, MemoryKind::Readback, "classes");
    }
    if (!plan.pack) {
        radii = Buffer(device, slots * 4, MemoryKind::Readback, "radii");
        heldRadii = plan.hold ? Buffer(device, slots * 4, MemoryKind::Readback, "held radii") : Buffer();
    }
}

void WorkBuffers::addHold(const gpu::Device& device, const Plan& plan, const PatchLayout& layout) {
    const uint64_t slots = layout.slots();
    seen = Buffer(device, slots * 16, MemoryKind::Device, "seen");
    kept = Buffer(device, slots * 16, slotMemory(plan), "kept");
    keptTime = Buffer(device, slots * 4, MemoryKind::Device, "keptTime");
    memoryCounts = Buffer(device, layout.patches() * 4ull, MemoryKind::Device, "memory counts");
}

// Cells are 1.5 times as wide as the distance between neighbouring depth pixels in the colour image. A
// surface that faces the colour camera is stretched there, and gaps would show the points that it hides.
void WorkBuffers::addOcclusion(const gpu::Device& device, const CameraInfo& camera) {
    const double ratio = std::max(camera.colour.fx / camera.depth.fx, camera.colour.fy / camera.depth.fy);
    cellEdge = std::max(1u, static_cast<uint32_t>(std::ceil(1.5 * ratio)));
    cellsAcross = (camera.colour.width + cellEdge - 1) / cellEdge;
    cellsDown = (camera.colour.height + cellEdge - 1) / cellEdge;
    nearest = Buffer(device, 4ull * cellsAcross * cellsDown, MemoryKind::Device, "nearest");
}

UploadBuffers::UploadBuffers(const gpu::Device& device, const Plan& plan, const CameraInfo& camera,
                             const std::shared_ptr<const void>& depthMemory,
                             const std::shared_ptr<const void>& colourMemory) {
    if (!plan.passes) {
        return;
    }
    const auto image = [&](const std::shared_ptr<const void>& memory, uint64_t bytes, const char* name) {
        return memory ? Buffer(device, gpu::HostPages{memory, bytes}, name)
                      : Buffer(device, bytes, MemoryKind::Upload, name);
    };
    params = Buffer(device, sizeof(shared::FrameParams), MemoryKind::Upload, "params");
    depth = image(depthMemory, 2ull * camera.depth.pixels(), "depth");
    if (plan.colour) {
        colour = image(colourMemory, camera.colourBytes(), "colour");
        format = camera.colourFormat;
    }
    if (plan.selfFilter) {
        arm = Buffer(device, ArmSpheres::kMaxEntries * 16ull, MemoryKind::Upload, "arm");
    }
}

SetBuffers::SetBuffers(const gpu::Device& device, const Plan& plan, const PatchLayout& layout) {
    const uint64_t slots = layout.slots(), patches = layout.patches();
    if (!plan.passes) {
        return;
    }
    counters = Buffer(device, sizeof(shared::FrameCounters), MemoryKind::Readback, "set counters");
    listed = Buffer(device, patches * 4, MemoryKind::Readback, "set listed");
    if (plan.spheres) {
        bits = Buffer(device, patches * 16 * 4, MemoryKind::Readback, "bits");
        if (plan.tree) {
            spheres = Buffer(device, slots * 16, MemoryKind::Device, "set spheres");
            held = plan.hold ? Buffer(device, slots * 16, MemoryKind::Device, "set held") : Buffer();
            classes = plan.classes > 1 ? Buffer(device, slots, MemoryKind::Device, "set classes") : Buffer();
        }
    }
    if (plan.tree) {
        nodes = Buffer(device, layout.bounds() * 16ull, MemoryKind::Device, "nodes");
        nodeCounts = Buffer(device, layout.bounds() * 4ull, MemoryKind::Device, "nodeCounts");
    }
    if (plan.pack) {
        packed = Buffer(device, slots * plan.packedBytes(), MemoryKind::Readback, "packed");
        places = Buffer(device, patches * 64, MemoryKind::Readback, "places");
        runs = Buffer(device, patches * 8, MemoryKind::Readback, "runs");
    }
    if (plan.moments) {
        moments = Buffer(device, patches * shared::kMaxClasses * sizeof(shared::PatchMoments),
                         MemoryKind::Readback, "moments");
    }
    if (plan.guidancePoints) {
        points = Buffer(device, slots * 16, MemoryKind::Readback, "set points");
        masks = Buffer(device, slots, MemoryKind::Readback, "set masks");
    }
}

} // namespace fathom::cloud
