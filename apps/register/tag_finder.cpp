// SPDX-License-Identifier: Apache-2.0
#include "apps/register/tag_finder.h"

#include "apps/register/point_pairs.h"
#include "apps/register/seen_plane.h"
#include "engine/types/error.h"

#include <algorithm>
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <sstream>

namespace fathom {

namespace {

constexpr int kLastTag = 586; // of the family 36h11

}

struct TagFinder::Detector {
    apriltag_family_t* family = tag36h11_create();
    apriltag_detector_t* detector = apriltag_detector_create();
    Detector() {
        apriltag_detector_add_family(detector, family);
        detector->quad_decimate = 1.0f; // sub-pixel corners matter more than time
    }
    ~Detector() {
        apriltag_detector_destroy(detector);
        tag36h11_destroy(family);
    }
    Detector(const Detector&) = delete;
    Detector& operator=(const Detector&) = delete;
};

std::map<int, TagPlace> readTagPlaces(const std::filesystem::path& file) {
    std::map<int, TagPlace> places;
    for (const TextLine& line : readRows(file, "id,size_m,x,y,z,qx,qy,qz,qw")) {
        std::string spaced = line.text;
        std::replace(spaced.begin(), spaced.end(), ',', ' ');
        std::istringstream words(spaced);
        TagPlace place;
        int id = -1;
        dvec3& t = place.baseTtag.position;
        dquat& q = place.baseTtag.rotation;
        std::string more;
        const bool read =
            static_cast<bool>(words >> id >> place.size >> t.x >> t.y >> t.z >> q.x >> q.y >> q.z >> q.w);
        if (!read || words >> more || id < 0 || id > kLastTag || !isNear(place.baseTtag, place.size) ||
            places.count(id) != 0) {
            throw BadInput(file.string(), "line " + std::to_string(line.number), line.text.substr(0, 160),
                           "id,size_m,x,y,z,qx,qy,qz,qw: unique ids from 0 to 586, size of 0.001 to 10 m, "
                           "position within "
                           "1e6 m, valid quaternion");
        }
        q = glm::normalize(q);
        places[id] = place;
    }
    if (places.empty()) {
        throw BadInput(file.string(), "rows", "none", "at least one tag");
    }
    return places;
}

TagFinder::TagFinder(const CameraInfo& camera, std::map<int, TagPlace> places)
    : camera_(camera)
    , places_(std::move(places))
    , detector_(std::make_unique<Detector>()) {}

TagFinder::~TagFinder() = default;

std::vector<TagFinder::Corners> TagFinder::detect(const Frame& frame) {
    greyOf(frame, grey_);
    const auto width = static_cast<int32_t>(camera_.colour.width),
               height = static_cast<int32_t>(camera_.colour.height);
    image_u8_t image{width, height, width, grey_.data()};
    zarray_t* found = apriltag_detector_detect(detector_->detector, &image);
    std::vector<Corners> tags;
    for (int i = 0; i < zarray_size(found); ++i) {
        apriltag_detection_t* one = nullptr;
        zarray_get(found, i, &one);
        if (places_.count(one->id) != 0 && one->hamming == 0) {
            Corners corners{one->id, {}};
            for (size_t k = 0; k < 4;
                 ++k) { // the library's (0, 0) is the corner of the first pixel, Fathom's its centre
                corners.pixels[k] = {one->p[k][0] - 0.5, one->p[k][1] - 0.5};
            }
            tags.push_back(corners);
        }
    }
    apriltag_detections_destroy(found);
    return tags;
}

std::vector<PointPair> TagFinder::find(const Frame& frame) {
    std::vector<PointPair> pairs;
    for (const Corners& corners : detect(frame)) {
        const auto plane = SeenPlane::inside(frame, camera_, corners.pixels);
        if (!plane) {
            continue;
        }
        const TagPlace& place = places_.at(corners.id);
        const double half = 0.5 * place.size;
        const dvec3 own[4] = {{-half, half, 0.0}, {half, half, 0.0}, {half, -half, 0.0}, {-half, -half, 0.0}};
        for (size_t k = 0; k < 4; ++k) {
            pairs.push_back({plane->at(corners.pixels[k]),
                             place.baseTtag.rotation * own[k] + place.baseTtag.position,
                             "tag " + std::to_string(corners.id) + " corner " + std::to_string(k)});
        }
    }
    return pairs;
}

} // namespace fathom
