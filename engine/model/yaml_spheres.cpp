// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sphere_sets.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"
#include "engine/types/suggestion.h"
#include "engine/types/yaml_document.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace fathom {

namespace {

constexpr size_t kLargestSet =
    1u << 20; // 15 000 spheres; real sets have 50 kB, and the parser needs up to 250 bytes per byte
constexpr size_t kMaxSpheres = 65536; // over all links: an alias can repeat one list for each link

constexpr const char* kLinks = "{LINK: [{center: [x, y, z], radius: r}]}";

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

[[noreturn]] void refuseRepeated(const std::string& file, const YAML::Node& value, const std::string& key) {
    throw BadInput(file, lineOf(value), "'" + excerpt(key) + "' given twice", "each key once");
}

// The value of a key; yaml-cpp itself would take the first of several.
YAML::Node tableOf(const std::string& file, const YAML::Node& node, const std::string& key) {
    YAML::Node found(YAML::NodeType::Undefined);
    for (auto entry = node.begin(); node.IsMap() && entry != node.end(); ++entry) {
        if (!entry->first.IsScalar() || entry->first.Scalar() != key) {
            continue;
        }
        if (found.IsDefined()) {
            refuseRepeated(file, entry->second, key);
        }
        found.reset(entry->second);
    }
    return found;
}

// key: "center", or "origin" of foam.
Sphere sphereOf(const std::string& file, const YAML::Node& entry, const std::string& key) {
    const YAML::Node centre = tableOf(file, entry, key), radius = tableOf(file, entry, "radius");
    if (!centre || !centre.IsSequence() || centre.size() != 3 || !radius) {
        throw BadInput(file, lineOf(entry), "not a sphere", "{" + key + ": [x, y, z], radius: r}");
    }
    return {{number(file, centre[0]), number(file, centre[1]), number(file, centre[2])},
            number(file, radius)};
}

// The table that holds `collision_spheres`. `levels` bounds the depth as in cuRobo's files: an alias may
// refer to its own table.
YAML::Node holderOf(const std::string& file, const YAML::Node& root, int levels = 3) {
    if (levels == 0 || tableOf(file, root, "collision_spheres").IsDefined()) {
        return levels == 0 ? YAML::Node(YAML::NodeType::Undefined) : root;
    }
    for (const char* name : {"robot_cfg", "kinematics"}) {
        if (const YAML::Node below = tableOf(file, root, name)) {
            if (const YAML::Node found = holderOf(file, below, levels - 1)) {
                return found;
            }
        }
    }
    return YAML::Node(YAML::NodeType::Undefined);
}

YAML::Node loadYaml(const std::filesystem::path& file) {
    const std::string text = readWholeFile(file, kLargestSet, "a readable YAML file");
    try {
        return onlyYamlDocument(file.string(), text);
    } catch (const YAML::Exception& e) {
        throw BadInput(file.string(), "line " + std::to_string(e.mark.line + 1), excerpt(e.msg),
                       "a readable YAML file");
    }
}

// A list of spheres; `all` counts those of the file.
std::vector<Sphere> spheresOf(const std::filesystem::path& file, const std::string& link,
                              const YAML::Node& list, const std::string& key, size_t& all) {
    if (list.IsNull()) { // as cuRobo's `attached_object`
        return {};
    }
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
        if (s.radius > 0.0 || key == "center") { // cuRobo's may grow
            spheres.push_back(s);
        }
    }
    return spheres;
}

// Links of a table, or of a list of tables as in Lula's files; also those without spheres.
std::vector<LinkSpheres> linksOf(const std::filesystem::path& file, const YAML::Node& section) {
    std::vector<YAML::Node> tables(section.begin(), section.IsSequence() ? section.end() : section.begin());
    if (section.IsMap()) {
        tables.push_back(section);
    }
    std::vector<LinkSpheres> sets;
    std::set<std::string> seen;
    size_t all = 0;
    for (const YAML::Node& table : tables) {
        if (!table.IsMap()) {
            throw BadInput(file.string(), lineOf(table), "no table", kLinks);
        }
        for (const auto& entry : table) {
            const std::string link = entry.first.IsScalar() ? entry.first.Scalar() : "";
            if (!seen.insert(link).second) {
                refuseRepeated(file.string(), entry.second, link);
            }
            sets.push_back({link, spheresOf(file, link, entry.second, "center", all)});
        }
    }
    return sets;
}

// The section of an XRDF about collisions with the world; format_version 2.0 has another name for it.
const char* collisionKey(const std::filesystem::path& file, const YAML::Node& root) {
    return tableOf(file.string(), root, "world_collision").IsDefined() ? "world_collision" : "collision";
}

// The name of the geometry that an XRDF uses for collisions.
std::string geometryOf(const std::filesystem::path& file, const YAML::Node& root,
                       const YAML::Node& geometry) {
    const std::string key = collisionKey(file, root);
    const YAML::Node named = tableOf(file.string(), tableOf(file.string(), root, key), "geometry");
    if (named && named.IsScalar()) {
        return named.Scalar();
    }
    if (geometry.size() != 1 || !geometry.begin()->first.IsScalar()) {
        throw BadInput(file.string(), key + ".geometry", "missing", "the name of one of several geometries");
    }
    return geometry.begin()->first.Scalar();
}

// Adds the distances of a key, {LINK: d} or one for all links, to the radii, and drops links without spheres.
// A distance for such a link gives a warning, unless it seems to be meant for another one.
void growBy(const std::filesystem::path& file, const YAML::Node& table, const std::string& key,
            const std::string& field, std::vector<LinkSpheres>& sets) {
    const YAML::Node distances = tableOf(file.string(), table, key);
    if (distances && distances.IsSequence()) {
        throw BadInput(file.string(), field, "a list", "distance or {LINK: distance}");
    }
    const bool same = distances.IsDefined() && distances.IsScalar();
    const double all = same ? number(file.string(), distances) : 0.0;
    std::vector<std::string_view> bare; // links without a distance, of which one may be misspelt
    for (LinkSpheres& set : sets) {
        const YAML::Node own = tableOf(file.string(), distances, set.link);
        bare.insert(bare.end(), own ? 0 : 1, set.link);
        if (!set.spheres.empty()) {
            growSpheres(file, set, own ? number(file.string(), own) : all);
        }
    }
    for (auto entry = distances.begin(); distances.IsMap() && entry != distances.end(); ++entry) {
        const std::string link = entry->first.IsScalar() ? entry->first.Scalar() : "";
        if (std::ranges::find(sets, link, &LinkSpheres::link) != sets.end()) {
            continue;
        }
        if (std::ranges::any_of(bare, [&](std::string_view name) { return isMisspelt(link, name); })) {
            throw BadInput(file.string(), field, "link '" + excerpt(link) + "'", namesOf(sets));
        }
        log::warn("{}: {}: link {} has no spheres", file.string(), field, excerpt(printable(link)));
    }
    std::erase_if(sets, [](const LinkSpheres& set) { return set.spheres.empty(); });
}

void warnIfNewer(const std::string& file, const YAML::Node& root) {
    constexpr double kNewest = 2.0;
    const YAML::Node version = tableOf(file, root, "format_version");
    double stated = 0.0;
    if (version && version.IsScalar() && YAML::convert<double>::decode(version, stated) && stated > kNewest) {
        log::warn("{}: format_version {:.4g} is newer than {:.4g}: keys of it may be missed", file, stated,
                  kNewest);
    }
}

std::vector<LinkSpheres> xrdfSets(const std::filesystem::path& file, const YAML::Node& root) {
    const std::string name = file.string();
    warnIfNewer(name, root);
    const YAML::Node geometry = tableOf(name, root, "geometry");
    if (!geometry || !geometry.IsMap()) {
        throw BadInput(name, "geometry", "missing or not a table", "{NAME: {spheres: {LINK: [...]}}}");
    }
    const std::string used = geometryOf(file, root, geometry);
    const YAML::Node model = tableOf(name, geometry, used), spheres = tableOf(name, model, "spheres");
    if (!spheres || !spheres.IsMap()) {
        throw BadInput(name, "geometry." + excerpt(used) + ".spheres", "missing or not a table", kLinks);
    }
    for (const auto& entry : model) { // such as `clone`, whose spheres would be missing
        if (!entry.first.IsScalar() || entry.first.Scalar() != "spheres") {
            throw BadInput(name, "geometry." + excerpt(used),
                           "'" + (entry.first.IsScalar() ? excerpt(entry.first.Scalar()) : "?") + "'",
                           "only spheres");
        }
    }
    std::vector<LinkSpheres> sets = linksOf(file, spheres);
    const std::string key = collisionKey(file, root);
    growBy(file, tableOf(name, root, key), "buffer_distance", key + ".buffer_distance", sets);
    return sets;
}

std::vector<LinkSpheres> curoboSets(const std::filesystem::path& file, const YAML::Node& root) {
    const YAML::Node holder = holderOf(file.string(), root);
    const YAML::Node section = tableOf(file.string(), holder, "collision_spheres");
    if (section && section.IsScalar()) {
        throw BadInput(file.string(), "collision_spheres", "the name of a file, " + excerpt(section.Scalar()),
                       std::string(kLinks) + "; use that file, with collision_sphere_buffer of this one");
    }
    if (!section || !(section.IsMap() || section.IsSequence())) {
        throw BadInput(file.string(), "collision_spheres", "missing or not a table", kLinks);
    }
    std::vector<LinkSpheres> sets = linksOf(file, section);
    growBy(file, holder, "collision_sphere_buffer", "collision_sphere_buffer", sets);
    return sets;
}

bool isXrdf(const std::string& file, const YAML::Node& root) {
    const YAML::Node format = tableOf(file, root, "format");
    return format && format.IsScalar() && format.Scalar() == "xrdf";
}

} // namespace

std::vector<LinkSpheres> readXrdf(const std::filesystem::path& file) {
    return xrdfSets(file, loadYaml(file));
}

std::vector<LinkSpheres> readFoam(const std::filesystem::path& file) {
    YAML::Node root = loadYaml(file); // JSON is YAML
    if (root.IsSequence() && root.size() > 0) {
        root = root[root.size() - 1];
    }
    if (holderOf(file.string(), root)) {
        return curoboSets(file, root);
    }
    size_t all = 0;
    std::vector<LinkSpheres> sets;
    if (const YAML::Node spheres = tableOf(file.string(), root, "spheres"); spheres && spheres.IsSequence()) {
        const std::string link = file.stem().string();
        sets.push_back({link, spheresOf(file, link, spheres, "origin", all)});
        return sets;
    }
    if (!root.IsMap()) {
        throw BadInput(file.string(), "spheres", "missing",
                       "{\"LINK::shape\": {\"spheres\": [{\"origin\": [x, y, z], \"radius\": r}]}}");
    }
    std::set<std::string> seen;
    for (const auto& entry : root) {
        const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "";
        const std::string link = name.substr(0, name.find("::"));
        if (!seen.insert(name).second) {
            refuseRepeated(file.string(), entry.second, name);
        }
        const YAML::Node list = tableOf(file.string(), entry.second, "spheres");
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
    return isXrdf(file.string(), root) ? xrdfSets(file, root) : curoboSets(file, root);
}

} // namespace fathom
