// SPDX-License-Identifier: Apache-2.0
// What Fathom uses of a URDF, as bytes between fathom-reader and the process that asked it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <urdf_model/model.h>
#include <vector>

namespace fathom {

inline constexpr size_t kMaxLinks = 1000;            // traversals from the root are recursive
inline constexpr uint64_t kMaxUrdfBytes = 64u << 20; // of a packet

// A capsule is a mesh whose file name is this, its radius and its length: the parser knows no capsules.
inline constexpr const char* kCapsuleFile = "capsule: ";

// A URDF with notes for the user on what of the file was not read, one line each.
struct UrdfModel : urdf::ModelInterface {
    std::vector<std::string> notes;
};

// Notes, links with their collision shapes, joints with their limits and what they mimic. Of visuals and
// inertia only whether there are any.
std::string packUrdf(const urdf::ModelInterface& model, const std::vector<std::string>& notes);
// Null when the bytes are not such a packet, or its links are not a tree below one root.
std::shared_ptr<const UrdfModel> unpackUrdf(std::string_view packet);

} // namespace fathom
