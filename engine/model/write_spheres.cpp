// SPDX-License-Identifier: Apache-2.0
#include "engine/model/write_spheres.h"

#include "engine/model/xml_text.h"

#include <cstdio>
#include <map>

namespace fathom {

namespace {

std::string digits(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

std::string listOf(const dvec3& v, const char* between) {
    return digits(v.x) + between + digits(v.y) + between + digits(v.z);
}

// For YAML and JSON.
std::string quoted(const std::string& name) {
    std::string out = "\"";
    for (const char c : name) {
        out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    }
    return out + "\"";
}

std::string linksText(std::span<const LinkSpheres> sets, const std::string& indent) {
    std::string out;
    for (const LinkSpheres& set : sets) {
        out += indent + quoted(set.link) + ":\n";
        for (const Sphere& s : set.spheres) {
            out +=
                indent + "  - {center: [" + listOf(s.centre, ", ") + "], radius: " + digits(s.radius) + "}\n";
        }
    }
    return out;
}

std::string collisionsOf(const LinkSpheres& set) {
    std::string out;
    for (const Sphere& s : set.spheres) {
        out += "    <collision><origin xyz=\"" + listOf(s.centre, " ") +
               "\" rpy=\"0 0 0\"/><geometry><sphere radius=\"" + digits(s.radius) +
               "\"/></geometry></collision>\n";
    }
    return out;
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
        out += (&set == sets.data() ? "\n" : ",\n") + quoted(set.link + "::spheres") +
               ": {\"mean\": 0, \"best\": 0, \"worst\": 0, \"spheres\": [";
        for (size_t i = 0; i < set.spheres.size(); ++i) {
            out += (i == 0 ? "\n" : ",\n");
            out += "  {\"origin\": [" + listOf(set.spheres[i].centre, ", ") +
                   "], \"radius\": " + digits(set.spheres[i].radius) + "}";
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
    std::string out, link;
    size_t collision = 0; // depth
    for (XmlPieces pieces(urdf); pieces.next();) {
        const XmlPiece& piece = pieces.piece();
        if (piece.name == "collision" && !piece.closes) {
            collision += piece.isEmpty ? 0 : 1;
            continue;
        }
        if (collision > 0) {
            collision -= piece.name == "collision" && piece.closes ? 1 : 0;
            continue;
        }
        if (piece.name == "link" && !piece.closes && !piece.isEmpty) {
            link = xmlAttribute(piece.text, "name");
        }
        const auto set = byLink.find(link);
        if (piece.name == "link" && piece.closes && set != byLink.end()) {
            out += collisionsOf(*set->second);
        }
        out += piece.text;
    }
    return out;
}

std::string spherizedText(const LinkSpheres& set) {
    return "<?xml version=\"1.0\"?>\n<robot name=\"spheres\">\n  <link name=\"" + xmlEscaped(set.link) +
           "\">\n" + collisionsOf(set) + "  </link>\n</robot>\n";
}

} // namespace fathom
