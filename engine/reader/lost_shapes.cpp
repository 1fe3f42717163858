// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/lost_shapes.h"

#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/printable.h"

#include <algorithm>
#include <initializer_list>
#include <map>

namespace fathom {

namespace {

using WrittenShapes = std::map<std::string, std::vector<std::string>>; // tags of shapes, by link

// The first tag of each collision's geometry, empty where there is none.
WrittenShapes shapesIn(const std::string& text) {
    WrittenShapes shapes;
    std::string link;
    std::vector<std::string_view> open;
    const auto isInside = [&](std::initializer_list<std::string_view> names) {
        return std::ranges::equal(open, names);
    };
    for (XmlPieces pieces(text); pieces.next();) {
        const XmlPiece& piece = pieces.piece();
        if (piece.name.empty() || piece.name.starts_with('!')) {
            continue;
        }
        if (piece.closes) {
            open.resize(open.size() - std::min<size_t>(open.size(), 1));
            continue;
        }
        if (isInside({"robot"}) && piece.name == "link") {
            link = xmlAttribute(piece.text, "name");
        } else if (isInside({"robot", "link"}) && piece.name == "collision") {
            shapes[link].emplace_back();
        } else if (isInside({"robot", "link", "collision", "geometry"}) && shapes[link].back().empty()) {
            shapes[link].back() = piece.text;
        }
        if (!piece.isEmpty) {
            open.push_back(piece.name);
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
        const auto known = model.links_.find(link);
        const size_t read = known == model.links_.end() ? 0 : known->second->collision_array.size();
        if (read >= shapes.size()) {
            continue;
        }
        const Reason reason = reasonFor(link, errors);
        const std::string field = "link " + printable(link);
        if (!reason.ofShape) {
            throw BadInput(file, field, "its collision shapes are lost behind an error: " + reason.words,
                           "visual and inertial elements as the URDF specification has them");
        }
        const std::string shape = shapes[read].empty() ? "no shape" : excerpt(printable(shapes[read]));
        throw BadInput(file, field,
                       "collision " + std::to_string(read + 1) + " of " + std::to_string(shapes.size()) +
                           ": " + shape + ": " + reason.words,
                       "<box size=\"X Y Z\"/>, <cylinder> or <capsule> with radius and length, <sphere "
                       "radius=\"R\"/>, <mesh filename=\"FILE\"/> with scale=\"X Y Z\" or without");
    }
}

} // namespace fathom
