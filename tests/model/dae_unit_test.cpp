// SPDX-License-Identifier: Apache-2.0
// COLLADA files that the mesh library would read as another shape.
#include "engine/model/mesh_file.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <doctest/doctest.h>
#include <string>
#include <vector>

using namespace fathom;
using namespace fathom::testing;

namespace {

// A triangle of 0.2 by 0.1 units in a file whose asset contains `unit`, with elements before the scenes.
ScratchFile triangleIn(const std::string& unit, const std::string& kind = "triangles",
                       const std::string& more = "",
                       const std::string& nodes = "<node><instance_geometry url='#g'/></node>") {
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
            "<visual_scene id='s'>" +
            nodes +
            "</visual_scene>"
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

namespace {

ScratchFile nodesIn(const std::string& nodes, const std::string& more = "") {
    return triangleIn("", "triangles", more, nodes);
}

std::string nodesRefusal(const std::string& nodes, const std::string& more = "") {
    const ScratchFile file = nodesIn(nodes, more);
    const std::string refusal = refusalOf([&] { loadMesh(file.path()); });
    return refusal.starts_with(file.path().string()) ? refusal.substr(file.path().string().size()) : refusal;
}

} // namespace

TEST_CASE("A .dae with an instance of a missing element is rejected with element and url") {
    const std::string own = "<node><instance_geometry url='#g'/></node>";
    CHECK(nodesRefusal(own + "<node><instance_geometry url='#gone'/></node>") ==
          ": <instance_geometry>: url=\"#gone\" (allowed: #id of a <geometry> or <controller> of this file)");
    CHECK(nodesRefusal(own + "<node><instance_controller url='g'/></node>") ==
          ": <instance_controller>: url=\"g\" (allowed: #id of a <geometry> or <controller> of this file)");
    CHECK(nodesRefusal(own + "<node><instance_node url='part.dae#gone'/></node>") ==
          ": <instance_node>: url=\"part.dae#gone\" (allowed: #id of a <node> of this file)");
    const std::string library =
        "<library_nodes><node id='part'><instance_geometry url='#g'/></node></library_nodes>";
    const ScratchFile twice =
        nodesIn(own + "<node><translate>0 0 0.05</translate><instance_node url='#part'/></node>", library);
    CHECK(loadMesh(twice.path()).mesh.triangles.size() == 2);
    CHECK(nodesRefusal(own + "<node><instance_controller url='#c'/></node>",
                       "<library_controllers><controller id='c'><skin source='#gone'/></controller>"
                       "</library_controllers>") ==
          ": <controller id=\"c\">: source=\"#gone\" (allowed: #id of a <geometry> of this file)");
    const ScratchFile extra = nodesIn(
        "<node><instance_geometry url='#g'/><extra><technique profile='x'><instance_geometry url='#other'/>"
        "</technique></extra></node>");
    CHECK(loadMesh(extra.path()).mesh.triangles.size() == 1);
}

TEST_CASE("A .dae with a node inside of itself or a skewed node is rejected before the library reads it") {
    CHECK(nodesRefusal("<node id='n'><instance_geometry url='#g'/><node><instance_node url='#n'/></node>"
                       "</node>") ==
          ": <instance_node>: node 'n' is inside of itself (allowed: nodes without a loop)");
    CHECK(nodesRefusal("<node><instance_node url='#a'/></node>",
                       "<library_nodes><node id='a'><instance_node url='#b'/></node>"
                       "<node id='b'><instance_node url='#a'/></node></library_nodes>")
              .ends_with(" is inside of itself (allowed: nodes without a loop)"));
    CHECK(nodesRefusal("<node name='m'><instance_geometry url='#g'/><instance_node url='#m'/></node>")
              .ends_with(" is inside of itself (allowed: nodes without a loop)"));
    CHECK(nodesRefusal("<node><skew>45 1 0 0 0 1 0</skew><instance_geometry url='#g'/></node>") ==
          ": node: <skew> (allowed: matrix, translate, rotate, scale or lookat)");
    const ScratchFile upright =
        nodesIn("<node><instance_geometry url='#g'/><extra><skew>45</skew></extra></node>");
    CHECK(loadMesh(upright.path()).mesh.triangles.size() == 1);
}

TEST_CASE("Notes on a .dae name a unit beside --scale, an up axis that is not applied, and a skin") {
    using Notes = std::vector<std::string>;
    const std::string up = "states Y_UP, which is not applied; --up y turns it";
    const ScratchFile inches = triangleIn("<unit meter='0.0254'/>"), metres = triangleIn("");
    CHECK(loadMesh(inches.path()).notes == Notes{up});
    MeshOptions options;
    options.up = 'y';
    CHECK(loadMesh(metres.path(), options).notes.empty());
    options.scale = 10.0;
    CHECK(loadMesh(metres.path(), options).notes.empty());
    CHECK(loadMesh(inches.path(), options).notes ==
          Notes{"the file's unit of 0.0254 m and --scale 10 both apply: it is 0.0508 x 0 x 0.0254 m large"});
    MeshOptions ofUrdf;
    ofUrdf.ofUrdf = true;
    ofUrdf.stretch = dvec3(10.0);
    CHECK(loadMesh(inches.path(), ofUrdf).notes.empty());
    const ScratchFile skin = nodesIn("<node><instance_geometry url='#g'/></node>",
                                     "<library_controllers><controller id='c'><skin "
                                     "source='#g'><bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"
                                     "</bind_shape_matrix></skin></controller></library_controllers>");
    CHECK(loadMesh(skin.path(), ofUrdf).notes ==
          Notes{"has a <skin>: its mesh is read as it is, without the poses of its joints"});
}
