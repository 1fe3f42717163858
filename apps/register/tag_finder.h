// SPDX-License-Identifier: Apache-2.0
// AprilTags in a depth + colour frame, as points in the frame of the depth camera.
#pragma once

#include "apps/register/rigid_fit.h"
#include "engine/types/camera_info.h"
#include "engine/types/frame.h"

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

namespace fathom {

// A printed tag of the family 36h11. Its frame: origin in its middle, x to the right, y down, z into the tag.
struct TagPlace {
    double size = 0.0; // [m] edge of the black square
    Pose baseTtag;
};

// CSV rows "id,size_m,x,y,z,qx,qy,qz,qw"; lines with # are comments. Throws BadInput.
std::map<int, TagPlace> readTagPlaces(const std::filesystem::path& file);

class TagFinder {
public:
    TagFinder(const CameraInfo& camera, std::map<int, TagPlace> places);
    ~TagFinder();

    // The four corners of every known tag in the frame: intersections of the colour camera's rays with the
    // plane fitted to the depth inside the tag (depth is least certain at edges). Tags with fewer than 50
    // depth pixels, or whose depth deviates from the plane by more than 1 % of its distance, are skipped.
    std::vector<PointPair> find(const Frame& frame);

private:
    struct Detector;
    struct Corners {
        int id = 0;
        std::array<glm::dvec2, 4> pixels; // of the colour image, in order of the tag's corners
    };
    std::vector<Corners> detect(const Frame& frame);

    CameraInfo camera_;
    std::map<int, TagPlace> places_;
    std::unique_ptr<Detector> detector_;
    std::vector<uint8_t> grey_;
};

} // namespace fathom
