// SPDX-License-Identifier: Apache-2.0
// Meshes by Assimp.
#include "engine/model/import_triangles.h"
#include "engine/reader/answers.h"
#include "engine/reader/obj_text.h"
#include "engine/reader/stl_text.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <new>

namespace fathom {

namespace {

constexpr size_t kLongestReason = 200; // Assimp may quote the rest of the file

// Counts all instances, because a few bytes can reference one mesh a million times. Stops at the limit.
size_t countPoints(const aiScene& scene, const aiNode& node) {
    size_t count = 0;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        count += scene.mMeshes[node.mMeshes[m]]->mNumVertices;
    }
    for (unsigned c = 0; c < node.mNumChildren && count <= kMaxImportedPoints; ++c) {
        count += countPoints(scene, *node.mChildren[c]);
    }
    return count;
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

// instead: what to parse in place of the file, of the same kind, unless empty.
std::string readWithAssimp(const std::filesystem::path& file, const std::string& instead,
                           TriangleMesh& mesh) {
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = [&] {
        const ParserScope parser;
        constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_SortByPType;
        return instead.empty() ? importer.ReadFile(file.string(), kSteps)
                               : importer.ReadFileFromMemory(instead.data(), instead.size(), kSteps,
                                                             endingOf(file).c_str() + 1);
    }();
    if (scene == nullptr || scene->mRootNode == nullptr) {
        const std::string why = importer.GetErrorString();
        return why.empty() ? "not understood" : excerpt(why.substr(0, why.find('\n')), kLongestReason);
    }
    if (countPoints(*scene, *scene->mRootNode) > kMaxImportedPoints) {
        return "over " + std::to_string(kMaxImportedPoints) + " corners";
    }
    addNode(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
    return "";
}

} // namespace

bool answerMesh(const std::filesystem::path& file, int pipe, uint64_t mostMemory) {
    TriangleMesh mesh;
    std::string text;
    try {
        std::string instead;
        text = endingOf(file) == ".obj" ? plainObj(file, instead) : stlFault(file, instead);
        text = text.empty() ? readWithAssimp(file, instead, mesh) : text;
    } catch (const std::bad_alloc&) {
        mesh = {};
        text = "takes over " + std::to_string(mostMemory >> 20) + " MiB to read";
    } catch (const std::exception&) {
        mesh = {};
        text = "not understood";
    }
    const TrianglesHeader head{mesh.points.size(), mesh.triangles.size()};
    return writeText(pipe, text) && writeAll(pipe, &head, sizeof head) &&
           writeAll(pipe, mesh.points.data(), mesh.points.size() * sizeof mesh.points[0]) &&
           writeAll(pipe, mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
}

} // namespace fathom
