// SPDX-License-Identifier: Apache-2.0
#include "engine/model/import_triangles.h"

#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <type_traits>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr rlim_t kMostSeconds = 60;     // of CPU time
constexpr unsigned kMostPatience = 300; // [s] for a reader that waits for what never comes
constexpr size_t kMostPoints = 6'000'000;

// With all its copies: a few bytes can name one mesh a million times. Ends where there are too many.
size_t countPoints(const aiScene& scene, const aiNode& node) {
    size_t count = 0;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        count += scene.mMeshes[node.mMeshes[m]]->mNumVertices;
    }
    for (unsigned c = 0; c < node.mNumChildren && count <= kMostPoints; ++c) {
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

std::string readWithAssimp(const std::filesystem::path& file, TriangleMesh& mesh) {
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_SortByPType);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        const std::string why = importer.GetErrorString();
        return why.empty() ? "not understood" : why.substr(0, why.find('\n'));
    }
    if (countPoints(*scene, *scene->mRootNode) > kMostPoints) {
        return "over " + std::to_string(kMostPoints) + " corners";
    }
    addNode(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
    return "";
}

// What goes through the pipe first; then the text, the points, the triangles.
struct Head {
    uint64_t text = 0, points = 0, triangles = 0;
};

// All of it through ::read or ::write, in as many calls as that takes.
template <class Byte>
bool moveAll(ssize_t (*move)(int, Byte*, size_t), int pipe, Byte* data, size_t size) {
    auto* at = static_cast<std::conditional_t<std::is_const_v<Byte>, const char, char>*>(data);
    while (size > 0) {
        const ssize_t done = move(pipe, at, size);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            return false;
        }
        at += done;
        size -= static_cast<size_t>(done);
    }
    return true;
}

bool writeAll(int pipe, const void* data, size_t size) {
    return moveAll<const void>(::write, pipe, data, size);
}

bool readAll(int pipe, void* data, size_t size) {
    return moveAll<void>(::read, pipe, data, size);
}

// Of this process, address space of the parent included [bytes]; 0 where the system does not tell, or where a
// sanitizer has mapped terabytes and maps more whenever it likes.
rlim_t mappedNow() {
#ifdef FATHOM_SANITIZED
    return 0;
#endif
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

[[noreturn]] void child(const std::filesystem::path& file, int pipe, uint64_t mostMemory) {
    for (const int fault : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGINT, SIGTERM, SIGALRM}) {
        std::signal(fault, SIG_DFL); // it dies alone, and says nothing
    }
    ::alarm(kMostPatience);
    const rlimit none{0, 0}, time{kMostSeconds, kMostSeconds};
    ::setrlimit(RLIMIT_CORE, &none);
    ::setrlimit(RLIMIT_CPU, &time);
    if (const rlim_t mapped = mappedNow(); mapped > 0) {
        const rlimit memory{mapped + mostMemory, mapped + mostMemory};
        ::setrlimit(RLIMIT_AS, &memory);
    }
    TriangleMesh mesh;
    std::string text;
    try {
        text = readWithAssimp(file, mesh);
    } catch (const std::bad_alloc&) {
        mesh = {};
        text = "takes over " + std::to_string(mostMemory >> 20) + " MiB to read";
    } catch (const std::exception&) {
        mesh = {};
        text = "not understood";
    }
    const Head head{text.size(), mesh.points.size(), mesh.triangles.size()};
    const bool said = writeAll(pipe, &head, sizeof head) && writeAll(pipe, text.data(), text.size()) &&
                      writeAll(pipe, mesh.points.data(), mesh.points.size() * sizeof mesh.points[0]) &&
                      writeAll(pipe, mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
    ::_exit(said ? 0 : 1);
}

bool take(int pipe, ImportedTriangles& out) {
    Head head;
    if (!readAll(pipe, &head, sizeof head) || head.text > 4096 || head.points > kMostPoints ||
        head.triangles > kMostPoints) {
        return false;
    }
    out.fault.resize(head.text);
    out.mesh.points.resize(head.points);
    out.mesh.triangles.resize(head.triangles);
    const auto sound = [&](const std::array<uint32_t, 3>& corners) {
        return std::max({corners[0], corners[1], corners[2]}) < head.points;
    };
    return readAll(pipe, out.fault.data(), out.fault.size()) &&
           readAll(pipe, out.mesh.points.data(), head.points * sizeof(dvec3)) &&
           readAll(pipe, out.mesh.triangles.data(), head.triangles * sizeof out.mesh.triangles[0]) &&
           std::all_of(out.mesh.triangles.begin(), out.mesh.triangles.end(), sound);
}

} // namespace

ImportedTriangles importTriangles(const std::filesystem::path& file, uint64_t mostMemory) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) {
        throw Error(file.string() + ": no pipe: " + std::strerror(errno));
    }
    const pid_t reader = ::fork();
    if (reader == 0) {
        ::close(pipe[0]);
        child(file, pipe[1], mostMemory);
    }
    ::close(pipe[1]);
    ImportedTriangles out;
    const bool whole = reader > 0 && take(pipe[0], out);
    ::close(pipe[0]);
    int status = 0;
    while (reader > 0 && ::waitpid(reader, &status, 0) < 0 && errno == EINTR) {
    }
    if (reader < 0) {
        throw Error(file.string() + ": no process to read it in");
    }
    if (!whole) {
        out.mesh = {};
        out.fault = WIFSIGNALED(status)
                        ? "breaks the mesh reader (signal " + std::to_string(WTERMSIG(status)) + ")"
                        : "breaks the mesh reader";
    }
    return out;
}

} // namespace fathom
