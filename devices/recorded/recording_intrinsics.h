// SPDX-License-Identifier: Apache-2.0
// intrinsics.json of a recording folder: flat (one registered lens) or depth / color blocks with extrinsics.
#pragma once

#include "engine/types/camera_info.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// Largest image [pixels].
inline constexpr uint32_t kMaxImageWidth = 3840;
inline constexpr uint32_t kMaxImageHeight = 2160;

// Whether depth_scale_m_per_unit may be missing, and is checked.
enum class ScaleRule { Needed, Optional, Unchecked };

struct RecordingIntrinsics {
    std::string file; // name of the file that states them; empty for a lens that is known
    CameraInfo camera;
    std::optional<double> scale; // [m per unit] as stated
    // Why a depth scale under the name of another program is not read: a refusal where images need one.
    // Empty = there is none, or `scale` is stated, too.
    std::string unreadScale = {};
    // A warning of 16-bit images whose recording states another unit than this file, or of a file that states
    // two; empty = none.
    std::string unitWarning = {};
    // Only when the file lists them: capture times [s] of the files in depth/ and rgb/ in order of their
    // names.
    std::vector<double> depthStamps, colourStamps;
    bool relatesColour = false;             // two lenses, or registered_to_color: colour is as this file says
    std::vector<std::string> warnings = {}; // of what the file states and is not used
    bool rangeImages = false;               // depth/ holds ranges along the rays, not z
    // [s] largest distance of a depth stamp from its colour stamp: half a frame at nominal_fps
    double pairWithin = 0.02;
};

// Flat: width height fx fy cx cy [distortion_model distortion] depth_scale_m_per_unit [registered_to_color:
// true]. Two lenses: depth and color (or colour) blocks of the same keys, depth_scale_m_per_unit,
// registered_to_color, and unless registered extrinsics_topic_tf {Depth, Color: {t [m], q_xyzw}}. Distortion
// is as setDistortion() takes it (lens_model.h).
// has_color: false (flat only) marks a recording without colour. Sonars and laser scans (flat only):
// projection: equal_angles (fx, fy in pixels per radian), depth_is: range, and beam {width_deg, sigma_m,
// sigma_m_per_m}; its rgb/ images show intensity as grey. Throws BadInput naming the file and field.
// A missing depth_scale_m_per_unit is 0.001 unless it is needed. Open3D's camera_intrinsic.json is read as
// well (intrinsic_matrix, column by column; depth_scale in units per metre, else millimetres). Distortion
// under a name of other programs (D, distortion_coefficients, ...) is rejected unless it is zero.
RecordingIntrinsics readIntrinsics(const std::filesystem::path& file, ScaleRule rule = ScaleRule::Needed);

// For a file that replaces the lenses of a recording: colour keeps its recorded lens and pose, if these are
// its own and the file does not relate it to depth. recorded: reads the recording's lenses. Throws BadInput
// that names the file where recorded throws.
void keepRecordedColour(RecordingIntrinsics& given, const std::function<CameraInfo()>& recorded);

} // namespace fathom
