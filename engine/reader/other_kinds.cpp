// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/other_kinds.h"

#include "engine/model/xml_text.h"
#include "engine/types/error.h"

#include <array>
#include <set>
#include <string_view>

namespace fathom {

namespace {

constexpr const char* kRobot = "a URDF or MJCF of the robot";

struct OtherKind {
    std::string_view mark; // at the start of the file, or the name of its root
    const char *is, *instead;
};

constexpr std::array<OtherKind, 5> kStarts{{{"#usda", "a USD scene", kRobot},
                                            {"PXR-USDC", "a USD scene", kRobot},
                                            {"#VRML_SIM", "a robot of Webots", kRobot},
                                            {"solid", "an STL mesh", "a URDF or MJCF that names the mesh"},
                                            {"{", "JSON", kRobot}}};

constexpr std::array<OtherKind, 6> kRoots{
    {{"sdf", "an SDF", kRobot},
     {"mujocoinclude", "a part of an MJCF", "the MJCF that includes it"},
     {"Robot", "a robot of OpenRAVE", kRobot},
     {"KinBody", "a body of OpenRAVE", kRobot},
     {"Environment", "a scene of OpenRAVE", kRobot},
     {"COLLADA", "a COLLADA file", "a URDF or MJCF; a mesh is named in one"}}};

[[noreturn]] void refuse(const std::filesystem::path& file, const char* is, const char* instead) {
    throw BadInput(file.string(), "robot", is, instead);
}

bool isUtf16(std::string_view text) {
    const std::string_view start = text.substr(0, 2);
    return start == "\xff\xfe" || start == "\xfe\xff" || start == std::string_view("<\0", 2) ||
           start == std::string_view("\0<", 2);
}

// Tables of spheres are YAML.
bool isSphereTable(std::string_view text) {
    for (const char* key :
         {"format: xrdf", "format: 'xrdf'", "format: \"xrdf\"", "robot_cfg:", "collision_spheres:"}) {
        if (text.find(key) != std::string_view::npos) {
            return true;
        }
    }
    return false;
}

void refuseNoXml(const std::filesystem::path& file, std::string_view text) {
    if (isUtf16(text)) {
        refuse(file, "in UTF-16", "the same file saved as UTF-8");
    }
    text = text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text;
    const size_t start = text.find_first_not_of(" \t\r\n");
    text = start == std::string_view::npos ? std::string_view() : text.substr(start);
    if (text.starts_with('<')) {
        return;
    }
    for (const OtherKind& kind : kStarts) {
        if (text.starts_with(kind.mark)) {
            refuse(file, kind.is, kind.instead);
        }
    }
    if (isSphereTable(text)) {
        refuse(file, "spheres of a robot (XRDF or cuRobo), without links and joints",
               "the URDF that it belongs to");
    }
    refuse(file, "no XML", kRobot);
}

} // namespace

void refuseOtherKinds(const std::filesystem::path& file, const std::string& text) {
    static const std::set<std::string_view> kSemantic{"group",
                                                      "group_state",
                                                      "end_effector",
                                                      "virtual_joint",
                                                      "passive_joint",
                                                      "disable_collisions",
                                                      "disable_default_collisions"};
    refuseNoXml(file, text);
    bool links = false, semantic = false, root = true;
    for (XmlTags tags(text); tags.next(); root = false) {
        const std::string_view name = tags.tag().name;
        for (const OtherKind& kind : kRoots) {
            if (root && name == kind.mark) {
                refuse(file, kind.is, kind.instead);
            }
        }
        if (root && name.ends_with(":robot")) {
            throw BadInput(file.string(), "robot", "<" + std::string(name) + ">",
                           "<robot>, without the prefix of a namespace");
        }
        if (name == "robot" && tags.path() != "" && tags.path().find("robot") == std::string_view::npos) {
            throw BadInput(file.string(), "robot", "<robot> inside of <" + std::string(tags.path()) + ">",
                           "a file whose outermost element is <robot>");
        }
        const bool part = tags.path() == "robot";
        links = links || (part && name == "link");
        semantic = semantic || (part && kSemantic.count(name) > 0);
    }
    if (semantic && !links) {
        refuse(file, "an SRDF of MoveIt, without links and joints", "the URDF that it belongs to");
    }
}

} // namespace fathom
