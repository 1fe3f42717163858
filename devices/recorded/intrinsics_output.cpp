// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/intrinsics_output.h"

#include "devices/recorded/lens_model.h"
#include "engine/types/output_file.h"

#include <nlohmann/json.hpp>
#include <numbers>

namespace fathom {

namespace {

using Json = nlohmann::ordered_json;

Json lensJson(const Intrinsics& lens) {
    return {{"width", lens.width},
            {"height", lens.height},
            {"fx", lens.fx},
            {"fy", lens.fy},
            {"cx", lens.cx},
            {"cy", lens.cy},
            {"distortion_model", distortionModel(lens)},
            {"distortion", distortionCoefficients(lens)}};
}

Json poseJson(const Pose& pose) {
    const dvec3& t = pose.position;
    const dquat& q = pose.rotation;
    return {{"t", {t.x, t.y, t.z}}, {"q_xyzw", {q.x, q.y, q.z, q.w}}};
}

Json intrinsicsJson(const CameraInfo& camera) {
    Json json = camera.registered ? lensJson(camera.depth) : Json{};
    if (!camera.registered) {
        json["depth"] = lensJson(camera.depth);
        json["color"] = lensJson(camera.colour);
        json["extrinsics_topic_tf"] = {{"Depth", poseJson(Pose{})}, {"Color", poseJson(camera.colourTdepth)}};
    }
    json["depth_scale_m_per_unit"] = camera.metresPerUnit;
    json["registered_to_color"] = camera.registered;
    if (camera.depth.fan) {
        json["projection"] = "equal_angles";
    }
    if (camera.beam) {
        constexpr double kDegrees = 180.0 / std::numbers::pi;
        json["beam"] = {{"width_deg", camera.beam->width * kDegrees},
                        {"sigma_m", camera.beam->range},
                        {"sigma_m_per_m", camera.beam->perMetre}};
    }
    if (camera.decimation > 1) {
        json["decimation"] = camera.decimation;
    }
    if (camera.inWater) {
        json["port_corrected"] = {{"sigma_m", camera.sigma}};
    }
    if (!camera.hasColour) {
        json["has_color"] = false;
    }
    return json;
}

} // namespace

void writeIntrinsics(const std::filesystem::path& file, const CameraInfo& camera) {
    OutputFile out(file);
    out.write(intrinsicsJson(camera).dump(2) + "\n");
    out.commit();
}

} // namespace fathom
