// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sphere_sets.h"

#include "engine/model/sph_file.h"
#include "engine/model/urdf_file.h"
#include "engine/types/error.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <urdf_model/model.h>

namespace fathom {

namespace {

constexpr size_t kShownNames = 1000;

std::string namesOf(const std::vector<LinkSpheres>& sets) {
    std::string names;
    for (const LinkSpheres& set : sets) {
        names += (names.empty() ? "" : ", ") + set.link;
    }
    return excerpt(std::move(names), kShownNames);
}

} // namespace

std::vector<LinkSpheres> readSpherizedUrdf(const std::filesystem::path& file, const ReaderOptions& reader) {
    const auto model = readUrdf(file, reader);
    std::vector<LinkSpheres> sets;
    for (const auto& [name, link] : model->links_) {
        LinkSpheres set{name, {}};
        for (const auto& collision : link->collision_array) {
            const auto* ball = dynamic_cast<const urdf::Sphere*>(collision->geometry.get());
            if (ball == nullptr) {
                continue;
            }
            const Sphere sphere{poseOf(collision->origin).position, ball->radius};
            if (!isFinite(sphere.centre) || !(sphere.radius > 0.0) || !std::isfinite(sphere.radius)) {
                throw BadInput(file.string(), "link " + name + ", sphere", std::to_string(ball->radius),
                               "finite centre, radius above 0");
            }
            set.spheres.push_back(sphere);
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

std::vector<LinkSpheres> readSets(const std::filesystem::path& file, const ReaderOptions& reader) {
    const std::string kind = endingOf(file);
    std::vector<LinkSpheres> sets;
    if (kind == ".sph") {
        const SphereTree tree = readSph(file);
        sets.push_back({file.stem().string(), {}});
        std::copy_if(tree.lastLevel().begin(), tree.lastLevel().end(), std::back_inserter(sets[0].spheres),
                     [](const Sphere& s) { return s.radius >= 0.0; });
    } else if (kind == ".urdf") {
        sets = readSpherizedUrdf(file, reader);
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
    return sets;
}

std::vector<LinkSpheres> selectLink(std::vector<LinkSpheres> sets, const std::string& link,
                                    const std::filesystem::path& file) {
    if (link.empty()) {
        return sets;
    }
    const auto found =
        std::find_if(sets.begin(), sets.end(), [&](const LinkSpheres& s) { return s.link == link; });
    if (found == sets.end()) {
        throw BadInput(file.string(), "link", "'" + link + "'", namesOf(sets));
    }
    return {*found};
}

SphereTree readSphereTree(const std::filesystem::path& file, const std::string& link,
                          const ReaderOptions& reader) {
    if (endingOf(file) == ".sph") {
        return readSph(file);
    }
    const auto sets = selectLink(readSets(file, reader), link, file);
    if (sets.size() > 1) {
        throw BadInput(file.string(), "link", "not named", namesOf(sets));
    }
    return buildSphereTree(sets[0].spheres);
}

} // namespace fathom
