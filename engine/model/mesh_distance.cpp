// SPDX-License-Identifier: Apache-2.0
#include "engine/model/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace fathom {

namespace {

constexpr uint32_t kLeafFaces = 6;
constexpr double kFar = 2.3; // times a group's radius: its dipole then has an error of about 1 %
double squareToBox(const dvec3& p, const dvec3& low, const dvec3& high) {
    const dvec3 d = glm::max(dvec3(0.0), glm::max(low - p, p - high));
    return glm::dot(d, d);
}

// Solid angle of a triangle over 4 pi (Van Oosterom and Strackee 1983).
double windingOfTriangle(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec3 u = a - p, v = b - p, w = c - p;
    const double lu = glm::length(u), lv = glm::length(v), lw = glm::length(w);
    const double above = glm::dot(u, glm::cross(v, w));
    const double below = lu * lv * lw + glm::dot(u, v) * lw + glm::dot(v, w) * lu + glm::dot(w, u) * lv;
    return std::atan2(above, below) / (2.0 * std::numbers::pi);
}

} // namespace

dvec3 nearestOnTriangle(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d1 <= 0.0 && d2 <= 0.0) {
        return a;
    }
    if (d3 >= 0.0 && d4 <= d3) {
        return b;
    }
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        return a + d1 / (d1 - d3) * ab;
    }
    if (d6 >= 0.0 && d5 <= d6) {
        return c;
    }
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        return a + d2 / (d2 - d6) * ac;
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    }
    const double whole = va + vb + vc;
    return whole > 0.0 ? a + (vb * ab + vc * ac) / whole : a;
}

MeshDistance::MeshDistance(const TriangleMesh& mesh, bool solid)
    : mesh_(mesh)
    , solid_(solid)
    , order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty()) {
        build(0, static_cast<uint32_t>(order_.size()));
    }
}

void MeshDistance::bound(Node& node) const {
    node.low = dvec3(std::numeric_limits<double>::max());
    node.high = -node.low;
    node.middle = node.areas = dvec3(0.0);
    double area = 0.0;
    for (uint32_t i = node.begin; i < node.end; ++i) {
        const uint32_t t = order_[i];
        const double a = mesh_.area(t);
        node.middle += a / 3.0 * (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2));
        node.areas += a * mesh_.normal(t);
        area += a;
        for (int k = 0; k < 3; ++k) {
            node.low = glm::min(node.low, mesh_.corner(t, k));
            node.high = glm::max(node.high, mesh_.corner(t, k));
        }
    }
    node.middle = area > 0.0 ? node.middle / area : 0.5 * (node.low + node.high);
    for (uint32_t i = node.begin; i < node.end; ++i) {
        for (int k = 0; k < 3; ++k) {
            node.reach = std::max(node.reach, glm::distance(node.middle, mesh_.corner(order_[i], k)));
        }
    }
}

uint32_t MeshDistance::build(uint32_t begin, uint32_t end) {
    const auto index = static_cast<uint32_t>(nodes_.size());
    Node node;
    node.begin = begin;
    node.end = end;
    bound(node);
    nodes_.push_back(node);
    if (end - begin > kLeafFaces) {
        const dvec3 size = node.high - node.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
        const uint32_t half = begin + (end - begin) / 2;
        const auto place = [&](uint32_t t) {
            return mesh_.corner(t, 0)[axis] + mesh_.corner(t, 1)[axis] + mesh_.corner(t, 2)[axis];
        };
        std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                         [&](uint32_t a, uint32_t b) { return place(a) < place(b); });
        build(begin, half);
        nodes_[index].right = build(half, end);
    }
    return index;
}

void MeshDistance::search(uint32_t index, const dvec3& p, Nearest& best, double& bestSquare) const {
    const Node& node = nodes_[index];
    if (node.right == 0) {
        for (uint32_t i = node.begin; i < node.end; ++i) {
            const uint32_t t = order_[i];
            const dvec3 q = nearestOnTriangle(p, mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
            const double square = glm::dot(q - p, q - p);
            if (square < bestSquare) {
                bestSquare = square;
                best.point = q;
            }
        }
        return;
    }
    uint32_t near = index + 1, far = node.right;
    double nearSquare = squareToBox(p, nodes_[near].low, nodes_[near].high);
    double farSquare = squareToBox(p, nodes_[far].low, nodes_[far].high);
    if (farSquare < nearSquare) {
        std::swap(near, far);
        std::swap(nearSquare, farSquare);
    }
    if (nearSquare < bestSquare) {
        search(near, p, best, bestSquare);
    }
    if (farSquare < bestSquare) {
        search(far, p, best, bestSquare);
    }
}

MeshDistance::Nearest MeshDistance::nearest(const dvec3& p) const {
    return nearest(p, std::numeric_limits<double>::infinity());
}

MeshDistance::Nearest MeshDistance::nearest(const dvec3& p, double most) const {
    constexpr double kRounding = 1e-9; // of the distance and of the coordinates
    Nearest best;
    double square = std::pow(most * (1.0 + kRounding) + kRounding * glm::length(p), 2.0);
    if (!nodes_.empty()) {
        search(0, p, best, square);
    }
    best.distance = std::sqrt(square);
    return best;
}

double MeshDistance::windingOf(uint32_t index, const dvec3& p) const {
    const Node& node = nodes_[index];
    const dvec3 way = node.middle - p;
    const double away = glm::length(way);
    if (away > kFar * node.reach) {
        return glm::dot(way, node.areas) / (4.0 * std::numbers::pi * away * away * away);
    }
    if (node.right != 0) {
        return windingOf(index + 1, p) + windingOf(node.right, p);
    }
    double sum = 0.0;
    for (uint32_t i = node.begin; i < node.end; ++i) {
        const uint32_t t = order_[i];
        sum += windingOfTriangle(p, mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
    }
    return sum;
}

double MeshDistance::winding(const dvec3& p) const {
    return nodes_.empty() ? 0.0 : windingOf(0, p);
}

} // namespace fathom
