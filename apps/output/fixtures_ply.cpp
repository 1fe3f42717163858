// SPDX-License-Identifier: Apache-2.0
#include "apps/output/fixtures_ply.h"

#include "apps/output/silhouette.h"
#include "engine/types/output_file.h"

#include <bit>
#include <string>

namespace fathom {

namespace {

constexpr size_t kVertexBytes = 4 * sizeof(double) + 2 * sizeof(int32_t);

template <class Bits>
char* putLittleEndian(char* out, Bits bits) {
    for (size_t i = 0; i < sizeof(Bits); ++i) {
        *out++ = static_cast<char>((bits >> (8 * i)) & 0xffu);
    }
    return out;
}

} // namespace

std::filesystem::path fixturesFileName(int64_t frame) {
    std::string digits = std::to_string(frame);
    if (digits.size() < 6) {
        digits.insert(0, 6 - digits.size(), '0');
    }
    return std::filesystem::path("fixtures") / (digits + ".ply");
}

void writeFixturesPly(const std::filesystem::path& file, const HostFixtures& set) {
    const RegionSpheres& spheres = set.spheres;
    OutputFile out(file);
    out.write(std::string(kFixturesPlyStart) + "element vertex " + std::to_string(spheres.size()) +
              "\nproperty double x\nproperty double y\nproperty double z\nproperty double radius\n"
              "property int class\nproperty int held\nend_header\n");
    const uint32_t pixels = set.camera.depth.pixels();
    for (size_t i = 0; i < spheres.size(); ++i) {
        char vertex[kVertexBytes];
        char* next = vertex;
        const dvec3 at = regionCentre(set, i);
        for (double value : {at.x, at.y, at.z, double{spheres.radius[i]}}) {
            next = putLittleEndian(next, std::bit_cast<uint64_t>(value));
        }
        next = putLittleEndian(next, uint32_t{spheres.fixture[i]});
        putLittleEndian(next, uint32_t{spheres.source[i] >= pixels});
        out.write(vertex, sizeof vertex);
    }
    out.commit();
}

} // namespace fathom
