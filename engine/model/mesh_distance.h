// SPDX-License-Identifier: Apache-2.0
// Distance to a mesh and whether a point is inside: a box hierarchy, and the generalised winding number
// (Jacobson et al. 2013) with each distant group approximated by one dipole (Barill et al. 2018).
#pragma once

#include "engine/model/triangle_mesh.h"

#include <vector>

namespace fathom {

// Built once; all queries are const and may run on many threads.
class MeshDistance {
public:
    // `mesh` must outlive this. A mesh that is not `solid` has no interior and needs no winding number.
    MeshDistance(const TriangleMesh& mesh, bool solid);

    // The point of the mesh that is nearest to another [m].
    struct Nearest {
        dvec3 point{0.0};
        double distance = 0.0; // [m] >= 0
    };
    Nearest nearest(const dvec3& p) const;
    // The same when it is known to be at most `most` [m] away, which takes less time.
    Nearest nearest(const dvec3& p, double most) const;

    // About 1 inside, 0 outside; 2 where two closed parts overlap. Accurate to about 0.01.
    double winding(const dvec3& p) const;
    bool isInside(const dvec3& p) const { return solid_ && std::abs(winding(p)) > 0.5; }

    // Signed distance [m], negative inside. Inside overlapping parts it is never below the true value.
    double signedDistance(const dvec3& p) const {
        const double d = nearest(p).distance;
        return isInside(p) ? -d : d;
    }
    // The same for a point at `p`, near `about`, whose signed distance is `known`: a shorter step does not
    // cross the surface, so the sign stays.
    double signedDistance(const dvec3& p, const dvec3& about, double known) const {
        const double step = glm::distance(p, about);
        const double d = nearest(p, step + std::abs(known)).distance;
        const bool stays = step < std::abs(known);
        return (stays ? known < 0.0 : isInside(p)) ? -d : d;
    }
    bool solid() const { return solid_; }

private:
    struct Node {
        dvec3 low, high;             // box
        dvec3 middle, areas;         // area-weighted mean, sum of area x normal
        double reach = 0.0;          // [m] farthest corner from `middle`
        uint32_t begin = 0, end = 0; // of order_
        uint32_t right = 0;          // 0 = leaf; the left child is the next node
    };
    uint32_t build(uint32_t begin, uint32_t end);
    void bound(Node& node) const;
    void search(uint32_t node, const dvec3& p, Nearest& best, double& bestSquare) const;
    double windingOf(uint32_t node, const dvec3& p) const;

    const TriangleMesh& mesh_;
    bool solid_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

// Nearest point of the triangle a b c to p (Ericson, Real-Time Collision Detection, 5.1.5).
dvec3 nearestOnTriangle(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c);

} // namespace fathom
