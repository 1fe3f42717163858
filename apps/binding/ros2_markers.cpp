// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/ros2_markers.h"

#include <cmath>
#include <map>

namespace fathom {

namespace {

using ros2::Marker;
using Colour = std::array<float, 4>;

constexpr Colour kForbiddenColour{0.9f, 0.2f, 0.15f, 0.7f}, kKeepInColour{0.2f, 0.7f, 0.3f, 0.25f},
    kLineColour{0.2f, 0.5f, 0.9f, 0.9f};

void addSpheres(std::vector<Marker>& markers, std::span<const ros2::RegionPoint> points) {
    constexpr double kStep = 1.1; // from one radius to the next
    std::map<std::pair<int, int>, Marker> lists;
    for (const ros2::RegionPoint& point : points) {
        const int step =
            static_cast<int>(std::ceil(std::log(static_cast<double>(point.radius)) / std::log(kStep)));
        Marker& list = lists[{static_cast<int>(point.fixture), step}];
        list.scale = dvec3(2.0 * std::pow(kStep, step));
        list.points.push_back({point.x, point.y, point.z});
    }
    for (auto& [key, list] : lists) {
        list.space = "class " + std::to_string(key.first);
        list.id = key.second;
        list.kind = Marker::Kind::SphereList;
        list.colour = kForbiddenColour;
        markers.push_back(std::move(list));
    }
}

Marker markerOf(const Shape& shape) {
    constexpr double kPlane = 1.0, kThin = 0.001, kArrow = 0.2, kShaft = 0.005;
    Marker marker;
    marker.space = "shapes";
    marker.pose = shape.baseTshape;
    marker.scale = shape.size;
    marker.colour = shape.keepIn ? kKeepInColour : kForbiddenColour;
    switch (shape.kind) {
    case ShapeKind::Sphere:
        marker.scale = dvec3(2.0 * shape.size.x);
        break;
    case ShapeKind::Cylinder:
        marker.kind = Marker::Kind::Cylinder;
        marker.scale = {2.0 * shape.size.x, 2.0 * shape.size.x, shape.size.y};
        break;
    case ShapeKind::Plane:
        marker.kind = Marker::Kind::Cube;
        marker.scale = {kPlane, kPlane, kThin};
        break;
    case ShapeKind::Line:
    case ShapeKind::Axis: { // arrows point along x
        const dquat zFromX(std::sqrt(0.5), 0.0, -std::sqrt(0.5), 0.0);
        marker.kind = Marker::Kind::Arrow;
        marker.pose.rotation = marker.pose.rotation * zFromX;
        marker.scale = {kArrow, kShaft, kShaft};
        marker.colour = kLineColour;
        break;
    }
    case ShapeKind::Box:
    case ShapeKind::None:
        marker.kind = Marker::Kind::Cube;
        break;
    }
    return marker;
}

} // namespace

std::vector<Marker> ros2Markers(const Ros2Regions& regions) {
    std::vector<Marker> markers(1);
    markers.front().action = Marker::Action::DeleteAll;
    addSpheres(markers, regions.points);
    for (const Shape& shape : regions.shapes) {
        markers.push_back(markerOf(shape));
        markers.back().id = static_cast<int32_t>(shape.fixture);
    }
    return markers;
}

} // namespace fathom
