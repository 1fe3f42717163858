// SPDX-License-Identifier: Apache-2.0
#include "engine/model/arm_shapes.h"

#include "engine/model/cover_links.h"
#include "engine/model/urdf_file.h"

#include <set>

namespace fathom {

void ArmShapes::add(const urdf::Link& link, const Pose& frameTlink, const LinkCarrier& carrier) {
    for (const auto& collision : link.collision_array) {
        shapes_.push_back({link.name, collision->geometry, frameTlink * poseOf(collision->origin), carrier});
    }
}

void ArmShapes::cover(const std::filesystem::path& urdf, const ArmOptions& options, ArmModel& model) const {
    std::vector<LinkGeometry> all;
    for (const Shape& shape : shapes_) {
        all.push_back({shape.link, shape.geometry});
    }
    const auto made =
        spheresOf(all, {urdf, options.meshes, options.keepStray, options.reader}, options.leavesPerShape);
    std::set<std::string> outside; // files
    std::vector<std::string> open; // links of meshes
    for (size_t i = 0; i < shapes_.size(); ++i) {
        const Shape& shape = shapes_[i];
        for (const std::string& note : made[i].notes) {
            model.notes.push_back("link " + shape.link + ": " + note);
        }
        if (!made[i].outside.empty()) {
            outside.insert(made[i].outside.lexically_normal().string());
        }
        if (made[i].open) {
            open.push_back(shape.link);
        }
        if (!made[i].spheres.empty() && (model.links.empty() || model.links.back() != shape.link)) {
            model.links.push_back(shape.link);
        }
        for (const Sphere& s : made[i].spheres) {
            model.leaves.push_back({{shape.frameTshape.apply(s.centre), s.radius},
                                    shape.carrier.joint,
                                    static_cast<uint32_t>(model.links.size() - 1),
                                    shape.carrier.finger});
        }
    }
    if (!open.empty()) {
        model.notes.push_back("meshes that are not closed and are covered at their surface only: " +
                              std::to_string(open.size()) + ", the first on link " + open[0]);
    }
    if (!outside.empty()) {
        model.notes.push_back("meshes outside their search folder: " + std::to_string(outside.size()) +
                              ", the first " + *outside.begin());
    }
}

} // namespace fathom
