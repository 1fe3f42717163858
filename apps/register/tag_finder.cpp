// SPDX-License-Identifier: Apache-2.0
#include "apps/register/tag_finder.h"

#include "engine/types/error.h"

#include <Eigen/Eigenvalues>
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>

namespace fathom {

namespace {

constexpr size_t kLeastPixels = 50;
constexpr double kMostOffPlane = 0.01; // of the distance

struct Plane {
    dvec3 point{0.0}, normal{0.0};
};

std::optional<Plane> fitPlane(const std::vector<dvec3>& points) {
    if (points.size() < kLeastPixels) {
        return std::nullopt;
    }
    dvec3 mean(0.0);
    for (const dvec3& p : points) {
        mean += p / static_cast<double>(points.size());
    }
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const dvec3& p : points) {
        const Eigen::Vector3d d(p.x - mean.x, p.y - mean.y, p.z - mean.z);
        spread += d * d.transpose() / static_cast<double>(points.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> shape(spread);
    if (std::sqrt(std::max(0.0, shape.eigenvalues()(0))) > kMostOffPlane * mean.z) {
        return std::nullopt;
    }
    const Eigen::Vector3d n = shape.eigenvectors().col(0);
    return Plane{mean, {n(0), n(1), n(2)}};
}

bool inside(const std::array<glm::dvec2, 4>& corners, const glm::dvec2& p) {
    int left = 0;
    for (size_t i = 0; i < 4; ++i) {
        const glm::dvec2 edge = corners[(i + 1) % 4] - corners[i], to = p - corners[i];
        left += edge.x * to.y - edge.y * to.x > 0.0 ? 1 : 0;
    }
    return left == 0 || left == 4;
}

} // namespace

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
    std::ifstream in(file);
    if (!in) {
        throw BadInput(file.string(), "file", "cannot be read", "CSV rows id,size_m,x,y,z,qx,qy,qz,qw");
    }
    std::map<int, TagPlace> places;
    int number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        if (line.empty() || line[0] == '#' || line[0] == 'i') { // a comment, or the header
            continue;
        }
        for (char& c : line) {
            c = c == ',' ? ' ' : c;
        }
        std::istringstream words(line);
        TagPlace place;
        int id = -1;
        dvec3& t = place.baseTtag.position;
        dquat& q = place.baseTtag.rotation;
        std::string more;
        const bool read =
            static_cast<bool>(words >> id >> place.size >> t.x >> t.y >> t.z >> q.x >> q.y >> q.z >> q.w);
        if (!read || words >> more || id < 0 || !(place.size > 0.0) || !(glm::length(q) > 1e-6) ||
            places.count(id) != 0) {
            throw BadInput(file.string(), "line " + std::to_string(number), line,
                           "id,size_m,x,y,z,qx,qy,qz,qw: each id once, a positive size, a quaternion");
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
    grey_.resize(frame->colour.size());
    for (size_t i = 0; i < grey_.size(); ++i) { // BT.601 luma
        const uint32_t c = frame->colour[i];
        grey_[i] = static_cast<uint8_t>((77 * (c & 255) + 150 * (c >> 8 & 255) + 29 * (c >> 16 & 255)) >> 8);
    }
    const auto width = static_cast<int32_t>(camera_.colour.width),
               height = static_cast<int32_t>(camera_.colour.height);
    image_u8_t picture{width, height, width, grey_.data()};
    zarray_t* found = apriltag_detector_detect(detector_->detector, &picture);
    std::vector<Corners> tags;
    for (int i = 0; i < zarray_size(found); ++i) {
        apriltag_detection_t* one = nullptr;
        zarray_get(found, i, &one);
        if (places_.count(one->id) != 0 && one->hamming == 0) {
            Corners corners{one->id, {}};
            for (size_t k = 0; k < 4;
                 ++k) { // its pixel (0, 0) is the corner of the first pixel, ours the centre
                corners.pixels[k] = {one->p[k][0] - 0.5, one->p[k][1] - 0.5};
            }
            tags.push_back(corners);
        }
    }
    apriltag_detections_destroy(found);
    return tags;
}

// Points of the depth picture that the colour camera sees inside the tag, in the colour camera's frame.
std::vector<dvec3> TagFinder::depthInside(const Frame& frame, const Corners& corners) const {
    std::vector<dvec3> points;
    for (uint32_t i = 0; i < frame->depth.size(); ++i) {
        if (frame->depth[i] == 0) {
            continue;
        }
        const glm::dvec2 ray = camera_.depth.ray(i % camera_.depth.width, i / camera_.depth.width);
        const double z = frame->depth[i] * camera_.metresPerUnit;
        const Pose& pose = camera_.colourTdepth;
        const dvec3 p = pose.rotation * dvec3(ray.x * z, ray.y * z, z) + pose.position;
        if (p.z > 0.0 && inside(corners.pixels, camera_.colour.project(p))) {
            points.push_back(p);
        }
    }
    return points;
}

std::vector<PointPair> TagFinder::find(const Frame& frame) {
    std::vector<PointPair> pairs;
    for (const Corners& corners : detect(frame)) {
        const std::optional<Plane> plane = fitPlane(depthInside(frame, corners));
        if (!plane) {
            continue;
        }
        const TagPlace& place = places_.at(corners.id);
        const double half = 0.5 * place.size;
        const dvec3 own[4] = {{-half, half, 0.0}, {half, half, 0.0}, {half, -half, 0.0}, {-half, -half, 0.0}};
        for (size_t k = 0; k < 4; ++k) {
            const glm::dvec2 slope = camera_.colour.ray(corners.pixels[k].x, corners.pixels[k].y);
            const dvec3 ray(slope, 1.0);
            const dvec3 seen = ray * (glm::dot(plane->point, plane->normal) / glm::dot(ray, plane->normal));
            const Pose depthTcolour = inverse(camera_.colourTdepth);
            pairs.push_back({depthTcolour.rotation * seen + depthTcolour.position,
                             place.baseTtag.rotation * own[k] + place.baseTtag.position,
                             "tag " + std::to_string(corners.id) + " corner " + std::to_string(k)});
        }
    }
    return pairs;
}

} // namespace fathom
