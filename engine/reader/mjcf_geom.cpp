// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/mjcf_geom.h"

#include "engine/model/xml_text.h"
#include "engine/types/printed.h"

#include <cmath>
#include <filesystem>

namespace fathom {

namespace {

// Roll, pitch and yaw about fixed axes. Yaw follows from the roll that was found, so that errors of both
// cancel where the pitch is near 90 degrees.
dvec3 rollPitchYaw(const dquat& q) {
    const glm::dmat3 m = glm::mat3_cast(q); // m[column][row]
    const double roll = std::atan2(m[1][2], m[2][2]), s = std::sin(roll), c = std::cos(roll);
    const double pitch = std::atan2(-m[0][2], std::hypot(m[0][0], m[0][1]));
    return {roll, pitch, std::atan2(s * m[2][0] - c * m[1][0], c * m[1][1] - s * m[2][1])};
}

std::string triple(const dvec3& v) {
    return urdfNumber(v.x) + " " + urdfNumber(v.y) + " " + urdfNumber(v.z);
}

std::string fileOf(const tinyxml2::XMLElement& root, const std::string& named) {
    std::filesystem::path folder, file = named;
    for (auto* compiler = root.FirstChildElement("compiler"); compiler != nullptr;
         compiler = compiler->NextSiblingElement("compiler")) {
        for (const char* key : {"assetdir", "meshdir"}) {
            folder = compiler->Attribute(key) != nullptr ? compiler->Attribute(key) : folder;
        }
        const char* const strip = compiler->Attribute("strippath");
        file = strip != nullptr && std::string(strip) == "true" ? file.filename() : file;
    }
    return (folder / file).string();
}

// Geoms of explicit pairs, which collide whatever contype and conaffinity say.
std::set<std::string> pairedGeoms(const tinyxml2::XMLElement& root) {
    std::set<std::string> names;
    for (auto* contact = root.FirstChildElement("contact"); contact != nullptr;
         contact = contact->NextSiblingElement("contact")) {
        for (auto* pair = contact->FirstChildElement("pair"); pair != nullptr;
             pair = pair->NextSiblingElement("pair")) {
            for (const char* key : {"geom1", "geom2"}) {
                const char* const name = pair->Attribute(key);
                names.insert(name != nullptr ? name : "");
            }
        }
    }
    return names;
}

} // namespace

std::string urdfNumber(double value) {
    return printed("%.17g", value);
}

std::string urdfOrigin(const Pose& pose) {
    return "<origin xyz='" + triple(pose.position) + "' rpy='" + triple(rollPitchYaw(pose.rotation)) + "'/>";
}

MjcfGeoms::MjcfGeoms(const MjcfClasses& classes, const MjcfAngles& angles, const tinyxml2::XMLElement& root)
    : classes_(classes)
    , angles_(angles)
    , paired_(pairedGeoms(root)) {
    for (auto* asset = root.FirstChildElement("asset"); asset != nullptr;
         asset = asset->NextSiblingElement("asset")) {
        for (auto* mesh = asset->FirstChildElement("mesh"); mesh != nullptr;
             mesh = mesh->NextSiblingElement("mesh")) {
            const char* const file = classes.find(*mesh, "", "file");
            const char* const name = mesh->Attribute("name");
            Mesh made{file != nullptr ? fileOf(root, file) : "", ""};
            const auto scale = classes.numbers(*mesh, "", "scale", {1.0, 1.0, 1.0}, 3, 3);
            if (scale[0] != 1.0 || scale[1] != 1.0 || scale[2] != 1.0) {
                made.scale = triple({scale[0], scale[1], scale[2]});
            }
            if (mesh->Attribute("refpos") != nullptr || mesh->Attribute("refquat") != nullptr) {
                classes.refuse(*mesh, "refpos or refquat", "a mesh in its file's own frame");
            }
            meshes_[name != nullptr ? name
                                    : std::filesystem::path(file != nullptr ? file : "").stem().string()] =
                made;
        }
    }
}

std::string MjcfGeoms::shape(const tinyxml2::XMLElement& geom, const std::string& childClass,
                             const Pose& at) {
    const MjcfShapePose place = mjcfShapePose(classes_, angles_, geom, childClass);
    const auto touches = [&](const char* name) {
        return classes_.numbers(geom, childClass, name, {1.0}, 1, 1)[0] != 0.0;
    };
    const char* const name = geom.Attribute("name");
    const bool paired = name != nullptr && paired_.count(name) > 0;
    const std::string kind = paired || touches("contype") || touches("conaffinity") ? "collision" : "visual";
    return "<" + kind + ">" + urdfOrigin(at * place.pose) + "<geometry>" +
           geometry(geom, childClass, place.half ? &*place.half : nullptr) + "</geometry></" + kind + ">";
}

std::string MjcfGeoms::geometry(const tinyxml2::XMLElement& geom, const std::string& childClass,
                                const double* half) {
    const char* const stated = classes_.find(geom, childClass, "type");
    const char* const mesh = classes_.find(geom, childClass, "mesh");
    const std::string type = stated != nullptr ? stated : mesh != nullptr ? "mesh" : "sphere";
    if (type == "mesh" || mesh != nullptr) {
        fitted_ += type == "mesh" ? 0 : 1;
        return meshGeometry(geom, childClass);
    }
    const bool round = type == "capsule" || type == "cylinder", box = type == "box" || type == "ellipsoid";
    if (!round && !box && type != "sphere") {
        classes_.refuse(geom, "type=\"" + type + "\"",
                        "sphere, capsule, cylinder, box, ellipsoid or mesh on a body");
    }
    const size_t least = type == "sphere" || half != nullptr ? 1 : round ? 2 : 3;
    const auto size = classes_.numbers(geom, childClass, "size", {}, least, 3, true);
    if (size.size() < least) {
        classes_.refuse(geom, "no size", std::to_string(least) + " numbers [m]");
    }
    if (type == "sphere") {
        return "<sphere radius='" + urdfNumber(size[0]) + "'/>";
    }
    if (round) {
        return "<" + type + " radius=\"" + urdfNumber(size[0]) + "\" length=\"" +
               urdfNumber(2.0 * (half != nullptr ? *half : size[1])) + "\"/>";
    }
    const dvec3 halves = half != nullptr ? dvec3(size[0], size[0], *half) : dvec3(size[0], size[1], size[2]);
    return "<box size='" + triple(2.0 * halves) + "'/>";
}

std::string MjcfGeoms::meshGeometry(const tinyxml2::XMLElement& geom, const std::string& childClass) const {
    const char* const name = classes_.find(geom, childClass, "mesh");
    const auto mesh = meshes_.find(name != nullptr ? name : "");
    if (mesh == meshes_.end() || mesh->second.file.empty()) {
        classes_.refuse(geom, "mesh=\"" + std::string(name != nullptr ? name : "") + "\"",
                        "a mesh of <asset> with a file");
    }
    return "<mesh filename='" + xmlEscaped(mesh->second.file) + "'" +
           (mesh->second.scale.empty() ? "" : " scale='" + mesh->second.scale + "'") + "/>";
}

} // namespace fathom
