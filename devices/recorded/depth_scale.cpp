// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/depth_scale.h"

#include "devices/recorded/foreign_field.h"
#include "devices/recorded/source_options.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <cmath>

namespace fathom {

std::string otherScale(const JsonField& root) {
    try {
        if (const auto scale = foreignScale(root)) {
            scale->refuse("depth_scale_m_per_unit at the top level, metres per unit: 1000 units per metre "
                          "are 0.001; or scale=M "
                          "after the recording's name");
        }
    } catch (const BadInput& e) {
        return e.what();
    }
    return "";
}

std::optional<double> statedScale(const JsonField& root, ScaleRule rule) {
    const bool check = rule != ScaleRule::Unchecked, open3d = root.find("intrinsic_matrix").has_value();
    const auto scale = root.find("depth_scale_m_per_unit"), foreign = root.find("depth_scale");
    if (!scale && foreign && (open3d || rule == ScaleRule::Needed)) {
        const double unit = 1.0 / foreign->positive();
        if (!open3d || (check && (unit < kFinestUnit || unit > kCoarsestUnit))) {
            foreign->refuse(open3d ? "units per metre, 10 to 1000000"
                                   : "depth_scale_m_per_unit: 1000 units per metre are 0.001");
        }
        return unit;
    }
    if (!scale && (open3d || rule != ScaleRule::Needed)) {
        return std::nullopt;
    }
    if (const std::string other = scale ? "" : otherScale(root); !other.empty() && check) {
        throw BadInput(other);
    }
    const double unit = root.at("depth_scale_m_per_unit").positive();
    if (check && (unit < kFinestUnit || unit > kCoarsestUnit)) {
        scale->refuse("metres per unit, 0.000001 to 0.1: 1000 units per metre are 0.001");
    }
    return unit;
}

std::optional<double> scaleIn(const std::filesystem::path& file) {
    const nlohmann::json document = parseJsonFile(file);
    return statedScale(JsonField(document, file.string(), ""), ScaleRule::Optional);
}

std::string unitsDiffer(const std::string& lensFile, double ofLensFile, const std::string& recorded,
                        double ofRecorded) {
    if (std::abs(ofLensFile - ofRecorded) <= 1e-6 * ofRecorded) {
        return "";
    }
    return "the depth unit of " + lensFile + " is " + significant(ofLensFile, 6) + " m, but that of " +
           recorded + " is " + significant(ofRecorded, 6) +
           " m, which is used; scale=M after the recording's name gives another unit";
}

std::string twoScales(const JsonField& root, const std::string& file, double unit) {
    const std::optional<OtherUnit> other = otherUnit(root, unit);
    if (!other) {
        return "";
    }
    return "the depth unit of " + file + " is " + significant(unit, 6) + " m, which is used, but its " +
           other->field.path() + " is " + significant(other->field.finite(), 6) + ", a unit of " +
           significant(other->unit, 6) + " m; remove one, or append scale=M to the recording's name";
}

void keepRecordedUnit(RecordingIntrinsics& given, const std::string& from,
                      const std::function<std::optional<double>()>& recorded) {
    std::optional<double> unit;
    try {
        unit = recorded();
    } catch (const BadInput& e) {
        given.unreadScale = e.what();
    }
    if (!unit) {
        return;
    }
    given.unitWarning = given.scale ? unitsDiffer(given.file, *given.scale, from, *unit) : "";
    given.scale = given.camera.metresPerUnit = *unit;
}

} // namespace fathom
