// SPDX-License-Identifier: Apache-2.0
#include "engine/model/write_spheres.h"

#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"
#include "engine/types/printable.h"

#include <algorithm>
#include <map>
#include <string_view>
#include <vector>

namespace fathom {

namespace {

std::string listOf(const dvec3& v, const char* between) {
    return significant(v.x, 17) + between + significant(v.y, 17) + between + significant(v.z, 17);
}

std::string linksText(std::span<const LinkSpheres> sets, const std::string& indent) {
    std::string out;
    for (const LinkSpheres& set : sets) {
        out += indent + doubleQuoted(set.link) + ":\n";
        for (const Sphere& s : set.spheres) {
            out += indent + "  - {center: [" + listOf(s.centre, ", ") +
                   "], radius: " + significant(s.radius, 17) + "}\n";
        }
    }
    return out;
}

// name: what the first one is called, as others may refer to it, such as contact sensors; empty = nothing.
std::string collisionsOf(const LinkSpheres& set, const std::string& name = "") {
    std::string out;
    for (size_t i = 0; i < set.spheres.size(); ++i) {
        const Sphere& s = set.spheres[i];
        const std::string own = name.empty() || i == 0 ? name : name + "_" + std::to_string(i);
        out += "    <collision" + (own.empty() ? "" : " name=\"" + xmlEscaped(own) + "\"") +
               "><origin xyz=\"" + listOf(s.centre, " ") + "\" rpy=\"0 0 0\"/><geometry><sphere radius=\"" +
               significant(s.radius, 17) + "\"/></geometry></collision>\n";
    }
    return out;
}

[[noreturn]] void refuseWithoutLink(const std::string& link) {
    throw BadInput("URDF", "link " + excerpt(printable(link)),
                   "has spheres, but is not in the text, or is empty (<link/>)",
                   "a URDF with this <link> in <robot>");
}

} // namespace

std::string curoboText(std::span<const LinkSpheres> sets) {
    return "collision_spheres:\n" + linksText(sets, "  ");
}

std::string xrdfText(std::span<const LinkSpheres> sets) {
    return "format: xrdf\nformat_version: 1.0\ncollision:\n  geometry: fathom\ngeometry:\n  fathom:\n    "
           "spheres:\n" +
           linksText(sets, "      ");
}

std::string foamText(std::span<const LinkSpheres> sets) {
    std::string out = "{";
    for (const LinkSpheres& set : sets) {
        out += (&set == sets.data() ? "\n" : ",\n") + doubleQuoted(set.link + "::spheres") +
               ": {\"mean\": 0, \"best\": 0, \"worst\": 0, \"spheres\": [";
        for (size_t i = 0; i < set.spheres.size(); ++i) {
            out += (i == 0 ? "\n" : ",\n");
            out += "  {\"origin\": [" + listOf(set.spheres[i].centre, ", ") +
                   "], \"radius\": " + significant(set.spheres[i].radius, 17) + "}";
        }
        out += "]}";
    }
    return out + "\n}\n";
}

std::string spherizedText(const std::string& urdf, std::span<const LinkSpheres> sets) {
    std::map<std::string, const LinkSpheres*> byLink;
    for (const LinkSpheres& set : sets) {
        byLink[set.link] = &set;
    }
    std::string out, link, name;        // of the link, and of its first collision
    std::vector<std::string_view> open; // elements around the piece
    const auto isBelow = [&](std::string_view parent, size_t depth) {
        return open.size() == depth && open[depth - 1] == parent;
    };
    for (XmlPieces pieces(urdf); pieces.next();) {
        const XmlPiece& piece = pieces.piece();
        const bool element = !piece.name.empty() && !piece.name.starts_with('!');
        const bool dropped = open.size() > 2 && open[1] == "link" && open[2] == "collision";
        if (element && piece.closes) {
            open.resize(open.size() - std::min<size_t>(open.size(), 1));
        }
        const bool inLink = isBelow("link", 2);
        if (dropped || (inLink && piece.name == "collision")) {
            name = inLink && !piece.closes && name.empty() ? xmlAttribute(piece.text, "name") : name;
        } else {
            if (isBelow("robot", 1) && piece.name == "link" && !piece.closes) {
                link = xmlAttribute(piece.text, "name");
                name.clear();
            } else if (const auto set = byLink.find(link);
                       isBelow("robot", 1) && piece.name == "link" && set != byLink.end()) {
                out += collisionsOf(*set->second, name);
                byLink.erase(set);
            }
            out += piece.text;
        }
        if (element && !piece.closes && !piece.isEmpty) {
            open.push_back(piece.name);
        }
    }
    if (!byLink.empty()) {
        refuseWithoutLink(byLink.begin()->first);
    }
    return out;
}

std::string spherizedText(const LinkSpheres& set) {
    return "<?xml version=\"1.0\"?>\n<robot name=\"spheres\">\n  <link name=\"" + xmlEscaped(set.link) +
           "\">\n" + collisionsOf(set) + "  </link>\n</robot>\n";
}

} // namespace fathom
