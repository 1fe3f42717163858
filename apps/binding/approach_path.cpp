// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/approach_path.h"

#include "engine/types/haptic_device.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

namespace fathom {

namespace {

constexpr double kStep = 0.01;       // [s] between waypoints
constexpr double kFastest = 0.24;    // [m/s] peak speed of a free move
constexpr double kPushSpeed = 0.10;  // [m/s] peak speed of a push
constexpr double kPushDepth = 0.020; // [m] beyond the touch
constexpr double kPushStart = 0.060; // [m] start of a push, before the touch
constexpr double kClear = 0.030;     // [m] clearance around the start pose
constexpr double kRoom =
    0.100; // [m] distance of the first candidate of the start pose from the nearest region
constexpr double kBackStep = 0.020;     // [m]
constexpr int kMaxBackSteps = 200;      // 4 m: more than the near limit of any camera
constexpr double kBeforeTarget = 0.060; // [m]
constexpr double kGapCap = 0.050;       // [m] longest step of the search
constexpr double kRotation = 4.0;       // [degree]
constexpr double kRotationTime = 1.4;   // [s]
constexpr double kHoldTime = 2.2;       // [s] at a guidance target
constexpr double kButtonTime = 1.5;     // [s] of that, at the end, with the button down

struct Goal {
    int fixture = 0;
    Role role = Role::Forbidden;
    dvec3 point{0.0}; // base frame
};

// Tests free moves of the tool: straight lines with the orientation of the base frame.
class FreeSpace {
public:
    FreeSpace(const Tool& tool, const HostFixtures& set, const RegionGrid& grid)
        : tool_(tool)
        , set_(set)
        , grid_(grid) {}

    double gap(const dvec3& position, int fixture = -1) const {
        return leastGap(tool_, set_, grid_, {position, dquat(1.0, 0.0, 0.0, 0.0)}, kGapCap, fixture);
    }

    // Length of the move from a to b up to the first contact of a leaf; empty when the move is free. Each
    // step is as long as the current gap, so it cannot skip a region. A minimum step keeps grazing moves
    // progressing; it is halved when it ends inside.
    std::optional<double> touch(const dvec3& a, const dvec3& b, int fixture = -1) const {
        const double length = glm::length(b - a);
        const dvec3 direction = length > 0.0 ? (b - a) / length : dvec3(0.0);
        double free = 0.0, left = gap(a, fixture);
        while (left > 0.0) {
            if (free >= length) {
                return std::nullopt;
            }
            const double next = std::min(length, free + std::max(left, 20e-6));
            left = gap(a + next * direction, fixture);
            if (left <= 0.0) {
                return lastFree(a, direction, free, next, fixture);
            }
            free = next;
        }
        return 0.0;
    }

private:
    double lastFree(const dvec3& a, const dvec3& direction, double free, double inside, int fixture) const {
        for (int i = 0; i < 40; ++i) {
            const double middle = 0.5 * (free + inside);
            (gap(a + middle * direction, fixture) > 0.0 ? free : inside) = middle;
        }
        return free;
    }

    const Tool& tool_;
    const HostFixtures& set_;
    const RegionGrid& grid_;
};

class PathWriter {
public:
    explicit PathWriter(const dvec3& start) { path_.push_back({0.0, {start, dquat(1.0, 0.0, 0.0, 0.0)}, 0}); }

    // Minimum jerk: the peak speed is 15/8 of the mean.
    void move(const dvec3& to, double peakSpeed) {
        const dvec3 from = path_.back().deviceThandle.position;
        const double duration = 1.875 * glm::length(to - from) / peakSpeed;
        append(duration, 0, [&](double s) {
            return Pose{from + minimumJerk(s) * (to - from), {1.0, 0.0, 0.0, 0.0}};
        });
    }
    void rest(double duration, uint32_t buttons) {
        const Pose pose = path_.back().deviceThandle;
        append(duration, buttons, [&](double) { return pose; });
    }
    // Rotates to both sides and back, about an axis through the tool's origin.
    void step(const dvec3& axis, double angle, double duration) {
        const dvec3 position = path_.back().deviceThandle.position;
        append(duration, 0, [&](double s) {
            return Pose{position,
                        rotationExp(angle * std::sin(2.0 * std::numbers::pi * minimumJerk(s)) * axis)};
        });
    }
    std::vector<HandWaypoint> take() { return std::move(path_); }

private:
    static double minimumJerk(double s) { return s * s * s * (10.0 + s * (-15.0 + 6.0 * s)); }

    // A waypoint's buttons are valid from its time on, so the waypoint at the start gets them, too.
    template <class PoseAt>
    void append(double duration, uint32_t buttons, const PoseAt& poseAt) {
        path_.back().buttons = buttons;
        const double start = path_.back().t;
        const auto steps = static_cast<uint32_t>(std::ceil(duration / kStep));
        for (uint32_t i = 1; i <= steps; ++i) {
            path_.push_back({start + i * kStep, poseAt(static_cast<double>(i) / steps), buttons});
        }
        path_.back().buttons = 0;
    }

    std::vector<HandWaypoint> path_;
};

// Centre of the class's sphere nearest to their mean; empty without spheres.
std::optional<dvec3> middleSphere(const HostFixtures& set, int fixture) {
    const RegionSpheres& s = set.spheres;
    dvec3 sum(0.0);
    size_t count = 0;
    for (size_t i = 0; i < s.size(); ++i) {
        if (s.fixture[i] == fixture) {
            sum += dvec3(s.x[i], s.y[i], s.z[i]);
            ++count;
        }
    }
    std::optional<dvec3> middle;
    double nearest = HUGE_VAL;
    for (size_t i = 0; i < s.size(); ++i) {
        const dvec3 centre(s.x[i], s.y[i], s.z[i]);
        const double distance = glm::length(centre - sum / static_cast<double>(count));
        if (s.fixture[i] == fixture && distance < nearest) {
            middle = set.origin + centre;
            nearest = distance;
        }
    }
    return middle;
}

std::vector<Goal> goalsOf(const Scene& scene, const HostFixtures& set) {
    std::vector<Goal> goals;
    for (size_t row = 0; row < scene.fixtures.size(); ++row) {
        const FixtureClass& fixture = scene.fixtures[row];
        const int index = static_cast<int>(row);
        if (!fixture.isPoints()) {
            continue;
        }
        if (fixture.role == Role::Forbidden) {
            if (const std::optional<dvec3> point = middleSphere(set, index)) {
                goals.push_back({index, fixture.role, *point});
            }
            continue;
        }
        for (const GuidancePose& guidance : set.guidance) {
            if (guidance.fixture == row && guidance.present) {
                goals.push_back({index, fixture.role, guidance.target.position});
            }
        }
    }
    return goals;
}

// The point `distance` before `end` on the ray from the camera, or closer to the camera until it is clear and
// the move from `from` is free.
dvec3 standBefore(const FreeSpace& space, const dvec3& end, const dvec3& direction, double distance,
                  const dvec3* from) {
    dvec3 point = end - distance * direction;
    for (int i = 0; i < kMaxBackSteps; ++i, point -= kBackStep * direction) {
        if (space.gap(point) >= kClear && (from == nullptr || !space.touch(*from, point))) {
            break;
        }
    }
    return point;
}

dvec3 directionFrom(const dvec3& camera, const dvec3& point, const Pose& baseTcamera) {
    const dvec3 way = point - camera;
    return glm::length(way) > 1e-9 ? glm::normalize(way) : baseTcamera.rotation * dvec3(0.0, 0.0, 1.0);
}

void push(PathWriter& path, const FreeSpace& space, const Goal& goal, const dvec3& before,
          const dvec3& direction) {
    const dvec3 far = goal.point + kRoom * direction;
    const double touch = space.touch(before, far, goal.fixture).value_or(glm::length(goal.point - before));
    path.move(before + std::max(0.0, touch - kPushStart) * direction, kFastest);
    path.move(before + (touch + kPushDepth) * direction, kPushSpeed);
    path.rest(0.3, 0);
    // Mostly across the push, which tilts a long tool, and partly about it.
    const dvec3 aside = glm::cross(direction, std::abs(direction.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0));
    path.step(glm::normalize(glm::normalize(aside) + 0.5 * direction), kRotation * std::numbers::pi / 180.0,
              kRotationTime);
    path.rest(0.3, 0);
    path.move(before, kFastest);
}

void seek(PathWriter& path, const FreeSpace& space, const Goal& goal, const dvec3& before,
          const dvec3& direction) {
    double reach = glm::dot(goal.point - kBeforeTarget * direction - before, direction);
    if (const std::optional<double> touch = space.touch(before, before + std::max(reach, 0.0) * direction)) {
        reach = *touch - 0.002;
    }
    path.move(before + std::max(reach, 0.0) * direction, kFastest);
    path.rest(kHoldTime - kButtonTime, 0);
    path.rest(kButtonTime, kGuidanceButton);
    path.move(before, kFastest);
}

} // namespace

double leastGap(const Tool& tool, const HostFixtures& set, const RegionGrid& grid, const Pose& baseTtool,
                double cap, int fixture) {
    const RegionSpheres& s = set.spheres;
    double least = cap;
    for (const Sphere& leaf : tool.leaves()) {
        const dvec3 centre = baseTtool.apply(leaf.centre) - set.origin;
        grid.forEachNear(centre, leaf.radius + grid.maxRadius() + std::max(least, 0.0), [&](uint32_t i) {
            if (fixture < 0 || s.fixture[i] == fixture) {
                const double distance = glm::length(centre - dvec3(s.x[i], s.y[i], s.z[i]));
                least = std::min(least, distance - leaf.radius - double{s.radius[i]});
            }
        });
    }
    return least;
}

std::vector<HandWaypoint> approachPath(const Scene& scene, const Tool& tool, const HostFixtures& firstSet,
                                       const RegionGrid& grid) {
    const FreeSpace space(tool, firstSet, grid);
    const dvec3 camera = firstSet.baseTcamera.position;
    const std::vector<Goal> goals = goalsOf(scene, firstSet);
    dvec3 middle = firstSet.baseTcamera.apply({0.0, 0.0, 0.5});
    double nearest = 0.5;
    if (!goals.empty()) {
        dvec3 sum(0.0);
        nearest = HUGE_VAL;
        for (const Goal& goal : goals) {
            sum += goal.point;
            nearest = std::min(nearest, glm::length(goal.point - camera));
        }
        middle = sum / static_cast<double>(goals.size());
    }
    const double clearance = grid.maxRadius() + tool.boundingRadius() + kRoom;
    const dvec3 ahead = directionFrom(camera, middle, firstSet.baseTcamera);
    const dvec3 start = standBefore(space, camera + nearest * ahead, ahead, clearance, nullptr);

    PathWriter path(start);
    path.rest(0.5, 0);
    for (const Goal& goal : goals) {
        const dvec3 direction = directionFrom(camera, goal.point, firstSet.baseTcamera);
        const double room = clearance + (goal.role == Role::Guidance ? kBeforeTarget : 0.0);
        const dvec3 before = standBefore(space, goal.point, direction, room, &start);
        path.move(before, kFastest);
        goal.role == Role::Forbidden ? push(path, space, goal, before, direction)
                                     : seek(path, space, goal, before, direction);
        path.move(start, kFastest);
    }
    path.rest(0.5, 0);
    return path.take();
}

} // namespace fathom
