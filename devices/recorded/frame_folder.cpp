// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/frame_folder.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/depth_scale.h"
#include "devices/recorded/lens_model.h"
#include "devices/recorded/matrix_file.h"
#include "devices/recorded/numbered_images.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/split_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

namespace fathom {

namespace {

namespace fs = std::filesystem;

// Lines KEY = VALUE, as SensReader writes them.
class SensorInfo {
public:
    explicit SensorInfo(const fs::path& file)
        : file_(file.string()) {
        for (const TextLine& line : readDataLines(file)) {
            const std::vector<std::string_view> parts = splitFields(line.text, '=');
            if (parts.size() == 2) {
                values_.emplace(parts[0], parts[1]);
            }
        }
    }
    bool has(const std::string& key) const { return values_.contains(key); }

    // Size and lens of "Depth" or "Color".
    Intrinsics lens(const std::string& stream) const {
        const std::string small = stream == "Depth" ? "m_depth" : "m_color",
                          matrix = "m_calibration" + stream + "Intrinsic";
        const auto k = numbers(matrix, 16);
        if (!lensFault(std::array{k[0], k[1], k[2], k[4], k[5], k[6], k[8], k[9], k[10]}).empty()) {
            refuse(matrix, "fx 0 cx 0, 0 fy cy 0, 0 0 1 0, 0 0 0 1");
        }
        return {.width = size(small + "Width", kMaxImageWidth),
                .height = size(small + "Height", kMaxImageHeight),
                .fx = k[0],
                .fy = k[5],
                .cx = k[2],
                .cy = k[6]};
    }
    // [pixels]
    double skew(const std::string& stream) const {
        return numbers("m_calibration" + stream + "Intrinsic", 16)[1];
    }
    void checkExtrinsic(const std::string& stream) const {
        const std::string key = "m_calibration" + stream + "Extrinsic";
        if (has(key) && !std::ranges::equal(numbers(key, 16), kIdentityMatrix)) {
            refuse(key, "the identity; or intrinsics=FILE after the folder name");
        }
    }
    double metresPerUnit() const {
        const double unit = 1.0 / numbers("m_depthShift", 1)[0];
        if (!(unit >= kFinestUnit && unit <= kCoarsestUnit)) {
            refuse("m_depthShift", "units per metre, 10 to 1000000");
        }
        return unit;
    }

private:
    [[noreturn]] void refuse(const std::string& key, const std::string& allowed) const {
        throw BadInput(file_, key, has(key) ? values_.at(key) : "missing", allowed);
    }
    std::vector<double> numbers(const std::string& key, size_t count) const {
        const std::string text = has(key) ? values_.at(key) : "";
        std::vector<double> all;
        for (const std::string_view word : splitWords(text)) {
            all.push_back(std::nan(""));
            if (!parseNumber(word, all.back())) {
                refuse(key, "numbers");
            }
        }
        if (all.size() != count) {
            refuse(key, std::to_string(count) + (count == 1 ? " number" : " numbers"));
        }
        return all;
    }
    uint32_t size(const std::string& key, uint32_t most) const {
        const double value = numbers(key, 1)[0];
        if (!(value >= 1.0 && value <= most) || value != std::floor(value)) {
            refuse(key, "a whole number, 1 to " + std::to_string(most));
        }
        return static_cast<uint32_t>(value);
    }

    std::string file_;
    std::map<std::string, std::string> values_;
};

constexpr const char* kDepthLens = "m_calibrationDepthIntrinsic";

struct Calibration {
    std::optional<fs::path> file;
    std::string unusable; // why a file of the name of one is none; empty = there is none
};

// optional: skips a file that cannot be read. 12-Scenes has its calibration next to the folder of images,
// where other data sets may have any text.
bool takeCalibration(Calibration& found, const fs::path& file, bool optional) {
    std::error_code failed;
    if (optional ? !fs::is_regular_file(file, failed) : !fs::exists(file, failed)) {
        return false;
    }
    std::string why = file.string() + " has no " + kDepthLens;
    try {
        if (SensorInfo(file).has(kDepthLens)) {
            found.file = file;
            return true;
        }
    } catch (const BadInput& e) {
        if (!optional) {
            throw;
        }
        why = e.what();
    }
    found.unusable = found.unusable.empty() ? why : found.unusable;
    return false;
}

// The folder in which this one is named, and that in which it lies, if it is a link.
std::array<fs::path, 2> foldersAbove(const fs::path& folder) {
    fs::path named = fs::absolute(folder).lexically_normal();
    named = named.has_filename() ? named : named.parent_path();
    return {named.parent_path(), fs::weakly_canonical(folder).parent_path()};
}

Calibration calibrationOf(const fs::path& folder) {
    Calibration found;
    for (const char* name : {"info.txt", "_info.txt"}) {
        if (takeCalibration(found, folder / name, false)) {
            return found;
        }
    }
    for (const fs::path& above : foldersAbove(folder)) {
        if (takeCalibration(found, above / "info.txt", true)) {
            return found;
        }
    }
    return found;
}

RecordingIntrinsics readInfo(const fs::path& file, bool depthOnly) {
    const SensorInfo info(file);
    RecordingIntrinsics intrinsics;
    intrinsics.file = file.filename().string();
    CameraInfo& camera = intrinsics.camera;
    info.checkExtrinsic("Depth");
    camera.depth = camera.colour = info.lens("Depth");
    warnAboutSkew(intrinsics.warnings, intrinsics.file + ": " + kDepthLens, info.skew("Depth"));
    if (!depthOnly) {
        info.checkExtrinsic("Color");
        camera.colour = info.lens("Color");
        camera.registered = sameLens(camera.depth, camera.colour);
        warnAboutSkew(intrinsics.warnings, intrinsics.file + ": m_calibrationColorIntrinsic",
                      info.skew("Color"));
    }
    intrinsics.scale = camera.metresPerUnit = info.metresPerUnit();
    return intrinsics;
}

std::string nominalWarning(const Calibration& none) {
    return "the nominal lens of 7-Scenes is used (fx and fy 585, principal point (320, 240)); another one is "
           "read from info.txt or intrinsics=FILE after the folder name" +
           (none.unusable.empty() ? "" : ". " + none.unusable);
}

// The data set's own calibration.
RecordingIntrinsics sevenScenesLens() {
    RecordingIntrinsics intrinsics;
    intrinsics.camera.depth =
        Intrinsics{.width = 640, .height = 480, .fx = 585.0, .fy = 585.0, .cx = 320.0, .cy = 240.0};
    intrinsics.camera.colour = intrinsics.camera.depth;
    return intrinsics;
}

// The lens of 3DMatch and the like, in a text of one matrix in the folder or above; nothing without one.
// fault: why such a file is not used.
std::optional<RecordingIntrinsics> matrixLensOf(const fs::path& folder, const std::vector<IndexLine>& index,
                                                std::string& fault) {
    std::vector<fs::path> folders{folder};
    std::ranges::copy(foldersAbove(folder), std::back_inserter(folders));
    std::error_code failed;
    for (const fs::path& one : folders) {
        for (const char* name : {"camera-intrinsics.txt", "camera_intrinsics.txt", "intrinsics.txt"}) {
            if (!fs::is_regular_file(one / name, failed)) {
                continue;
            }
            try {
                RecordingIntrinsics intrinsics;
                intrinsics.file = name;
                intrinsics.camera.depth = intrinsics.camera.colour =
                    matrixLens(one / name, firstDepthSize(index), intrinsics.warnings);
                return intrinsics;
            } catch (const BadInput& e) {
                fault = fault.empty() ? e.what() : fault;
            }
        }
    }
    return std::nullopt;
}

constexpr std::string_view kFrameName = "frame-", kDepthName = ".depth";

// Poses have no word of their own where depth has one: frame-000000.rendered.depth.png.
fs::path poseFile(const fs::path& folder, const std::string& stem) {
    constexpr const char* kEnd = ".pose.txt";
    std::error_code failed;
    const fs::path own = folder / (stem + kEnd);
    return fs::exists(own, failed) ? own : folder / (stem.substr(0, stem.find('.')) + kEnd);
}

} // namespace

bool hasFrameImages(const fs::path& folder) {
    std::error_code failed;
    const fs::directory_iterator files(folder, failed);
    return std::any_of(begin(files), end(files), [](const fs::directory_entry& entry) {
        const std::string stem = entry.path().stem().string();
        return stem.starts_with(kFrameName) && stem.ends_with(kDepthName) &&
               endsAs(entry.path(), kDepthEndings);
    });
}

RecordingLayout readFrameFolder(const LayoutRequest& request) {
    const fs::path& folder = request.folder;
    Calibration calibration = calibrationOf(folder);
    const std::optional<fs::path>& info = calibration.file;
    RecordingLayout layout;
    layout.index = pairByNumber({folder, kDepthEndings, std::string(kDepthName)},
                                {folder, kColourEndings, ".color"}, request.depthOnly);
    if (request.lens) {
        layout.intrinsics = *request.lens;
        if (info && !request.depthOnly) {
            keepRecordedColour(layout.intrinsics, [&] { return readInfo(*info, false).camera; });
        }
    } else if (info) {
        layout.intrinsics = readInfo(*info, request.depthOnly);
    } else if (const auto matrix = matrixLensOf(folder, layout.index, calibration.unusable)) {
        layout.intrinsics = *matrix;
    } else {
        layout.intrinsics = sevenScenesLens();
        layout.warnings.push_back(nominalWarning(calibration));
    }
    if (info && request.lens) {
        keepRecordedUnit(layout.intrinsics, info->filename().string(),
                         [&] { return SensorInfo(*info).metresPerUnit(); });
    }
    layout.invalid = info ? 0 : 65535;
    for (IndexLine& line : layout.index) {
        std::string stem = line.depth.stem().string();
        stem.resize(stem.size() - kDepthName.size());
        layout.posePerImage |= usePose(line, poseFile(folder, stem));
    }
    return layout;
}

} // namespace fathom
