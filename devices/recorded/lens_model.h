// SPDX-License-Identifier: Apache-2.0
// Names and coefficients of lens distortion, as intrinsics.json and sensor_msgs/CameraInfo give them.
#pragma once

#include "engine/types/camera_info.h"

#include <span>
#include <string>
#include <vector>

namespace fathom {

// Sets the lens's model and coefficients. Names in any case, with spaces or underscores:
// plumb_bob, radtan, brown_conrady: k1 k2 p1 p2 [k3]; rational_polynomial: k1 k2 p1 p2 k3 k4 k5 k6, further
// ones zero; inverse_brown_conrady, modified_brown_conrady: as librealsense projects them, with the
// tangential part after the radial one; equidistant, kannala_brandt4, fisheye: k1 k2 k3 k4. All zero is no
// distortion for every model but the equidistant ones. Returns what is allowed, or empty when it was set.
std::string setDistortion(Intrinsics& lens, const std::string& model, std::span<const double> coefficients);

// The same, to be written.
std::string distortionModel(const Intrinsics& lens);
std::vector<double> distortionCoefficients(const Intrinsics& lens);

// Whether the principal point of a pinhole is outside of the image, or its focal lengths differ by over a
// quarter, as those of hardly any camera. False for a lens that is rejected anyway (camera_limits.h).
bool isUnusualLens(const Intrinsics& lens);
// Warnings of a camera whose lens is unusual, for depth and for colour with a lens of its own: it may be that
// of another image size.
std::vector<std::string> lensWarnings(const CameraInfo& camera);

// Adds a warning of a lens matrix, by its name, whose skew [pixels] is over 0.1: it is not used.
void warnAboutSkew(std::vector<std::string>& warnings, const std::string& matrix, double skew,
                   const std::string& images = "the images");
// For a lens matrix, by its name, of a file that states no image size: adds a warning where the principal
// point is at one share of the images' width and height that is far from their middle.
void warnAboutSize(std::vector<std::string>& warnings, const std::string& matrix, const Intrinsics& lens);

// Within 1e-6 pixels.
bool sameLens(const Intrinsics& a, const Intrinsics& b);
// Whether both see the border and the middle of the image within a tenth of a pixel: as one lens that is
// computed anew for each image.
bool nearlySameLens(const Intrinsics& a, const Intrinsics& b);

} // namespace fathom
