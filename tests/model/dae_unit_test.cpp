// SPDX-License-Identifier: Apache-2.0
// COLLADA files that the mesh library would read as another shape.
#include "engine/model/mesh_file.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <string>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A triangle of 0.2 by 0.1 units in a file whose asset contains `unit`, with elements before the scenes.
ScratchFile triangleIn(const std::string& unit, const std::string& kind = "triangles",
                       const std::string& more = "") {
    return ScratchFile(
        "unit.dae",
        "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
        "version='1.4.1'><asset><contributor/>" +
            unit +
            "<up_axis>Y_UP</up_axis></asset><library_geometries><geometry id='g'><mesh><source id='p'>"
            "<float_array id='pa' count='9'>0 0 0 0.2 0 0 0 0.1 0</float_array><technique_common>"
            "<accessor source='#pa' count='3' stride='3'><param name='X' type='float'/>"
            "<param name='Y' type='float'/><param name='Z' type='float'/></accessor></technique_common>"
            "</source><vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
            "<" +
            kind + " count='1'><input semantic='VERTEX' source='#v' offset='0'/><p>0 1 2</p></" + kind +
            "></mesh></geometry></library_geometries>" + more +
            "<library_visual_scenes>"
            "<visual_scene id='s'><node><instance_geometry url='#g'/></node></visual_scene>"
            "</library_visual_scenes><scene><instance_visual_scene url='#s'/></scene></COLLADA>");
}

double widthIn(const std::string& unit) {
    const ScratchFile file = triangleIn(unit);
    return loadMesh(file.path()).mesh.high().x;
}

} // namespace

TEST_CASE("The unit of a .dae scales it, also with a comma in its number, and its up axis does not turn it") {
    for (const auto& [text, width] : {std::pair<std::string, double>{"", 0.2},
                                      {"<unit name='metre'/>", 0.2},
                                      {"<unit meter=''/>", 0.2},
                                      {"<unit meter='0.0254' name='inch'/>", 0.00508},
                                      {"<unit meter='1e-1'/>", 0.02},
                                      {"<unit meter='+0.1'/>", 0.02},
                                      {"<unit meter='0,0254'/>", 0.00508}}) {
        const std::string& unit = text; // CAPTURE needs a variable
        CAPTURE(unit);
        CHECK(widthIn(unit) == doctest::Approx(width));
    }
}

TEST_CASE("A unit of a .dae that is no size is rejected, and not taken for a metre") {
    for (const std::string metre : {"0", "-1", " 0.01", "0.01 m", "centimetre", "inf", "nan"}) {
        const ScratchFile file = triangleIn("<unit meter='" + metre + "'/>");
        CHECK(refusalOf([&] { loadMesh(file.path()); }) ==
              file.path().string() + ": unit: meter=\"" + metre + "\" (allowed: metres per unit, above 0)");
    }
}

TEST_CASE("A .dae with fans of triangles, which would lose their middle, is rejected; strips are read") {
    const ScratchFile strip = triangleIn("", "tristrips"), fan = triangleIn("", "trifans");
    CHECK(loadMesh(strip.path()).mesh.triangles.size() == 1);
    CHECK(refusalOf([&] { loadMesh(fan.path()); }) ==
          fan.path().string() + ": mesh: <trifans> (allowed: triangles, polylist, polygons or tristrips)");
}

TEST_CASE("A .dae whose skin moves its geometry is rejected with the matrix, one that does not is read") {
    const auto skinned = [](const std::string& matrix) {
        return triangleIn("", "triangles",
                          "<library_controllers><controller id='c'><skin source='#g'><bind_shape_matrix>" +
                              matrix + "</bind_shape_matrix></skin></controller></library_controllers>");
    };
    CHECK(loadMesh(skinned("1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1.0000001").path()).mesh.triangles.size() == 1);
    for (const std::string matrix : {"0.5 0 0 0 0 0.5 0 0 0 0 0.5 0 0 0 0 1", "1 0 0 0 0 1 0 0 0 0 1 0"}) {
        const ScratchFile file = skinned(matrix);
        CHECK(refusalOf([&] {
                  loadMesh(file.path());
              }).find(": bind_shape_matrix: " + matrix + " (allowed: 1 0 0 0 0 1") != std::string::npos);
    }
}
