// SPDX-License-Identifier: Apache-2.0
// Targets that read shapes: sphere files, arms, meshes.
#include "engine/model/arm_model.h"
#include "engine/model/mesh_file.h"
#include "engine/model/sph_file.h"
#include "engine/model/sphere_sets.h"
#include "engine/model/urdf_packet.h"
#include "engine/types/error.h"
#include "tests/fuzz/fuzz_target.h"

#include <array>
#include <cstdlib>
#include <vector>

namespace fathom::testing {

namespace {

void needSound(const SphereTree& tree) {
    if (!validate(tree).empty()) {
        std::abort();
    }
}

} // namespace

void readSphFile(Bytes input) {
    needSound(readSph(fuzzFile("tree.sph", input)));
}

void readSpheresYaml(Bytes input) {
    try {
        needSound(readSphereTree(fuzzFile("spheres.yaml", input))); // of cuRobo, or XRDF
    } catch (const Error&) {
        // it can still be JSON of foam
    }
    for (const LinkSpheres& set : readSets(fuzzFile("spheres.json", input))) {
        needSound(buildSphereTree(set.spheres));
    }
}

void readUrdfFile(Bytes input) {
    const auto file = fuzzFile("arm.urdf", input);
    try {
        needSound(readSphereTree(file));
    } catch (const Error&) {
        // no spheres; it can still be an arm
    }
    ArmOptions few;
    few.leavesPerShape = 1; // covering a shape is slow and reads no untrusted input
    const ArmModel arm = loadArm(file, few);
    JointVector q{};
    ArmFrames frames;
    arm.follow(q);
    arm.place(q, {}, frames);
    for (size_t i = 0; i < arm.leaves.size(); ++i) {
        if (!isFinite(arm.centre(frames, i))) {
            std::abort();
        }
    }
}

// What fathom-reader sends: a tree below one root, or nothing.
void readUrdfPacket(Bytes input) {
    const auto model = unpackUrdf({reinterpret_cast<const char*>(input.data()), input.size()});
    if (!model) {
        throw Error("not a packet");
    }
    std::vector<const urdf::Link*> open{model->getRoot().get()};
    size_t reached = 0;
    for (; !open.empty() && reached <= kMaxLinks; ++reached) {
        const urdf::Link* const link = open.back();
        open.pop_back();
        for (const auto& child : link->child_links) {
            open.push_back(child.get());
        }
    }
    need(reached == model->links_.size());
}

// The first byte selects the kind of file.
void readMesh(Bytes input) {
    if (input.empty()) {
        return;
    }
    constexpr std::array kNames{"mesh.stl", "mesh.obj", "mesh.dae"};
    const LoadedMesh loaded = loadMesh(fuzzFile(kNames[input[0] % kNames.size()], input.subspan(1)));
    for (const auto& triangle : loaded.mesh.triangles) {
        for (uint32_t corner : triangle) {
            if (corner >= loaded.mesh.points.size() || !isFinite(loaded.mesh.points[corner])) {
                std::abort();
            }
        }
    }
}

} // namespace fathom::testing
