// SPDX-License-Identifier: Apache-2.0
#include "engine/model/mesh_file.h"

#include "engine/model/dae_file.h"
#include "engine/model/import_triangles.h"
#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "engine/types/number_text.h"
#include "engine/types/printed.h"
#include "engine/types/read_file.h"
#include "engine/types/stand_in.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace fathom {

namespace {

constexpr double kMinExtent = 1e-3, kMaxExtent = 10.0; // [m]
constexpr double kUnlikelyExtent = 2.0; // [m] for tools and links: 80 mm stored in inches would read as 3.1
constexpr size_t kMaxTriangles = 2'000'000;

std::string metres(double v) {
    return printed("%.4g m", v);
}

bool isAllowedExtent(double extent) {
    return extent >= kMinExtent && extent <= kMaxExtent;
}

// With enough digits that it does not read as an allowed one.
std::string refusedExtent(double extent) {
    int digits = 4;
    std::string text = metres(extent);
    while (digits < 17 && isAllowedExtent(std::stod(text))) {
        text = printed("%.*g m", ++digits, extent);
    }
    return text;
}

// The file's `up` axis becomes +z by the smallest rotation.
dvec3 upright(const dvec3& p, char up) {
    if (up == 'y') {
        return {p.x, -p.z, p.y};
    }
    return up == 'x' ? dvec3(-p.z, p.y, p.x) : p;
}

TriangleMesh readTriangles(const std::filesystem::path& file, const ReaderOptions& reader, DaeFacts& facts) {
    const std::string kinds = "a readable STL, OBJ or COLLADA (.dae) mesh";
    if (!isRegularFile(file)) {
        std::error_code failed;
        const bool folder = std::filesystem::is_directory(file, failed);
        const bool missing = !std::filesystem::exists(file, failed);
        throw BadInput(file.string(), "mesh",
                       missing  ? "no such file"
                       : folder ? "a folder"
                                : whyUnreadable(file),
                       kinds);
    }
    const std::string kind = endingOf(file);
    if (kind != ".stl" && kind != ".obj" && kind != ".dae") { // the library would accept fifty other formats
        throw BadInput(file.string(), "mesh", "kind '" + kind + "'", kinds);
    }
    if (const auto bytes = std::filesystem::file_size(file); bytes > kLargestMesh) {
        throw BadInput(file.string(), "mesh", std::to_string(bytes) + " bytes",
                       "at most " + std::to_string(kLargestMesh));
    }
    refuseStandIn(file, kinds);
    noteInput(file);
    if (kind == ".dae") {
        facts = checkDae(file);
    }
    auto [mesh, fault] = importTriangles(file, reader);
    if (!fault.empty()) {
        throw BadInput(file.string(), "mesh", fault, kinds);
    }
    if (mesh.triangles.empty() || mesh.triangles.size() > kMaxTriangles) {
        throw BadInput(file.string(), "triangles", std::to_string(mesh.triangles.size()),
                       "1 to " + std::to_string(kMaxTriangles) +
                           (mesh.triangles.empty() ? "" : "; a mesh program can simplify it"));
    }
    return mesh;
}

// Returns the extent.
double checkExtent(const std::string& file, const TriangleMesh& mesh, bool ofUrdf) {
    if (mesh.triangles.empty()) {
        throw BadInput(file, "triangles", "none with an area", "at least 1");
    }
    const dvec3 size = mesh.high() - mesh.low();
    const double extent = std::max({size.x, size.y, size.z});
    if (!isAllowedExtent(extent)) {
        throw BadInput(file, "size", refusedExtent(extent),
                       extent < kMinExtent ? std::string("0.001 to 10 m; ") +
                                                 (ofUrdf ? "<mesh scale>" : "--scale") + " enlarges it"
                       : ofUrdf ? "0.001 to 10 m; <mesh scale=\"0.001 0.001 0.001\"> for millimetres, three "
                                  "times 0.0254 for inches"
                                : "0.001 to 10 m; --scale 0.001 for millimetres, 0.0254 for inches");
    }
    return extent;
}

// A .dae states its unit; STL and OBJ do not.
std::string unitWarning(const std::filesystem::path& file, const MeshOptions& options, double extent) {
    if (options.scale || options.stretch != dvec3(1.0) || extent <= kUnlikelyExtent ||
        endingOf(file) == ".dae") {
        return "";
    }
    return metres(extent) + " large if its unit is the metre, which the file does not state (inches?)";
}

// size: of the mesh as it is read [m].
std::vector<std::string> daeNotes(const DaeFacts& facts, const MeshOptions& options, const dvec3& size) {
    std::vector<std::string> notes;
    if (options.scale && *options.scale != 1.0 && facts.metre != 1.0) {
        notes.push_back("the file's unit of " + significant(facts.metre, 6) + " m and --scale " +
                        significant(*options.scale, 6) + " both apply: it is " +
                        printed("%.4g x %.4g x %.4g m", size.x, size.y, size.z) + " large");
    }
    if (!options.ofUrdf && options.up == 0 && (facts.up == "Y_UP" || facts.up == "X_UP")) {
        notes.push_back("states " + facts.up + ", which is not applied; --up " +
                        (facts.up == "Y_UP" ? "y" : "x") + " turns it");
    }
    if (facts.skin) {
        notes.emplace_back("has a <skin>: its mesh is read as it is, without the poses of its joints");
    }
    return notes;
}

} // namespace

LoadedMesh loadMesh(const std::filesystem::path& file, const MeshOptions& options) {
    const double scale = options.scale.value_or(1.0);
    if (!(scale > 0.0) || !std::isfinite(scale)) {
        throw BadInput(file.string(), "--scale", significant(scale, 6), "a positive number");
    }
    DaeFacts stated;
    LoadedMesh loaded{readTriangles(file, options.reader, stated), {}, {}, {}};
    TriangleMesh& mesh = loaded.mesh;
    for (dvec3& p : mesh.points) {
        p = upright(p * options.stretch * scale, options.up);
        if (!isFinite(p)) {
            throw BadInput(file.string(), "vertex", "not finite", "finite coordinates");
        }
    }
    // Equal points of a text file can differ in the last digit, so the tolerance is a millionth of the size.
    loaded.facts = tidy(mesh, 1e-7 * glm::distance(mesh.low(), mesh.high()));
    findStray(mesh, loaded.facts, options.dropStray && !options.keepStray);
    const MeshFacts& facts = loaded.facts;
    if (facts.strayParts > 0 && !options.dropStray && !options.keepStray) {
        throw BadInput(file.string(), "stray geometry", strayText(facts),
                       "one group of pieces; --drop-stray leaves them out");
    }
    loaded.warning = unitWarning(file, options, checkExtent(file.string(), mesh, options.ofUrdf));
    loaded.notes = daeNotes(stated, options, mesh.high() - mesh.low());
    return loaded;
}

std::string strayText(const MeshFacts& facts) {
    return std::to_string(facts.strayParts) + " pieces up to " + metres(facts.strayFarthest) +
           " away from the rest";
}

} // namespace fathom
