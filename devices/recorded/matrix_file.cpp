// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/matrix_file.h"

#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/split_words.h"

#include <cmath>
#include <glm/mat3x3.hpp>

namespace fathom {

std::array<double, 16> readMatrix(const std::filesystem::path& file, bool orThree) {
    std::vector<double> all;
    for (const TextLine& line : readDataLines(file)) {
        for (const std::string_view word : splitWords(line.text)) {
            double value = 0.0;
            if (!parseNumber(word, value)) {
                throw BadInput(file.string(), "matrix", std::string(word), "numbers");
            }
            all.push_back(value);
        }
    }
    if (all.size() != 16 && !(orThree && all.size() == 9)) {
        throw BadInput(file.string(), "matrix", std::to_string(all.size()) + " numbers",
                       orThree ? "4 x 4 or 3 x 3" : "4 x 4");
    }
    const size_t rows = all.size() == 16 ? 4 : 3;
    auto out = kIdentityMatrix;
    for (size_t k = 0; k < all.size(); ++k) {
        out[k / rows * 4 + k % rows] = all[k];
    }
    return out;
}

Pose rigidPose(const std::array<double, 9>& rows, const dvec3& position, const std::string& file) {
    const glm::dmat3 rotation(rows[0], rows[3], rows[6], rows[1], rows[4], rows[7], rows[2], rows[5],
                              rows[8]);
    const dquat q = glm::quat_cast(rotation);
    const double length = glm::length(q);
    if (!(std::abs(length - 1.0) < 0.1) || !std::isfinite(position.x + position.y + position.z)) {
        throw BadInput(file, "pose", "not a rigid motion", "a rotation matrix and a position");
    }
    return {position, q / length};
}

bool usePose(IndexLine& line, const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) {
        return false;
    }
    try {
        const auto m = readMatrix(file);
        line.baseTcamera = rigidPose({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]},
                                     {m[3], m[7], m[11]}, file.string());
    } catch (const BadInput& e) {
        line.fault = e.what();
    }
    return true;
}

} // namespace fathom
