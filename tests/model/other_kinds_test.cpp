// SPDX-License-Identifier: Apache-2.0
// Files of other kinds in place of a robot's: what they are and what to give instead.
#include "tests/model/urdf_text.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

std::string refusalOfFile(const std::string& text) {
    const ScratchFile file("arm.urdf", text);
    return refusalOf([&] { loadArm(file.path(), {}); });
}

} // namespace

TEST_CASE("A file that is no robot is named as what it is, with what to give instead") {
    const std::string spheres =
                          "spheres of a robot (XRDF or cuRobo), without links and joints (allowed: the URDF "
                          "that it belongs to)",
                      instead = " (allowed: a URDF or MJCF of the robot)";
    for (const auto& given : {
             std::pair<std::string, std::string>("format: xrdf\nformat_version: 1.0\n", spheres),
             {"robot_cfg:\n  kinematics: {}\n", spheres},
             {"# spheres\ncollision_spheres: {}\n", spheres},
             {"#usda 1.0\n(\n)\n", "a USD scene" + instead},
             {std::string("PXR-USDC\0\0", 10), "a USD scene" + instead},
             {"#VRML_SIM R2023b utf8\nPROTO X [] { }\n", "a robot of Webots" + instead},
             {"solid x\nfacet normal 0 0 1\n", "an STL mesh (allowed: a URDF or MJCF that names the mesh)"},
             {"{\"robot\": {}}", "JSON" + instead},
             {std::string("\xff\xfe<\0r\0", 6), "in UTF-16 (allowed: the same file saved as UTF-8)"},
             {"link a, link b", "no XML" + instead},
             {"<mujocoinclude><body/></mujocoinclude>",
              "a part of an MJCF (allowed: the MJCF that includes it)"},
             {"<?xml version='1.0'?><Robot name='x'/>", "a robot of OpenRAVE" + instead},
             {"<COLLADA version='1.5.0'/>",
              "a COLLADA file (allowed: a URDF or MJCF; a mesh is named in one)"},
             {"<model><robot name='r'>" + ballLink("a") + "</robot></model>",
              "<robot> inside of <model> (allowed: a file whose outermost element is <robot>)"},
             {"<r:robot xmlns:r='urdf' name='x'/>",
              "<r:robot> (allowed: <robot>, without the prefix of a namespace)"},
             {"<!DOCTYPE robot [<!ENTITY r '0.1'>]><robot name='r'>" + ballLink("a") + "</robot>",
              "hidden by <!DOCTYPE ...>, which is not read: remove it, and write the values of its entities"},
             {"<sdf version='1.6'/>", "an SDF" + instead},
         }) {
        const auto &text = given.first, &says = given.second;
        CAPTURE(text);
        const std::string refusal = refusalOfFile(text);
        CAPTURE(refusal);
        CHECK(refusal.find("arm.urdf: robot: " + says) != std::string::npos);
    }
    for (const char* before : {"", "\xef\xbb\xbf", "\n  ", "<?xml version='1.0'?>", "<!-- <model> -->"}) {
        CHECK(refusalOfFile(std::string(before) + "<robot name='r'>" + ballLink("a") + ballLink("b") +
                            jointText("j", "revolute", "a", "b", "0 0 0.1", "0 1 0") + "</robot>") == "");
    }
}
