// SPDX-License-Identifier: Apache-2.0
#include "engine/model/dae_file.h"

#include "engine/model/mesh_file.h"
#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/parse_number.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <locale>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace fathom {

namespace {

// The library would take 1 m for a unit that it cannot read, and mirror the mesh for a negative one.
double unitOf(const std::string& file, const std::string& metre) {
    std::string number = metre.substr(metre.starts_with('+') ? 1 : 0);
    std::ranges::replace(number, ',', '.'); // of exporters in some locales
    double value = 1.0;
    if (!metre.empty() && !(parseWhole(number, value) && value > 0.0 && std::isfinite(value))) {
        throw BadInput(file, "unit", "meter=\"" + printable(metre) + "\"", "metres per unit, above 0");
    }
    return value;
}

bool turnsNothing(const std::string& skew) {
    std::istringstream in(skew);
    in.imbue(std::locale::classic());
    double angle = 1.0;
    return in >> angle && angle == 0.0;
}

bool isIdentity(const std::string& matrix) {
    std::istringstream in(matrix);
    in.imbue(std::locale::classic()); // not the program's own
    double value = 0.0;
    size_t count = 0;
    for (; in >> value; ++count) {
        if (!(std::abs(value - (count % 5 == 0 ? 1.0 : 0.0)) <= 1e-6)) {
            return false;
        }
    }
    return count == 16;
}

// A node that contains itself, if any.
std::optional<size_t> inItself(const std::vector<std::vector<size_t>>& below) {
    enum class Seen : uint8_t { No, Above, Done };
    std::vector<Seen> seen(below.size(), Seen::No);
    std::vector<std::pair<size_t, size_t>> way; // node, and how many below it were visited
    for (size_t root = 0; root < below.size(); ++root) {
        if (seen[root] == Seen::No) {
            way.emplace_back(root, 0);
            seen[root] = Seen::Above;
        }
        while (!way.empty()) {
            auto& [node, visited] = way.back();
            if (visited == below[node].size()) {
                seen[node] = Seen::Done;
                way.pop_back();
                continue;
            }
            const size_t next = below[node][visited++];
            if (seen[next] == Seen::Above) {
                return next;
            }
            if (seen[next] == Seen::No) {
                seen[next] = Seen::Above;
                way.emplace_back(next, 0);
            }
        }
    }
    return std::nullopt;
}

// The nodes of a file, and what they instance.
class DaeInstances {
public:
    void see(const XmlTags& tags) {
        const std::string name(tags.tag().name), id = xmlAttribute(tags.tag().text, "id");
        const size_t around = tags.path().size();
        while (!open_.empty() && open_.back().around >= around) { // has ended: this tag is behind it
            open_.pop_back();
        }
        if (name == "geometry") {
            geometries_.insert(id);
        } else if (name == "controller") {
            controller_ = id;
            controllers_[id] = "";
        } else if ((name == "skin" || name == "morph") && tags.path().ends_with("/controller")) {
            controllers_[controller_] = xmlAttribute(tags.tag().text, "source");
        } else if (name == "node") {
            addNode(id, xmlAttribute(tags.tag().text, "name"), around);
        } else if (!open_.empty() && around == open_.back().around + kInNode && // not in <extra>
                   (name == "instance_geometry" || name == "instance_controller" ||
                    name == "instance_node")) {
            instances_.push_back({name, xmlAttribute(tags.tag().text, "url"), open_.back().node});
        }
    }

    void check(const std::string& file) {
        for (const Instance& instance : instances_) {
            if (instance.element == "instance_node") {
                below_[instance.node].push_back(nodeOf(file, instance));
            } else {
                checkMesh(file, instance);
            }
        }
        if (const std::optional<size_t> node = inItself(below_)) {
            throw BadInput(file, "<instance_node>",
                           "node '" + excerpt(printable(ids_[*node])) + "' is inside of itself",
                           "nodes without a loop");
        }
    }

private:
    struct Instance {
        std::string element, url;
        size_t node; // index
    };
    struct OpenNode {
        size_t node, around; // around: length of the path of the elements around it
    };
    static std::string idOf(const std::string& url) { return url.starts_with('#') ? url.substr(1) : ""; }

    [[noreturn]] static void refuse(const std::string& file, const Instance& instance, const char* allowed) {
        throw BadInput(file, "<" + instance.element + ">", "url=\"" + excerpt(printable(instance.url)) + "\"",
                       std::string("#id of a ") + allowed + " of this file");
    }

    // The library takes a name where no id fits.
    size_t nodeOf(const std::string& file, const Instance& instance) const {
        const std::string id = idOf(instance.url);
        const std::map<std::string, size_t>& nodes = nodes_.contains(id) ? nodes_ : names_;
        const auto found = nodes.find(id);
        if (id.empty() || found == nodes.end()) {
            refuse(file, instance, "<node>");
        }
        return found->second;
    }

    void checkMesh(const std::string& file, const Instance& instance) const {
        const std::string id = idOf(instance.url);
        const auto controller = controllers_.find(id);
        if (id.empty() || (controller == controllers_.end() && !geometries_.contains(id))) {
            refuse(file, instance, "<geometry> or <controller>");
        }
        if (!geometries_.contains(id) && !geometries_.contains(idOf(controller->second))) {
            throw BadInput(file, "<controller id=\"" + excerpt(printable(id)) + "\">",
                           "source=\"" + excerpt(printable(controller->second)) + "\"",
                           "#id of a <geometry> of this file");
        }
    }

    static constexpr size_t kInNode = std::string_view("/node").size(); // longer is the path inside

    void addNode(const std::string& id, const std::string& name, size_t around) {
        const size_t node = ids_.size();
        ids_.push_back(id);
        below_.emplace_back();
        if (!open_.empty()) {
            below_[open_.back().node].push_back(node);
        }
        open_.push_back({node, around});
        if (!id.empty()) {
            nodes_.emplace(id, node);
        }
        if (!name.empty()) {
            names_.emplace(name, node);
        }
    }

    std::vector<std::string> ids_;           // of nodes
    std::vector<std::vector<size_t>> below_; // children of nodes
    std::vector<OpenNode> open_;
    std::vector<Instance> instances_;
    std::map<std::string, size_t> nodes_, names_;    // by id, by name
    std::set<std::string> geometries_;               // ids
    std::map<std::string, std::string> controllers_; // id -> source
    std::string controller_;                         // the last one
};

} // namespace

DaeFacts checkDae(const std::filesystem::path& file) {
    const std::string text = readFileAtMost(file, kLargestMesh).value_or("");
    DaeFacts facts;
    DaeInstances instances;
    for (XmlTags tags(text); tags.next();) {
        const std::string_view name = tags.tag().name;
        instances.see(tags);
        facts.skin = facts.skin || name == "skin";
        if (name == "unit" && tags.path() == "COLLADA/asset") {
            facts.metre = unitOf(file.string(), xmlAttribute(tags.tag().text, "meter"));
        } else if (name == "up_axis" && tags.path() == "COLLADA/asset") {
            facts.up = tags.content();
        } else if (name == "trifans") {
            throw BadInput(file.string(), "mesh", "<trifans>", "triangles, polylist, polygons or tristrips");
        } else if (name == "skew" && tags.path().ends_with("/node") && !turnsNothing(tags.content())) {
            throw BadInput(file.string(), "node", "<skew>", "matrix, translate, rotate, scale or lookat");
        } else if (const std::string matrix = name == "bind_shape_matrix" ? tags.content() : "";
                   !matrix.empty() && !isIdentity(matrix)) {
            throw BadInput(file.string(), "bind_shape_matrix", printable(matrix.substr(0, 160)),
                           "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1; apply the armature before you export the mesh");
        }
    }
    instances.check(file.string());
    return facts;
}

} // namespace fathom
