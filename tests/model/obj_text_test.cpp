// SPDX-License-Identifier: Apache-2.0
// OBJ files as text: what the mesh library would misread without a word.
#include "engine/model/mesh_file.h"
#include "engine/types/error.h"
#include "tests/support/scratch_folder.h"

#include <cstdio>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

const std::string kObjFaces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
const std::string kObjVertices = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\n";
const std::string kObjTetra = kObjVertices + kObjFaces;

// Triangles and size [mm], or the refusal.
std::string readObj(const std::string& text) {
    const testing::ScratchFile file("text.obj", text);
    try {
        const TriangleMesh mesh = loadMesh(file.path()).mesh;
        const dvec3 size = 1e3 * (mesh.high() - mesh.low());
        char summary[80];
        std::snprintf(summary, sizeof summary, "%zu: %.3g %.3g %.3g", mesh.triangles.size(), size.x, size.y,
                      size.z);
        return summary;
    } catch (const BadInput& e) {
        return e.what();
    }
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
        text.replace(at, what.size(), by);
    }
    return text;
}

const std::string kRead = "4: 100 100 100";

} // namespace

TEST_CASE("The numbers of an OBJ may begin with a dot or a plus, and end with one") {
    CHECK(readObj(kObjTetra) == kRead);
    CHECK(readObj(replaced(kObjTetra, "0.1", ".1")) == kRead);
    CHECK(readObj(replaced(kObjTetra, "v 0.1", "v .1")) == kRead);
    CHECK(readObj(replaced(kObjTetra, "0.1", "-.1")) == kRead);
    CHECK(readObj(replaced(kObjTetra, "0.1", "+.1")) == kRead);
    CHECK(readObj(replaced(kObjTetra, "0.1", "1.e-1")) == kRead);
    CHECK(
        readObj("v 0 0 0\nv .1 0 0\nv 0 .1 0\nf -3 -2 -1\nv 0 0 .1\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n") ==
        kRead);
}

TEST_CASE("A colour or weight behind the coordinates of an OBJ does not scale them") {
    for (const char* colour : {" 0.2 .5 .5", " .2 .5 .5", " 0.2 0.5 0.5", " 2", " 1 1 1 1"}) {
        CHECK_MESSAGE(readObj(replaced(kObjVertices, "\n", colour + std::string("\n")) + kObjFaces) == kRead,
                      colour);
    }
}

TEST_CASE("A backslash at the end of a comment or name of an OBJ takes no line away") {
    for (const char* line : {"# exported from C:\\models\\", "g part\\", "usemtl a\\", "o C:\\", "s 1 \\"}) {
        CHECK_MESSAGE(readObj(replaced(kObjTetra, "0.1\nf", "0.1\n" + std::string(line) + "\nf")) == kRead,
                      line);
    }
    CHECK(readObj(replaced(kObjTetra, "f 1 3 2", "f 1 \\\n 3 2 # first \\")) == kRead);
    CHECK(readObj(replaced(kObjTetra, "v 0.1", "v 0.1\\\n")) == kRead);
}

TEST_CASE("An OBJ is read with comments behind faces, indented, of any line end and with other elements") {
    CHECK(readObj(replaced(kObjTetra, "f 1 3 2", "f 1 3 2 # first")) == kRead);
    CHECK(readObj("\t" + replaced(kObjTetra, "\n", "\n \t")) == kRead);
    CHECK(readObj(replaced(kObjTetra, "\n", "\r\n")) == kRead);
    CHECK(readObj(replaced(kObjTetra, "\n", "\r")) == kRead);
    CHECK(readObj("\xef\xbb\xbf" + kObjTetra) == kRead);
    CHECK(readObj("mtllib a.mtl\nvn 0 0 1\nvt 0 0\n" +
                  replaced(kObjTetra, "f 1 3 2", "p 1 2\nl 1 2 3\nf 1/1/1 3//1 2/1")) == kRead);
    CHECK(readObj(replaced(kObjTetra, "f ", "fo ")) == kRead);
    CHECK(readObj(kObjTetra.substr(0, kObjTetra.size() - 1)) == kRead);
}

TEST_CASE("An OBJ with a vertex or face that is not understood is rejected with its line") {
    const auto refuses = [](const std::string& text, const std::string& why) {
        const std::string result = readObj(text);
        INFO(result);
        return result.find(".obj: mesh: " + why) != std::string::npos;
    };
    CHECK(refuses(replaced(kObjTetra, "v 0.1", "v 1.0D-01"), "line 2: 'v 1.0D-01 0 0'"));
    CHECK(refuses(replaced(kObjTetra, "v 0.1 0", "v 0,1"), "line 2: 'v 0,1 0'"));
    CHECK(refuses(replaced(kObjTetra, "v 0.1 0 0", "v 0.1 0"), "line 2: "));
    CHECK(refuses(replaced(kObjTetra, "v 0.1", "v nan"), "line 2: "));
    CHECK(refuses(replaced(kObjTetra, "f 1 3 2", "f 1 a 2"), "line 5: 'f 1 a 2'"));
    CHECK(refuses(replaced(kObjTetra, "f 1 3 2", "f 0 3 2"), "line 5: "));
    CHECK(refuses(replaced(kObjTetra, "f 1 3 2", "f 1 5 2"), "line 5: vertex 5 of 4"));
    CHECK(refuses(replaced(kObjTetra, "f 1 3 2", "f 1 -5 2"), "line 5: 'f 1 -5 2'"));
    CHECK(readObj(kObjFaces + kObjVertices) == kRead);
    CHECK(refuses(kObjVertices + "p 1\n", "no faces"));
    CHECK(refuses("an OBJ?\n", "no vertices"));
    CHECK(refuses("", "no vertices"));
}

TEST_CASE("An OBJ with free-form surfaces, which would be missing, is rejected with the line of the first") {
    const std::string start = kObjTetra + "cstype bezier\ndeg 3 3\n";
    for (const char* surface : {"surf 0 1 0 1 1 2 3 4", "surf 0 1 0 1 1 \\\n2 3 4", "bzp 1 2 3 4"}) {
        const std::string result = readObj(start + surface + "\nend\n");
        CHECK_MESSAGE(result.find(".obj: mesh: line 1") != std::string::npos, result);
        CHECK_MESSAGE(result.find("', a free-form surface, not faces") != std::string::npos, result);
    }
    CHECK(readObj(start + "curv 0 1 1 2 3 4\nparm u 0 1\nend\n") == kRead);
}
