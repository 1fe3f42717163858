// SPDX-License-Identifier: Apache-2.0
#include "engine/model/urdf_file.h"

#include "engine/types/error.h"

#include <cmath>
#include <locale>
#include <sstream>
#include <string_view>

namespace fathom {

std::optional<CapsuleSize> capsuleOf(const urdf::Geometry& shape) {
    const auto* mesh = dynamic_cast<const urdf::Mesh*>(&shape);
    if (mesh == nullptr || mesh->filename.rfind(kCapsuleFile, 0) != 0) {
        return std::nullopt;
    }
    std::istringstream sizes(mesh->filename.substr(std::string_view(kCapsuleFile).size()));
    sizes.imbue(std::locale::classic());
    CapsuleSize size{NAN, NAN};
    return sizes >> size.radius >> size.length ? size : CapsuleSize{NAN, NAN};
}

std::shared_ptr<const UrdfModel> readUrdf(const std::filesystem::path& file, const ReaderOptions& options) {
    std::string fault, packet;
    std::shared_ptr<const UrdfModel> model;
    const ReaderEnd end = runReader("urdf", file, options, [&](ReaderPipe& pipe) {
        uint64_t size = 0;
        if (!pipe.readText(fault) || !pipe.read(&size, sizeof size) || size > kMaxUrdfBytes) {
            return false;
        }
        packet.resize(size);
        if (!pipe.read(packet.data(), size)) {
            return false;
        }
        model = fault.empty() ? unpackUrdf(packet) : nullptr;
        return model != nullptr || !fault.empty();
    });
    refuseForeign(options, end);
    if (!end.whole) {
        throw BadInput(file.string(), "robot", broken("URDF reader", end), "a URDF robot");
    }
    if (!fault.empty()) {
        throw BadInput(fault);
    }
    return model;
}

Pose poseOf(const urdf::Pose& pose) {
    const urdf::Rotation& r = pose.rotation;
    return {{pose.position.x, pose.position.y, pose.position.z}, glm::normalize(dquat(r.w, r.x, r.y, r.z))};
}

} // namespace fathom
