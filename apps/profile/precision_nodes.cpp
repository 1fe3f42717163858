// SPDX-License-Identifier: Apache-2.0
// Formats of the region tree's nodes: centre and radius of a bound in double, single, half, and half relative
// to the patch. The radius grows, rounded up, by the rounding error of the centre, so that a node always
// contains its spheres.
#include "apps/profile/half_number.h"
#include "apps/profile/precision.h"
#include "engine/types/pose.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace fathom::profile {

namespace {

constexpr size_t kChildren = 16;    // sub-patches of a patch, and spheres of a sub-patch
constexpr double kSphere = 0.02;    // [m] radius of a region sphere
constexpr double kCullReach = 0.01; // [m] reach of the cull
constexpr double kLeaf = 0.008;     // [m] radius of a leaf
constexpr double kSpread = 0.0064;  // [m] edge of a sub-patch

struct Bound {
    dvec3 centre{0.0};
    double radius = 0.0;
};

// A wall of sub-patches, 16 per patch. Each is the bound of its 16 spheres, which are stored, too.
struct Wall {
    std::vector<dvec3> spheres;
    std::vector<Bound> nodes;   // sub-patches, patch by patch
    std::vector<dvec3> anchors; // one per patch
    std::vector<dvec3> leaves;

    Wall(size_t patches, size_t leafCount, double away) {
        const auto across = static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(patches))));
        for (size_t p = 0; p < patches; ++p) {
            const size_t row = p / across;
            const dvec3 corner(4.0 * kSpread * static_cast<double>(p % across),
                               4.0 * kSpread * static_cast<double>(row), away);
            anchors.push_back(dvec3(glm::vec3(corner + dvec3(2.0 * kSpread, 2.0 * kSpread, 0.0))));
            for (size_t s = 0; s < kChildren; ++s) {
                const size_t line = s / 4;
                addSubPatch(corner +
                            kSpread * dvec3(static_cast<double>(s % 4), static_cast<double>(line), 0.0));
            }
        }
        const double extent = 4.0 * kSpread * static_cast<double>(across);
        for (size_t i = 0; i < leafCount; ++i) {
            const double t = static_cast<double>(i);
            leaves.push_back({extent * (0.5 + 0.3 * std::sin(1.7 * t)),
                              extent * (0.5 + 0.3 * std::cos(2.3 * t)), away - 0.03 - 0.03 * std::sin(t)});
        }
    }

private:
    void addSubPatch(const dvec3& corner) {
        Bound bound;
        for (size_t k = 0; k < kChildren; ++k) {
            const double n = static_cast<double>(spheres.size());
            const size_t line = k / 4;
            spheres.push_back(corner + dvec3(0.25 * kSpread * static_cast<double>(k % 4),
                                             0.25 * kSpread * static_cast<double>(line),
                                             0.01 * std::sin(37.0 * n)));
            bound.centre += spheres.back() / static_cast<double>(kChildren);
        }
        for (size_t k = spheres.size() - kChildren; k < spheres.size(); ++k) {
            bound.radius = std::max(bound.radius, glm::distance(spheres[k], bound.centre) + kSphere);
        }
        nodes.push_back(bound);
    }
};

// Each format defines how a node is stored, and its conversion back to centre and radius in the type that the
// cull uses.
struct DoubleNode {
    using Number = double;
    double x, y, z, r;
    static DoubleNode of(const Bound& b, const dvec3&) {
        return {b.centre.x, b.centre.y, b.centre.z, b.radius};
    }
    glm::dvec4 sphere(const dvec3&) const { return {x, y, z, r}; }
};

struct SingleNode {
    using Number = float;
    float x, y, z, r;
    static SingleNode of(const Bound& b, const dvec3&) {
        const glm::vec3 c(b.centre);
        const double needed = b.radius + glm::distance(dvec3(c), b.centre);
        float r = static_cast<float>(needed);
        r = static_cast<double>(r) < needed ? std::nextafter(r, std::numeric_limits<float>::max()) : r;
        return {c.x, c.y, c.z, r};
    }
    glm::vec4 sphere(const dvec3&) const { return {x, y, z, r}; }
};

template <bool kAboutPatch>
struct HalfNode {
    using Number = float;
    uint16_t x, y, z, r;
    static HalfNode of(const Bound& b, const dvec3& anchor) {
        const glm::vec3 c(kAboutPatch ? b.centre - anchor : b.centre);
        HalfNode node{halved(c.x), halved(c.y), halved(c.z), 0};
        node.r = halvedUp(b.radius + glm::distance(dvec3(node.sphere(anchor)), b.centre));
        return node;
    }
    glm::vec4 sphere(const dvec3& anchor) const {
        const glm::vec3 c(widened(x), widened(y), widened(z));
        return {kAboutPatch ? c + glm::vec3(anchor) : c, widened(r)};
    }
};

// Centres of the leaves; their number is a multiple of 16.
template <class T>
struct Leaves {
    std::vector<T> x, y, z;
    explicit Leaves(const std::vector<dvec3>& leaves) {
        for (const dvec3& l : leaves) {
            x.push_back(static_cast<T>(l.x));
            y.push_back(static_cast<T>(l.y));
            z.push_back(static_cast<T>(l.z));
        }
    }
};

// Marks the nodes within reach of some leaf. Tests every node against every leaf.
template <class Node>
void cull(const Wall& wall, const Leaves<typename Node::Number>& leaves, const std::vector<Node>& nodes,
          std::vector<uint8_t>& marks) {
    using T = typename Node::Number;
    marks.assign(nodes.size(), 0);
    for (size_t n = 0; n < nodes.size(); ++n) {
        const auto node = nodes[n].sphere(wall.anchors[n / kChildren]);
        const T limit = node.w + static_cast<T>((kCullReach + kLeaf) * 1.00001 + 1e-6);
        const T nearest = nearestSquared(leaves.x.data(), leaves.y.data(), leaves.z.data(), leaves.x.size(),
                                         node.x, node.y, node.z);
        marks[n] = nearest <= limit * limit ? 1 : 0;
    }
}

// [m] by which the stored node extends beyond the exact one; negative if a sphere is outside.
template <class Node>
double growthOf(const Wall& wall, const std::vector<Node>& nodes, const std::string& name) {
    double most = 0.0;
    for (size_t n = 0; n < nodes.size(); ++n) {
        const glm::dvec4 sphere(nodes[n].sphere(wall.anchors[n / kChildren]));
        const Bound b{dvec3(sphere), sphere.w};
        for (size_t k = n * kChildren; k < (n + 1) * kChildren; ++k) {
            const double out = glm::distance(wall.spheres[k], b.centre) + kSphere - b.radius;
            verify(out <= 1e-15, "precision", name,
                   "a sphere protrudes from its node by " + digits(out * 1e6) + " um");
        }
        most =
            std::max(most, b.radius + glm::distance(b.centre, wall.nodes[n].centre) - wall.nodes[n].radius);
    }
    return most;
}

template <class Node>
PrecisionLoop loopOf(const std::string& source, const std::string& name,
                     const std::shared_ptr<const Wall>& shared, const std::vector<uint8_t>& needed,
                     double allowed) {
    const Wall& wall = *shared;
    std::vector<Node> nodes;
    for (size_t n = 0; n < wall.nodes.size(); ++n) {
        nodes.push_back(Node::of(wall.nodes[n], wall.anchors[n / kChildren]));
    }
    const double growth = growthOf(wall, nodes, name);
    verify(growth <= allowed, "precision", name, "a node grows by " + digits(growth * 1e3) + " mm");
    const Leaves<typename Node::Number> leaves(wall.leaves);
    std::vector<uint8_t> marks;
    cull(wall, leaves, nodes, marks);
    for (size_t n = 0; n < marks.size() && !needed.empty(); ++n) {
        verify(marks[n] >= needed[n], "precision", name, "the cull loses node " + std::to_string(n));
    }
    StudyRow row = precisionRow(source, name, name == "single", growth * 1e3, sizeof(Node),
                                static_cast<double>(nodes.size()),
                                static_cast<double>(std::count(marks.begin(), marks.end(), 1)));
    return {std::move(row),
            [shared, leaves, nodes, marks]() mutable { cull(*shared, leaves, nodes, marks); }};
}

} // namespace

std::vector<PrecisionLoop> nodeRows(const StudyContext& context) {
    const size_t patches = context.settings.quick ? 64 : 1200, leaves = context.settings.quick ? 32 : 256;
    std::vector<PrecisionLoop> loops;
    for (double away : {0.8, 8.0}) {
        const auto wall = std::make_shared<const Wall>(patches, leaves, away);
        const std::string source = "tree nodes " + digits(away) + " m from the origin";
        std::vector<DoubleNode> exact;
        for (const Bound& b : wall->nodes) {
            exact.push_back(DoubleNode::of(b, {}));
        }
        std::vector<uint8_t> needed;
        cull(*wall, Leaves<double>(wall->leaves), exact, needed);
        loops.push_back(loopOf<DoubleNode>(source, "double", wall, {}, 1e-15));
        loops.push_back(loopOf<SingleNode>(source, "single", wall, needed, 4e-6));
        loops.push_back(loopOf<HalfNode<true>>(source, "half about the patch", wall, needed, 1e-4));
        loops.push_back(loopOf<HalfNode<false>>(source, "half", wall, needed, away * 4e-3));
    }
    return loops;
}

} // namespace fathom::profile
