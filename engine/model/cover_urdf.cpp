// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_urdf.h"

#include "engine/model/cover_links.h"
#include "engine/model/urdf_file.h"
#include "engine/types/error.h"

#include <urdf_model/model.h>

namespace fathom {

UrdfCover coverUrdf(const std::filesystem::path& file, const std::filesystem::path& meshes, uint32_t leaves,
                    bool keepStray, const ReaderOptions& reader) {
    const auto model = readUrdf(file, reader);
    std::vector<LinkGeometry> shapes;
    std::vector<Pose> places; // in the link
    for (const auto& [name, link] : model->links_) {
        for (const auto& collision : link->collision_array) {
            shapes.push_back({name, collision->geometry});
            places.push_back(poseOf(collision->origin));
        }
    }
    const auto made = spheresOf(shapes, {file, meshes, keepStray, reader}, leaves);
    UrdfCover cover;
    cover.notes = model->notes;
    for (size_t i = 0; i < shapes.size(); ++i) {
        for (const std::string& note : made[i].notes) {
            cover.notes.push_back("link " + shapes[i].link + ": " + note);
        }
        if (!made[i].spheres.empty() && (cover.links.empty() || cover.links.back().link != shapes[i].link)) {
            cover.links.push_back({shapes[i].link, {}});
        }
        for (const Sphere& s : made[i].spheres) {
            cover.links.back().spheres.push_back({places[i].apply(s.centre), s.radius});
        }
    }
    if (cover.links.empty()) {
        throw BadInput(file.string(), "collision", "no shapes on any link", "links with collision geometry");
    }
    return cover;
}

} // namespace fathom
