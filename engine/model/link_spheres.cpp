// SPDX-License-Identifier: Apache-2.0
#include "engine/model/link_spheres.h"

#include "engine/model/find_mesh.h"
#include "engine/model/sphere_cover.h"
#include "engine/model/urdf_file.h"
#include "engine/types/angle.h"
#include "engine/types/inside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace fathom {

namespace {

constexpr double kMaxAlongCapsule = 256.0; // spheres
constexpr double kThinnest = 1e-6;         // [m]

// Upright about z; a rectangle for four corners.
TriangleMesh prism(uint32_t sides, const std::array<double, 2>& half, double length) {
    TriangleMesh mesh;
    for (uint32_t i = 0; i < sides; ++i) {
        const double turn = kTurn * (i + 0.5) / sides, wide = sides == 4 ? std::sqrt(2.0) : 1.0;
        for (double z : {-0.5 * length, 0.5 * length}) {
            mesh.points.emplace_back(half[0] * wide * std::cos(turn), half[1] * wide * std::sin(turn), z);
        }
        const uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
        if (i > 0 && i + 1 < sides) {
            mesh.triangles.insert(mesh.triangles.end(), {{0, b, a}, {1, a + 1, b + 1}});
        }
    }
    return mesh;
}

LoadedMesh readMesh(const urdf::Mesh& mesh, const ShapeSource& source, ShapeSpheres& made) {
    MeshOptions options;
    options.stretch = {mesh.scale.x, mesh.scale.y, mesh.scale.z};
    options.dropStray = !source.keepStray; // the parts of an arm are close together; anything else is stray
    options.keepStray = source.keepStray;
    options.ofUrdf = true;
    options.reader = source.reader;
    if (!isFinite(options.stretch) || options.stretch.x * options.stretch.y * options.stretch.z == 0.0) {
        throw ShapeRefused{"a mesh scale that is 0 or not finite", "three finite numbers, none 0"};
    }
    const std::filesystem::path file = findMesh(mesh.filename, source).file;
    LoadedMesh loaded = loadMesh(file, options);
    made.outside = outsideOf(file, source);
    made.open = !loaded.facts.closed();
    if (loaded.facts.strayParts > 0) {
        made.notes.push_back(file.string() + ": stray geometry is dropped: " + strayText(loaded.facts) +
                             "; arm.keep_stray keeps it");
    }
    if (!loaded.warning.empty()) {
        made.notes.push_back(file.string() + ": " + loaded.warning);
    }
    for (const std::string& note : loaded.notes) {
        made.notes.push_back(file.string() + ": " + note);
    }
    return loaded;
}

// A size of 0 belongs to a plate, disc or rod, which an arm must keep out of regions like any other part.
double thick(double size) {
    return std::max(size, kThinnest);
}

// Spheres along the axis of a capsule, so close that they contain it with 5 % of its radius.
std::vector<Sphere> capsuleSpheres(const CapsuleSize& capsule) {
    const double own = thick(capsule.radius), radius = 1.05 * own, half = 0.5 * capsule.length;
    const double reach = std::sqrt(radius * radius - own * own);
    const auto count = static_cast<size_t>(std::min(kMaxAlongCapsule, std::ceil(half / reach))) + 1;
    const double step = capsule.length / static_cast<double>(count);
    const double grown = std::hypot(own, 0.5 * step); // of spheres in the middle of each step
    std::vector<Sphere> spheres;
    for (size_t i = 0; i < count; ++i) {
        spheres.push_back({{0.0, 0.0, -half + (static_cast<double>(i) + 0.5) * step}, grown});
    }
    spheres.push_back({{0.0, 0.0, -half}, own});
    spheres.push_back({{0.0, 0.0, half}, own});
    return spheres;
}

LoadedMesh meshOf(const urdf::Geometry& shape, const ShapeSource& source, ShapeSpheres& made) {
    LoadedMesh loaded;
    if (const auto* box = dynamic_cast<const urdf::Box*>(&shape)) {
        loaded.mesh = prism(4, {0.5 * thick(box->dim.x), 0.5 * thick(box->dim.y)}, thick(box->dim.z));
    } else if (const auto* tube = dynamic_cast<const urdf::Cylinder*>(&shape)) {
        // Twenty-four sides about the circle: the flats lie outside it.
        const double radius = thick(tube->radius) / std::cos(std::numbers::pi / 24.0);
        loaded.mesh = prism(24, {radius, radius}, thick(tube->length));
    } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&shape)) {
        return readMesh(*mesh, source, made);
    }
    loaded.facts = tidy(loaded.mesh, 0.0);
    return loaded;
}

// The sizes [m] of a shape that may not all be 0; a capsule without length is a sphere.
std::vector<double> sizesOf(const urdf::Geometry& shape) {
    if (const auto* box = dynamic_cast<const urdf::Box*>(&shape)) {
        return {box->dim.x, box->dim.y, box->dim.z};
    }
    if (const auto* tube = dynamic_cast<const urdf::Cylinder*>(&shape)) {
        return {tube->radius, tube->length};
    }
    if (const auto capsule = capsuleOf(shape)) {
        return capsule->length == 0.0 ? std::vector{capsule->radius}
                                      : std::vector{capsule->radius, capsule->length};
    }
    const auto* ball = dynamic_cast<const urdf::Sphere*>(&shape);
    return {ball != nullptr ? ball->radius : 1.0};
}

} // namespace

MeshPlace meshFileOf(const urdf::Geometry& shape, const ShapeSource& source) {
    const auto* mesh = dynamic_cast<const urdf::Mesh*>(&shape);
    return mesh == nullptr || capsuleOf(shape) ? MeshPlace{} : findMesh(mesh->filename, source);
}

std::filesystem::path outsideOf(const std::filesystem::path& file, const ShapeSource& source) {
    return liesInside(file, source.meshes.empty() ? source.urdf.parent_path() : source.meshes) ? "" : file;
}

LinkShape readLinkShape(const urdf::Geometry& shape, const ShapeSource& source) {
    LinkShape out;
    const std::vector<double> sizes = sizesOf(shape);
    if (!std::all_of(sizes.begin(), sizes.end(), [](double size) { return size >= 0.0; })) {
        throw ShapeRefused{"a shape with a negative size", "sizes above 0"};
    }
    const auto none = std::count(sizes.begin(), sizes.end(), 0.0);
    if (none == std::ssize(sizes)) {
        out.made.notes.push_back("a shape of size 0 is skipped");
        return out;
    }
    if (none > 0) {
        out.made.notes.push_back("a shape with a size of 0 is covered as a surface or line");
    }
    if (const auto capsule = capsuleOf(shape)) {
        out.made.spheres = capsuleSpheres(*capsule);
    } else if (const auto* ball = dynamic_cast<const urdf::Sphere*>(&shape)) {
        out.made.spheres.push_back({dvec3(0.0), ball->radius});
    } else {
        out.surface = meshOf(shape, source, out.made);
    }
    return out;
}

ShapeSpheres linkSpheres(LinkShape shape, uint32_t leaves) {
    ShapeSpheres made = std::move(shape.made);
    if (shape.surface) {
        CoverOptions cover;
        cover.leaves = leaves;
        cover.effort = 0;
        const TriangleMesh& mesh = shape.surface->mesh;
        made.spheres = coverMesh(mesh, MeshDistance(mesh, shape.surface->facts.closed()), cover).spheres;
    }
    for (const Sphere& s : made.spheres) {
        if (!isFinite(s.centre) || !(s.radius > 0.0)) {
            throw ShapeRefused{"a sphere of radius 0", "radii above 0"};
        }
    }
    return made;
}

} // namespace fathom
