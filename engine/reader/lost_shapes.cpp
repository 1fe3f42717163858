// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/lost_shapes.h"

#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/printable.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <map>

namespace fathom {

namespace {

// Tags of shapes by link, one list per collision.
using WrittenShapes = std::map<std::string, std::vector<std::vector<std::string>>>;

// The element that the parser would read if this one, in the element `parent` of a link or the link itself,
// were spelt otherwise; empty = none.
std::string meantBy(std::string_view name, std::string_view parent) {
    std::string small(name);
    std::ranges::transform(small, small.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::string meant = small == "collisions" || small == "collision_group" ? "collision" : small;
    const bool inLink = parent == "link" && meant == "collision";
    const bool inCollision = parent == "collision" && (meant == "origin" || meant == "geometry");
    return (inLink || inCollision) && meant != name ? meant : "";
}

bool isShape(std::string_view name) {
    return name != "material" && name.find(':') == std::string_view::npos;
}

// Throws BadInput for elements in links that the parser would skip because of their spelling.
WrittenShapes shapesIn(const std::string& text, const std::string& file) {
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
        const bool inLink = isInside({"robot", "link"}),
                   inCollision = isInside({"robot", "link", "collision"});
        const std::string meant = inLink || inCollision ? meantBy(piece.name, open.back()) : "";
        if (!meant.empty()) {
            throw BadInput(file, "link " + printable(link),
                           "<" + printable(std::string(piece.name)) + ">: not read", "<" + meant + ">");
        }
        if (isInside({"robot"}) && piece.name == "link") {
            link = xmlAttribute(piece.text, "name");
        } else if (inLink && piece.name == "collision") {
            shapes[link].emplace_back();
        } else if (isInside({"robot", "link", "collision", "geometry"}) && isShape(piece.name)) {
            shapes[link].back().emplace_back(piece.text);
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
    for (const auto& [link, shapes] : shapesIn(text, file)) {
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
                           "visual and inertial elements as the URDF specification has them");
        }
        const std::string shape = shapes[read].empty() ? "no shape" : excerpt(printable(shapes[read][0]));
        throw BadInput(file, field,
                       "collision " + std::to_string(read + 1) + " of " + std::to_string(shapes.size()) +
                           ": " + shape + ": " + reason.words,
                       "<box size=\"X Y Z\"/>, <cylinder> or <capsule> with radius and length, <sphere "
                       "radius=\"R\"/>, <mesh filename=\"FILE\"/> with scale=\"X Y Z\" or without");
    }
}

} // namespace fathom
