// SPDX-License-Identifier: Apache-2.0
// Meshes with known faces, and a file to hold one.
#pragma once

#include "engine/model/triangle_mesh.h"
#include "tests/support/scratch_folder.h"

#include <cmath>
#include <filesystem>
#include <fstream>

namespace fathom::testing {

inline void addBox(TriangleMesh& mesh, const dvec3& middle, const dvec3& size) {
    const auto first = static_cast<uint32_t>(mesh.points.size());
    for (int k = 0; k < 8; ++k) {
        const dvec3 way(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
        mesh.points.push_back(middle + way * size);
    }
    constexpr uint32_t kSides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& q : kSides) {
        mesh.triangles.push_back({first + q[0], first + q[1], first + q[2]});
        mesh.triangles.push_back({first + q[0], first + q[2], first + q[3]});
    }
}

inline TriangleMesh boxMesh(const dvec3& middle, const dvec3& size) {
    TriangleMesh mesh;
    addBox(mesh, middle, size);
    return mesh;
}

// A ring about z: `around` x `across` quads.
inline TriangleMesh ringMesh(double large, double small, uint32_t around, uint32_t across) {
    TriangleMesh mesh;
    for (uint32_t i = 0; i < around; ++i) {
        for (uint32_t k = 0; k < across; ++k) {
            const double a = 6.283185307179586 * i / around, b = 6.283185307179586 * k / across;
            const double out = large + small * std::cos(b);
            mesh.points.emplace_back(out * std::cos(a), out * std::sin(a), small * std::sin(b));
            const auto at = [&](uint32_t u, uint32_t v) { return (u % around) * across + v % across; };
            mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    }
    return mesh;
}

// The mesh as an OBJ file, removed by the destructor.
class ObjFile {
public:
    explicit ObjFile(const TriangleMesh& mesh, double unit = 1.0) {
        std::ofstream out(path());
        out.precision(9);
        for (const dvec3& p : mesh.points) {
            out << "v " << p.x / unit << " " << p.y / unit << " " << p.z / unit << "\n";
        }
        for (const auto& t : mesh.triangles) {
            out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
        }
    }
    const std::filesystem::path& path() const { return file_.path(); }

private:
    ScratchFile file_{"mesh.obj"};
};

} // namespace fathom::testing
