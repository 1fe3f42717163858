// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/lost_shapes.h"

#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/printable.h"

#include <algorithm>
#include <map>

namespace fathom {

namespace {

// Tags of shapes by link, one list per collision.
using WrittenShapes = std::map<std::string, std::vector<std::vector<std::string>>>;

bool isShape(std::string_view name) {
    return name != "material" && name.find(':') == std::string_view::npos;
}

WrittenShapes shapesIn(const std::string& text) {
    WrittenShapes shapes;
    std::string link;
    for (XmlTags tags(text); tags.next();) {
        const XmlPiece& tag = tags.tag();
        if (tags.path() == "robot" && tag.name == "link") {
            link = xmlAttribute(tag.text, "name");
        } else if (tags.path() == "robot/link" && tag.name == "collision") {
            shapes[link].emplace_back();
        } else if (tags.path() == "robot/link/collision/geometry" && isShape(tag.name)) {
            shapes[link].back().emplace_back(tag.text);
        }
    }
    return shapes;
}

// The parser's reason to reject an element of the link. It precedes the line that names the link.
struct Reason {
    bool ofShape = true; // else of an element in front of the shapes
    std::string words = "not understood";
};

Reason reasonFor(const std::string& link, const std::vector<std::string>& errors) {
    const std::string named = "Link [" + link + "]";
    const auto line = std::ranges::find_if(
        errors, [&](const std::string& text) { return text.find(named) != std::string::npos; });
    if (line == errors.end()) {
        return {};
    }
    const bool explained =
        line != errors.begin() && std::prev(line)->find("element for Link [") == std::string::npos;
    return {line->find("collision") != std::string::npos, printable(explained ? *std::prev(line) : *line)};
}

} // namespace

void refuseLostShapes(const urdf::ModelInterface& model, const std::string& text, const std::string& file,
                      const std::vector<std::string>& errors) {
    for (const auto& [link, shapes] : shapesIn(text)) {
        const std::string field = "link " + printable(link);
        const auto several = std::ranges::find_if(shapes, [](const auto& tags) { return tags.size() > 1; });
        if (several != shapes.end()) {
            throw BadInput(file, field,
                           "collision " + std::to_string(several - shapes.begin() + 1) + ": " +
                               std::to_string(several->size()) + " shapes",
                           "one <collision> per shape");
        }
        const auto known = model.links_.find(link);
        const size_t read = known == model.links_.end() ? 0 : known->second->collision_array.size();
        if (read >= shapes.size()) {
            continue;
        }
        const Reason reason = reasonFor(link, errors);
        if (!reason.ofShape) {
            throw BadInput(file, field, "its collision shapes are lost behind an error: " + reason.words,
                           "visual elements as the URDF specification has them");
        }
        const bool drake = shapes[read].empty() && text.find("<drake:capsule") != std::string::npos;
        const std::string shape = shapes[read].empty() ? "no shape" : excerpt(printable(shapes[read][0]));
        throw BadInput(
            file, field,
            "collision " + std::to_string(read + 1) + " of " + std::to_string(shapes.size()) + ": " + shape +
                ": " + reason.words,
            (drake ? "<capsule> instead of <drake:capsule>; " : "") +
                std::string("<box size=\"X Y Z\"/>, <cylinder> or <capsule> with radius and length, <sphere "
                            "radius=\"R\"/>, <mesh filename=\"FILE\"/> with scale=\"X Y Z\" or without"));
    }
}

} // namespace fathom
