// SPDX-License-Identifier: Apache-2.0
#include "engine/model/mesh_file.h"

#include "engine/types/error.h"

#include <algorithm>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cmath>
#include <cstdio>

namespace fathom {

namespace {

constexpr double kLeastExtent = 1e-3, kMostExtent = 10.0; // [m]
constexpr uintmax_t kMostBytes = 512u << 20;
constexpr size_t kMostTriangles = 2'000'000;

std::string metres(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g m", v);
    return text;
}

void addNode(const aiScene& scene, const aiNode& node, const aiMatrix4x4& above, TriangleMesh& mesh) {
    const aiMatrix4x4 here = above * node.mTransformation;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        const aiMesh& part = *scene.mMeshes[node.mMeshes[m]];
        const auto first = static_cast<uint32_t>(mesh.points.size());
        for (unsigned v = 0; v < part.mNumVertices; ++v) {
            const aiVector3D p = here * part.mVertices[v];
            mesh.points.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y),
                                     static_cast<double>(p.z));
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices == 3) {
                mesh.triangles.push_back(
                    {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
            }
        }
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) {
        addNode(scene, *node.mChildren[c], here, mesh);
    }
}

// The file's `up` axis becomes +z by the smallest rotation.
dvec3 upright(const dvec3& p, char up) {
    if (up == 'y') {
        return {p.x, -p.z, p.y};
    }
    return up == 'x' ? dvec3(-p.z, p.y, p.x) : p;
}

TriangleMesh readTriangles(const std::filesystem::path& file) {
    const std::string kinds = "a readable STL, OBJ or COLLADA (.dae) mesh";
    if (!std::filesystem::is_regular_file(file)) {
        throw BadInput(file.string(), "mesh", "no such file", kinds);
    }
    if (const auto bytes = std::filesystem::file_size(file); bytes > kMostBytes) {
        throw BadInput(file.string(), "mesh", std::to_string(bytes) + " bytes",
                       "at most " + std::to_string(kMostBytes));
    }
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_SortByPType);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        std::string why = importer.GetErrorString();
        why = why.substr(0, why.find('\n'));
        throw BadInput(file.string(), "mesh", why.empty() ? "not understood" : why, kinds);
    }
    TriangleMesh mesh;
    addNode(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
    if (mesh.triangles.empty() || mesh.triangles.size() > kMostTriangles) {
        throw BadInput(file.string(), "triangles", std::to_string(mesh.triangles.size()),
                       "1 to " + std::to_string(kMostTriangles));
    }
    return mesh;
}

void checkExtent(const std::string& file, const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) {
        throw BadInput(file, "triangles", "none with an area", "at least 1");
    }
    const dvec3 size = mesh.high() - mesh.low();
    const double extent = std::max({size.x, size.y, size.z});
    if (!(extent >= kLeastExtent && extent <= kMostExtent)) {
        throw BadInput(file, "size", metres(extent),
                       "0.001 to 10 m; --scale 0.001 for millimetres, 0.0254 for inches");
    }
}

} // namespace

LoadedMesh loadMesh(const std::filesystem::path& file, const MeshOptions& options) {
    if (!(options.scale > 0.0) || !std::isfinite(options.scale)) {
        throw BadInput(file.string(), "--scale", std::to_string(options.scale), "a positive number");
    }
    LoadedMesh loaded{readTriangles(file), {}};
    TriangleMesh& mesh = loaded.mesh;
    for (dvec3& p : mesh.points) {
        p = upright(p * options.scale, options.up);
        if (!isFinite(p)) {
            throw BadInput(file.string(), "vertex", "not finite", "finite coordinates");
        }
    }
    // Equal points of a text file can differ in the last digit: a millionth of the size is the same place.
    loaded.facts = tidy(mesh, 1e-7 * glm::distance(mesh.low(), mesh.high()));
    findStray(mesh, loaded.facts, options.dropStray);
    const MeshFacts& facts = loaded.facts;
    if (facts.strayParts > 0 && !options.dropStray) {
        throw BadInput(file.string(), "stray geometry",
                       std::to_string(facts.strayParts) + " pieces up to " + metres(facts.strayFarthest) +
                           " away from the rest",
                       "one group of pieces; --drop-stray leaves them out");
    }
    checkExtent(file.string(), mesh);
    return loaded;
}

} // namespace fathom
