// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sphere_sets.h"
#include "engine/types/error.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cmath>
#include <yaml-cpp/yaml.h>

namespace fathom {

namespace {

constexpr size_t kLargestSet =
    1u << 20; // 15 000 spheres; real sets have 50 kB, and the parser needs up to 250 bytes per byte
constexpr size_t kMaxSpheres = 65536; // over all links: an alias can repeat one list for each link

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

// key: "center", or "origin" of foam.
Sphere sphereOf(const std::string& file, const YAML::Node& entry, const std::string& key) {
    const YAML::Node centre = entry.IsMap() ? entry[key] : YAML::Node();
    const YAML::Node radius = entry.IsMap() ? entry["radius"] : YAML::Node();
    if (!centre || !centre.IsSequence() || centre.size() != 3 || !radius) {
        throw BadInput(file, lineOf(entry), "not a sphere", "{" + key + ": [x, y, z], radius: r}");
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

YAML::Node loadYaml(const std::filesystem::path& file) {
    const std::string text = readWholeFile(file, kLargestSet, "a readable YAML file");
    try {
        return YAML::Load(text);
    } catch (const YAML::Exception& e) {
        throw BadInput(file.string(), "line " + std::to_string(e.mark.line + 1), excerpt(e.msg),
                       "a readable YAML file");
    }
}

// A list of spheres; `all` counts those of the file.
std::vector<Sphere> spheresOf(const std::filesystem::path& file, const std::string& link,
                              const YAML::Node& list, const std::string& key, size_t& all) {
    if (!list.IsSequence()) {
        throw BadInput(file.string(), lineOf(list), "link " + excerpt(link) + ": not a list",
                       "a list of spheres");
    }
    all += list.size();
    if (all > kMaxSpheres) {
        throw BadInput(file.string(), "collision_spheres", "over " + std::to_string(kMaxSpheres),
                       std::to_string(kMaxSpheres) + " spheres at most");
    }
    std::vector<Sphere> spheres;
    for (const YAML::Node& entry : list) {
        const Sphere s = sphereOf(file.string(), entry, key);
        if (s.radius > 0.0) {
            spheres.push_back(s);
        }
    }
    return spheres;
}

std::vector<LinkSpheres> linksOf(const std::filesystem::path& file, const YAML::Node& section) {
    std::vector<LinkSpheres> sets;
    size_t all = 0;
    for (const auto& entry : section) {
        const std::string link = entry.first.IsScalar() ? entry.first.Scalar() : "";
        LinkSpheres set{link, spheresOf(file, link, entry.second, "center", all)};
        if (!set.spheres.empty()) {
            sets.push_back(std::move(set));
        }
    }
    return sets;
}

YAML::Node tableOf(const YAML::Node& node, const std::string& key) {
    return node && node.IsMap() ? node[key] : YAML::Node(YAML::NodeType::Undefined);
}

// The name of the geometry that an XRDF uses for collisions.
std::string geometryOf(const std::filesystem::path& file, const YAML::Node& root,
                       const YAML::Node& geometry) {
    const YAML::Node named = tableOf(tableOf(root, "collision"), "geometry");
    if (named && named.IsScalar()) {
        return named.Scalar();
    }
    if (geometry.size() != 1 || !geometry.begin()->first.IsScalar()) {
        throw BadInput(file.string(), "collision.geometry", "missing",
                       "the name of one of several geometries");
    }
    return geometry.begin()->first.Scalar();
}

void grow(const std::filesystem::path& file, const YAML::Node& buffers, std::vector<LinkSpheres>& sets) {
    for (LinkSpheres& set : sets) {
        const YAML::Node buffer = tableOf(buffers, set.link);
        for (Sphere& s : set.spheres) {
            s.radius += buffer ? number(file.string(), buffer) : 0.0;
        }
        std::erase_if(set.spheres, [](const Sphere& s) { return !(s.radius > 0.0); });
    }
    std::erase_if(sets, [](const LinkSpheres& set) { return set.spheres.empty(); });
}

std::vector<LinkSpheres> xrdfSets(const std::filesystem::path& file, const YAML::Node& root) {
    const YAML::Node geometry = tableOf(root, "geometry");
    if (!geometry || !geometry.IsMap()) {
        throw BadInput(file.string(), "geometry", "missing or not a table",
                       "{NAME: {spheres: {LINK: [...]}}}");
    }
    const std::string name = geometryOf(file, root, geometry);
    const YAML::Node spheres = tableOf(tableOf(geometry, name), "spheres");
    if (!spheres || !spheres.IsMap()) {
        throw BadInput(file.string(), "geometry." + excerpt(name) + ".spheres", "missing or not a table",
                       "{LINK: [{center: [x, y, z], radius: r}]}");
    }
    std::vector<LinkSpheres> sets = linksOf(file, spheres);
    grow(file, tableOf(tableOf(root, "collision"), "buffer_distance"), sets);
    return sets;
}

std::vector<LinkSpheres> curoboSets(const std::filesystem::path& file, const YAML::Node& root) {
    const YAML::Node section = sectionOf(root);
    if (!section || !section.IsMap()) {
        throw BadInput(file.string(), "collision_spheres", "missing or not a table",
                       "{LINK: [{center: [x, y, z], radius: r}]}");
    }
    return linksOf(file, section);
}

bool isXrdf(const YAML::Node& root) {
    const YAML::Node format = tableOf(root, "format");
    return format && format.IsScalar() && format.Scalar() == "xrdf";
}

} // namespace

std::vector<LinkSpheres> readCuroboYaml(const std::filesystem::path& file) {
    return curoboSets(file, loadYaml(file));
}

std::vector<LinkSpheres> readXrdf(const std::filesystem::path& file) {
    return xrdfSets(file, loadYaml(file));
}

std::vector<LinkSpheres> readFoam(const std::filesystem::path& file) {
    YAML::Node root = loadYaml(file); // JSON is YAML
    if (root.IsSequence() && root.size() > 0) {
        root = root[root.size() - 1];
    }
    size_t all = 0;
    std::vector<LinkSpheres> sets;
    if (const YAML::Node spheres = tableOf(root, "spheres"); spheres && spheres.IsSequence()) {
        const std::string link = file.stem().string();
        sets.push_back({link, spheresOf(file, link, spheres, "origin", all)});
        return sets;
    }
    if (!root.IsMap()) {
        throw BadInput(file.string(), "spheres", "missing",
                       "{\"LINK::shape\": {\"spheres\": [{\"origin\": [x, y, z], \"radius\": r}]}}");
    }
    for (const auto& entry : root) {
        const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
        const std::string link = name.substr(0, name.find("::"));
        const YAML::Node list = tableOf(entry.second, "spheres");
        const auto more = spheresOf(file, link, list ? list : entry.second, "origin", all);
        const auto same = [&](const LinkSpheres& set) { return set.link == link; };
        auto set = std::find_if(sets.begin(), sets.end(), same);
        set = set == sets.end() ? sets.insert(sets.end(), LinkSpheres{link, {}}) : set;
        set->spheres.insert(set->spheres.end(), more.begin(), more.end());
    }
    std::erase_if(sets, [](const LinkSpheres& set) { return set.spheres.empty(); });
    return sets;
}

std::vector<LinkSpheres> readYamlSets(const std::filesystem::path& file) {
    const YAML::Node root = loadYaml(file);
    return isXrdf(root) ? xrdfSets(file, root) : curoboSets(file, root);
}

} // namespace fathom
