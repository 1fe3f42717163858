// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sphere_sets.h"

#include "engine/model/sph_file.h"
#include "engine/model/urdf_file.h"
#include "engine/types/error.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cmath>
#include <urdf_model/model.h>
#include <yaml-cpp/yaml.h>

namespace fathom {

namespace {

constexpr size_t kLargestSet =
    1u << 20; // 15 000 spheres; real sets have 50 kB, and the parser needs up to 250 bytes per byte
constexpr size_t kShownNames = 1000;
constexpr size_t kMostSpheres = 65536; // over all links: an alias can repeat one list for each link

std::string lineOf(const YAML::Node& node) {
    return "line " + std::to_string(node.Mark().line + 1);
}

double number(const std::string& file, const YAML::Node& node) {
    double value = NAN;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
        throw BadInput(file, lineOf(node), node.IsScalar() ? "'" + excerpt(node.Scalar()) + "'" : "no number",
                       "a finite number [m]");
    }
    return value;
}

Sphere sphereOf(const std::string& file, const YAML::Node& entry) {
    const YAML::Node centre = entry.IsMap() ? entry["center"] : YAML::Node();
    const YAML::Node radius = entry.IsMap() ? entry["radius"] : YAML::Node();
    if (!centre || !centre.IsSequence() || centre.size() != 3 || !radius) {
        throw BadInput(file, lineOf(entry), "not a sphere", "{center: [x, y, z], radius: r}");
    }
    return {{number(file, centre[0]), number(file, centre[1]), number(file, centre[2])},
            number(file, radius)};
}

// `levels` bounds the depth as in cuRobo's files: an alias may refer to its own table.
YAML::Node sectionOf(const YAML::Node& root, int levels = 3) {
    if (levels == 0 || !root.IsMap()) {
        return {};
    }
    for (const char* name : {"collision_spheres", "robot_cfg", "kinematics"}) {
        const YAML::Node below = root[name];
        if (below && std::string(name) == "collision_spheres") {
            return below;
        }
        if (below) {
            if (const YAML::Node found = sectionOf(below, levels - 1)) {
                return found;
            }
        }
    }
    return {};
}

std::string namesOf(const std::vector<LinkSpheres>& sets) {
    std::string names;
    for (const LinkSpheres& set : sets) {
        names += (names.empty() ? "" : ", ") + set.link;
    }
    return excerpt(std::move(names), kShownNames);
}

} // namespace

std::vector<LinkSpheres> readSpherizedUrdf(const std::filesystem::path& file) {
    const auto model = readUrdf(file);
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

std::vector<LinkSpheres> readCuroboYaml(const std::filesystem::path& file) {
    const std::string text = readWholeFile(file, kLargestSet, "a readable YAML file");
    YAML::Node root;
    try {
        root = YAML::Load(text);
    } catch (const YAML::Exception& e) {
        throw BadInput(file.string(), "line " + std::to_string(e.mark.line + 1), excerpt(e.msg),
                       "a readable YAML file");
    }
    const YAML::Node section = sectionOf(root);
    if (!section || !section.IsMap()) {
        throw BadInput(file.string(), "collision_spheres", "missing or not a table",
                       "{LINK: [{center: [x, y, z], radius: r}]}");
    }
    std::vector<LinkSpheres> sets;
    size_t all = 0;
    for (const auto& entry : section) {
        LinkSpheres set{entry.first.Scalar(), {}};
        if (!entry.second.IsSequence()) {
            throw BadInput(file.string(), lineOf(entry.second), "link " + excerpt(set.link) + ": not a list",
                           "a list of spheres");
        }
        all += entry.second.size();
        if (all > kMostSpheres) {
            throw BadInput(file.string(), "collision_spheres", "over " + std::to_string(kMostSpheres),
                           std::to_string(kMostSpheres) + " spheres at most");
        }
        for (const YAML::Node& sphere : entry.second) {
            const Sphere s = sphereOf(file.string(), sphere);
            if (s.radius > 0.0) {
                set.spheres.push_back(s);
            }
        }
        if (!set.spheres.empty()) {
            sets.push_back(std::move(set));
        }
    }
    return sets;
}

SphereTree readSphereTree(const std::filesystem::path& file, const std::string& link) {
    std::string kind = file.extension().string();
    std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
    if (kind == ".sph") {
        return readSph(file);
    }
    if (kind != ".urdf" && kind != ".yaml" && kind != ".yml") {
        throw BadInput(file.string(), "kind of file", "'" + kind + "'", ".sph, .urdf, .yaml, .yml");
    }
    const auto sets = kind == ".urdf" ? readSpherizedUrdf(file) : readCuroboYaml(file);
    if (sets.empty()) {
        throw BadInput(file.string(), "spheres", "none", "a link with collision spheres");
    }
    const auto found =
        std::find_if(sets.begin(), sets.end(), [&](const LinkSpheres& s) { return s.link == link; });
    if (found == sets.end() && !(link.empty() && sets.size() == 1)) {
        throw BadInput(file.string(), "link", link.empty() ? "not named" : "'" + link + "'", namesOf(sets));
    }
    return buildSphereTree(found == sets.end() ? sets[0].spheres : found->spheres);
}

} // namespace fathom
