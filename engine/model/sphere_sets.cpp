// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sphere_sets.h"

#include "engine/model/sph_file.h"
#include "engine/model/urdf_file.h"
#include "engine/types/error.h"
#include "engine/types/joined.h"
#include "engine/types/log.h"
#include "engine/types/number_text.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <urdf_model/model.h>

namespace fathom {

namespace {

constexpr size_t kShownNames = 1000;

std::string shapeWord(const urdf::Geometry& shape) {
    return capsuleOf(shape)                       ? "a capsule"
           : shape.type == urdf::Geometry::BOX    ? "a box"
           : shape.type == urdf::Geometry::SPHERE ? "a sphere"
           : shape.type == urdf::Geometry::MESH   ? "a mesh"
                                                  : "a cylinder";
}

Sphere collisionSphere(const urdf::Collision& collision, const std::filesystem::path& file,
                       const std::string& field) {
    const auto* ball = dynamic_cast<const urdf::Sphere*>(collision.geometry.get());
    if (ball == nullptr) {
        throw BadInput(file.string(), field, shapeWord(*collision.geometry),
                       "spheres; `fathom spheres " + file.filename().string() +
                           " --out NEW.urdf` covers other shapes with spheres");
    }
    const Sphere sphere{poseOf(collision.origin).position, ball->radius};
    if (!isFinite(sphere.centre) || !(sphere.radius > 0.0) || !std::isfinite(sphere.radius)) {
        throw BadInput(file.string(), field, "a sphere of radius " + significant(ball->radius, 6),
                       "finite centre, radius above 0");
    }
    return sphere;
}

} // namespace

void growSpheres(const std::filesystem::path& file, LinkSpheres& set, double distance) {
    constexpr double kDisabled = -1.0, kMin = 1e-3; // [m]
    std::erase_if(set.spheres,
                  [&](const Sphere& s) { return std::min(s.radius, s.radius + distance) <= kDisabled; });
    for (Sphere& s : set.spheres) {
        s.radius = s.radius + distance > 0.0 ? s.radius + distance : kMin;
    }
    if (set.spheres.empty()) {
        log::warn("{}: link {}: all spheres are disabled by radii of -1 or less", file.string(),
                  excerpt(printable(set.link)));
    }
}

std::string namesOf(const std::vector<LinkSpheres>& sets) {
    return excerpt(joined(sets, &LinkSpheres::link), kShownNames);
}

std::vector<LinkSpheres> readSpherizedUrdf(const std::filesystem::path& file, const std::string& wanted,
                                           const ReaderOptions& reader) {
    const auto model = readUrdf(file, reader);
    std::vector<LinkSpheres> sets;
    for (const auto& [name, link] : model->links_) {
        LinkSpheres set{name, {}};
        for (size_t i = 0; i < link->collision_array.size(); ++i) {
            const urdf::Collision& collision = *link->collision_array[i];
            if (wanted.empty() || wanted == name || collision.geometry->type == urdf::Geometry::SPHERE) {
                set.spheres.push_back(collisionSphere(
                    collision, file, "link " + printable(name) + ", collision " + std::to_string(i + 1)));
            }
        }
        if (!set.spheres.empty()) {
            sets.push_back(std::move(set));
        }
    }
    return sets;
}

bool isSphereFile(const std::filesystem::path& file) {
    const std::string kind = endingOf(file);
    return kind == ".sph" || kind == ".urdf" || kind == ".yaml" || kind == ".yml" || kind == ".xrdf" ||
           kind == ".json";
}

std::vector<LinkSpheres> readSets(const std::filesystem::path& file, const std::string& link,
                                  const ReaderOptions& reader) {
    const std::string kind = endingOf(file);
    std::vector<LinkSpheres> sets;
    if (kind == ".sph") {
        const SphereTree tree = readSph(file);
        sets.push_back({file.stem().string(), {}});
        std::copy_if(tree.lastLevel().begin(), tree.lastLevel().end(), std::back_inserter(sets[0].spheres),
                     [](const Sphere& s) { return s.radius >= 0.0; });
    } else if (kind == ".urdf") {
        sets = readSpherizedUrdf(file, link, reader);
    } else if (kind == ".json") {
        sets = readFoam(file);
    } else if (isSphereFile(file)) {
        sets = kind == ".xrdf" ? readXrdf(file) : readYamlSets(file);
    } else {
        throw BadInput(file.string(), "kind of file", "'" + kind + "'",
                       ".sph, .urdf, .yaml, .yml, .xrdf, .json");
    }
    if (sets.empty()) {
        throw BadInput(file.string(), "spheres", "none", "a link with collision spheres");
    }
    return selectLink(std::move(sets), link, file);
}

std::vector<LinkSpheres> selectLink(std::vector<LinkSpheres> sets, const std::string& link,
                                    const std::filesystem::path& file) {
    if (link.empty()) {
        return sets;
    }
    const auto found = std::ranges::find(sets, link, &LinkSpheres::link);
    if (found == sets.end()) {
        throw BadInput(file.string(), "link", "'" + link + "'", namesOf(sets));
    }
    return {*found};
}

SphereTree readSphereTree(const std::filesystem::path& file, const std::string& link,
                          const ReaderOptions& reader) {
    if (endingOf(file) == ".sph") {
        if (!link.empty()) {
            throw BadInput(file.string(), "link", link, "none: a .sph file has no links");
        }
        return readSph(file);
    }
    const auto sets = readSets(file, link, reader);
    if (sets.size() > 1) {
        throw BadInput(file.string(), "link", "not named", namesOf(sets));
    }
    return buildSphereTree(sets[0].spheres);
}

} // namespace fathom
