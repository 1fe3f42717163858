// SPDX-License-Identifier: Apache-2.0
#include "engine/model/link_spheres.h"

#include "engine/model/sphere_cover.h"
#include "engine/types/inside.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace fathom {

namespace {

// Upright about z; a rectangle for four corners.
TriangleMesh prism(uint32_t sides, const std::array<double, 2>& half, double length) {
    TriangleMesh mesh;
    for (uint32_t i = 0; i < sides; ++i) {
        const double turn = 6.283185307179586 * (i + 0.5) / sides, wide = sides == 4 ? std::sqrt(2.0) : 1.0;
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

std::filesystem::path pathOf(std::string name, const ShapeSource& source) {
    for (const std::string scheme : {"package://", "file://"}) {
        name = name.rfind(scheme, 0) == 0 ? name.substr(scheme.size()) : name;
    }
    if (!source.meshes.empty()) {
        return source.meshes / name;
    }
    std::filesystem::path folder = source.urdf.parent_path();
    for (int up = 0; up < 3 && !std::filesystem::exists(folder / name); ++up) {
        folder /= "..";
    }
    return folder / name;
}

bool liesOutside(const std::filesystem::path& file, const ShapeSource& source) {
    return !liesInside(file, source.meshes.empty() ? source.urdf.parent_path() : source.meshes);
}

LoadedMesh readMesh(const urdf::Mesh& mesh, const ShapeSource& source, ShapeSpheres& made) {
    MeshOptions options;
    options.stretch = {mesh.scale.x, mesh.scale.y, mesh.scale.z};
    options.dropStray = true; // the parts of an arm are close together; anything else is stray
    if (!isFinite(options.stretch) || options.stretch.x * options.stretch.y * options.stretch.z == 0.0) {
        throw ShapeRefused{"a mesh scale that is 0 or not finite", "three finite numbers, none 0"};
    }
    const std::filesystem::path file = pathOf(mesh.filename, source);
    LoadedMesh loaded = loadMesh(file, options);
    made.outside = liesOutside(file, source) ? file : "";
    if (loaded.facts.strayParts > 0) {
        made.notes.push_back(file.string() + ": stray geometry is dropped: " + strayText(loaded.facts));
    }
    if (!loaded.doubt.empty()) {
        made.notes.push_back(file.string() + ": " + loaded.doubt);
    }
    return loaded;
}

LoadedMesh meshOf(const urdf::Geometry& shape, const ShapeSource& source, ShapeSpheres& made) {
    LoadedMesh loaded;
    if (const auto* box = dynamic_cast<const urdf::Box*>(&shape)) {
        loaded.mesh = prism(4, {0.5 * box->dim.x, 0.5 * box->dim.y}, box->dim.z);
    } else if (const auto* tube = dynamic_cast<const urdf::Cylinder*>(&shape)) {
        // Twenty-four sides about the circle: the flats lie outside it.
        const double radius = tube->radius / std::cos(std::numbers::pi / 24.0);
        loaded.mesh = prism(24, {radius, radius}, tube->length);
    } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(&shape)) {
        return readMesh(*mesh, source, made);
    }
    loaded.facts = tidy(loaded.mesh, 0.0);
    if (loaded.mesh.triangles.empty()) {
        throw ShapeRefused{"a shape of size 0", "positive sizes"};
    }
    return loaded;
}

} // namespace

LinkShape readLinkShape(const urdf::Geometry& shape, const ShapeSource& source) {
    LinkShape out;
    if (const auto* ball = dynamic_cast<const urdf::Sphere*>(&shape)) {
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
