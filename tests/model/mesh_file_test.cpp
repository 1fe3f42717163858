// SPDX-License-Identifier: Apache-2.0
#include "engine/model/mesh_file.h"

#include "engine/model/import_triangles.h"
#include "engine/model/mesh_distance.h"
#include "engine/types/error.h"
#include "tests/model/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/sanitized.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::filesystem::path kMeshes = "../shared/data/meshes";

std::string refusalOfMesh(const std::filesystem::path& file, const MeshOptions& options = {}) {
    return refusalOf([&] { loadMesh(file, options); });
}

// `nodes` nodes that all reference one mesh of 99 999 corners.
void writeCopies(const std::filesystem::path& file, int nodes, const std::string& asset = "") {
    std::ofstream out(file);
    out << "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
           "version='1.4.1'>"
        << asset
        << "<library_geometries><geometry id='g'><mesh><source id='p'>"
           "<float_array id='pa' count='9'>0 0 0 0.1 0 0 0 0.1 0</float_array><technique_common>"
           "<accessor source='#pa' count='3' stride='3'><param name='X' type='float'/>"
           "<param name='Y' type='float'/><param name='Z' type='float'/></accessor></technique_common>"
           "</source><vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
           "<triangles count='33333'><input semantic='VERTEX' source='#v' offset='0'/><p>";
    for (int i = 0; i < 33333; ++i) {
        out << "0 1 2 ";
    }
    out << "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
           "<visual_scene id='s'>";
    for (int i = 0; i < nodes; ++i) {
        out << "<node><instance_geometry url='#g'/></node>";
    }
    out << "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
           "</COLLADA>";
}

bool present(const std::filesystem::path& file) {
    if (std::filesystem::exists(file)) {
        return true;
    }
    MESSAGE("SKIPPED: no such file: " << file);
    return false;
}

} // namespace

TEST_CASE("A mesh that is a pointer of Git LFS is refused as such") {
    const ScratchFolder scratch;
    for (const char* name : {"a.stl", "a.obj", "a.dae"}) {
        scratch.write(name, "version https://git-lfs.github.com/spec/v1\noid sha256:4d\nsize 9\n");
        CHECK(refusalOfMesh(scratch / name).find(": content: a Git LFS pointer") != std::string::npos);
    }
}

TEST_CASE("A closed mesh is read completely: size, volume, closed, nothing dropped") {
    const ObjFile file(boxMesh({0.1, -0.2, 0.3}, {0.2, 0.1, 0.05}));
    const LoadedMesh loaded = loadMesh(file.path());
    CHECK(loaded.mesh.triangles.size() == 12);
    CHECK(loaded.facts.closed());
    CHECK(loaded.facts.parts == 1);
    CHECK(loaded.facts.doubled == 0);
    CHECK(loaded.mesh.volume() == doctest::Approx(0.001).epsilon(1e-6));
    CHECK(loaded.mesh.area() == doctest::Approx(0.07).epsilon(1e-6));
    CHECK(glm::distance(loaded.mesh.low(), dvec3(0.0, -0.25, 0.275)) < 1e-6);
}

TEST_CASE("Duplicate faces are dropped and an inside-out mesh is reversed") {
    TriangleMesh mesh = boxMesh(dvec3(0.0), dvec3(0.1));
    for (size_t t = 0; t < 12; ++t) { // again with reversed winding, as CAD programs export
        mesh.triangles.push_back({mesh.triangles[t][0], mesh.triangles[t][2], mesh.triangles[t][1]});
    }
    std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
    const LoadedMesh loaded = loadMesh(ObjFile(mesh).path());
    CHECK(loaded.facts.doubled == 12);
    CHECK(loaded.facts.turned == 1);
    CHECK(loaded.facts.closed());
    CHECK(loaded.mesh.volume() == doctest::Approx(0.001).epsilon(1e-6));
    for (auto& t : mesh.triangles) {
        std::swap(t[0], t[1]);
    }
    CHECK(loadMesh(ObjFile(mesh).path()).mesh.volume() > 0.0);
}

TEST_CASE("An open mesh is read and its open edges are counted") {
    TriangleMesh mesh = boxMesh(dvec3(0.0), dvec3(0.1));
    mesh.triangles.pop_back();
    const LoadedMesh loaded = loadMesh(ObjFile(mesh).path());
    CHECK_FALSE(loaded.facts.closed());
    CHECK(loaded.facts.openEdges == 3);
}

TEST_CASE("Stray geometry is rejected with its distance, or dropped on request") {
    TriangleMesh mesh = boxMesh(dvec3(0.0), dvec3(0.1));
    addBox(mesh, {0.15, 0.0, 0.0}, dvec3(0.05)); // next to it: part of the object
    addBox(mesh, {20.0, 0.0, 0.0}, dvec3(0.02));
    const ObjFile file(mesh);
    CHECK(refusalOfMesh(file.path()).find("stray geometry: 1 pieces up to 19.8") != std::string::npos);
    MeshOptions options;
    options.dropStray = true;
    const LoadedMesh loaded = loadMesh(file.path(), options);
    CHECK(loaded.facts.strayParts == 1);
    CHECK(loaded.mesh.triangles.size() == 24);
    CHECK(loaded.mesh.high().x == doctest::Approx(0.175));
}

TEST_CASE("Several like parts in one mesh are kept, and a small one as far away is stray") {
    TriangleMesh jaws = boxMesh(dvec3(0.0), dvec3(0.02));
    addBox(jaws, {0.15, 0.0, 0.0}, dvec3(0.02));
    addBox(jaws, {0.45, 0.0, 0.0}, dvec3(0.01));
    CHECK(loadMesh(ObjFile(jaws).path()).facts.strayParts == 0);
    addBox(jaws, {-0.1, 0.0, 0.0}, dvec3(0.002));
    const ObjFile file(jaws);
    CHECK(refusalOfMesh(file.path()).find("stray geometry: 1 pieces") != std::string::npos);
    MeshOptions keep;
    keep.keepStray = true;
    CHECK(loadMesh(file.path(), keep).mesh.triangles.size() == 48);
}

TEST_CASE("An unstated unit is rejected by the size and set by --scale; --up rotates an axis to +z") {
    const ObjFile millimetres(boxMesh(dvec3(0.0), {0.3, 0.2, 0.1}), 0.001);
    CHECK(refusalOfMesh(ObjFile(boxMesh({}, dvec3(10.00001))).path()).find("10.00001") != std::string::npos);
    CHECK(refusalOfMesh(millimetres.path()).find("size: 300 m (allowed: 0.001 to 10 m") != std::string::npos);
    MeshOptions options;
    options.scale = 0.001;
    CHECK(loadMesh(millimetres.path(), options).mesh.high().x == doctest::Approx(0.15));
    options.up = 'x';
    CHECK(loadMesh(millimetres.path(), options).mesh.high().z == doctest::Approx(0.15));
    options.up = 'y';
    CHECK(loadMesh(millimetres.path(), options).mesh.high().z == doctest::Approx(0.1));
    options.scale = -1.0;
    CHECK(refusalOfMesh(millimetres.path(), options).find("--scale") != std::string::npos);
    CHECK(refusalOfMesh("no/such/mesh.stl").find("no such file") != std::string::npos);
    CHECK(refusalOfMesh("tests/model/meshes.h").find("mesh: ") != std::string::npos);
}

TEST_CASE("The hint for a tiny mesh is to enlarge it, and for one without triangles not to simplify it") {
    const ObjFile tiny(boxMesh(dvec3(0.0), dvec3(1e-4)));
    CHECK(refusalOfMesh(tiny.path()).find("(allowed: 0.001 to 10 m; --scale enlarges it)") !=
          std::string::npos);
    MeshOptions urdf;
    urdf.ofUrdf = true;
    CHECK(refusalOfMesh(tiny.path(), urdf).find("0.001 to 10 m; <mesh scale> enlarges it)") !=
          std::string::npos);
    const ObjFile none(TriangleMesh{{dvec3(0.0), dvec3(0.1)}, {}});
    CHECK(refusalOfMesh(none.path()).find("simplify") == std::string::npos);
}

TEST_CASE("A folder or a pipe is rejected as such, and not as a missing file") {
    CHECK(refusalOfMesh("tests/model").find("mesh: a folder") != std::string::npos);
    CHECK(refusalOfMesh("/dev/null").find("mesh: a pipe or device") != std::string::npos);
}

TEST_CASE("Each axis of a mesh is stretched by its own factor, and a mirrored mesh keeps outward normals") {
    const ObjFile file(boxMesh({0.1, 0.1, 0.1}, dvec3(0.1)));
    MeshOptions options;
    options.scale = 2.0;
    options.stretch = {1.0, 2.0, -3.0};
    const TriangleMesh mesh = loadMesh(file.path(), options).mesh;
    CHECK(glm::distance(mesh.low(), dvec3(0.1, 0.2, -0.9)) < 1e-6);
    CHECK(glm::distance(mesh.high(), dvec3(0.3, 0.6, -0.3)) < 1e-6);
    CHECK(mesh.volume() == doctest::Approx(0.2 * 0.4 * 0.6).epsilon(1e-6));
}

TEST_CASE("A mesh of over two metres without a unit gives a warning, unless --scale is given") {
    const ObjFile large(boxMesh(dvec3(0.0), {3.2, 1.0, 1.0})), small(boxMesh(dvec3(0.0), dvec3(1.9)));
    CHECK(loadMesh(large.path()).warning.find("3.2 m large") == 0);
    CHECK(loadMesh(small.path()).warning == "");
    MeshOptions metres;
    metres.scale = 1.0;
    CHECK(loadMesh(large.path(), metres).warning == "");
    metres = {};
    metres.stretch = dvec3(0.9);
    CHECK(loadMesh(large.path(), metres).warning == "");
}

TEST_CASE("Unsupported kinds of file are rejected, whatever they contain") {
    const ObjFile box(boxMesh(dvec3(0.0), dvec3(0.1)));
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "kind.ply";
    std::ofstream(file) << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                           "end_header\n0 0 0\n0.1 0 0\n0 0.1 0\n3 0 1 2\n";
    CHECK(importTriangles(file).fault == ""); // the library can
    CHECK(refusalOfMesh(file).find("kind '.ply' (allowed: a readable STL, OBJ or COLLADA") !=
          std::string::npos);
    const std::filesystem::path upper = scratch.path() / "kind.OBJ";
    std::filesystem::copy_file(box.path(), upper, std::filesystem::copy_options::overwrite_existing);
    CHECK(refusalOfMesh(upper) == "");
}

TEST_CASE("A mesh that needs too much memory is rejected, and copies are counted before they are made") {
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "copies.dae";
    writeCopies(file, 10);
    CHECK(importTriangles(file).mesh.triangles.size() == 333'330);
    if (!kSanitized) {         // a sanitizer has no memory limit
        writeCopies(file, 55); // 130 MB of corners
        const ImportedTriangles large = importTriangles(file, {.mostMemory = 16 << 20});
        CHECK(large.mesh.triangles.empty());
        CHECK(large.fault == "takes over 16 MiB to read");
    }
    writeCopies(file, 1000);
    const ImportedTriangles many =
        importTriangles(file, {.mostMemory = 200 << 20}); // the copies would take 2400 MB
    CHECK(many.fault == "over 6000000 corners");
    CHECK(many.mesh.points.empty());
}

TEST_CASE("A .dae whose unit is 0 is rejected with the unit") {
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "unit.dae";
    writeCopies(file, 1, "<asset><unit meter='0' name='metre'/></asset>");
    CHECK(refusalOfMesh(file) == file.string() + ": unit: meter=\"0\" (allowed: metres per unit, above 0)");
    for (const char* good : {"<asset><unit meter='1'/></asset>", "<asset><unit name='metre'/></asset>", ""}) {
        writeCopies(file, 1, good);
        CHECK(refusalOfMesh(file) == "");
    }
}

TEST_CASE("Distance and winding agree with a box's formula inside, outside and where two boxes overlap") {
    const TriangleMesh mesh = boxMesh(dvec3(0.0), {2.0, 4.0, 6.0});
    const MeshDistance distance(mesh, true);
    for (const dvec3& p : {dvec3(0.0), dvec3(0.9, 0.5, -2.0), dvec3(1.5, 0.0, 0.0), dvec3(3.0, 5.0, 7.0)}) {
        const dvec3 q = glm::abs(p) - dvec3(1.0, 2.0, 3.0);
        const double truth = glm::length(glm::max(q, dvec3(0.0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
        CHECK(distance.signedDistance(p) == doctest::Approx(truth).epsilon(1e-12));
    }
    TriangleMesh two = boxMesh(dvec3(0.0), dvec3(2.0));
    addBox(two, dvec3(1.0), dvec3(2.0));
    const MeshDistance both(two, true);
    CHECK(both.winding(dvec3(0.5)) == doctest::Approx(2.0).epsilon(0.02));
    CHECK(both.isInside(dvec3(0.5)));
    CHECK(both.isInside(dvec3(1.5)));
    CHECK_FALSE(both.isInside(dvec3(1.5, -0.5, 0.0)));
    CHECK_FALSE(MeshDistance(two, false).isInside(dvec3(0.5)));
}

TEST_CASE("The dipole approximation of the winding number is correct for a ring of many faces") {
    const TriangleMesh ring = ringMesh(0.1, 0.03, 96, 48);
    const MeshDistance distance(ring, true);
    for (int i = 0; i < 500; ++i) {
        const double a = 0.61 * i, b = 1.7 * i, s = 0.06 * (i % 50) / 50.0;
        const dvec3 p((0.1 + s * std::cos(b)) * std::cos(a), (0.1 + s * std::cos(b)) * std::sin(a),
                      s * std::sin(b));
        if (std::abs(s - 0.03) > 0.0005) {
            CHECK(distance.isInside(p) == (s < 0.03));
        }
    }
}

TEST_CASE("Difficult real files are read in metres: inches, duplicate faces, an open finger tip") {
    if (const auto file = kMeshes / "gazebo_models_CC-BY-3.0/hand_wheel_valve.dae"; present(file)) {
        const LoadedMesh loaded = loadMesh(file);
        const dvec3 size = loaded.mesh.high() - loaded.mesh.low();
        CHECK(std::max({size.x, size.y, size.z}) < 1.0); // the numbers in the file are inches
        CHECK(std::max({size.x, size.y, size.z}) > 0.08);
        CHECK(loaded.facts.doubled > 1000);
    }
    if (const auto file = kMeshes / "uuv_manipulators_Apache-2.0/FingerTip.dae"; present(file)) {
        CHECK(loadMesh(file).facts.openEdges > 0);
    }
    if (const auto file = kMeshes / "uuv_manipulators_Apache-2.0/Jaw.stl"; present(file)) {
        const LoadedMesh loaded = loadMesh(file);
        CHECK(loaded.facts.closed());
        CHECK((loaded.mesh.high() - loaded.mesh.low()).x == doctest::Approx(0.191).epsilon(0.01));
    }
}

TEST_CASE("A file that crashes the mesh reader is rejected in one line, and so is a truncated one") {
    std::ifstream in("tests/fuzz/corpus/mesh/finding-collada", std::ios::binary);
    const std::string input{std::istreambuf_iterator<char>(in), {}};
    REQUIRE(input.size() > 100);
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "finding.dae";
    for (size_t size = 1; size <= input.size(); size += 97) {
        std::ofstream(file, std::ios::binary)
            << input.substr(1, size); // the first byte belongs to the fuzz target
        CHECK_THROWS_AS(loadMesh(file), BadInput);
    }
    std::ofstream(file, std::ios::binary) << input.substr(1);
    const std::string line = refusalOfMesh(file); // Assimp 5.4 itself rejects the file that crashes 5.2
    CHECK_MESSAGE((line.find("breaks the mesh reader") != std::string::npos ||
                   line.find("Not enough data for accessor") != std::string::npos),
                  line);
}
