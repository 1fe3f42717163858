// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/matrix_file.h"

#include "devices/recorded/lens_model.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/median.h"
#include "engine/types/number_text.h"
#include "engine/types/rotation_fault.h"
#include "engine/types/split_words.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace fathom {

namespace {

constexpr const char* kHint = " (poses in millimetres?)";
constexpr double kMaxRowOff = 1e-3; // of 0 and 1 in the last row of a matrix

// Other programs write matrices column by column.
void checkLastRow(const std::array<double, 16>& m, const std::string& file) {
    const bool lost = !std::isfinite(m[12] + m[13] + m[14] + m[15]); // as the rest of it
    const bool good = lost || (std::abs(m[12]) <= kMaxRowOff && std::abs(m[13]) <= kMaxRowOff &&
                               std::abs(m[14]) <= kMaxRowOff && std::abs(m[15] - 1.0) <= kMaxRowOff);
    if (!good) {
        throw BadInput(file, "pose", "its last row is not 0 0 0 1",
                       "a matrix row by row, with the position in its last column");
    }
}

} // namespace

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

Pose poseFromRows(const std::array<double, 9>& rows, const dvec3& position, const std::string& file,
                  const std::string& field) {
    const glm::dmat3 rotation(rows[0], rows[3], rows[6], rows[1], rows[4], rows[7], rows[2], rows[5],
                              rows[8]);
    const bool finite = std::isfinite(position.x + position.y + position.z);
    if (const std::string fault = finite ? rotationFault(rotation) : "not finite"; !fault.empty()) {
        throw BadInput(file, field, fault, "a rotation matrix and a position");
    }
    const dquat q = glm::quat_cast(rotation);
    return {position, q / glm::length(q)};
}

std::string lensFault(std::span<const double, 9> k) {
    if (k[2] == 0.0 && k[5] == 0.0 && (k[6] != 0.0 || k[7] != 0.0)) {
        return "written column by column";
    }
    constexpr std::array<const char*, 9> kNames{"fx", "", "cx", "", "fy", "cy", "", "", ""};
    for (const size_t i : {0, 4, 2, 5}) {
        if (!std::isfinite(k[i]) || (i % 4 == 0 && !(k[i] > 0.0))) {
            return std::string(kNames[i]) + " is " + significant(k[i], 6);
        }
    }
    // Some programs leave the last row out, or scale the matrix with its images.
    if (std::abs(k[6]) > kMaxRowOff || std::abs(k[7]) > kMaxRowOff || !(std::abs(k[8] - 1.0) <= kMaxRowOff)) {
        return "its last row is " + significant(k[6], 6) + " " + significant(k[7], 6) + " " +
               significant(k[8], 6);
    }
    return "";
}

Intrinsics matrixLens(const std::filesystem::path& file, std::optional<PngSize> size,
                      std::vector<std::string>& warnings) {
    const auto k = readMatrix(file, true);
    const std::string fault = lensFault(std::array{k[0], k[1], k[2], k[4], k[5], k[6], k[8], k[9], k[10]});
    if (!fault.empty()) {
        throw BadInput(file.string(), "matrix", fault, kLensRows);
    }
    if (!size || size->width > kMaxImageWidth || size->height > kMaxImageHeight) {
        throw BadInput(file.string(), "matrix",
                       size ? "for images of " + sizeText(size->width, size->height)
                            : "for images of unknown size",
                       "images of at most 3840x2160 that are read");
    }
    const Intrinsics lens{
        .width = size->width, .height = size->height, .fx = k[0], .fy = k[5], .cx = k[2], .cy = k[6]};
    warnAboutSkew(warnings, file.filename().string(), k[1]);
    warnAboutSize(warnings, file.filename().string(), lens);
    return lens;
}

bool usePose(IndexLine& line, const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) {
        return false;
    }
    try {
        const auto m = readMatrix(file);
        checkLastRow(m, file.string());
        line.baseTcamera = poseFromRows({m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]},
                                        {m[3], m[7], m[11]}, file.string(), "pose");
    } catch (const BadInput& e) {
        line.fault = e.what();
    }
    return true;
}

// Cameras in a building are some metres from each other and from the origin.
std::string fastPoses(const std::vector<IndexLine>& index) {
    constexpr double kMaxStep = 1.0, kFarthest = 100.0; // [m]
    std::vector<double> steps;
    const IndexLine* before = nullptr;
    std::string first; // the first step of over kMaxStep
    for (const IndexLine& line : index) {
        if (!line.baseTcamera) {
            continue;
        }
        const dvec3& position = line.baseTcamera->position;
        if (const double away = glm::length(position); away > kFarthest) {
            return "the pose of " + line.depth.filename().string() + ": the camera is " +
                   significant(away, 4) + " m from the origin" + kHint;
        }
        if (before != nullptr) {
            steps.push_back(glm::distance(position, before->baseTcamera->position));
            if (steps.back() > kMaxStep && first.empty()) {
                first = "the pose of " + line.depth.filename().string() + ": the camera moves " +
                        significant(steps.back(), 4) + " m from one image to the next" + kHint;
            }
        }
        before = &line;
    }
    return !steps.empty() && medianOf(steps) > kMaxStep ? first : "";
}

} // namespace fathom
