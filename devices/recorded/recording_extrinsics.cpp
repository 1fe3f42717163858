// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/recording_extrinsics.h"

#include "engine/types/error.h"
#include "engine/types/number_text.h"
#include "engine/types/rotation_fault.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace fathom {

namespace {

// node: has t and q_xyzw.
void checkRig(const JsonField& node, const std::string& file, const Pose& colourTdepth) {
    const std::optional<RigFault> fault = rigFault(colourTdepth);
    if (fault && fault->turned) {
        node.at("q_xyzw").refuse("x y z w, in this order, with " + fault->allowed);
    }
    if (fault) {
        throw BadInput(file, node.at("t").path(), fault->value, fault->allowed);
    }
}

Pose readPose(const JsonField& node) {
    const std::vector<double> t = node.at("t").numbers(3);
    const JsonField rotation = node.at("q_xyzw");
    const std::vector<double> q = rotation.numbers(4);
    const dquat quat(q[3], q[0], q[1], q[2]);
    if (const std::string fault = quaternionFault(quat, "x y z w"); !fault.empty()) {
        rotation.refuse(fault);
    }
    return {{t[0], t[1], t[2]}, quat / glm::length(quat)};
}

} // namespace

std::optional<RigFault> rigFault(const Pose& colourTdepth) {
    constexpr double kMaxApart = 1.0, kRounding = 1e-6;
    if (const double apart = glm::length(colourTdepth.position); !(apart <= kMaxApart)) {
        return RigFault{significant(apart, 4) + " m between the lenses",
                        "at most 1 m; metres, not millimetres", false};
    }
    const double cosine = (colourTdepth.rotation * dvec3(0.0, 0.0, 1.0)).z;
    if (cosine < -kRounding) {
        const double angle = glm::degrees(std::acos(std::max(-1.0, cosine)));
        return RigFault{significant(angle, 4) + " degrees between the optical axes",
                        "optical axes within 90 degrees of each other", true};
    }
    return std::nullopt;
}

// A tf entry maps points of the common reference (the depth camera) to its stream: p_colour = R p_depth + t.
// Found on a D435 recording: projected so, depth edges fall on colour edges (mean gradient 24 of 60); by the
// inverse they do not (2), nor by +t with the inverse rotation (5). It also fits the D435, whose colour
// camera sits 15 mm to the left of the depth origin, so that points move to the right (+x).
Pose readColourTdepth(const JsonField& root, const std::string& file) {
    const JsonField tf = root.at("extrinsics_topic_tf");
    const auto british = tf.find("Colour"), depth = tf.find("Depth");
    const JsonField ofColour = british && !tf.find("Color") ? *british : tf.at("Color");
    const Pose colourTdepth = readPose(ofColour) * inverse(depth ? readPose(*depth) : Pose{});
    checkRig(ofColour, file, colourTdepth);
    return colourTdepth;
}

Pose readExtrinsics(const std::filesystem::path& file) {
    const nlohmann::json document = parseJsonFile(file);
    const JsonField root(document, file.string(), "");
    if (root.find("extrinsics_topic_tf")) {
        return readColourTdepth(root, file.string());
    }
    const Pose pose = readPose(root);
    checkRig(root, file.string(), pose);
    return pose;
}

} // namespace fathom
