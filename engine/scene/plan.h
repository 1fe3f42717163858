// SPDX-License-Identifier: Apache-2.0
// Decides which passes, buffers and threads a scene needs on a device, and gives the reasons.
#pragma once

#include "engine/scene/scene.h"
#include "engine/types/camera_info.h"
#include "engine/types/device_facts.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fathom {

// What the passes compute.
struct PlannedPasses {
    bool occlusion = false; // unregistered colour: finds the points that the colour camera sees
    bool passes = false;    // any point class: the frame needs a device
    bool spheres = false;   // any forbidden point class
    bool thin = false;      // error budget
    bool tree = false;      // bounds of spheres up to one root, for the GPU query
    bool hold = false;
    bool moments = false;        // any guidance class
    bool guidancePoints = false; // a guidance class needs its points on the CPU (largest part, trimmed mean)
    uint32_t classes = 0;        // number of point classes
    bool box = false;            // some class has a box
    bool range = false;          // some class has a range gate
    bool fan = false;            // the sensor's pixels are beams at equal angles
    bool beam = false;           // each point's sphere grows by its own sigma
    bool leaks = false; // somewhere in near..far neighbours may be a region radius apart: leaks are detected
    uint32_t filterRadius = 0;
    bool edge = false;
    bool isolation = false;         // isolated pixels are rejected
    bool estimates = false;         // depths are averaged over frames
    bool polynomialWeights = false; // of the filter, instead of exp
    bool quarticWeights = false;    // exp of the weights by a power of a quartic polynomial
    bool arm = false;               // an arm carries the tool: joints are the unknowns, and all links collide
    bool water = false;             // colours are corrected for attenuation in water
    bool selfFilter = false;        // points inside the arm's spheres are removed
    enum class Query { None, Cpu, Gpu } query = Query::None; // contact query
    bool grid = false; // each set waits for the host's grid over its spheres: only where the CPU answers
};

// What is uploaded, stored and sent to the host, and in which form.
struct PlannedLayout {
    bool rays = false;    // ray table: distorted lens, or a fan
    bool colour = false;  // some class uses colour, so it is uploaded
    bool inPlace = false; // images in whole pages are read in place, not copied
    // with byPixel: the device packs spheres for the host, because its memory is across a bus
    bool pack = false;
    bool memoryTexels = false; // the memory of points is read as texels: faster on a CPU device; on a GPU a
                               // fetch may follow the write to the same place
    bool keepDepth = false;    // classify leaves the depth on the device for the passes after it
};

// How the passes are divided among invocations and threads. Changes times, never results.
struct PlannedTuning {
    bool onCpu = false;       // the device is a CPU: it uses the processors of the host
    bool tiled = false;       // the filter reads its window from shared memory
    bool filterBlock = false; // the filter has one invocation per 4x4 sub-patch and its window in registers
    // With shared memory: `spheres` has one invocation per pixel, `moments` one per sub-patch. Otherwise one
    // per sub-patch and one per patch.
    bool byPixel = false;
    // Groups run in several rounds, so throughput counts more than latency. Decided by the image size,
    // because the number of patches with work is unknown when passes are recorded.
    bool manyPatches = false;
    uint32_t pixelGroup = 256;   // most invocations per group of the pixel passes; divides 256
    uint32_t subPatchGroup = 64; // invocations per group of the sub-patch passes
    bool passTimes = true;       // the device times the passes; else their times are zero
    uint32_t publishers = 1;     // threads that lay out a set for the host, including the frame thread
};

// Fixture sets of a program: one that is written, the newest, and four that are leased: by the contact query,
// by batches of poses, by the camera feed, and at the start of a run or of an observer
// (engine/types/lease_pool.h).
inline constexpr uint32_t kFixtureSets = 6;

struct PatchLayout;

// Pure data. Code that builds pipelines and buffers only follows it.
struct Plan : PlannedPasses, PlannedLayout, PlannedTuning {
    // A part that is in the plan or skipped, with the reason.
    struct Item {
        std::string kind; // "pass", "buffer", "thread", "arm"
        std::string name;
        bool in = false;
        std::string why;
        uint64_t bytes = 0; // device and host memory of a buffer
    };
    std::vector<Item> items;

    bool has(const std::string& name) const; // whether it includes the item; for tests
    // CPU devices list patches in a separate pass, because divergent lanes of classify would all pay for it.
    bool lists() const { return passes && !byPixel; }
    // Thinning is a separate pass, unless the group that computes a patch's spheres does it.
    bool thins() const { return thin && !byPixel; }
    // A seen sphere is packed as its depth, from which the host computes the point. With beams it is packed
    // whole.
    bool packsDepths() const { return pack && !beam; }
    uint64_t packedBytes() const { // per slot, at most
        return packsDepths() ? 4u + (thin ? 1u : 0u) + (hold ? 16u : 0u) : (hold ? 32u : 16u);
    }
    // Two filtered pixels per invocation: a sixth faster with many groups, slower with few.
    bool filterPairs() const { return manyPatches && tiled && !filterBlock && filterRadius == 2; }
    bool delivers() const { return passes && byPixel; }     // by a dispatch; CPU devices copy instead
    uint32_t dispatchesPerFrame() const;                    // of the frame cadence, without the query
    uint64_t setBytes(const PatchLayout& layout) const;     // buffers of one fixture set (cloud::SetBuffers)
    static uint64_t momentBytes(const PatchLayout& layout); // of one fixture set with guidance
};

// Range [m] below which neighbouring points of one surface (|dz| <= 0.7 of their distance) are nearer to each
// other than `radius` [m]. 0 = unknown: fans, distorted and very wide lenses.
double leaksFrom(const Intrinsics& lens, double radius) noexcept;

// Size of the image in 16x16 patches, and of each level of a tree over them. The device stores the bounds of
// levels 0 and 1, which queries search; frames.csv counts the nodes of all levels.
struct PatchLayout {
    uint32_t across = 0, down = 0;
    // One level: nodes across and down, index of the first.
    struct Level {
        uint32_t across, down, first;
    };
    std::vector<Level> levels; // 0 = 4x4 pixels, 1 = patches, ..., last = root
    uint32_t patches() const { return across * down; }
    uint32_t slots() const { return patches() * 256; }
    uint32_t bounds() const { return 17 * patches(); } // of levels 0 and 1
    uint32_t nodes() const { return levels.back().first + levels.back().across * levels.back().down; }
};
// Layout for a depth image [pixels]. Throws BadInput when it is empty or larger than 3840x2160.
PatchLayout patchLayout(uint32_t width, uint32_t height);

// Slot of a pixel in patch-major order: the same arithmetic as shaders/lib/slots.glsl.
inline uint32_t slotOfPixel(uint32_t u, uint32_t v, uint32_t patchesAcross) {
    return ((v / 16) * patchesAcross + u / 16) * 256 + ((v % 16 / 4) * 4 + u % 16 / 4) * 16 + (v % 4) * 4 +
           u % 4;
}

// toolLeaves chooses between CPU and GPU query for `auto`: the GPU from DeviceFacts::gpuQueryLeaves on,
// unless the device is a CPU. Both answers are equal to the last bit. Throws BadInput for a camera out of
// range, and for an image whose buffers exceed what the device can read.
Plan makePlan(const Scene& scene, const CameraInfo& camera, uint32_t toolLeaves, const DeviceFacts& device);

} // namespace fathom
